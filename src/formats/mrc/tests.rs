//! Facts about reading maps, on small files made here.

use glam::DVec3;

use super::*;

/// A header of 2 × 3 × 4 voxels of 1 × 2 × 3 Å, written in either order.
struct Made {
    big: bool,
    bytes: Vec<u8>,
}

impl Made {
    fn new(big: bool, mode: i32) -> Self {
        let mut made = Self { big, bytes: vec![0; 1024] };
        made.ints(1, &[2, 3, 4, mode, 0, 0, 0, 2, 3, 4]);
        made.floats(11, &[2.0, 6.0, 12.0, 90.0, 90.0, 90.0]);
        made.ints(17, &[1, 2, 3]);
        made.bytes[208..212].copy_from_slice(b"MAP ");
        made.bytes[212..214].copy_from_slice(if big { &[0x11, 0x11] } else { &[0x44, 0x44] });
        made
    }

    fn put(&mut self, word: usize, mut little: [u8; 4]) {
        if self.big {
            little.reverse();
        }
        self.bytes[(word - 1) * 4..word * 4].copy_from_slice(&little);
    }

    fn ints(&mut self, word: usize, values: &[i32]) {
        for (i, value) in values.iter().enumerate() {
            self.put(word + i, value.to_le_bytes());
        }
    }

    fn floats(&mut self, word: usize, values: &[f32]) {
        for (i, value) in values.iter().enumerate() {
            self.put(word + i, value.to_le_bytes());
        }
    }

    fn read(&self, voxels: &[u8]) -> Result<Loaded, String> {
        let bytes = [&self.bytes, voxels].concat();
        read(Stream::of(bytes), Path::new("test.mrc"), &Stated::default())
    }

    /// The place of a voxel, in a map of bytes.
    fn place(&self, index: [f64; 3]) -> DVec3 {
        let voxels = vec![0; 24];
        self.read(&voxels).unwrap().grid.index_to_world.transform_point3(DVec3::from(index))
    }
}

#[test]
fn every_mode_survives_either_byte_order() {
    let order = |big: bool, bytes: [u8; 2]| if big { [bytes[1], bytes[0]] } else { bytes };
    for big in [false, true] {
        let read =
            |mode: i32, bytes: Vec<u8>| match Made::new(big, mode).read(&bytes).unwrap().voxels {
                Voxels::Scalars(scalars) => scalars,
                Voxels::Painted(_) => panic!("painted"),
            };
        assert!(matches!(read(0, vec![255; 24]), Scalars::I8(v) if v[23] == -1));
        let short = (-300_i16..-276).flat_map(|v| order(big, v.to_le_bytes())).collect();
        assert!(matches!(read(1, short), Scalars::I16(v) if v[1] == -299));
        let word = (65_000_u16..65_024).flat_map(|v| order(big, v.to_le_bytes())).collect();
        assert!(matches!(read(6, word), Scalars::U16(v) if v[23] == 65_023));
        let float = [if big { 1.5_f32.to_be_bytes() } else { 1.5_f32.to_le_bytes() }; 24].concat();
        assert!(matches!(read(2, float), Scalars::F32(v) if v[..] == [1.5; 24]));
        let half = [order(big, f16::from_f32(-0.75).to_le_bytes()); 24].concat();
        assert!(matches!(read(12, half), Scalars::F32(v) if v[..] == [-0.75; 24]));
    }
}

#[test]
fn a_wrong_or_missing_stamp_gives_way_to_what_makes_sense() {
    for big in [false, true] {
        for stamp in [[0x11, 0x11], [0x44, 0x41], [0, 0]] {
            let mut made = Made::new(big, 1);
            made.bytes[212..214].copy_from_slice(&stamp);
            let value = if big { [1, 2] } else { [2, 1] };
            let loaded = made.read(&[value; 24].concat()).unwrap();
            assert!(matches!(loaded.voxels, Voxels::Scalars(Scalars::I16(v)) if v[5] == 0x0102));
        }
    }
}

