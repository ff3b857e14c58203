//! Facts about files that are not what they say: no reader panics, and none believes more than the file backs.

use std::path::Path;

use proptest::prelude::*;

use super::made::{gzip, map, nifti, pages, zlib};
use super::stream::Stream;
use super::{Stated, Voxels, read_stream};

/// One sound file of each format and encoding.
fn sound() -> Vec<(&'static str, Vec<u8>)> {
    let start = "NRRD0005\ntype: short\ndimension: 3\nsizes: 2 3 2\nspace: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,2)\nspace origin: (0,0,0)\nkinds: domain domain domain\nendian: big\nbyte skip: 0\nline skip: 0\n";
    let painted = "NRRD0005\ntype: float\ndimension: 4\nsizes: 4 2 3 2\nspacings: nan 1 1 2\nkinds: RGBA-color domain domain domain\nendian: big\nencoding: raw\n\n";
    let (nifti, map) = (nifti(), map());
    let meta = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 1 1 2\nDimSize = 2 3 2\nElementType = MET_SHORT\n";
    let local = "ElementDataFile = LOCAL\n";
    let text = "{'descr': '<i2', 'fortran_order': False, 'shape': (2, 3, 2), }\n";
    let array = [b"\x93NUMPY\x01\x00", &[text.len() as u8, 0][..], text.as_bytes(), &[1; 24]];
    vec![
        ("i.mha", [meta.as_bytes(), local.as_bytes(), &[1; 24]].concat()),
        (
            "j.mha",
            [meta.as_bytes(), b"CompressedData = True\n", local.as_bytes(), &zlib(&[1; 24])]
                .concat(),
        ),
        ("k.npy", array.concat()),
        ("l.tif", pages(2)),
        ("a.nrrd", [start.as_bytes(), b"encoding: raw\n\n", &[1; 24]].concat()),
        ("b.nrrd", [start.as_bytes(), b"encoding: gzip\n\n", &gzip(&[1; 24])].concat()),
        (
            "c.nrrd",
            [start.as_bytes(), b"encoding: ascii\n\n", "-12 ".repeat(12).as_bytes()].concat(),
        ),
        ("d.nrrd", [painted.as_bytes(), &[1; 192]].concat()),
        ("e.nii.gz", gzip(&nifti)),
        ("f.nii", nifti),
        ("g.mrc.gz", gzip(&map)),
        ("h.map", map),
    ]
}

/// Reads the bytes; what comes out, if anything, must hold together.
fn consistent(name: &str, bytes: Vec<u8>) -> bool {
    let Ok(loaded) = read_stream(Stream::of(bytes), Path::new(name), &Stated::default()) else {
        return false;
    };
    let count = match &loaded.voxels {
        Voxels::Scalars(scalars) => scalars.len(),
        Voxels::Painted(painted) => painted.len(),
    };
    assert_eq!(count, loaded.grid.voxels());
    assert!(loaded.grid.corners().iter().all(|corner| corner.is_finite()));
    true
}

#[test]
fn the_sound_files_are_sound_and_no_part_of_one_is_whole() {
    for (name, bytes) in sound() {
        assert!(consistent(name, bytes.clone()), "{name}");
        for length in 0..bytes.len() {
            let whole = consistent(name, bytes[..length].to_vec());
            // Text ends where its last number does, with or without the blank, and that number may be shorter.
            assert!(
                !whole || (name == "c.nrrd" && length + 3 >= bytes.len()),
                "{name} at {length}"
            );
        }
    }
}

#[test]
fn a_gzip_bomb_gives_way_at_the_first_byte_past_its_promise() {
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 10 10 10\nencoding: gzip\n\n";
    let bomb = gzip(&vec![0; 64 << 20]);
    let said = read_stream(
        Stream::of([header.as_bytes(), &bomb].concat()),
        Path::new("bomb.nrrd"),
        &Stated::default(),
    );
    assert!(said.unwrap_err().contains("inflates past its header"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn garbage_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..1200), name in 0..8_usize) {
        let (name, _) = sound().swap_remove(name);
        prop_assert!(!consistent(name, bytes));
    }

    #[test]
    fn a_changed_file_never_panics(
        file in 0..8_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
        shorter in any::<bool>(),
    ) {
        let (name, mut bytes) = sound().swap_remove(file);
        // Mostly the headers: a change of a voxel is not a mistake.
        let header = if name.ends_with("gz") { bytes.len() } else { bytes.len() - 24 };
        for (at, value) in &changes {
            bytes[at.index(header)] = *value;
        }
        if shorter {
            let length = bytes.len() - cut.index(4);
            bytes.truncate(length);
        }
        consistent(name, bytes);
    }

    #[test]
    fn fields_of_any_value_never_panic(field in 0..12_usize, value in "[-0-9.,() a-zA-Z%]{0,24}") {
        let fields = ["type", "sizes", "dimension", "encoding", "endian", "spacings", "kinds", "space", "space directions", "space origin", "byte skip", "line skip"];
        let mut header: Vec<String> = ["type: short", "sizes: 2 3 2", "dimension: 3", "encoding: raw", "endian: little"]
            .map(str::to_owned).into();
        header.retain(|line| !line.starts_with(&format!("{}:", fields[field])));
        header.push(format!("{}: {value}", fields[field]));
        let text = format!("NRRD0004\n{}\n\n", header.join("\n"));
        consistent("x.nrrd", [text.as_bytes(), &[0; 24]].concat());
    }
}
