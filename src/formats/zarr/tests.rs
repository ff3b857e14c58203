//! Facts about arrays and images of Zarr: that all ways of writing an array are read alike, and what of many is chosen.

use glam::DVec3;

use super::*;
use crate::formats::made::{put, zarr};
use crate::formats::{is_volume, read_volume, survey};
use tempfile::TempDir;

/// A folder of these files.
fn folder(files: &[(&str, Vec<u8>)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), files).unwrap();
    folder
}

fn texts(files: &[(&'static str, &str)]) -> Vec<(&'static str, Vec<u8>)> {
    files.iter().map(|(name, text)| (*name, text.as_bytes().to_vec())).collect()
}

fn of(path: &Path) -> Result<Loaded, String> {
    read_folder(path, &Stated::default())
}

fn numbers(loaded: &Loaded) -> Vec<i16> {
    let Voxels::Scalars(Scalars::I16(values)) = &loaded.voxels else { panic!("not i16") };
    values.to_vec()
}

/// The array in `made` of that place, with a change of its metadata.
fn changed(which: usize, change: impl Fn(&str) -> String) -> TempDir {
    let (_, mut files) = zarr().swap_remove(which);
    files[0].1 = change(std::str::from_utf8(&files[0].1).unwrap()).into_bytes();
    folder(&files)
}

/// An array without chunks of a shape and a fill value.
fn empty(shape: &str, fill: &str) -> String {
    format!(
        r#"{{"zarr_format":2,"shape":[{shape}],"chunks":[{shape}],"dtype":"|u1","order":"C","fill_value":{fill},"compressor":null,"filters":null}}"#
    )
}

#[test]
fn all_ways_of_writing_an_array_are_read_alike() {
    for (name, files) in zarr() {
        let folder = folder(&files);
        let loaded = of(folder.path()).unwrap();
        assert_eq!(loaded.grid.size, [4, 3, 2], "{name}");
        assert_eq!(numbers(&loaded), (0..24).collect::<Vec<_>>(), "{name}");
        assert!(loaded.warnings[0].contains("spacing_mm") && loaded.warnings.len() == 1, "{name}");
        let found = survey(folder.path(), &Stated::default()).unwrap();
        assert_eq!((found.format, found.files.len()), ("Zarr", files.len()), "{name}");
        assert!(found.bytes > 48, "{name}");
    }
}

#[test]
fn a_chunk_that_is_not_there_is_the_fill_value_and_that_is_said() {
    for (which, (name, mut files)) in zarr().into_iter().enumerate().take(3) {
        files.remove(2);
        let loaded = of(folder(&files).path()).unwrap();
        let mut expected: Vec<i16> = (0..24).collect();
        for at in [3, 7, 15, 19] {
            expected[at] = -7;
        }
        assert_eq!(numbers(&loaded), expected, "{name}");
        assert!(loaded.warnings[1].contains("1 of its 4 chunks"), "{which}");
    }
    // In a shard its place in the table says so.
    let (_, mut files) = zarr().swap_remove(3);
    let table = files[1].1.len() - 64;
    files[1].1[table + 16..table + 32].fill(255);
    let loaded = of(folder(&files).path()).unwrap();
    assert_eq!(numbers(&loaded)[..8], [0, 1, -7, -7, 4, 5, -7, -7]);
}

#[test]
fn numbers_of_every_type_and_their_fill_values_are_read() {
    for (kind, fill) in
        [("<f4", "\"NaN\""), ("<f8", "2.5"), ("|b1", "true"), ("<u8", "7"), ("<f2", "1.5")]
    {
        let text = empty("2, 2, 3", fill).replace("|u1", kind);
        let loaded = of(folder(&texts(&[(".zarray", &text)])).path()).unwrap();
        let Voxels::Scalars(scalars) = loaded.voxels else { panic!("painted") };
        let right = match &scalars {
            Scalars::F32(v) => v.iter().all(|v| v.is_nan() || *v == 1.5),
            Scalars::F64(v) => v.iter().all(|v| *v == 2.5),
            Scalars::U8(v) => v.iter().all(|v| *v == 1),
            Scalars::U64(v) => v.iter().all(|v| *v == 7),
            _ => false,
        };
        assert!(right, "{kind}");
    }
    let text = empty("2, 3, 4, 4", "9");
    let painted = of(folder(&texts(&[(".zarray", &text)])).path()).unwrap();
    assert!(matches!(painted.voxels, Voxels::Painted(_)));
    assert_eq!(painted.grid.size, [4, 3, 2]);
}

const IMAGE: &str = r#"{"multiscales":[{"version":"0.4","axes":[{"name":"c","type":"channel"},{"name":"z","type":"space","unit":"micrometer"},{"name":"y","type":"space","unit":"micrometer"},{"name":"x","type":"space","unit":"micrometer"}],"datasets":[{"path":"fine","coordinateTransformations":[{"type":"scale","scale":[1,2000,500,500]},{"type":"translation","translation":[0,0,1000,3000]}]},{"path":"levels/coarse","coordinateTransformations":[{"type":"scale","scale":[1,2000,1000,1000]}]}]}]}"#;

/// An image of two channels at two levels, the second of which is smaller.
fn image() -> TempDir {
    let array = |shape: &str| empty(shape, "5").replace("zattrs", "");
    let (fine, coarse) = (array("2, 3, 4, 5"), array("2, 3, 2, 2"));
    folder(&texts(&[
        (".zgroup", r#"{"zarr_format":2}"#),
        (".zattrs", IMAGE),
        ("fine/.zarray", &fine),
        ("levels/.zgroup", r#"{"zarr_format":2}"#),
        ("levels/coarse/.zarray", &coarse),
    ]))
}

#[test]
fn an_image_is_its_finest_level_and_any_level_by_its_folder() {
    let folder = image();
    for path in
        [folder.path().to_owned(), folder.path().join("fine"), folder.path().join(".zattrs")]
    {
        let loaded = read_volume(&path, &Stated::default()).unwrap();
        assert_eq!(loaded.grid.size, [5, 4, 3]);
        assert_eq!(loaded.grid.spacing(), DVec3::new(0.5, 0.5, 2.0));
        assert_eq!(loaded.grid.corners()[0], DVec3::new(3.0, 1.0, 0.0));
        assert!(loaded.warnings[0].contains("of its 2 channels"), "{:?}", loaded.warnings);
    }
    let coarse = of(&folder.path().join("levels/coarse")).unwrap();
    assert_eq!((coarse.grid.size, coarse.grid.spacing()), ([2, 2, 3], DVec3::new(1.0, 1.0, 2.0)));
    assert!(is_volume(&folder.path().join(".zattrs")) && !is_volume(&folder.path().join("fine")));
    let second = Stated { channel: Some(1), ..Stated::default() };
    let warnings = read_folder(folder.path(), &second).unwrap().warnings;
    assert!(warnings.len() == 1 && warnings[0].contains("chunks are not there"), "{warnings:?}");
}

#[test]
fn a_group_is_its_one_volume_or_lists_those_in_it() {
    let array = empty("2, 3, 4", "0");
    let line = empty("4", "0");
    let root = ("zarr.json", r#"{"zarr_format":3,"node_type":"group","attributes":{}}"#);
    let one = folder(&texts(&[
        root,
        ("a/.zgroup", "{}"),
        ("a/b/.zarray", &array),
        ("line/.zarray", &line),
    ]));
    assert_eq!(of(one.path()).unwrap().grid.size, [4, 3, 2]);
    let two = folder(&texts(&[root, ("a/.zarray", &array), ("b/.zattrs", IMAGE)]));
    let problem = of(two.path()).unwrap_err();
    let named = |name: &str| problem.contains(&two.path().join(name).display().to_string());
    assert!(problem.contains("holds 2 volumes") && named("a") && named("b"), "{problem}");
    let none = folder(&texts(&[root, ("line/.zarray", &line)]));
    assert!(of(none.path()).unwrap_err().contains("without an array of three axes"));
}

#[test]
fn attributes_of_a_bare_array_state_its_spacing() {
    let array = empty("2, 3, 4", "0");
    for (attributes, spacing) in [
        (r#"{"spacing":[3, 2, 0.5]}"#, [0.5, 2.0, 3.0]),
        (r#"{"voxel_size":[8000, 4000, 2000],"units":["nm","nm","nm"]}"#, [0.002, 0.004, 0.008]),
        (r#"{"scale":[1, 2, 3],"_ARRAY_DIMENSIONS":["x","y","z"]}"#, [1.0, 2.0, 3.0]),
    ] {
        let folder = folder(&texts(&[(".zarray", &array), (".zattrs", attributes)]));
        let loaded = of(folder.path()).unwrap();
        assert!((loaded.grid.spacing() - DVec3::from(spacing)).length() < 1e-12, "{attributes}");
        assert!(loaded.warnings[0].contains("is taken as the spacing"), "{:?}", loaded.warnings);
    }
}

#[test]
fn what_is_not_read_is_named_with_a_remedy() {
    for (which, from, to, said) in [
        (0, "\"compressor\":null", "\"compressor\":{\"id\":\"bz2\"}", "`bz2`"),
        (0, "\"<i2\"", "\"<c8\"", "astype"),
        (0, "\"<i2\"", "[[\"a\",\"<i2\"]]", "one field alone"),
        (0, "\"C\"", "\"K\"", "`K`"),
        (0, "[2,2,3]", "[2,0,3]", "none of 0"),
        (0, "[2,2,3]", "[2,3]", "as many axes"),
        (0, "-7", "0.5", "no number of its type"),
        (1, "\"/\"", "\"-\"", "separated by `-`"),
        (2, "\"int16\"", "\"complex64\"", "complex64"),
        (2, "regular", "rectangular", "`rectangular`"),
        (2, "\"default\"", "\"hashed\"", "`hashed`"),
        (2, "[1,0,2]", "[1,1,2]", "each of 3 axes"),
        (2, "\"bytes\"", "\"vlen-utf8\"", "`vlen-utf8`"),
        (2, "\"attributes\"", "\"future\"", "`future`"),
        (3, "[2,2,2]", "[2,3,2]", "not a multiple"),
        (3, "\"end\"", "\"middle\"", "`middle`"),
    ] {
        let folder = changed(which, |text| text.replacen(from, to, 1));
        let problem = of(folder.path()).unwrap_err();
        assert!(problem.contains(said), "{problem}");
    }
    let problem = of(&folder(&[]).path().join("none.zarr")).unwrap_err();
    assert!(problem.contains("holds no zarr.json"), "{problem}");
}
