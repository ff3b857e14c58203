//! A volume in place of a scene: drawn at once, said aloud, and its scene saved.

use gelray::formats::{Loaded, Stated, Voxels, read_picture, read_volume};
use gelray::volume::grid::Scalars;

use super::{Place, Ran, small_nrrd};

fn place() -> Place {
    let place = Place::new();
    place.write("small.nrrd", small_nrrd());
    place
}

#[test]
fn a_volume_without_a_scene_is_drawn_and_what_it_was_taken_for_is_said() {
    let place = place();
    let ran = place.done("render small.nrrd -o a.png --size 40x30");
    assert!(ran.err.contains("labels by its values") && ran.err.contains("--iso"), "{}", ran.err);
    let picture = read_picture(&place.path("a.png")).unwrap();
    assert_eq!(picture.size, [40, 30]);
    // It fills the picture: the middle is lit gel, and a corner the background.
    let (middle, corner) = (picture.pixels[15 * 40 + 20], picture.pixels[0]);
    assert!(middle[0] > 4.0 * corner[0], "{middle:?} {corner:?}");
    assert_eq!(place.done("render small.nrrd -q -o b.png").err, "");
}

#[test]
fn the_saved_scene_makes_the_same_bytes_from_its_own_folder_and_from_another() {
    let place = place();
    place.done("render small.nrrd -o a.png --size 40x30 --iso 100 --save-scene small.toml");
    place.done("render small.toml -o b.png");
    assert_eq!(place.read("a.png"), place.read("b.png"));
    std::fs::create_dir(place.path("kept")).unwrap();
    place.done("render small.nrrd -o c.png --size 40x30 --iso 100 --save-scene kept/small.toml");
    place.done("render kept/small.toml -o d.png");
    let pixels = |name| read_picture(&place.path(name)).unwrap().pixels.to_vec();
    assert!(pixels("a.png") == pixels("d.png"));
}

#[test]
fn changes_and_plans_are_those_of_the_scene_that_is_made() {
    let place = place();
    place.done("render small.nrrd -o a.png --size 40x30");
    place.done("render small.nrrd -o b.png --size 40x30 --set volume.material.color=#00ff00");
    assert_ne!(place.read("a.png"), place.read("b.png"));
    assert!(place.done("plan small.nrrd --preset ct-skin").out.contains("volume"));
    place.refused("render small.nrrd -o a.png --max-memory 100", 1, &["120", "memory"]);
}

