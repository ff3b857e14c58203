//! Facts about scenes that are made for volumes that come without one.

use super::*;
use crate::scene::load;

fn made(name: &str, bytes: &[u8], wish: &Wish) -> (Source, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let (source, said) = first_contact(&path, wish).unwrap();
    let loaded = load(&source, &[], &[], false).unwrap();
    assert_eq!(loaded.files, [path]);
    (source, said)
}

/// A block of `inside` in `outside`, as an NRRD of 16-bit numbers, with rows of noise so that it is no segmentation.
fn block(outside: i16, inside: i16, noise: i16) -> Vec<u8> {
    let header =
        "NRRD0004\ntype: short\ndimension: 3\nsizes: 20 20 20\nencoding: raw\nendian: little\n\n";
    let value = |i: usize| {
        let within = |n: usize| (5..15).contains(&n);
        let here = within(i % 20) && within(i / 20 % 20) && within(i / 400);
        (if here { inside } else { outside }) + noise * ((i as i16).wrapping_mul(37) % 11) / 11
    };
    header.bytes().chain((0..8000).flat_map(|i| value(i).to_le_bytes())).collect()
}

#[test]
fn ct_is_told_from_labels_and_from_the_rest_and_that_is_said() {
    for (bytes, kind, how) in [
        (block(-1000, 40, 50), "CT in Hounsfield units", "ct-bone"),
        (block(0, 3, 0), "labels", "value = 0.5"),
        (block(100, 600, 50), "of no kind", "iso = ["),
    ] {
        let (source, said) = made("a.nrrd", &bytes, &Wish::default());
        assert!(said.contains(kind) && source.text.contains(how), "{said}\n{}", source.text);
    }
}

#[test]
fn a_wish_goes_before_the_guess() {
    let bytes = block(-1000, 40, 50);
    let iso = Wish { iso: Some(300.0), size: Some([80, 40]), ..Wish::default() };
    let (source, _) = made("a.nrrd", &bytes, &iso);
    assert!(source.text.contains("value = 300.0") && source.text.contains("size = [80, 40]"));
    // A surface is found between voxels.
    for sharp in ["reconstruct = \"values\"", "thickness_voxels = 0"] {
        assert!(source.text.contains(sharp), "{}", source.text);
    }
    let skin = Wish { preset: Some(Preset::CtSkin), ..Wish::default() };
    let (source, said) = made("a.nrrd", &bytes, &skin);
    assert!(source.text.contains("preset = \"ct-skin\"") && said.contains("as asked for"));
}

#[test]
fn names_that_are_no_toml_are_written_so_that_they_are() {
    for name in ["a \"quoted\".nrrd", "a\nline.nrrd", "ü'#.nrrd", "back\\slash.nrrd"] {
        made(name, &block(100, 600, 50), &Wish::default());
    }
}

#[test]
fn a_volume_of_one_value_makes_a_scene_too() {
    let (_, said) = made("a.nrrd", &block(7, 7, 0), &Wish::default());
    assert!(said.contains("alike"), "{said}");
}

#[test]
fn what_is_more_than_may_be_read_is_refused_before_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.nrrd");
    std::fs::write(&path, block(0, 9, 0)).unwrap();
    let wish = Wish { most_bytes: Some(1000), ..Wish::default() };
    assert!(matches!(first_contact(&path, &wish), Err(Error::Memory { needed: 16_000, .. })));
}
