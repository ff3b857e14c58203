//! Facts about reading NRRD, on small files made here.

use std::path::Path;

use glam::DVec3;

use super::*;
use crate::formats::made::gzip;
use crate::volume::grid::{Painted, Scalars};

fn parse(header: &str, voxels: &[u8]) -> Result<Loaded, String> {
    let bytes = [header.as_bytes(), b"\n", voxels].concat();
    read(Stream::of(bytes), Path::new("test.nrrd"), &Stated::default())
}

fn problem(header: &str, voxels: &[u8]) -> String {
    parse(header, voxels).unwrap_err()
}

/// A header of 2³ voxels, with the field `lines` after those that every header needs.
fn header(kind: &str, encoding: &str, lines: &str) -> String {
    format!(
        "NRRD0004\n# a comment\ntype: {kind}\ndimension: 3\nsizes: 2 2 2\nencoding: {encoding}\n{lines}"
    )
}

macro_rules! survives {
    ($($name:literal, $kind:ty, $variant:ident;)*) => {$({
        let values: Vec<$kind> = [0_u8, 1, 2, 7, 63, 100, 101, 127].map(|v| v as $kind * (<$kind>::MAX / 127_u8 as $kind)).to_vec();
        let little: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
        let text = values.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        for (encoding, endian, bytes) in [
            ("raw", "endian: little\n", little.clone()),
            ("RAW", "endian: big\r\n", big.clone()),
            ("gzip", "endian: little\n", gzip(&little)),
            ("gz", "Endian: BIG\n", gzip(&big)),
            ("ascii", "", text.clone().into_bytes()),
            ("txt", "endian: big\n", text.clone().into_bytes()),
        ] {
            let loaded = parse(&header($name, encoding, endian), &bytes).unwrap();
            let Voxels::Scalars(Scalars::$variant(read)) = loaded.voxels else { panic!($name) };
            assert_eq!(read[..], values[..], "{} {encoding}", $name);
            assert!(loaded.warnings.is_empty());
        }
    })*};
}

#[test]
#[allow(clippy::cast_lossless, trivial_numeric_casts, reason = "one body for all types")]
fn every_type_survives_every_byte_order_and_encoding() {
    survives! {
        "uchar", u8, U8; "int8", i8, I8; "unsigned short", u16, U16; "short", i16, I16; "uint", u32, U32;
        "int", i32, I32; "unsigned long long int", u64, U64; "int64_t", i64, I64; "float", f32, F32; "double", f64, F64;
    }
}

#[test]
fn rgba_voxels_are_painted() {
    let header = |kind: &str, kinds: &str| {
        format!(
            "NRRD0005\ntype: {kind}\ndimension: 4\nsizes: 4 2 2 2\nkinds: {kinds} domain domain domain\nspacings: nan 1 1 3\nendian: big\nencoding: raw\n"
        )
    };
    let bytes: Vec<u8> = (0..128).collect();
    let loaded = parse(&header("uchar", "RGBA-color"), &bytes[..32]).unwrap();
    let Voxels::Painted(Painted::U8(texels)) = loaded.voxels else { panic!("not u8") };
    assert_eq!(texels[7], [28, 29, 30, 31]);
    assert_eq!(loaded.grid.spacing(), DVec3::new(1.0, 1.0, 3.0));
    let loaded = parse(&header("ushort", "4-vector"), &bytes[..64]).unwrap();
    let Voxels::Painted(Painted::U16(texels)) = loaded.voxels else { panic!("not u16") };
    assert_eq!(texels[0], [0x0001, 0x0203, 0x0405, 0x0607]);
    let loaded = parse(&header("float", "4-color"), &bytes).unwrap();
    assert!(matches!(loaded.voxels, Voxels::Painted(Painted::F32(texels)) if texels.len() == 8));
    assert!(problem(&header("double", "RGBA-color"), &bytes).contains("uint8, uint16 or float"));
    assert!(problem(&header("uchar", "list"), &bytes).contains("RGBA-color"));
}