#[test]
fn a_mesh_is_drawn_with_y_up_or_as_a_scene_states() {
    let place = Place::new();
    // A triangle that stands: wide at its foot, y up.
    place.write("foot.obj", "v -1 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    let ran = place.done("render foot.obj -o a.png --size 40x40 --save-scene foot.toml");
    assert!(ran.err.contains("y up") && ran.err.contains("`space`"), "{}", ran.err);
    let lit = |name: &str| {
        let picture = read_picture(&place.path(name)).unwrap();
        let row = |y: usize| picture.pixels[y * 40..(y + 1) * 40].iter();
        let count = |y: usize| row(y).filter(|pixel| pixel[0] > 0.05).count();
        [count(12), count(28)]
    };
    let [above, below] = lit("a.png");
    assert!(above > 0 && below > above, "{above} {below}");
    // Lying on its back, it is seen from a little above: next to nothing.
    place.done("render foot.toml -o b.png --set mesh.mesh.space=lps");
    assert_eq!(lit("b.png")[0], 0);
    place.done("render foot.toml -o c.png --set mesh.mesh.unit_mm=1000 --set mesh.mesh.space=y-up");
    assert_eq!(lit("c.png"), [above, below]);
    // The same triangle, in meters, and as PolyData that says nothing of its axes.
    place.write("foot.gltf", r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"data:;base64,AACAvwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]}"#);
    place.done("render foot.gltf -o d.png --size 40x40");
    assert_eq!(lit("d.png"), [above, below]);
    place.write("foot.vtk", "# vtk DataFile Version 3.0\nfoot\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n-1 0 0 1 0 0 0 2 0\nPOLYGONS 1 4\n3 0 1 2\n");
    place.done("render foot.vtk -o e.png --size 40x40 --set mesh.mesh.space=y-up");
    assert_eq!(lit("e.png"), [above, below]);
    place.refused("render foot.obj -o a.png --iso 3", 2, &["surface already"]);
    place.write(
        "point.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n3\n",
    );
    place.refused("render point.ply -o a.png", 1, &["no face"]);
}

#[test]
fn a_volume_is_converted_to_nrrd_bit_for_bit() {
    let place = place();
    place.done("convert small.nrrd big.nrrd");
    let of = |name: &str| read_volume(&place.path(name), &Stated::default()).unwrap();
    let (small, big) = (of("small.nrrd"), of("big.nrrd"));
    let bytes = |loaded: Loaded| match loaded.voxels {
        Voxels::Scalars(Scalars::U8(values)) => values.to_vec(),
        _ => panic!("not bytes"),
    };
    assert_eq!(small.grid, big.grid);
    assert_eq!(bytes(small), bytes(big));
    place.refused("convert small.nrrd small.mha", 2, &[".nrrd"]);
    place.refused("convert small.nrrd small.nrrd", 2, &["choose another"]);
    place.refused("convert nowhere.nii a.nrrd", 1, &["nowhere.nii"]);
}

#[test]
fn flags_of_a_volume_without_a_scene_are_misuse_with_a_scene() {
    let place = place();
    for flag in ["--iso 300", "--preset ct-bone", "--save-scene a.toml"] {
        place.refused(&format!("render cross.toml -o a.png {flag}"), 2, &["--set"]);
    }
    place.refused("render small.nrrd -o a.png --preset bone", 2, &["ct-bone", "mr-brain"]);
    place.refused("render small.nrrd -o a.png --iso x", 2, &["300"]);
    place.refused("render small.nrrd -o a.png --iso 3 --preset ct-bone", 2, &["--preset"]);
    place.refused("render small.nrrd -o a.png --save-scene a.png", 2, &["both name"]);
    place.refused("render small.nrrd -o a.png --save-scene small.nrrd", 2, &["is read"]);
}

/// An array of Zarr with two channels: a ball, and a cube that is larger.
fn place_of_zarr() -> Place {
    let place = Place::new();
    std::fs::create_dir_all(place.path("cells.zarr")).unwrap();
    place.write("cells.zarr/.zarray", r#"{"zarr_format":2,"shape":[2,12,12,12],"chunks":[1,12,12,12],"dtype":"|u1","order":"C","fill_value":0,"compressor":null,"filters":null}"#);
    place.write(
        "cells.zarr/.zattrs",
        r#"{"_ARRAY_DIMENSIONS":["c","z","y","x"],"spacing":[1,1,1,1]}"#,
    );
    let from_middle = |i: usize| [i / 144, i / 12 % 12, i % 12].map(|n| (n as f32 - 5.5).abs());
    let ball = |i: usize| from_middle(i).iter().map(|d| d * d).sum::<f32>() < 9.0;
    let cube = |i: usize| from_middle(i).iter().all(|d| *d < 5.0);
    let bytes = |inside: &dyn Fn(usize) -> bool| {
        (0..1728).map(|i| u8::from(inside(i)) * 200).collect::<Vec<_>>()
    };
    place.write("cells.zarr/0.0.0.0", bytes(&ball));
    place.write("cells.zarr/1.0.0.0", bytes(&cube));
    place
}

#[test]
fn a_folder_of_zarr_is_drawn_and_a_channel_of_it_chosen() {
    let place = place_of_zarr();
    let ran = place.done("render cells.zarr -o a.png --size 40x40");
    assert!(ran.err.contains("of its 2 channels"), "{}", ran.err);
    place.done("render cells.zarr -o b.png --size 40x40 --set volume.volume.channel=1 --set observer.view.height_mm=20");
    place.done("render cells.zarr/.zarray -o c.png --size 40x40 --set observer.view.height_mm=20");
    let lit = |name: &str| {
        let picture = read_picture(&place.path(name)).unwrap();
        picture.pixels.iter().filter(|pixel| pixel[0] > 0.05).count()
    };
    assert!(lit("b.png") > 2 * lit("c.png"), "{} {}", lit("b.png"), lit("c.png"));
}

#[test]
fn flags_choose_the_channel_and_time_that_are_read_wherever_no_scene_does() {
    let place = place_of_zarr();
    let flags = "--channel 1 --size 40x40";
    place.done(&format!("render cells.zarr -o a.png {flags} --save-scene kept.toml"));
    assert!(String::from_utf8(place.read("kept.toml")).unwrap().contains("channel = 1"));
    place.done("render kept.toml -o b.png");
    place.done("render cells.zarr -o c.png --channel 0 --size 40x40");
    let pixels = |name| read_picture(&place.path(name)).unwrap().pixels.to_vec();
    assert!(pixels("a.png") == pixels("b.png") && pixels("a.png") != pixels("c.png"));
    // Voxels of the highest value.
    let filled = |ran: &Ran| ran.out.split_whitespace().last().unwrap().to_owned();
    let ball = place.done("info cells.zarr --channel 0");
    let cube = place.done("info cells.zarr --channel 1");
    assert!(!ball.err.contains("channels") && !cube.err.contains("channels"), "{}", cube.err);
    assert_eq!(filled(&cube), "1000", "{}", cube.out);
    assert_ne!(filled(&ball), filled(&cube));
    for (from, to) in [("0", "ball.nrrd"), ("1", "cube.nrrd")] {
        place.done(&format!("convert cells.zarr {to} -q --channel {from}"));
    }
    assert_eq!(filled(&place.done("info cube.nrrd")), filled(&cube));
    assert_eq!(filled(&place.done("info ball.nrrd")), filled(&ball));
    // The first, and a word about it, where none is chosen.
    let ran = place.done("convert cells.zarr first.nrrd");
    assert!(ran.err.contains("`--channel 1` without a scene"), "{}", ran.err);
    assert_eq!(place.read("first.nrrd"), place.read("ball.nrrd"));
    let ran = place.done("convert cells.zarr first.nrrd --time 3 --channel 0");
    assert!(ran.err.contains("no axis for `time`"), "{}", ran.err);
    let ran = place.done("info cube.nrrd --channel 1");
    assert!(ran.err.contains("no more than one `channel`"), "{}", ran.err);
}

#[test]
fn a_time_of_a_series_in_a_nifti_is_chosen() {
    let place = Place::new();
    // Three times of 4 × 4 × 4 bytes: 0 everywhere, 10 and 20.
    let mut bytes = vec![0_u8; 352];
    bytes[..4].copy_from_slice(&348_u32.to_le_bytes());
    for (axis, n) in [4_u8, 4, 4, 4, 3].into_iter().enumerate() {
        bytes[40 + 2 * axis] = n;
    }
    bytes[70] = 2;
    for axis in 0..4 {
        bytes[76 + 4 * axis..80 + 4 * axis].copy_from_slice(&1.0_f32.to_le_bytes());
    }
    bytes[344..348].copy_from_slice(b"n+1\0");
    bytes.extend((0..192).map(|at| at / 64 * 10));
    place.write("series.nii", &bytes);
    let ran = place.done("info series.nii");
    assert!(ran.err.contains("of its 3 times the first is read"), "{}", ran.err);
    let ran = place.done("info series.nii --time 2");
    assert!(ran.out.contains("20 to 20") && ran.out.contains("4 × 4 × 4 of uint8"), "{}", ran.out);
    place.done("render series.nii --time 1 -o a.png --size 20x20 --save-scene a.toml");
    assert!(String::from_utf8(place.read("a.toml")).unwrap().contains("time = 1"));
    place.refused("convert series.nii a.nrrd --time 3", 1, &["it has 3 times"]);
    place.write("series.nii", &bytes[..500]);
    place.refused("convert series.nii a.nrrd --time 1", 1, &["truncated"]);
}

#[test]
fn channels_that_there_are_not_and_what_has_none_are_refused() {
    let place = place_of_zarr();
    let said = ["it has 2 channels", "the first of which is 0"];
    for verb in ["render cells.zarr -o a.png", "info cells.zarr", "convert cells.zarr a.nrrd"] {
        place.refused(&format!("{verb} --channel 2"), 1, &said);
        place.refused(&format!("{verb} --time x"), 2, &["--time"]);
    }
    place.write("foot.obj", "v -1 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    place.refused("info foot.obj --channel 1", 2, &["--channel", "a mesh is none"]);
    place.refused("info phantom:ball --time 1", 2, &["--time", "a phantom is none"]);
    place.refused("render foot.obj -o a.png --channel 1", 2, &["--channel is for volumes"]);
    place.refused("render cross.toml -o a.png --time 1", 2, &["--set ENTITY.volume.time=1"]);
}

#[test]
fn the_saved_scene_of_a_folder_leads_back_to_it_from_another() {
    let place = place_of_zarr();
    std::fs::create_dir_all(place.path("kept")).unwrap();
    place.done("render cells.zarr -o a.png --size 40x40 --save-scene kept/cells.toml");
    place.done("render kept/cells.toml -o b.png");
    let pixels = |name| read_picture(&place.path(name)).unwrap().pixels.to_vec();
    assert!(pixels("a.png") == pixels("b.png"));
}

#[test]
fn no_output_replaces_a_chunk_and_what_a_folder_promises_is_weighed() {
    let place = place_of_zarr();
    let chunk = place.read("cells.zarr/0.0.0.0");
    place.refused("info cells.zarr -o cells.zarr/0.0.0.0", 2, &["which is read"]);
    place.refused("render cells.zarr -o a.png --stats cells.zarr/0.0.0.0", 2, &["which is read"]);
    place.refused("render cells.zarr -o a.png --max-memory 1000", 1, &["memory"]);
    assert_eq!(place.read("cells.zarr/0.0.0.0"), chunk);
    place.refused(
        "render cells.zarr -o a.png --set volume.volume.channel=2",
        1,
        &["2 channels", "the first of which is 0"],
    );
    assert!(place.done("info cells.zarr").out.contains("12 × 12 × 12"));
}
