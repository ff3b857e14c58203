//! Facts about files of others, where GELRAY_DATA names the folder that holds them.

use std::io::Write;
use std::path::PathBuf;

use glam::{DMat3, DVec3};

use super::{Loaded, Stated, Voxels, read_volume};
use crate::measure::sigma::sigma;
use crate::volume::grid::Scalars;

/// The file, read; `None`, with a line that says so, where there is no data folder or no such file in it.
fn real(name: &str) -> Option<Loaded> {
    let path = std::env::var_os("GELRAY_DATA").map(|folder| PathBuf::from(folder).join(name));
    let Some(path) = path.filter(|path| path.exists()) else {
        // Past the harness, which keeps what passing tests print to itself.
        let _ = writeln!(
            std::io::stderr(),
            "skipped: {name} is not in the folder that GELRAY_DATA names"
        );
        return None;
    };
    Some(read_volume(&path, &Stated::default()).unwrap())
}

fn scalars(loaded: Loaded) -> Scalars {
    match loaded.voxels {
        Voxels::Scalars(scalars) => scalars,
        Voxels::Painted(_) => panic!("these files are scalars"),
    }
}

#[test]
fn the_head_of_the_paper_is_read() {
    let Some(head) = real("cthead/cthead.nrrd") else { return };
    assert_eq!((head.grid.size, head.grid.spacing()), ([256, 256, 113], DVec3::new(1.0, 1.0, 2.0)));
    let Scalars::U16(values) = scalars(head) else { panic!("not u16") };
    assert_eq!(values.iter().max(), Some(&3272));
    assert_eq!(values[0], 25);
}

#[test]
fn detached_headers_are_read() {
    let Some(tooth) = real("raw/tooth_103x94x161_uint16be.nhdr") else { return };
    assert_eq!(tooth.grid.size, [103, 94, 161]);
    assert!(matches!(scalars(tooth), Scalars::U16(v) if v.iter().max() == Some(&1300)));
    let Some(protein) = real("raw/neghip_64x64x64_uint8.nhdr") else { return };
    assert!(matches!(scalars(protein), Scalars::U8(v) if v.len() == 1 << 18));
}

#[test]
fn a_nifti_abdomen_is_turned_to_left_and_posterior() {
    let Some(abdomen) = real("nifti/totalseg_example_ct.nii.gz") else { return };
    assert_eq!(abdomen.grid.size, [122, 101, 112]);
    let grid = abdomen.grid.index_to_world;
    assert!(grid.translation.distance(DVec3::new(177.956_33, -11.319, 94.301_76)) < 1e-4);
    assert_eq!(grid.matrix3, DMat3::from_diagonal(DVec3::new(-3.0, -3.0, 3.0)));
    let Scalars::I32(values) = scalars(abdomen) else { panic!("not i32") };
    assert_eq!((values.iter().min(), values.iter().max()), (Some(&-1207), Some(&3382)));
}

#[test]
fn a_map_of_ribonuclease_lies_where_its_model_does() {
    let Some(map) = real("maps/rnase_sa_2fofc_chainA.ccp4") else { return };
    assert_eq!(map.grid.size, [70, 62, 66]);
    let step = DVec3::new(64.897 / 108.0, 78.323 / 128.0, 38.792 / 64.0);
    assert!(map.grid.spacing().distance(step) < 1e-6);
    let start = step * DVec3::new(61.0, -20.0, -16.0);
    assert!(map.grid.index_to_world.translation.distance(start) < 1e-4);
    assert!(map.warnings.is_empty(), "{:?}", map.warnings);
    // The box around one chain varies a little more than the whole cell, whose deviation is 0.3734.
    let found = sigma(&scalars(map)).unwrap();
    assert!(found.mean.abs() < 1e-5 && (found.deviation - 0.379_60).abs() < 1e-5, "{found:?}");
}

#[test]
fn a_gzipped_map_of_a_molecule_is_read() {
    let Some(map) = real("maps/betagal.mrc.gz") else { return };
    assert_eq!(map.grid.size, [100; 3]);
    assert!(map.grid.spacing().distance(DVec3::splat(3.54)) < 1e-6);
    assert!((sigma(&scalars(map)).unwrap().deviation - 0.0165).abs() < 5e-5);
}