#[test]
fn a_fourth_axis_that_is_not_colour_is_refused() {
    let start = "NRRD0004\ntype: uchar\ndimension: 4\nencoding: raw\n";
    for lines in ["sizes: 4 2 2 2\n", "sizes: 3 2 2 2\nkinds: RGB-color domain domain domain\n"] {
        assert!(problem(&format!("{start}{lines}"), &[0; 32]).contains("three axes of space"));
    }
    let plane = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 2 2\nkinds: RGBA-color domain domain\nencoding: raw\n";
    assert!(problem(plane, &[0; 16]).contains("three axes of space"));
}

#[test]
fn directions_of_every_space_place_voxels_in_lps() {
    for (space, signs) in [
        ("right-anterior-superior", [-1.0, -1.0, 1.0]),
        ("RAS", [-1.0, -1.0, 1.0]),
        ("left-anterior-superior", [1.0, -1.0, 1.0]),
        ("left-posterior-superior", [1.0, 1.0, 1.0]),
        ("scanner-xyz", [1.0, 1.0, 1.0]),
        ("3D-right-handed", [1.0, 1.0, 1.0]),
    ] {
        let lines = format!(
            "space: {space}\nspace directions: (0, 2,0) (-3,0,0) (0,0,4.5)\nspace origin: (10,20,30)\n"
        );
        let loaded = parse(&header("uchar", "raw", &lines), &[0; 8]).unwrap();
        let at = |x, y, z| loaded.grid.index_to_world.transform_point3(DVec3::new(x, y, z));
        assert_eq!(at(0.0, 0.0, 0.0), DVec3::from(signs) * DVec3::new(10.0, 20.0, 30.0));
        assert_eq!(at(1.0, 1.0, 1.0), DVec3::from(signs) * DVec3::new(7.0, 22.0, 34.5));
        assert_eq!(loaded.grid.spacing(), DVec3::new(2.0, 3.0, 4.5));
    }
    let left = parse(&header("uchar", "raw", "space: 3D-left-handed\n"), &[0; 8]).unwrap();
    assert!(left.warnings[0].contains("mirrored"));
    assert!(problem(&header("uchar", "raw", "space: RAST\n"), &[0; 8]).contains("scanner-xyz"));
}

#[test]
fn spacings_alone_leave_the_first_voxel_at_the_origin() {
    let loaded = parse(&header("uchar", "raw", "spacings: 0.5 1 -2\n"), &[0; 8]).unwrap();
    let last = loaded.grid.index_to_world.transform_point3(DVec3::ONE);
    assert_eq!(last, DVec3::new(0.5, 1.0, -2.0));
    for wrong in ["0 1 1", "1 nan 1", "inf 1 1"] {
        let said = problem(&header("uchar", "raw", &format!("spacings: {wrong}\n")), &[0; 8]);
        assert!(said.contains("spacing_mm"), "{said}");
    }
}

#[test]
fn sizes_that_overflow_or_that_the_file_cannot_back_fail_before_allocation() {
    for (sizes, expected) in [
        ("4294967296 4294967296 4294967296", "multiply"),
        ("18446744073709551616 2 2", "whole number"),
        ("-2 2 2", "whole number"),
        ("60000 60000 60000", "truncated"),
        ("1 8 8", "at least 2"),
        ("0 8 8", "at least 2"),
        ("2 2", "dimension"),
    ] {
        for encoding in ["raw", "gzip", "ascii"] {
            let header = format!(
                "NRRD0004\ntype: double\ndimension: 3\nsizes: {sizes}\nencoding: {encoding}\nendian: little\n"
            );
            let said = problem(&header, &[0; 64]);
            assert!(said.contains(expected), "{sizes} {encoding}: {said}");
        }
    }
}

