//! Facts about images of VTK: the same voxels in every writing, and files that are not what they say.

use proptest::prelude::*;

use super::super::made::{base64, zlib};
use super::*;
use crate::volume::grid::Scalars;

fn voxels_in_bytes() -> Vec<u8> {
    (0..12_i16).flat_map(i16::to_le_bytes).collect()
}

/// The table of one block, and the block.
fn packed() -> (Vec<u8>, Vec<u8>) {
    let block = zlib(&voxels_in_bytes());
    ([1, 24, 24, block.len() as u32].map(u32::to_le_bytes).concat(), block)
}

fn file(compressor: &str, format: &str, inner: &str, appended: &[u8]) -> Vec<u8> {
    let head = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\"{compressor}>\n<ImageData WholeExtent=\"1 2 0 2 0 1\" Origin=\"10 20 30\" Spacing=\"1 2 3\" Direction=\"0 -1 0 1 0 0 0 0 1\">\n<Piece Extent=\"1 2 0 2 0 1\">\n<PointData Scalars=\"f\">\n<DataArray type=\"Float32\" Name=\"other\" format=\"ascii\">0</DataArray>\n<DataArray type=\"Int16\" Name=\"f\" {format}>{inner}</DataArray>\n</PointData>\n</Piece>\n</ImageData>\n"
    );
    let end = if appended.is_empty() { &b""[..] } else { b"</AppendedData>" };
    [head.as_bytes(), appended, end, b"</VTKFile>\n"].concat()
}

fn sound() -> Vec<Vec<u8>> {
    let zipped = " compressor=\"vtkZLibDataCompressor\"";
    let length = 24_u32.to_le_bytes();
    let plain = [&length[..], &voxels_in_bytes()].concat();
    let (table, block) = packed();
    let both = base64(&table) + &base64(&block);
    let appended = |encoding: &str, bytes: &[u8]| {
        [format!("<AppendedData encoding=\"{encoding}\">\n _").as_bytes(), bytes].concat()
    };
    let offset = "format=\"appended\" offset=\"0\"";
    vec![
        file("", "format=\"ascii\"", "0 1 2 3 4 5 6 7 8 9 10 11\n", b""),
        file("", "format=\"binary\"", &format!("\n  {}\n", base64(&plain)), b""),
        file(zipped, "format=\"binary\"", &format!("\n  {both}\n"), b""),
        file("", offset, "", &appended("raw", &plain)),
        file(zipped, offset, "", &appended("raw", &[table, block].concat())),
        file(zipped, offset, "", &appended("base64", both.as_bytes())),
    ]
}

fn of(bytes: Vec<u8>) -> Result<Loaded, String> {
    read(Stream::of(bytes), Path::new(""), &Stated::default())
}

#[test]
fn the_voxels_are_the_same_in_every_writing() {
    for (number, bytes) in sound().into_iter().enumerate() {
        assert!(recognizes(&bytes[..bytes.len().min(352)]));
        let loaded = of(bytes).unwrap();
        assert_eq!(loaded.grid.size, [2, 3, 2]);
        // The extent begins at x = 1, which runs along +y.
        let placed = loaded.grid.index_to_world;
        assert_eq!(placed.translation, DVec3::new(10.0, 21.0, 30.0), "{number}");
        assert_eq!(placed.matrix3.y_axis, DVec3::new(-2.0, 0.0, 0.0));
        let Voxels::Scalars(Scalars::I16(values)) = loaded.voxels else { panic!("not i16") };
        assert_eq!(values.to_vec(), (0..12).collect::<Vec<i16>>());
    }
}

#[test]
fn what_is_not_read_is_said() {
    let text = |from: &str, to: &str| {
        let bytes = String::from_utf8(sound().swap_remove(0)).unwrap();
        of(bytes.replace(from, to).into_bytes()).unwrap_err()
    };
    assert!(text("PointData", "CellData").contains("cell data"));
    assert!(text("\"1 2 0 2 0 1\" Origin", "\"1 2 0 2\" Origin").contains("6 numbers"));
    assert!(text("header_type=\"UInt32\"", "compressor=\"vtkLZ4DataCompressor\"").contains("zlib"));
    assert!(text("Int16", "String").contains("`String`"));
    assert!(text("\"1 2 0 2 0 1\" Origin", "\"1 2 0 9e9 0 9e9\" Origin").contains("multiply"));
}

fn consistent(bytes: Vec<u8>) {
    if let Ok(loaded) = of(bytes) {
        let Voxels::Scalars(scalars) = loaded.voxels else { return };
        assert_eq!(scalars.len(), loaded.grid.voxels());
    }
}

#[test]
fn a_part_of_a_file_never_panics() {
    for bytes in sound() {
        (0..bytes.len()).for_each(|length| consistent(bytes[..length].to_vec()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn changed_bytes_never_panic(
        file in 0..6_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = sound().swap_remove(file);
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        consistent(bytes);
    }
}
