"""Files that other programs write are read to the same voxels at the same places.

Run as `python3 tests/formats/check.py PROGRAM`; PROGRAM is a built gelray. Each check needs a Python package and is left
out, with a line that says so, where it is missing: numpy (for all), pydicom, SimpleITK, nibabel, tifffile, vtk,
trimesh, PIL, zarr, ome_zarr.
Exit code 1 where anything differs.
"""

import importlib
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "target/release/gelray"
CHECKS = []


def check(*packages):
    """A check that is run where its packages are installed."""

    def add(function):
        CHECKS.append((function, packages))
        return function

    return add


def run(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done


def read_nrrd(path):
    """The voxels (z, y, x) and the affine of a file as `gelray convert` writes it."""
    head, body = path.read_bytes().split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines()[1:])
    kinds = {"float": "f4", "double": "f8"}
    kind = kinds.get(fields["type"], fields["type"].replace("uint", "u").replace("int", "i"))
    if kind[0] in "ui":
        kind = kind[0] + str(int(kind[1:]) // 8)
    size = [int(word) for word in fields["sizes"].split()]
    voxels = np.frombuffer(body, "<" + kind).reshape(size[::-1])
    vectors = (fields["space directions"] + " " + fields["space origin"]).replace("none ", "")
    columns = [[float(n) for n in vector.strip("()").split(",")] for vector in vectors.split()]
    affine = np.eye(4)
    affine[:3, :] = np.array(columns).T
    return voxels, affine


def same(path, voxels, affine, folder, tolerance=1e-4, *flags):
    """Whether gelray reads the same voxels at the same places; the affine is to left, posterior, superior."""
    out = folder / "out.nrrd"
    run("convert", path, out, *flags)
    found, placed = read_nrrd(out)
    assert found.shape == voxels.shape, (found.shape, voxels.shape)
    assert np.array_equal(found, voxels), "voxels differ"
    corners = np.array([[x, y, z, 1] for x in (0, 7) for y in (0, 7) for z in (0, 7)]).T
    apart = np.abs(placed @ corners - affine @ corners).max()
    assert apart < tolerance, f"places differ by {apart}"


def volume(kind="int16"):
    """Voxels that are all different along each axis."""
    z, y, x = np.mgrid[0:5, 0:6, 0:7]
    return (z * 100 + y * 10 + x).astype(kind)


def turned():
    """A rotation about an axis of no special direction, for affines that are not trivial."""
    a, b = 0.3, -0.2
    about_z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    about_x = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    return about_z @ about_x


SPACING, ORIGIN = (0.7, 0.9, 2.5), (-12.5, 30.25, 7.0)


def placed():
    affine = np.eye(4)
    affine[:3, :3] = turned() @ np.diag(SPACING)
    affine[:3, 3] = ORIGIN
    return affine


@check("SimpleITK")
def metaimage_nrrd_and_nifti_of_simpleitk(folder):
    import SimpleITK as sitk

    for kind in ["uint8", "int16", "uint16", "int32", "float32", "float64"]:
        image = sitk.GetImageFromArray(volume(kind))
        image.SetSpacing(SPACING)
        image.SetOrigin(ORIGIN)
        image.SetDirection(turned().ravel().tolist())
        for name, packed in [("a.mha", 0), ("b.mha", 1), ("c.mhd", 0), ("d.mhd", 1), ("e.nrrd", 1), ("f.nii.gz", 1)]:
            sitk.WriteImage(image, str(folder / name), bool(packed))
            same(folder / name, volume(kind), placed(), folder)


@check("nibabel")
def nifti_of_nibabel(folder):
    import nibabel

    to_ras = np.diag([-1.0, -1.0, 1.0, 1.0])
    image = nibabel.Nifti1Image(volume().T, to_ras @ placed())
    for name in ["a.nii", "a.nii.gz"]:
        nibabel.save(image, folder / name)
        same(folder / name, volume(), placed(), folder)
    times = np.stack([volume().T + time for time in range(3)], axis=3)
    for name in ["series.nii", "series.nii.gz"]:
        nibabel.save(nibabel.Nifti1Image(times, to_ras @ placed()), folder / name)
        same(folder / name, volume(), placed(), folder)
        same(folder / name, volume() + 2, placed(), folder, 1e-4, "--time", 2)


@check()
def arrays_of_numpy(folder):
    for kind in ["uint8", "int16", ">u2", "float32", "float64"]:
        np.save(folder / "a.npy", volume(kind))
        same(folder / "a.npy", volume(kind), np.eye(4), folder)
        np.save(folder / "a.npy", np.asfortranarray(volume(kind).T))
        same(folder / "a.npy", volume(kind), np.eye(4), folder)
        for save in [np.savez, np.savez_compressed]:
            save(folder / "a.npz", line=np.arange(9), voxels=volume(kind))
            same(folder / "a.npz", volume(kind), np.eye(4), folder)


@check("tifffile")
def stacks_of_tifffile(folder):
    import tifffile

    for kind, packing in [("uint8", None), ("uint16", "zlib"), ("float32", None)]:
        tifffile.imwrite(
            folder / "a.tif", volume(kind), imagej=packing is None, compression=packing,
            resolution=(1 / 0.5, 1 / 0.25), metadata={"spacing": 2.0, "unit": "um", "axes": "ZYX"} if packing is None else None,
        )
        spacing = (0.5, 0.25, 2.0) if packing is None else (1, 1, 1)
        same(folder / "a.tif", volume(kind), np.diag([*spacing, 1.0]), folder)


@check("vtk")
def images_of_vtk(folder):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    for kind in ["uint8", "int16", "float32", "float64"]:
        image = vtk.vtkImageData()
        image.SetDimensions(7, 6, 5)
        image.SetSpacing(SPACING)
        image.SetOrigin(ORIGIN)
        image.SetDirectionMatrix(*turned().ravel())
        image.GetPointData().SetScalars(numpy_to_vtk(volume(kind).ravel(), deep=True))
        for mode in ["Ascii", "Binary", "Appended"]:
            for packed in [False, True]:
                writer = vtk.vtkXMLImageDataWriter()
                writer.SetFileName(str(folder / "a.vti"))
                writer.SetInputData(image)
                getattr(writer, f"SetDataModeTo{mode}")()
                if not packed:
                    writer.SetCompressorTypeToNone()
                writer.SetEncodeAppendedData(packed)
                writer.Write()
                same(folder / "a.vti", volume(kind), placed(), folder)


def small(kind):
    """Voxels that all number types hold, of more than one chunk on each axis."""
    z, y, x = np.mgrid[0:13, 0:20, 0:37]
    return ((z * 740 + y * 37 + x) % 113).astype(kind)


@check("zarr", "numcodecs")
def arrays_of_zarr_2(folder):
    import numcodecs
    import zarr

    ways = [None, numcodecs.Zlib(), numcodecs.GZip(), numcodecs.Zstd(), numcodecs.LZ4()]
    for name in numcodecs.blosc.list_compressors():
        for shuffle in [numcodecs.Blosc.NOSHUFFLE, numcodecs.Blosc.SHUFFLE, numcodecs.Blosc.BITSHUFFLE]:
            ways.append(numcodecs.Blosc(cname=name, clevel=5, shuffle=shuffle, blocksize=1024 if shuffle == 1 else 0))
    kinds = ["|u1", "|i1", "<u2", ">i2", "<u4", ">i4", "<f4", ">f8"]
    for number, way in enumerate(ways):
        for kind in kinds:
            path = folder / f"a{number}{kind[1:]}.zarr"
            array = zarr.create_array(
                path, shape=small(kind).shape, chunks=(8, 16, 16), dtype=kind, compressors=way, zarr_format=2,
                order="CF"[number % 2], fill_value=7, chunk_key_encoding={"name": "v2", "separator": "./"[number % 2]},
            )
            array[:] = small(kind)
            same(path, small(kind), np.eye(4), folder)
    voxels = small("<f2")
    zarr.create_array(folder / "half.zarr", shape=voxels.shape, chunks=voxels.shape, dtype="<f2", zarr_format=2)[:] = voxels
    same(folder / "half.zarr", voxels.astype("f4"), np.eye(4), folder)


@check("zarr")
def arrays_of_zarr_3(folder):
    import zarr
    from zarr.codecs import BloscCodec, BytesCodec, Crc32cCodec, GzipCodec, ShardingCodec, TransposeCodec, ZstdCodec

    turned, big = TransposeCodec(order=(2, 0, 1)), BytesCodec(endian="big")
    chains = [
        dict(compressors=None), dict(compressors=ZstdCodec(level=3, checksum=True)), dict(compressors=GzipCodec()),
        dict(compressors=[ZstdCodec(), Crc32cCodec()], filters=[turned], serializer=big),
        dict(compressors=BloscCodec(cname="lz4", shuffle="bitshuffle")), dict(shards=(16, 32, 32)),
        dict(shards=(8, 16, 48), compressors=BloscCodec(cname="zstd"), filters=[turned], serializer=big),
        dict(chunks=(16, 32, 32), compressors=None, serializer=ShardingCodec(
            chunk_shape=(8, 16, 16), codecs=[BytesCodec(), GzipCodec()], index_codecs=[BytesCodec()], index_location="start")),
    ]
    for number, chain in enumerate(chains):
        for kind in ["uint8", "int16", "uint32", "float32", "float64", "float16"]:
            for separator in "/.":
                path = folder / f"{number}{kind}{separator == '/'}.zarr"
                array = zarr.create_array(
                    path, **{"chunks": (8, 16, 16), **chain}, shape=small(kind).shape, dtype=kind, zarr_format=3,
                    fill_value=3, chunk_key_encoding={"name": "default", "separator": separator},
                )
                # The rest is the fill value, of which nothing is written.
                array[:, :16, 16:] = small(kind)[:, :16, 16:]
                expected = np.full_like(small(kind), 3)
                expected[:, :16, 16:] = small(kind)[:, :16, 16:]
                same(path, expected.astype("float32") if kind == "float16" else expected, np.eye(4), folder)


@check("zarr")
def images_of_ome_zarr(folder):
    import zarr

    levels = np.stack([small("uint16"), small("uint16") + 1])[None]
    axes = [{"name": "t", "type": "time"}, {"name": "c", "type": "channel"}]
    axes += [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
    (x, y, z), (ox, oy, oz) = SPACING, ORIGIN
    steps = [{"type": "scale", "scale": [1, 1, 1000 * z, 1000 * y, 1000 * x]},
             {"type": "translation", "translation": [0, 0, 1000 * oz, 1000 * oy, 1000 * ox]}]
    coarse = [{"type": "scale", "scale": [1, 1, 2000 * z, 2000 * y, 2000 * x]}]
    image = {"axes": axes, "datasets": [{"path": "0", "coordinateTransformations": steps}, {"path": "1", "coordinateTransformations": coarse}]}
    affine = np.diag([*SPACING, 1.0])
    affine[:3, 3] = ORIGIN
    for version in [2, 3]:
        path = folder / f"image{version}.zarr"
        stated = {"multiscales": [{"version": "0.4", **image}]}
        group = zarr.create_group(path, zarr_format=version, attributes=stated if version == 2 else {"ome": {"version": "0.5", "multiscales": [image]}})
        for name, step in [("0", 1), ("1", 2)]:
            part = levels[:, :, ::step, ::step, ::step]
            group.create_array(name, shape=part.shape, chunks=(1, 1, 8, 16, 16), dtype="uint16")[:] = part
        same(path, levels[0, 0], affine, folder)
        same(path / "0", levels[0, 0], affine, folder)
        same(path / "1", levels[0, 0, ::2, ::2, ::2], np.diag([*(2 * np.array(SPACING)), 1.0]), folder)


@check("ome_zarr", "zarr")
def images_of_ome_zarr_py(folder):
    import zarr
    from ome_zarr.format import FormatV04, FormatV05
    from ome_zarr.writer import write_image

    halved = [dict.fromkeys("zyx", 2)]
    for style, version, (unit, length_mm), kind in [
        (FormatV04(), 2, ("millimeter", 1.0), "uint16"),
        (FormatV05(), 3, ("micrometer", 1e-3), "uint8"),
        (FormatV05(), 3, ("meter", 1e3), "float32"),
    ]:
        path = folder / f"{unit}.zarr"
        group = zarr.open_group(path, mode="w", zarr_format=version)
        scale = {name: step / length_mm for name, step in zip("xyz", SPACING)}
        how = {"scale": scale, "axes_units": dict.fromkeys("zyx", unit), "scale_factors": halved, "fmt": style}
        write_image(small(kind), group, axes="zyx", **how)
        same(path, small(kind), np.diag([*SPACING, 1.0]), folder)
        # Each level at its own places, as the file's own words and zarr have it.
        stated = group.attrs.asdict()
        levels = stated.get("ome", stated)["multiscales"][0]["datasets"]
        assert len(levels) == 2, levels
        for level in levels:
            affine = np.eye(4)
            for step in level["coordinateTransformations"]:
                if step["type"] == "scale":
                    affine[:3, :3] = np.diag(step["scale"][::-1]) * length_mm
                else:
                    affine[:3, 3] = np.array(step["translation"][::-1]) * length_mm
            same(path / level["path"], group[level["path"]][:], affine, folder)

    # A channel and a time of an image of five axes.
    image = np.stack([small("int16") + at for at in range(4)]).reshape(2, 2, *small("int16").shape)
    units = {"t": "second", **dict.fromkeys("zyx", "millimeter")}
    write_image(image, str(folder / "five.zarr"), axes="tczyx", scale=dict(zip("xyz", SPACING)), axes_units=units)
    same(folder / "five.zarr", image[0, 0], np.diag([*SPACING, 1.0]), folder)


def write_series(folder, syntax, tilt=0.0, name="slice"):
    """Slices of signed values as 12 bits plus 1024, named against their order."""
    import pydicom
    from pydicom.dataset import FileDataset, FileMetaDataset
    from pydicom.uid import ExplicitVRLittleEndian, RLELossless, generate_uid

    rotation, series = turned(), generate_uid()
    for number, pixels in enumerate(volume()):
        meta = FileMetaDataset()
        meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
        meta.MediaStorageSOPInstanceUID = generate_uid()
        meta.TransferSyntaxUID = ExplicitVRLittleEndian if syntax == RLELossless else syntax
        slice_ = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
        slice_.SOPClassUID, slice_.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
        slice_.Modality, slice_.SeriesInstanceUID, slice_.InstanceNumber = "CT", series, 50 - number
        slice_.ImageOrientationPatient = [*map(float, rotation[:, 0]), *map(float, rotation[:, 1])]
        way = rotation[:, 2] + tilt * rotation[:, 1]
        slice_.ImagePositionPatient = [*map(float, np.array(ORIGIN) + number * SPACING[2] * way)]
        slice_.PixelSpacing = [SPACING[1], SPACING[0]]
        slice_.Rows, slice_.Columns = pixels.shape
        slice_.SamplesPerPixel, slice_.PhotometricInterpretation = 1, "MONOCHROME2"
        slice_.BitsAllocated, slice_.BitsStored, slice_.HighBit, slice_.PixelRepresentation = 16, 12, 11, 0
        slice_.RescaleSlope, slice_.RescaleIntercept = 1, -1024
        order = ">u2" if syntax == "1.2.840.10008.1.2.2" else "<u2"
        slice_.PixelData = (pixels + 1024).astype(order).tobytes()
        slice_["PixelData"].VR = "OW"
        if syntax == RLELossless:
            slice_.compress(RLELossless)
        pydicom.dcmwrite(folder / f"{name}{9 - number}", slice_, enforce_file_format=True)


@check("pydicom", "SimpleITK")
def series_of_pydicom_as_simpleitk_reads_them(folder):
    import SimpleITK as sitk

    names = ["1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2", "1.2.840.10008.1.2.5"]
    for syntax in names:
        own = folder / syntax
        own.mkdir()
        write_series(own, syntax)
        same(own, volume(), placed(), folder, 1e-3)
        same(own / "slice7", volume(), placed(), folder, 1e-3)
        if syntax != "1.2.840.10008.1.2.2":
            reader = sitk.ImageSeriesReader()
            reader.SetFileNames(reader.GetGDCMSeriesFileNames(str(own)))
            image = reader.Execute()
            assert np.array_equal(sitk.GetArrayFromImage(image), volume())
            assert np.allclose(image.GetOrigin(), ORIGIN, atol=1e-3)


@check("pydicom")
def a_tilted_gantry_is_sheared_and_not_resampled(folder):
    write_series(folder, "1.2.840.10008.1.2.1", tilt=0.3)
    affine = placed()
    affine[:3, 2] = SPACING[2] * (turned()[:, 2] + 0.3 * turned()[:, 1])
    same(folder, volume(), affine, folder / "..", 1e-3)


def drawn(path, folder):
    """A picture of a mesh, its coordinates taken as the world's whatever its format says of them."""
    plain = ["--set", "mesh.mesh.space=lps", "--set", "mesh.mesh.unit_mm=1", "--set", "mesh.smooth.normals=triangles"]
    run("render", path, "-o", folder / "drawn.npy", "--size", "64x64", "-q", *plain)
    return np.load(folder / "drawn.npy")


def alike(paths, folder):
    """Meshes are drawn to the same picture, but for coordinates that text has rounded."""
    pictures = [drawn(path, folder) for path in paths]
    assert pictures[0][..., 3].max() > 0.9, "nothing is drawn"
    for path, picture in zip(paths, pictures):
        apart = np.abs(picture - pictures[0]).max()
        assert apart < 0.05, f"{path.name} differs by {apart}"


@check("trimesh")
def meshes_of_trimesh_are_drawn_alike(folder):
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=2, radius=10.0)
    paths = []
    for name in ["ball.stl", "ball_text.stl", "ball.ply", "ball_text.ply", "ball.obj", "ball.glb", "ball.gltf"]:
        options = {"file_type": "stl_ascii"} if name == "ball_text.stl" else {}
        options |= {"encoding": "ascii"} if name == "ball_text.ply" else {}
        if name == "ball.gltf":
            for inner, content in trimesh.Scene(mesh).export(file_type="gltf").items():
                (folder / (name if inner == "model.gltf" else inner)).write_bytes(content)
        else:
            mesh.export(folder / name, **options)
        paths.append(folder / name)
    alike(paths, folder)


@check("vtk")
def meshes_of_vtk_are_drawn_alike(folder):
    import vtk

    ball = vtk.vtkSphereSource()
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(16)
    strips = vtk.vtkStripper()
    strips.SetInputConnection(ball.GetOutputPort())
    strips.Update()
    paths = []

    def write(writer, name, output=ball):
        writer.SetInputData(output.GetOutput())
        writer.SetFileName(str(folder / name))
        assert writer.Write() == 1
        paths.append(folder / name)

    write(vtk.vtkSTLWriter(), "ball.stl")
    write(vtk.vtkPLYWriter(), "ball.ply")
    write(vtk.vtkXMLPolyDataWriter(), "strips.vtp", strips)
    write(vtk.vtkPolyDataWriter(), "strips.vtk", strips)
    for mode in ["Ascii", "Binary", "Appended"]:
        for packed in [False, True]:
            writer = vtk.vtkXMLPolyDataWriter()
            getattr(writer, f"SetDataModeTo{mode}")()
            if not packed:
                writer.SetCompressorTypeToNone()
            writer.SetEncodeAppendedData(packed)
            write(writer, f"{mode}{packed}.vtp")
    for version in [42, 51]:
        for kind in ["ASCII", "Binary"]:
            writer = vtk.vtkPolyDataWriter()
            writer.SetFileVersion(version)
            getattr(writer, f"SetFileTypeTo{kind}")()
            write(writer, f"{kind}{version}.vtk")
    alike(paths, folder)


def painted(path, folder, *more):
    """A picture of a mesh in a texture, lit by its own normals; coordinates as in `drawn`."""
    scene = folder / "painted.toml"
    scene.write_text(f'''
[[entity]]
name = "mesh"
mesh = {{ file = "{path}", space = "lps", unit_mm = 1 }}
smooth = {{}}
textured = {{ texture = "portrait" }}
[[entity]]
name = "key"
light = {{ toward = [-1, -1, 0.5] }}
[[entity]]
name = "observer"
view = {{ size = [96, 96], azimuth = 20, elevation = 10 }}
''')
    run("render", scene, "-o", folder / "painted.npy", "-q", "--exact", *more)
    return np.load(folder / "painted.npy")


def painted_alike(paths, folder):
    """Meshes that have normals and places in a texture are painted alike, and not as they would be without."""
    pictures = [painted(path, folder) for path in paths]
    for path, picture in zip(paths, pictures):
        apart = np.abs(picture - pictures[0]).max()
        assert apart < 0.05, f"{path.name} differs by {apart}"
    one = "mesh.textured.corners=[[-90,0,90],[90,0,90],[-90,0,-90]]"
    for other in ["mesh.smooth.normals=triangles", one]:
        apart = np.abs(painted(paths[0], folder, "--set", other) - pictures[0]).max()
        assert apart > 0.2, f"{other} makes no difference"


@check("trimesh", "PIL")
def normals_and_places_of_trimesh_are_painted_alike(folder):
    import trimesh
    from PIL import Image

    ball = trimesh.creation.icosphere(subdivisions=3, radius=10.0)
    points = ball.vertices
    normals = points * [1, 1, 0.1] / np.linalg.norm(points * [1, 1, 0.1], axis=1)[:, None]
    uv = points[:, [0, 2]] / 20 + 0.5
    material = trimesh.visual.material.PBRMaterial(baseColorTexture=Image.new("RGB", (4, 4)))
    visual = trimesh.visual.TextureVisuals(uv=uv, material=material)
    mesh = trimesh.Trimesh(points, ball.faces, vertex_normals=normals, visual=visual, process=False)
    paths = [folder / name for name in ["ball.obj", "ball.glb"]]
    mesh.export(paths[0], include_normals=True)
    mesh.export(paths[1], include_normals=True)
    painted_alike(paths, folder)


def looks(path, folder, texture=""):
    """A picture of a mesh as its file has it look, or in a texture that the scene states."""
    scene = folder / "looks.toml"
    stated = 'textured = { texture = "stated" }' if texture else ""
    scene.write_text(f'''
[[entity]]
name = "mesh"
mesh = {{ file = "{path}", space = "lps", unit_mm = 1 }}
surface = {{ ambient = 1, diffuse = 0 }}
{stated}
[[entity]]
name = "observer"
view = {{ size = [96, 96], azimuth = 20, elevation = 10 }}
''')
    if texture:
        scene.write_text(scene.read_text() + f'[[entity]]\nname = "stated"\ntexture = {{ file = "{texture}" }}\n')
    done = run("render", scene, "-o", folder / "looks.npy", "--exact")
    assert "picture" not in done.stderr, done.stderr
    return np.load(folder / "looks.npy")


@check("trimesh", "PIL")
def pictures_of_trimesh_are_laid_as_those_that_are_stated(folder):
    import trimesh
    from PIL import Image

    y, x = np.mgrid[0:64, 0:64]
    picture = Image.fromarray(np.stack([4 * x, 4 * y, 255 * (x > y)], axis=-1).astype("u1"))
    picture.save(folder / "stated.png")
    ball = trimesh.creation.icosphere(subdivisions=3, radius=10.0)
    uv = ball.vertices[:, [0, 2]] / 22 + 0.5
    white = [255, 255, 255, 255]
    for name, material in [
        ("ball.glb", trimesh.visual.material.PBRMaterial(baseColorTexture=picture)),
        ("ball.gltf", trimesh.visual.material.PBRMaterial(baseColorTexture=picture)),
        ("ball.obj", trimesh.visual.material.SimpleMaterial(image=picture, diffuse=white)),
    ]:
        visual = trimesh.visual.TextureVisuals(uv=uv, material=material)
        mesh = trimesh.Trimesh(ball.vertices, ball.faces, visual=visual, process=False)
        if name == "ball.gltf":
            for inner, content in trimesh.Scene(mesh).export(file_type="gltf").items():
                (folder / (name if inner == "model.gltf" else inner)).write_bytes(content)
        else:
            mesh.export(folder / name)
        own = looks(folder / name, folder)
        assert own[..., 3].max() > 0.9 and np.ptp(own[40:56, 40:56, 0]) > 0.05, "no picture is seen"
        apart = np.abs(own - looks(folder / name, folder, "stated.png")).max()
        assert apart < 1e-3, f"{name} differs by {apart}"


@check("trimesh", "PIL")
def several_pictures_and_a_factor_of_trimesh_are_each_on_its_own(folder):
    import trimesh
    from PIL import Image

    place, scene = np.eye(4), trimesh.Scene()
    materials = [{"baseColorTexture": Image.new("RGB", (4, 4), color)} for color in [(255, 0, 0), (0, 0, 255)]]
    materials.append({"baseColorFactor": [0, 255, 0, 255]})
    for at, stated in enumerate(materials):
        ball = trimesh.creation.icosphere(subdivisions=2, radius=4.0)
        material = trimesh.visual.material.PBRMaterial(**stated)
        visual = trimesh.visual.TextureVisuals(uv=ball.vertices[:, :2], material=material)
        place[0, 3] = 10 * at
        scene.add_geometry(trimesh.Trimesh(ball.vertices, ball.faces, visual=visual, process=False), transform=place)
    scene.export(folder / "balls.glb")
    seen = looks(folder / "balls.glb", folder)
    for channel, count in enumerate([(seen[..., c] > 0.9).sum() for c in range(3)]):
        assert count > 100, f"the ball of channel {channel} is not seen"


@check("vtk")
def normals_and_places_of_vtk_are_painted_alike(folder):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    ball = vtk.vtkSphereSource()
    ball.SetRadius(10)
    ball.SetThetaResolution(48)
    ball.SetPhiResolution(32)
    ball.Update()
    mesh = ball.GetOutput()
    # Of so few digits that text rounds none.
    points = np.round(vtk_to_numpy(mesh.GetPoints().GetData()), 3).astype("f4")
    mesh.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    arrays = {"Normals": points * [1, 1, 0.1], "TCoords": points[:, [0, 2]] / 20 + 0.5, "Scalars": points[:, 0]}
    for use, array in arrays.items():
        if use == "Normals":
            array = array / np.linalg.norm(array, axis=1)[:, None]
        own = numpy_to_vtk(np.ascontiguousarray(array, "f4"), deep=True)
        own.SetName("own_" + use.lower())
        getattr(mesh.GetPointData(), "Set" + use)(own)
    cells = numpy_to_vtk(np.arange(mesh.GetNumberOfCells(), dtype="i8"), deep=True)
    cells.SetName("number")
    mesh.GetCellData().AddArray(cells)
    paths = []

    def write(writer, name):
        writer.SetInputData(mesh)
        writer.SetFileName(str(folder / name))
        assert writer.Write() == 1
        paths.append(folder / name)

    write(vtk.vtkXMLPolyDataWriter(), "ball.vtp")
    for version in [42, 51]:
        for kind in ["ASCII", "Binary"]:
            writer = vtk.vtkPolyDataWriter()
            writer.SetFileVersion(version)
            getattr(writer, f"SetFileTypeTo{kind}")()
            write(writer, f"{kind}{version}.vtk")
    write(vtk.vtkOBJWriter(), "ball.obj")
    for kind in ["ASCII", "Binary"]:
        writer = vtk.vtkPLYWriter()
        getattr(writer, f"SetFileTypeTo{kind}")()
        writer.SetTextureCoordinatesNameToTextureUV()
        write(writer, f"{kind}.ply")
    painted_alike(paths, folder)


def main():
    failed = 0
    for function, packages in CHECKS:
        name = function.__name__.replace("_", " ")
        missing = [package for package in packages if importlib.util.find_spec(package) is None]
        if missing:
            print(f"skipped: {name}: the Python package {missing[0]} is not installed")
            continue
        with tempfile.TemporaryDirectory() as folder:
            inner = Path(folder) / "files"
            inner.mkdir()
            try:
                function(inner)
                print(f"ok: {name}")
            except Exception as problem:
                failed += 1
                print(f"FAILED: {name}: {problem}")
    sys.exit(1 if failed else 0)


try:
    import importlib.util

    import numpy as np
except ModuleNotFoundError:
    print("skipped: all checks of formats: the Python package numpy is not installed")
    sys.exit(0)
main()
