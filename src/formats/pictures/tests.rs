//! Facts of every format at once: what is written comes back, twice the same, and nothing broken gets through.

use super::*;
use proptest::prelude::*;

fn picture() -> Picture {
    let value = |i: usize| (i * 37 % 101) as f32 / 100.0;
    let pixel = |i| [value(i) * value(i + 3), 0.5 * value(i + 3), value(i + 3), value(i + 3)];
    Picture::new([13, 29], (0..13 * 29).map(pixel).collect()).unwrap()
}

fn notes() -> Vec<(String, String)> {
    let names = ["scene", "settings", "version", "counts", "view", "name"];
    names.map(|name| (name.to_owned(), format!("the {name}, größer"))).to_vec()
}

fn written(format: &PictureFormat, picture: &Picture) -> Option<Vec<u8>> {
    let mut file = std::io::Cursor::new(Vec::new());
    (format.write?)(&mut file, picture, &notes()).unwrap();
    Some(file.into_inner())
}

/// A file of each format that is read.
fn files() -> Vec<(&'static PictureFormat, Vec<u8>)> {
    let file = |format| (format, written(format, &picture()).unwrap());
    PICTURE_FORMATS.iter().map(file).collect()
}

#[test]
fn floats_come_back_bit_for_bit_in_every_format_of_floats() {
    let folder = tempfile::tempdir().unwrap();
    let mut pixels = picture().pixels.to_vec();
    pixels[0] = [1e30, -2.0, 1e-40, 0.0]; // brighter than 1, negative, subnormal, light without opacity
    let picture = Picture::new(picture().size, pixels).unwrap();
    for name in ["out.exr", "out.tiff", "out.TIF", "out.npy"] {
        let path = folder.path().join(name);
        check_output(&path).unwrap();
        write_picture(&path, &picture, &notes()).unwrap();
        let back = read_picture(&path).unwrap();
        assert_eq!((back.size, &back.pixels[..]), (picture.size, &picture.pixels[..]), "{name}");
    }
}

#[test]
fn a_png_read_and_written_again_is_equal_byte_for_byte() {
    let png = format_of(Path::new("a.png")).unwrap();
    let first = written(png, &picture()).unwrap();
    let back = png.read.unwrap()(&first).unwrap();
    assert_eq!(written(png, &back).unwrap(), first);
    let before = picture();
    let apart = back
        .pixels
        .iter()
        .flatten()
        .zip(before.pixels.iter().flatten())
        .map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f32::max) < 0.006);
}

#[test]
fn a_webp_is_the_very_picture_that_a_png_is_and_no_larger_than_its_format_has_room_for() {
    let webp = webp::read(&written(&webp::FORMAT, &picture()).unwrap()).unwrap();
    let png = png::FORMAT.read.unwrap()(&written(&png::FORMAT, &picture()).unwrap()).unwrap();
    assert_eq!((webp.size, &webp.pixels[..]), (png.size, &png.pixels[..]));
    let long = Picture::new([16_385, 1], vec![[0.0; 4]; 16_385]).unwrap();
    let problem = webp::write(&mut std::io::Cursor::new(Vec::new()), &long, &[]).unwrap_err();
    assert!(problem.to_string().contains(".png"));
}

#[test]
fn a_jpeg_is_the_picture_over_black_but_for_small_losses() {
    let value = |i: usize| (i % 32) as f32 / 31.0;
    let pixel = |i: usize| [value(i) * 0.5, value(i / 32) * 0.5, 0.1, 0.5];
    let smooth = Picture::new([32, 32], (0..1024).map(pixel).collect()).unwrap();
    let bytes = written(&jpeg::FORMAT, &smooth).unwrap();
    let back = jpeg::read(&bytes).unwrap();
    let seen = |picture: &Picture| {
        picture.pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect::<Vec<_>>()
    };
    let apart = seen(&back).into_iter().zip(seen(&smooth)).map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f32::max) < 0.05 && back.pixels.iter().all(|p| p[3] == 1.0));
}

