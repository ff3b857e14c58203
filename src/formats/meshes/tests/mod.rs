//! Facts about meshes: the same tetrahedron in every format, and files that are not what they say.

mod clear;
mod corners;
mod materials;
mod moved;
mod sound;

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::components::Space;
use sound::{POINTS, SIDES, glb, sound};

fn read(name: &str, bytes: &[u8]) -> Result<Triangles, String> {
    let format = mesh_format(Path::new(name)).unwrap();
    (format.read)(bytes, Path::new(name)).and_then(checked)
}

#[test]
fn a_tetrahedron_is_the_same_in_every_format() {
    for (name, bytes) in sound() {
        let mesh = read(name, &bytes).unwrap();
        let corners = mesh.faces.iter().map(|face| face.map(|at| mesh.vertices[at as usize]));
        let expected = SIDES.map(|side| side.map(|at| DVec3::from(POINTS[at].map(f64::from))));
        assert_eq!(corners.collect::<Vec<_>>(), expected, "{name}");
        assert!(mesh.warnings.is_empty(), "{name} {:?}", mesh.warnings);
    }
}

#[test]
fn a_square_is_two_triangles_and_that_is_said() {
    let mesh = read("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
    assert_eq!(mesh.faces, [[0, 1, 2], [0, 2, 3]]);
    assert!(mesh.warnings[0].contains("1 of its polygons"));
}

#[test]
fn pictures_of_a_gltf_that_are_of_no_base_color_are_said() {
    let more = r#""images":[{"uri":"a.png"}],"scenes":[{"nodes":[0]}]"#;
    let mesh = read("a.glb", &glb(r#""nodes":[{"mesh":0}]"#, more)).unwrap();
    assert!(mesh.warnings.len() == 1 && mesh.pictures.is_empty());
    assert!(mesh.warnings[0].contains("1 of its pictures"), "{:?}", mesh.warnings);
}

#[test]
fn what_is_wrong_is_said() {
    for (name, bytes, said) in [
        ("a.obj", &b"v 0 0 0\nf 1 2 3\n"[..], "line 2"),
        ("a.obj", b"v 0 0\n", "line 1"),
        ("a.obj", b"v 0 0 0\n", "no face"),
        ("a.obj", b"v 0 0 nan\nv 1 1 1\nv 1 1 2\nf 1 2 3\n", "not finite"),
        ("a.stl", b"solid x\nvertex 1 2\n", "line 2"),
        ("a.stl", b"hello", "truncated"),
        ("a.gltf", b"{", "glTF"),
        ("a.gltf", b"{\"asset\":{\"version\":\"1.0\"}}", "2.0 is read"),
        ("a.gltf", b"{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]}", "draco"),
        ("a.gltf", b"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"children\":[0]}],\"scenes\":[{\"nodes\":[0]}]}", "circle"),
        ("a.gltf", b"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":1,\"uri\":\"missing.bin\"}]}", "missing.bin"),
        ("a.vtp", b"<VTKFile><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"></Piece>", "lacks an array"),
        ("a.vtp", b"<VTKFile><PolyData></PolyData></VTKFile>", "no face"),
        ("a.vtk", b"hello", "vtk DataFile"),
        ("a.vtk", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n", "no PolyData"),
        ("a.vtk", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 99999999 float\n1 2 3\n", "truncated"),
        ("a.ply", b"hello\n", "`ply`"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n0\n", "truncated"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_index\nend_header\n3 0 1 2\n", "beyond"),
    ] {
        let problem = read(name, bytes).unwrap_err();
        assert!(problem.contains(said), "{problem}");
    }
}

/// Reads the bytes; what comes out, if anything, names vertices that there are, no more than the bytes could hold.
fn consistent(name: &str, bytes: &[u8]) {
    if let Ok(mesh) = read(name, bytes) {
        assert!(mesh.faces.len() + mesh.vertices.len() <= bytes.len());
    }
}

#[test]
fn no_part_of_a_file_is_more_than_it_is() {
    for (name, bytes) in sound() {
        (0..bytes.len()).for_each(|length| consistent(name, &bytes[..length]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn changed_bytes_never_panic(
        file in 0..14_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let (name, mut bytes) = sound().swap_remove(file);
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        consistent(name, &bytes);
    }
}

#[test]
fn triangles_have_the_mean_of_the_colors_of_their_vertices() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        read_mesh(&path).unwrap()
    };
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 255 255\n3 0 1 2\n";
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 1 1\nf 1 2 3\n";
    for triangles in [read("a.ply", ply), read("a.obj", obj)] {
        let color = triangles.color(0).unwrap().0;
        assert!(color.abs_diff_eq(glam::Vec3::new(1.0, 2.0, 1.0) / 3.0, 1e-6), "{color}");
    }
    let partly = read("b.obj", "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 1 1\nf 1 2 3\n");
    assert!(partly.colors.is_empty() && partly.warnings[0].contains("no color"));
}

#[test]
fn nodes_place_a_mesh_and_a_file_that_places_it_without_end_is_refused() {
    let nodes =
        r#""nodes":[{"mesh":0,"translation":[0,0,5],"children":[1]},{"mesh":0,"scale":[-2,2,2]}]"#;
    let mesh = read("a.glb", &glb(nodes, r#""scenes":[{"nodes":[0]}]"#)).unwrap();
    assert_eq!((mesh.vertices.len(), mesh.faces.len()), (8, 8));
    assert_eq!(mesh.vertices[1], DVec3::new(1.0, 0.0, 5.0));
    assert_eq!(mesh.vertices[5], DVec3::new(-2.0, 0.0, 5.0));
    // What is mirrored runs the other way around, and stays outside out.
    assert_eq!((mesh.faces[0], mesh.faces[4]), ([0, 2, 1], [4, 5, 6]));
    assert_eq!((mesh.space, mesh.unit_mm), (Some(Space::YUp), Some(1000.0)));
    let copies = vec!["0"; 90_000].join(",");
    let children = vec![copies; 3].join(",");
    let nodes = format!(r#""nodes":[{{"mesh":0}},{{"children":[{children}]}}]"#);
    let problem = read("a.glb", &glb(&nodes, r#""scenes":[{"nodes":[1]}]"#)).unwrap_err();
    assert!(problem.contains("nodes"), "{problem}");
}

#[test]
fn a_factor_of_a_material_colors_what_it_is_on() {
    let more = r#""materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1]}}]"#;
    let mesh = read("a.glb", &glb(r#""nodes":[{"mesh":0}]"#, more)).unwrap();
    let color = mesh.color(0).unwrap().0;
    assert!(color.abs_diff_eq(glam::Vec3::new(0.5, 0.25, 1.0), 1e-6));
}

#[test]
fn a_strip_turns_every_second_triangle_and_scalars_of_bytes_are_colors() {
    let array = |kind: &str, name: &str, width: usize, text: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{width}\" format=\"ascii\">{text}</DataArray>"
        )
    };
    let text = format!(
        "<VTKFile><PolyData><Piece NumberOfPoints=\"4\" NumberOfStrips=\"1\"><PointData Scalars=\"c\">{}</PointData><Points>{}</Points><Strips>{}{}</Strips></Piece></PolyData></VTKFile>",
        array("UInt8", "c", 3, "255 0 0 255 0 0 255 0 0 255 0 0"),
        array("Float32", "p", 3, "0 0 0 1 0 0 0 1 0 1 1 0"),
        array("Int32", "connectivity", 1, "0 1 2 3"),
        array("Int32", "offsets", 1, "4"),
    );
    let mesh = read("a.vtp", text.as_bytes()).unwrap();
    assert_eq!(mesh.faces, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(mesh.color(1).unwrap().0, glam::Vec3::X);
}
