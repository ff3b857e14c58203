//! Facts about series of slices: their order and places, what is odd about them, and files that are not what they say.

use std::path::Path;

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::formats::read_volume;

const PLAIN: &str = "1.2.840.10008.1.2.1";

fn element(tag: u32, kind: &str, value: &[u8]) -> Vec<u8> {
    let mut value = value.to_vec();
    if value.len() % 2 == 1 {
        value.push(if kind == "UI" { 0 } else { b' ' });
    }
    let mut bytes = [(tag >> 16) as u16, tag as u16].map(u16::to_le_bytes).concat();
    bytes.extend(kind.bytes());
    if kind == "OW" || kind == "OB" || kind == "SQ" {
        bytes.extend([0, 0]);
        bytes.extend((value.len() as u32).to_le_bytes());
    } else {
        bytes.extend((value.len() as u16).to_le_bytes());
    }
    [bytes, value].concat()
}

/// One slice of 3 × 2 pixels.
#[derive(Clone)]
struct Made {
    series: &'static str,
    number: usize,
    position: [f64; 3],
    kind: &'static str,
    syntax: &'static str,
}

impl Made {
    fn at(number: usize, z: f64) -> Self {
        Self { series: "1.2.3", number, position: [10.0, 20.0, z], kind: "AXIAL", syntax: PLAIN }
    }

    fn header(&self) -> Vec<u8> {
        let short = |value: u16| value.to_le_bytes().to_vec();
        let text = |value: &str| value.as_bytes().to_vec();
        let [x, y, z] = self.position;
        // A sequence of undefined length within an item of undefined length, which readers must step over.
        let nested: Vec<u8> = [
            &[0x08, 0, 0x40, 0x11][..],
            b"SQ\0\0\xff\xff\xff\xff",
            b"\xfe\xff\x00\xe0\xff\xff\xff\xff",
            &element(0x0020_0032, "DS", b"9\\9\\9"),
            b"\xfe\xff\x0d\xe0\0\0\0\0",
            b"\xfe\xff\xdd\xe0\0\0\0\0",
        ]
        .concat();
        let parts = [
            vec![0; 128],
            text("DICM"),
            element(0x0002_0010, "UI", self.syntax.as_bytes()),
            element(0x0008_0008, "CS", format!("ORIGINAL\\PRIMARY\\{}", self.kind).as_bytes()),
            element(0x0008_103e, "LO", b"head"),
            nested,
            element(0x0020_000e, "UI", self.series.as_bytes()),
            element(0x0020_0013, "IS", self.number.to_string().as_bytes()),
            element(0x0020_0032, "DS", format!("{x}\\{y}\\{z}").as_bytes()),
            element(0x0020_0037, "DS", b"1\\0\\0\\0\\1\\0"),
            element(0x0028_0002, "US", &short(1)),
            element(0x0028_0004, "CS", b"MONOCHROME2"),
            element(0x0028_0010, "US", &short(2)),
            element(0x0028_0011, "US", &short(3)),
            element(0x0028_0030, "DS", b"0.5\\0.25"),
            element(0x0028_0100, "US", &short(16)),
            element(0x0028_0101, "US", &short(12)),
            element(0x0028_0102, "US", &short(11)),
            element(0x0028_0103, "US", &short(0)),
            element(0x0028_1052, "DS", b"-1024"),
            element(0x0028_1053, "DS", b"1"),
        ];
        parts.concat()
    }

    /// Pixels of 1024 + 100 z.
    fn bytes(&self) -> Vec<u8> {
        let value = (1024.0 + 100.0 * self.position[2]) as u16;
        let pixels = value.to_le_bytes().repeat(6);
        [self.header(), element(elements::PIXELS, "OW", &pixels)].concat()
    }

    /// The same pixels in run lengths.
    fn packed(&self) -> Vec<u8> {
        let value = ((1024.0 + 100.0 * self.position[2]) as u16).to_be_bytes();
        let mut runs = vec![0; 64];
        runs[0] = 2;
        (runs[4], runs[8]) = (64, 66);
        runs.extend([251, value[0], 251, value[1]]);
        let own = Self { syntax: "1.2.840.10008.1.2.5", ..self.clone() };
        let start =
            b"\xe0\x7f\x10\x00OB\0\0\xff\xff\xff\xff\xfe\xff\x00\xe0\0\0\0\0\xfe\xff\x00\xe0";
        let length = (runs.len() as u32).to_le_bytes();
        [&own.header(), &start[..], &length, &runs, b"\xfe\xff\xdd\xe0\0\0\0\0"].concat()
    }
}

