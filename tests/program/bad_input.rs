//! Bad input through the real program: each a sentence with the remedy, a code, no panic, nothing half-written.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::{Place, small_nrrd};

/// A scene of one volume and whatever follows.
fn volume(file: &str, more: &str) -> String {
    format!("[[entity]]\nname = \"v\"\nvolume = {{ file = \"{file}\" }}\n{more}")
}

/// Renders a scene of the volume in these bytes, which must fail and say those words.
fn refused_volume(name: &str, bytes: impl AsRef<[u8]>, said: &[&str]) {
    let place = Place::new();
    place.write(name, bytes);
    place.write("s.toml", volume(name, ""));
    place.refused("render s.toml -o a.png", 1, said);
    place.refused(&format!("info {name}"), 1, said);
}

/// Renders a scene that the loader must refuse.
fn refused_scene(scene: &str, said: &[&str]) {
    let place = Place::new();
    place.write("s.toml", scene);
    place.refused("render s.toml -o a.png", 1, said);
}

fn nrrd(fields: &str) -> Vec<u8> {
    format!("NRRD0004\ndimension: 3\n{fields}\n\n").into_bytes()
}

#[test]
fn a_volume_cut_short_is_refused() {
    let whole = small_nrrd();
    refused_volume("v.nrrd", &whole[..whole.len() - 7], &["v.nrrd"]);
    refused_volume("v.nrrd", &whole[..40], &["v.nrrd"]);
}

#[test]
fn sizes_whose_product_overflows_are_refused_before_anything_is_allocated() {
    let header =
        "type: double\nsizes: 4294967296 4294967296 4294967296\nencoding: raw\nendian: little";
    refused_volume("v.nrrd", nrrd(header), &["v.nrrd"]);
    let header = "type: uchar\nsizes: 100000 100000 100\nencoding: raw";
    refused_volume("v.nrrd", nrrd(header), &["v.nrrd"]);
}

#[test]
fn a_gzip_that_inflates_past_its_header_is_refused() {
    let mut packed = nrrd("type: uchar\nsizes: 4 4 4\nencoding: gzip");
    let mut encoder = GzEncoder::new(&mut packed, Compression::best());
    encoder.write_all(&vec![0; 1 << 20]).unwrap();
    encoder.finish().unwrap();
    refused_volume("v.nrrd", packed, &["v.nrrd"]);
}

#[test]
fn a_missing_or_impossible_byte_order_is_refused() {
    let voxels = [0_u8; 54];
    let with = |endian: &str| {
        let header = format!("type: short\nsizes: 3 3 3\nencoding: raw{endian}");
        [nrrd(&header), voxels.to_vec()].concat()
    };
    refused_volume("v.nrrd", with(""), &["endian"]);
    refused_volume("v.nrrd", with("\nendian: middle"), &["byte order", "little", "big"]);
}

#[test]
fn a_volume_of_nan_needs_a_stated_classification_and_then_renders_as_nothing() {
    let place = Place::new();
    let voxels: Vec<u8> = std::iter::repeat_n(f32::NAN.to_le_bytes(), 27).flatten().collect();
    let header = nrrd("type: float\nsizes: 3 3 3\nencoding: raw\nendian: little");
    place.write("v.nrrd", [header, voxels].concat());
    place.write("s.toml", volume("v.nrrd", ""));
    place.refused("render s.toml -o a.png", 1, &["classify"]);
    let stated = "classify = { iso = [{ value = 1 }] }\n";
    place.write("s.toml", volume("v.nrrd", stated));
    place.done("render s.toml -o a.npy --size 9x9 --stats s.json");
    assert_eq!(place.json("s.json")["counts"]["nan_voxels"], 27);
    assert!(place.read("a.npy")[128..].iter().all(|byte| *byte == 0));
}

#[test]
fn missing_files_negative_and_zero_spacings_are_told() {
    refused_scene(&volume("nowhere.nrrd", ""), &["nowhere.nrrd", "--data"]);
    let place = Place::new();
    place.write("v.nrrd", small_nrrd());
    let spaced =
        |spacing: &str| volume("v.nrrd", "").replace(" }", &format!(", spacing_mm = {spacing} }}"));
    place.write("s.toml", spaced("[1, 0, 1]"));
    place.refused("render s.toml -o a.png", 1, &["spacing"]);
    // A negative one flips its axis.
    place.write("s.toml", spaced("[1, 1, -1]"));
    place.done("render s.toml -o a.png --size 16x16");
}

#[test]
fn polygons_of_two_points_or_out_of_plane_are_named() {
    let polygon = |vertices: &str| {
        format!("[[entity]]\nname = \"kite\"\npolygon = {{ vertices = {vertices} }}\n")
    };
    refused_scene(&polygon("[[0, 0, 0], [1, 0, 0]]"), &["kite", "3"]);
    let bent = "[[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]]";
    refused_scene(&polygon(bent), &["kite", "plane", "triangles"]);
    refused_scene(&polygon("[[0, 0, 0], [1, 1, 1], [2, 2, 2]]"), &["kite", "line"]);
}

#[test]
fn a_view_along_view_up_is_the_limit_and_one_past_it_is_refused() {
    let place = Place::new();
    place.done("render cross.toml -o a.png --set observer.view.elevation=90");
    let words = "render cross.toml -o b.png --set observer.view.elevation=91";
    place.refused(words, 2, &["elevation", "90"]);
}

#[test]
fn an_image_of_no_size_is_refused() {
    let place = Place::new();
    place.refused("render cross.toml -o a.png --size 0x10", 2, &["size"]);
    place.refused("render cross.toml -o a.png --set observer.view.size=[0,10]", 2, &["size"]);
}