#[test]
fn the_first_voxel_is_at_the_start_unless_an_origin_is_stated() {
    let mut made = Made::new(false, 0);
    made.ints(5, &[61, -20, -16]);
    assert_eq!(made.place([0.0; 3]), DVec3::new(61.0, -40.0, -48.0));
    made.floats(50, &[7.0, 0.0, -1.5]);
    assert_eq!(made.place([1.0, 1.0, 1.0]), DVec3::new(8.0, 2.0, 1.5));
}

#[test]
fn permuted_axes_permute_the_columns_of_the_affine() {
    let mut made = Made::new(false, 0);
    // Columns run along Z, rows along X, sections along Y.
    made.ints(17, &[3, 1, 2]);
    made.ints(5, &[1, 2, 3]);
    assert_eq!(made.place([0.0; 3]), DVec3::new(2.0, 6.0, 3.0));
    assert_eq!(made.place([1.0, 2.0, 3.0]), DVec3::new(4.0, 12.0, 6.0));
}

#[test]
fn an_oblique_cell_keeps_its_lengths_and_angles() {
    let mut made = Made::new(false, 0);
    made.floats(14, &[80.0, 100.0, 120.0]);
    let step = |index| made.place(index) - made.place([0.0; 3]);
    let (a, b, c) = (step([1.0, 0.0, 0.0]), step([0.0, 1.0, 0.0]), step([0.0, 0.0, 1.0]));
    for (found, expected) in [
        (a.length(), 1.0),
        (b.length(), 2.0),
        (c.length(), 3.0),
        (b.angle_between(c).to_degrees(), 80.0),
        (a.angle_between(c).to_degrees(), 100.0),
        (a.angle_between(b).to_degrees(), 120.0),
    ] {
        assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
    }
    assert!(a.cross(b).dot(c) > 0.0);
}

#[test]
fn a_cell_that_spans_no_space_is_repaired_with_a_warning() {
    for angles in
        [[0.0, 0.0, 0.0], [90.0, 180.0, 90.0], [30.0, 30.0, 100.0], [f32::NAN, 90.0, 90.0]]
    {
        let mut made = Made::new(false, 0);
        made.floats(14, &angles);
        let loaded = made.read(&[0; 24]).unwrap();
        assert_eq!(loaded.grid.spacing(), DVec3::new(1.0, 2.0, 3.0));
        assert!(loaded.warnings[0].contains("right angles"));
    }
    let mut made = Made::new(false, 0);
    made.floats(11, &[0.0; 3]);
    let loaded = made.read(&[0; 24]).unwrap();
    assert_eq!(loaded.grid.spacing(), DVec3::ONE);
    assert!(loaded.warnings[0].contains("1 Å"));
}

#[test]
fn symmetry_records_are_left_out() {
    let mut made = Made::new(true, 0);
    made.ints(24, &[80]);
    let loaded = made.read(&[[9; 80].as_slice(), &[5; 24]].concat()).unwrap();
    assert!(matches!(loaded.voxels, Voxels::Scalars(Scalars::I8(v)) if v[..] == [5; 24]));
    assert!(loaded.warnings.is_empty());
}

#[test]
fn what_is_no_map_of_real_numbers_is_refused() {
    let refuse = |change: &dyn Fn(&mut Made), expected: &str| {
        let mut made = Made::new(false, 0);
        change(&mut made);
        let said = made.read(&[0; 24]).unwrap_err();
        assert!(said.contains(expected), "{said}");
    };
    refuse(&|m| m.ints(4, &[4]), "mode 2");
    refuse(&|m| m.ints(1, &[-2]), "neither byte order");
    refuse(&|m| m.ints(1, &[1, 3, 8]), "at least 2");
    refuse(&|m| m.ints(1, &[1 << 20, 1 << 20, 1 << 20]), "multiply");
    refuse(&|m| m.ints(1, &[5000, 5000, 5000]), "truncated");
    refuse(&|m| m.ints(17, &[1, 1, 3]), "MAPC");
    refuse(&|m| m.ints(24, &[-8]), "NSYMBT");
    refuse(&|m| m.ints(24, &[i32::MAX]), "truncated");
    refuse(&|m| m.bytes.truncate(500), "1024 bytes");
}