#[test]
fn voxels_too_few_or_too_many_are_told() {
    assert!(problem(&header("uchar", "raw", ""), &[0; 7]).contains("truncated"));
    assert!(problem(&header("uchar", "gzip", ""), &gzip(&[0; 7])).contains("truncated"));
    assert!(problem(&header("uchar", "gzip", ""), &gzip(&[0; 9])).contains("inflates past"));
    assert!(problem(&header("uchar", "ascii", ""), b"1  2 3 4 5 6 7  ").contains("7 were found"));
    assert!(problem(&header("uchar", "ascii", ""), b"1 2 3 4 5 6 7 256").contains("`256`"));
    let loaded = parse(&header("uchar", "raw", ""), &[0; 11]).unwrap();
    assert!(loaded.warnings[0].contains("3 bytes follow"));
    let loaded = parse(&header("uchar", "text", ""), b"1 2 3 4 5 6 7 8 9").unwrap();
    assert!(loaded.warnings[0].contains("`9`"));
}

#[test]
fn byte_order_is_needed_above_one_byte_and_must_be_one() {
    assert!(problem(&header("short", "raw", ""), &[0; 16]).contains("endian: big"));
    assert!(problem(&header("short", "raw", "endian: pdp\n"), &[0; 16]).contains("`pdp`"));
}

#[test]
fn lines_and_bytes_before_the_voxels_are_left_out() {
    let voxels: Vec<u8> = (10..18).collect();
    let read = |encoding: &str, lines: &str, bytes: &[u8]| {
        let loaded = parse(&header("uchar", encoding, lines), bytes)?;
        let Voxels::Scalars(scalars) = loaded.voxels else { panic!("painted") };
        Ok::<_, String>((0..8).map(|i| scalars.value(i) as u8).collect::<Vec<_>>())
    };
    let padded = [b"one\ntwo\nxyz".as_slice(), &voxels].concat();
    assert_eq!(read("raw", "line skip: 2\nbyte skip: 3\n", &padded).unwrap(), voxels);
    assert_eq!(read("raw", "byte skip: -1\n", &padded).unwrap(), voxels);
    let packed = [b"one\n".as_slice(), &gzip(&[b"xyz".as_slice(), &voxels].concat())].concat();
    assert_eq!(read("gzip", "line skip: 1\nbyteskip: 3\n", &packed).unwrap(), voxels);
    assert!(read("gzip", "byte skip: -1\n", &packed).unwrap_err().contains("encoding raw"));
    assert!(read("raw", "byte skip: -2\n", &padded).unwrap_err().contains("from 0"));
    assert!(read("raw", "line skip: 9\n", &padded).unwrap_err().contains("`line skip`"));
    assert!(
        read("raw", "byte skip: 9223372036854775807\n", &padded).unwrap_err().contains("truncated")
    );
}

#[test]
fn a_detached_header_finds_its_data_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("data")).unwrap();
    std::fs::write(folder.path().join("data/head ct.raw"), [5; 8]).unwrap();
    let path = folder.path().join("head.nhdr");
    let open = |name: &str| {
        std::fs::write(&path, header("uchar", "raw", &format!("data file: {name}"))).unwrap();
        crate::formats::read_volume(&path, &Stated::default()).map_err(|e| e.to_string())
    };
    assert_eq!(open("./data/head ct.raw").unwrap().grid.size, [2; 3]);
    assert!(open("absent.raw").unwrap_err().contains("absent.raw` no such file"));
    assert!(open("data").unwrap_err().contains("not a file"));
    for many in ["LIST\na.raw", "slice%03d.raw 1 9 1", ""] {
        let said = open(many).unwrap_err();
        assert!(said.contains("one file is expected"), "{said}");
    }
}

#[test]
fn unknown_fields_and_keys_are_ignored_and_known_ones_stand_once() {
    let lines =
        "content: a head: mine\nmin: 0\nold max: 9\nfuture field: 3\npatient:=nobody: none\n";
    assert!(parse(&header("uchar", "raw", lines), &[0; 8]).is_ok());
    assert!(problem(&header("uchar", "raw", "type: short\n"), &[0; 8]).contains("twice"));
    assert!(problem("NRRD0004\ndimension: 3\n", &[]).contains("`type`"));
    assert!(problem(&header("uchar", "bzip2", ""), &[]).contains("save it again"));
    assert!(problem("NRRD0009\n", &[]).contains("NRRD0005"));
}