#[test]
fn equal_pictures_and_notes_give_equal_bytes() {
    for format in PICTURE_FORMATS.iter().filter(|format| format.write.is_some()) {
        for _ in 0..3 {
            assert_eq!(written(format, &picture()), written(format, &picture()), "{}", format.name);
        }
    }
}

#[test]
fn the_notes_of_an_exr_are_text_attributes() {
    use ::exr::meta::attribute::{AttributeValue, Text};
    let bytes = written(&exr::FORMAT, &picture()).unwrap();
    let meta = ::exr::meta::MetaData::read_from_buffered(bytes.as_slice(), true).unwrap();
    let header = &meta.headers[0];
    let found = |name: &str| {
        let name = Text::new_or_panic(format!("gelray.{name}"));
        header.own_attributes.other.get(&name).or_else(|| header.shared_attributes.other.get(&name))
    };
    for (name, text) in notes() {
        assert_eq!(
            found(&name),
            Some(&AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes())))
        );
    }
}

#[test]
fn no_beginning_of_any_file_is_taken_for_a_picture() {
    for (format, bytes) in files() {
        let read = format.read.unwrap();
        read(&bytes).unwrap();
        for length in (0..bytes.len())
            .step_by(1 + bytes.len() / 997)
            .chain(bytes.len().saturating_sub(64)..bytes.len())
        {
            let problem = read(&bytes[..length]).expect_err(format.name);
            assert!(!problem.is_empty() && !problem.contains('\n'), "{problem}");
        }
    }
}

#[test]
fn a_file_of_another_format_is_refused_in_a_sentence_that_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    for (format, _) in files() {
        for (other, bytes) in files().into_iter().filter(|(other, _)| other.name != format.name) {
            let path = folder.path().join("lie").with_extension(format.extensions[0]);
            fs::write(&path, bytes).unwrap();
            let problem = read_picture(&path).expect_err(other.name).to_string();
            assert!(problem.contains("lie."), "{problem}");
        }
    }
}

#[test]
fn an_unknown_extension_is_told_the_known_ones_before_rendering() {
    let problem = |name: &str| check_output(Path::new(name)).unwrap_err().to_string();
    assert_eq!(
        problem("head.bmp"),
        "head.bmp: has the extension `.bmp`; name a picture with one of .png, .exr, .tiff, .tif, .npy, .jpg, .jpeg, .webp"
    );
    assert!(problem("head").contains("no extension"));
    assert!(read_picture(Path::new("head.bmp")).unwrap_err().to_string().contains(".jpeg"));
    assert!(
        read_picture(Path::new("there/is/no/head.png"))
            .unwrap_err()
            .to_string()
            .contains("cannot be read")
    );
}

#[test]
fn an_empty_picture_and_a_note_without_a_name_are_refused_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.png");
    let empty = Picture::new([0, 4], vec![]).unwrap();
    assert!(write_picture(&path, &empty, &[]).unwrap_err().to_string().contains("0 × 4"));
    for names in [["", "a"], ["a b", "c"], ["a", "a"]] {
        let notes = names.map(|name| (name.to_owned(), String::new()));
        assert!(write_picture(&path, &picture(), &notes).is_err());
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damage_makes_a_reader_panic(which in 0..PICTURE_FORMATS.len(), near in any::<bool>(), damage in prop::collection::vec((any::<u32>(), any::<u8>()), 1..6)) {
        thread_local!(static FILES: Vec<(&'static PictureFormat, Vec<u8>)> = files());
        let (format, mut bytes) = FILES.with(|files| files[which].clone());
        let reach = if near { bytes.len().min(400) } else { bytes.len() };
        for (place, value) in damage {
            bytes[place as usize % reach] = value;
        }
        let _ = format.read.unwrap()(&bytes);
    }
}
