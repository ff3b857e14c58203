//! Facts about reading NIfTI-1, on small files made here.

use glam::DVec3;

use super::*;
use crate::volume::grid::Painted;

/// The bytes of a file, written in either order.
#[derive(Clone)]
struct Made {
    big: bool,
    bytes: Vec<u8>,
}

impl Made {
    /// A header of 2³ voxels of the type `code`, without orientation and with a spacing of 1, 2, 3.
    fn new(big: bool, code: i16) -> Self {
        let mut made = Self { big, bytes: vec![0; 352] };
        made.put(0, 348_i32.to_le_bytes());
        for (axis, n) in [3_i16, 2, 2, 2, 1].into_iter().enumerate() {
            made.short(40 + 2 * axis, n);
        }
        made.short(70, code);
        made.floats(76, &[1.0, 1.0, 2.0, 3.0]);
        made.floats(108, &[352.0]);
        made.bytes[344..348].copy_from_slice(b"n+1\0");
        made
    }

    fn put<const N: usize>(&mut self, at: usize, mut little: [u8; N]) {
        if self.big {
            little.reverse();
        }
        self.bytes[at..at + N].copy_from_slice(&little);
    }

    fn short(&mut self, at: usize, value: i16) {
        self.put(at, value.to_le_bytes());
    }

    fn floats(&mut self, at: usize, values: &[f32]) {
        for (i, value) in values.iter().enumerate() {
            self.put(at + 4 * i, value.to_le_bytes());
        }
    }

    fn read(&self, voxels: &[u8]) -> Result<Loaded, String> {
        let bytes = [&self.bytes, voxels].concat();
        read(Stream::of(bytes), Path::new("test.nii"), &Stated::default())
    }
}

fn near(loaded: &Loaded, index: [f64; 3], world: [f64; 3]) {
    let found = loaded.grid.index_to_world.transform_point3(DVec3::from(index));
    assert!(found.distance(DVec3::from(world)) < 1e-6, "{found} is not {world:?}");
}

macro_rules! survives {
    ($($code:literal, $kind:ty, $variant:ident;)*) => {$(
        let values: Vec<$kind> = [0_u8, 1, 2, 3, 100, 101, 126, 127].map(|v| v as $kind).to_vec();
        for big in [false, true] {
            let bytes: Vec<u8> = values.iter().flat_map(|v| if big { v.to_be_bytes() } else { v.to_le_bytes() }).collect();
            let loaded = Made::new(big, $code).read(&bytes).unwrap();
            let Voxels::Scalars(Scalars::$variant(read)) = loaded.voxels else { panic!("another type") };
            assert_eq!(read[..], values[..]);
        }
    )*};
}

#[test]
#[allow(clippy::cast_lossless, trivial_numeric_casts, reason = "one body for all types")]
fn every_datatype_survives_either_byte_order() {
    survives! {
        2, u8, U8; 4, i16, I16; 8, i32, I32; 16, f32, F32; 64, f64, F64;
        256, i8, I8; 512, u16, U16; 768, u32, U32; 1024, i64, I64; 1280, u64, U64;
    }
    let painted = Made::new(false, 2304).read(&(0..32).collect::<Vec<u8>>()).unwrap();
    let Voxels::Painted(Painted::U8(texels)) = painted.voxels else { panic!("not painted") };
    assert_eq!(texels[1], [4, 5, 6, 7]);
}

#[test]
fn voxels_are_placed_by_the_affine_before_the_quaternion_before_the_spacings() {
    let mut made = Made::new(true, 2);
    let plain = made.read(&[0; 8]).unwrap();
    near(&plain, [1.0; 3], [-1.0, -2.0, 3.0]);
    assert!(plain.warnings[0].contains("no orientation"));
    // A quarter turn about z takes x to y; the third axis is flipped.
    made.short(252, 1);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    made.floats(256, &[0.0, 0.0, half, 10.0, 20.0, 30.0]);
    made.floats(76, &[-1.0]);
    let turned = made.read(&[0; 8]).unwrap();
    near(&turned, [0.0; 3], [-10.0, -20.0, 30.0]);
    near(&turned, [1.0, 0.0, 0.0], [-10.0, -21.0, 30.0]);
    near(&turned, [0.0, 1.0, 1.0], [-8.0, -20.0, 27.0]);
    made.short(254, 1);
    made.floats(280, &[0.0, 0.0, 5.0, 1.0, 4.0, 0.0, 0.0, 2.0, 0.0, 3.0, 0.0, 3.0]);
    let stated = made.read(&[0; 8]).unwrap();
    near(&stated, [1.0, 0.0, 0.0], [-1.0, -6.0, 3.0]);
    near(&stated, [0.0, 1.0, 1.0], [-6.0, -2.0, 6.0]);
    assert!(stated.warnings.is_empty());
    made.floats(280, &[0.0; 12]);
    near(&made.read(&[0; 8]).unwrap(), [0.0; 3], [-10.0, -20.0, 30.0]);
}

