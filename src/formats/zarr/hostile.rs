//! Facts about folders of Zarr that are not what they say: no reader panics, and none believes more than the files back.

use std::path::Path;

use proptest::prelude::*;

use super::{promised_of_folder, read_folder};
use crate::formats::made::{Files, put, zarr};
use crate::formats::{Stated, Voxels};

/// Reads a folder; what comes out, if anything, must hold together and is weighed.
fn consistent(folder: &Path) -> Result<(), String> {
    let loaded = read_folder(folder, &Stated::default())?;
    let Voxels::Scalars(scalars) = &loaded.voxels else { return Ok(()) };
    assert_eq!(scalars.len(), loaded.grid.voxels());
    assert!(loaded.grid.corners().iter().all(|corner| corner.is_finite()));
    let (bytes, _) = promised_of_folder(folder, &Stated::default()).unwrap();
    assert!(bytes >= scalars.len() as u64);
    Ok(())
}

fn of(files: &Files) -> Result<(), String> {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), files).unwrap();
    consistent(folder.path())
}

/// The array of `made` of that place, with a change of its metadata and its first chunk.
fn problem(which: usize, (from, to): (&str, &str), chunk: impl Fn(&mut Vec<u8>)) -> String {
    let (_, mut files) = zarr().swap_remove(which);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert!(text.contains(from), "{from}");
    files[0].1 = text.replacen(from, to, 1).into_bytes();
    chunk(&mut files[1].1);
    of(&files).unwrap_err()
}

#[test]
fn no_part_of_a_file_is_whole() {
    for (name, files) in zarr() {
        assert_eq!(of(&files), Ok(()), "{name}");
        for which in 0..2 {
            for length in 0..files[which].1.len() {
                let mut files = files.clone();
                files[which].1.truncate(length);
                assert!(of(&files).is_err(), "{name} at {length} of {}", files[which].0);
            }
        }
    }
}

#[test]
fn sizes_that_nothing_backs_are_refused_before_anything_is_allocated() {
    let same = |_: &mut Vec<u8>| {};
    for (from, to) in [
        ("[2,3,4]", "[200000,300000,400000]"),
        ("[2,3,4]", "[18446744073709551615,18446744073709551615,4]"),
        ("[2,2,3]", "[200000,200000,300000]"),
        ("[2,2,3]", "[18446744073709551615,18446744073709551615,18446744073709551615]"),
    ] {
        let said = problem(0, (from, to), same);
        assert!(["cannot hold", "multiply"].iter().any(|word| said.contains(word)), "{said}");
    }
    // A billion chunks of one number: only those that there are cost anything.
    let (_, mut files) = zarr().swap_remove(0);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    let many = text.replace("[2,3,4]", "[100,100,100]").replace("[2,2,3]", "[1,1,1]");
    files[0].1 = many.into_bytes();
    files.iter_mut().skip(1).for_each(|file| file.1.truncate(2));
    assert_eq!(of(&files), Ok(()));
}

#[test]
fn bombs_give_way_at_the_first_byte_past_their_chunk() {
    let said = problem(2, ("int16", "int16"), |chunk| {
        *chunk = crate::formats::made::gzip(&vec![0; 8 << 20]);
    });
    assert!(said.contains("unpacks to more than the 24 bytes"), "{said}");
    let said = problem(0, ("<i2", "<i2"), |chunk| *chunk = vec![0; 1 << 20]);
    assert!(said.contains("its numbers are 24"), "{said}");
}

#[test]
fn tables_of_shards_lead_nowhere_else() {
    let same = ("int16", "int16");
    for (at, value) in [(64, 255), (71, 255), (72, 200), (79, 1)] {
        let said = problem(3, same, |shard| shard[at] = value);
        assert!(said.contains("leads out of it") || said.contains("hold"), "{said}");
    }
    // A table of more rows than the file has bytes, and one that overlaps itself.
    let said = problem(3, ("[2,4,4]", "[2000000,4000000,4000000]"), |_| {});
    assert!(said.contains("cannot hold") || said.contains("truncated"), "{said}");
    let inner = r#"{"name":"sharding_indexed","configuration":{"chunk_shape":[2,2,2],"codecs":["#;
    let deep = inner.repeat(5);
    let said = problem(3, (inner, &deep), |_| {});
    assert!(said.contains("JSON") || said.contains("deeper than"), "{said}");
}

#[cfg(unix)]
#[test]
fn a_chunk_that_is_no_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (_, files) = zarr().swap_remove(0);
    put(folder.path(), &files).unwrap();
    std::fs::remove_file(folder.path().join("0.0.1")).unwrap();
    std::fs::create_dir(folder.path().join("0.0.1")).unwrap();
    assert!(consistent(folder.path()).unwrap_err().contains("not a file"));
    // Folders that lead back to themselves end with the axes.
    let (_, files) = zarr().swap_remove(1);
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), &files).unwrap();
    std::fs::remove_dir_all(folder.path().join("0/1")).unwrap();
    std::os::unix::fs::symlink(folder.path().join("0"), folder.path().join("0/1")).unwrap();
    assert!(consistent(folder.path()).unwrap_err().contains("not a file"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 800, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_files_never_panic(
        which in 0..4_usize,
        file in 0..2_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (_, mut files) = zarr().swap_remove(which);
        let bytes = &mut files[file].1;
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        let _ = of(&files);
    }

    #[test]
    fn metadata_of_any_value_never_panic(which in 0..4_usize, key in 0..9_usize, value in 0..12_usize) {
        let keys = ["\"shape\"", "\"chunks\"", "\"dtype\"", "\"order\"", "\"fill_value\"", "\"codecs\"", "\"chunk_shape\"", "\"chunk_grid\"", "\"name\""];
        let values = ["null", "[]", "{}", "-1", "[0,0,0]", "[1e99,2,3]", "\"\"", "[[[]]]", "[2,3,4,5]", "true", "[9,9,9]", "18446744073709551616"];
        let (_, mut files) = zarr().swap_remove(which);
        let text = String::from_utf8(files[0].1.clone()).unwrap();
        // The key's own value stays under another name.
        files[0].1 = text.replacen(keys[key], &format!("{}:{},\"_\"", keys[key], values[value]), 1).into_bytes();
        let _ = of(&files);
    }
}
