//! Facts about archives of NumPy: stored and deflated arrays are the same, and files that are not what they say.

use std::io::Write;

use flate2::write::DeflateEncoder;
use proptest::prelude::*;

use super::*;
use crate::formats::Voxels;
use crate::volume::grid::Scalars;

fn array(shape: &str) -> Vec<u8> {
    let text = format!("{{'descr': '<i2', 'fortran_order': False, 'shape': ({shape}), }}\n");
    let values = (0..12_i16).flat_map(i16::to_le_bytes).collect::<Vec<_>>();
    [b"\x93NUMPY\x01\x00", &[text.len() as u8, 0][..], text.as_bytes(), &values].concat()
}

/// An archive of these arrays. `wide` has sizes in fields of 64 bits, as numpy writes them.
fn archive(arrays: &[(&str, Vec<u8>)], deflated: bool, wide: bool) -> Vec<u8> {
    let (mut file, mut table) = (Vec::new(), Vec::new());
    for (name, bytes) in arrays {
        let mut packed = bytes.clone();
        if deflated {
            let mut packer = DeflateEncoder::new(Vec::new(), flate2::Compression::fast());
            packer.write_all(bytes).unwrap();
            packed = packer.finish().unwrap();
        }
        let mut crc = Crc::new();
        crc.update(bytes);
        let at = file.len() as u32;
        let (size, length) = (bytes.len() as u64, packed.len() as u64);
        let narrow = |n: u64| if wide { u32::MAX } else { n as u32 }.to_le_bytes();
        let extra = [&[1, 0, 16, 0][..], &size.to_le_bytes(), &length.to_le_bytes()].concat();
        let extra = if wide { extra } else { Vec::new() };
        let method = [if deflated { 8 } else { 0 }, 0];
        let common = [
            &[20, 0, 0, 0][..],
            &method,
            &[0; 4],
            &crc.sum().to_le_bytes(),
            &narrow(length),
            &narrow(size),
            &(name.len() as u16).to_le_bytes(),
            &(extra.len() as u16).to_le_bytes(),
        ]
        .concat();
        file.extend([b"PK\x03\x04", &common[..], name.as_bytes(), &extra, &packed].concat());
        let places = [&[0; 10][..], &at.to_le_bytes()].concat();
        let row = [b"PK\x01\x02\x14\x00", &common[..], &places, name.as_bytes(), &extra];
        table.extend(row.concat());
    }
    let (at, bytes) = (file.len() as u32, table.len() as u32);
    file.extend(table);
    file.extend([b"PK\x05\x06", &[0; 8][..], &bytes.to_le_bytes(), &at.to_le_bytes()].concat());
    file.extend([0, 0]);
    file
}

fn sound() -> Vec<Vec<u8>> {
    let arrays = [("line.npy", array("12,")), ("voxels.npy", array("2, 3, 2"))];
    [(false, false), (true, false), (false, true), (true, true)]
        .map(|(deflated, wide)| archive(&arrays, deflated, wide))
        .into()
}

fn of(bytes: Vec<u8>) -> Result<Loaded, String> {
    read(Stream::of(bytes), Path::new(""), &Stated::default())
}

#[test]
fn the_first_volume_of_an_archive_is_read_stored_or_deflated() {
    for bytes in sound() {
        assert!(recognizes(&bytes[..200]));
        let (promise, _) =
            promised(&mut Stream::of(bytes.clone()), Path::new(""), &Stated::default()).unwrap();
        assert_eq!(promise, 24 + bytes.len() as u64);
        let loaded = of(bytes).unwrap();
        assert_eq!(loaded.grid.size, [2, 3, 2]);
        assert!(loaded.warnings.iter().any(|said| said.contains("`voxels`")));
        let Voxels::Scalars(Scalars::I16(values)) = loaded.voxels else { panic!("not i16") };
        assert_eq!(values.to_vec(), (0..12).collect::<Vec<i16>>());
    }
}

#[test]
fn what_is_wrong_with_an_archive_is_said() {
    let none = archive(&[("line.npy", array("12,"))], false, false);
    assert!(of(none).unwrap_err().contains("only line"));
    for (deflated, said) in [(false, "damaged"), (true, "damaged")] {
        let mut bytes = archive(&[("a.npy", array("2, 3, 2"))], deflated, false);
        let table = bytes.windows(4).position(|four| four == b"PK\x01\x02").unwrap();
        // The checksum of the table is another's.
        bytes[table + 16] ^= 1;
        let problem = of(bytes).unwrap_err();
        assert!(problem.contains(said), "{problem}");
    }
    assert!(of(b"PK\x03\x04".repeat(30)).unwrap_err().contains("truncated"));
}

#[test]
fn no_part_of_an_archive_is_whole() {
    for bytes in sound() {
        for length in 0..bytes.len() - 2 {
            assert!(of(bytes[..length].to_vec()).is_err(), "{length}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_of_an_archive_never_panic(
        file in 0..4_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = sound().swap_remove(file);
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        if let Ok(loaded) = of(bytes) {
            prop_assert!(loaded.grid.voxels() < 1 << 16);
        }
    }
}