#[test]
fn a_half_turn_that_is_longer_than_one_is_still_a_rotation() {
    let mut made = Made::new(false, 2);
    made.short(252, 1);
    made.floats(256, &[1.000_001, 0.0, 0.0, 0.0, 0.0, 0.0]);
    near(&made.read(&[0; 8]).unwrap(), [1.0; 3], [-1.0, 2.0, -3.0]);
}

#[test]
fn scaled_values_become_floats_with_a_warning_and_the_identity_does_not() {
    let values: Vec<u8> =
        [0_i16, 1, -1, 1000, 0, 0, 0, 0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut made = Made::new(false, 4);
    made.short(252, 1);
    for identity in [[0.0, 7.0], [1.0, 0.0], [f32::NAN, 3.0]] {
        made.floats(112, &identity);
        let loaded = made.read(&values).unwrap();
        assert!(matches!(loaded.voxels, Voxels::Scalars(Scalars::I16(_))));
        assert!(loaded.warnings.is_empty());
    }
    made.floats(112, &[2.0, -1024.0]);
    let loaded = made.read(&values).unwrap();
    let Voxels::Scalars(Scalars::F32(read)) = loaded.voxels else { panic!("not f32") };
    assert_eq!(read[..4], [-1024.0, -1022.0, -1026.0, 976.0]);
    assert!(loaded.warnings[0].contains("scaled"));
}

#[test]
fn what_is_not_one_volume_of_numbers_is_refused() {
    let refuse = |change: &dyn Fn(&mut Made), expected: &str| {
        let mut made = Made::new(false, 2);
        change(&mut made);
        let said = made.read(&[0; 8]).unwrap_err();
        assert!(said.contains(expected), "{said}");
    };
    refuse(&|m| m.short(40, 2), "`dim`");
    refuse(&|m| m.short(40, -3), "`dim`");
    refuse(&|m| m.short(42, -2), "`dim`");
    refuse(&|m| m.short(46, 1), "at least 2");
    refuse(
        &|m| {
            m.short(40, 5);
            m.short(50, 5);
        },
        "series",
    );
    refuse(&|m| m.put(40, [4, 0, 2, 0, 2, 0, 2, 0, 0, 0]), "series");
    refuse(&|m| m.short(70, 128), "`datatype`");
    refuse(&|m| m.short(42, 9), "truncated");
    refuse(&|m| m.floats(80, &[0.0]), "spacing_mm");
    refuse(&|m| m.floats(80, &[f32::NAN]), "spacing_mm");
    refuse(&|m| m.floats(108, &[f32::INFINITY]), "`vox_offset`");
    refuse(&|m| m.floats(108, &[1e15]), "truncated");
    refuse(&|m| m.put(0, 349_i32.to_le_bytes()), "348");
    refuse(&|m| m.put(0, 540_i32.to_le_bytes()), "NIfTI-2");
    refuse(&|m| m.bytes[345] = b'i', ".hdr");
    refuse(&|m| m.bytes.truncate(100), "header needs 348 bytes");
}

#[test]
fn one_time_of_a_series_is_read_and_the_others_must_be_there() {
    let mut made = Made::new(true, 4);
    made.short(40, 4);
    made.short(48, 3);
    let voxels: Vec<u8> = (0..24_i16).flat_map(i16::to_be_bytes).collect();
    let first = |stated: &Stated, bytes: Vec<u8>| {
        let loaded = read(Stream::of(bytes), Path::new("test.nii"), stated)?;
        let Voxels::Scalars(Scalars::I16(values)) = loaded.voxels else { panic!("not i16") };
        assert_eq!((loaded.grid.size, values.len()), ([2; 3], 8));
        Ok::<_, String>((values[0], loaded.warnings))
    };
    let whole = [&made.bytes[..], &voxels].concat();
    for (time, value) in [(0, 0), (1, 8), (2, 16)] {
        let stated = Stated { time: Some(time), ..Stated::default() };
        let (found, warnings) = first(&stated, whole.clone()).unwrap();
        assert_eq!((found, warnings.len()), (value, 1));
        let short = whole[..whole.len() - 1].to_vec();
        assert!(first(&stated, short).unwrap_err().contains("truncated"));
    }
    let (found, warnings) = first(&Stated::default(), whole.clone()).unwrap();
    assert!(found == 0 && warnings[1].contains("of its 3 times the first is read"));
    let fourth = Stated { time: Some(3), ..Stated::default() };
    assert!(first(&fourth, whole).unwrap_err().contains("it has 3 times"));
}

#[test]
fn further_axes_of_one_are_no_series() {
    let mut made = Made::new(false, 2);
    made.short(40, 5);
    made.short(50, 1);
    assert_eq!(made.read(&[0; 8]).unwrap().grid.size, [2; 3]);
}