fn folder(files: &[(&str, Vec<u8>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

fn loaded(path: &Path) -> (Loaded, Vec<i16>) {
    let loaded = read_volume(path, &Stated::default()).unwrap();
    let Voxels::Scalars(Scalars::I16(values)) = &loaded.voxels else { panic!("not i16") };
    let values = values.to_vec();
    (loaded, values)
}

fn problem(path: &Path) -> String {
    read_volume(path, &Stated::default()).unwrap_err().to_string()
}

#[test]
fn slices_are_sorted_by_place_and_not_by_name_or_number() {
    let made = [("c", Made::at(1, 4.0)), ("a", Made::at(2, 2.0)), ("b", Made::at(3, 0.0))];
    let mut files: Vec<_> = made.iter().map(|(name, slice)| (*name, slice.bytes())).collect();
    files.push(("notes.txt", b"no slice".to_vec()));
    let folder = folder(&files);
    for path in [folder.path().to_owned(), folder.path().join("a")] {
        let (loaded, values) = loaded(&path);
        assert_eq!(loaded.grid.size, [3, 2, 3]);
        // Spacing between rows comes first in the file, and is that of y.
        assert_eq!(loaded.grid.spacing(), DVec3::new(0.25, 0.5, 2.0));
        assert_eq!(loaded.grid.index_to_world.translation, DVec3::new(10.0, 20.0, 0.0));
        assert_eq!([values[0], values[6], values[12]], [0, 200, 400]);
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    }
}

#[test]
fn run_lengths_hold_the_same_voxels() {
    let slices = [Made::at(1, 0.0), Made::at(2, 3.0)];
    let plain = folder(&[("a", slices[0].bytes()), ("b", slices[1].bytes())]);
    let packed = folder(&[("a", slices[0].packed()), ("b", slices[1].packed())]);
    assert_eq!(loaded(plain.path()).1, loaded(packed.path()).1);
}

#[test]
fn a_tilted_gantry_is_a_sheared_grid() {
    let tilted =
        |number: usize, z: f64| Made { position: [10.0, 20.0 + z / 2.0, z], ..Made::at(number, z) };
    let files = [("a", tilted(1, 0.0).bytes()), ("b", tilted(2, 2.0).bytes())];
    let folder = folder(&files);
    let (loaded, _) = loaded(folder.path());
    let step = loaded.grid.index_to_world.matrix3.z_axis;
    assert_eq!(step, DVec3::new(0.0, 1.0, 2.0));
    assert!(loaded.warnings[0].contains("26.6°"), "{:?}", loaded.warnings);
}

#[test]
fn a_missing_slice_is_interpolated_and_said_and_twins_are_left_out() {
    let places = [0.0, 1.0, 2.0, 4.0, 5.0, 5.0];
    let names = ["a", "b", "c", "d", "e", "f"];
    let slices = places.iter().zip(names).enumerate();
    let files: Vec<_> =
        slices.map(|(number, (&z, name))| (name, Made::at(number, z).bytes())).collect();
    let folder = folder(&files);
    let (loaded, values) = loaded(folder.path());
    assert_eq!(loaded.grid.size, [3, 2, 6]);
    let column: Vec<_> = values.chunks(6).map(|slice| slice[0]).collect();
    assert_eq!(column, [0, 100, 200, 300, 400, 500]);
    let said = loaded.warnings.join("; ");
    assert!(said.contains("1 of its slices") && said.contains("1.00 to 2.00 mm"), "{said}");
}

#[test]
fn several_series_are_listed_and_scouts_are_none_of_them() {
    let other = |number, z| Made { series: "1.2.4", ..Made::at(number, z) };
    let scout = Made { series: "1.2.5", kind: "LOCALIZER", ..Made::at(9, 9.0) };
    let mut files = vec![
        ("a", Made::at(1, 0.0).bytes()),
        ("b", Made::at(2, 1.0).bytes()),
        ("s", scout.bytes()),
    ];
    assert_eq!(loaded(folder(&files).path()).0.grid.size, [3, 2, 2]);
    files.extend([("x", other(1, 0.0).bytes()), ("y", other(2, 1.0).bytes())]);
    let both = folder(&files);
    let said = problem(both.path());
    assert!(said.contains("holds 2 series") && said.contains("(2 slices, \"head\")"), "{said}");
    assert_eq!(loaded(&both.path().join("y")).0.grid.size, [3, 2, 2]);
}

#[test]
fn what_cannot_be_read_is_said() {
    assert!(problem(tempfile::tempdir().unwrap().path()).contains("without slices"));
    let single = folder(&[("a", Made::at(1, 0.0).bytes())]);
    assert!(problem(single.path()).contains("single slice"));
    let wavelets = Made { syntax: "1.2.840.10008.1.2.4.90", ..Made::at(1, 0.0) };
    let packed = folder(&[("a", wavelets.bytes())]);
    for path in [packed.path().to_owned(), packed.path().join("a")] {
        assert!(problem(&path).contains("JPEG 2000 (transfer syntax 1.2.840.10008.1.2.4.90)"));
    }
}

/// Reads the bytes as a slice; what comes out, if anything, must hold together.
fn consistent(bytes: Vec<u8>) -> bool {
    let read =
        Slice::read(Stream::of(bytes), Path::new("a")).and_then(|(slice, mut elements, pixels)| {
            let stored = pixels::stored(&slice, &mut elements, pixels)?;
            Ok((slice, stored))
        });
    let Ok((slice, stored)) = read else { return false };
    assert_eq!(stored.len(), usize::from(slice.size[0]) * usize::from(slice.size[1]));
    true
}

#[test]
fn no_part_of_a_file_is_whole() {
    // Of a packed file, what is last ends its fragments.
    for bytes in [Made::at(1, 0.0).bytes(), Made::at(1, 0.0).packed()] {
        assert!(consistent(bytes.clone()));
        assert!((0..bytes.len()).all(|length| !consistent(bytes[..length].to_vec())));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn changed_bytes_never_panic_or_take_more_than_the_file(
        packed in any::<bool>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let slice = Made::at(1, 0.0);
        let mut bytes = if packed { slice.packed() } else { slice.bytes() };
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[128 + at.index(length - 128)] = *value;
        }
        consistent(bytes);
    }

    #[test]
    fn a_jpeg_of_any_bytes_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let lossless = Made { syntax: "1.2.840.10008.1.2.4.70", ..Made::at(1, 0.0) };
        let start = b"\xe0\x7f\x10\x00OB\0\0\xff\xff\xff\xff\xfe\xff\x00\xe0\0\0\0\0\xfe\xff\x00\xe0";
        let bytes = [&[0xff, 0xd8, 0xff, 0xc3][..], &bytes].concat();
        let length = (bytes.len() as u32).to_le_bytes();
        consistent([&lossless.header(), &start[..], &length, &bytes, b"\xfe\xff\xdd\xe0\0\0\0\0"].concat());
    }
}
