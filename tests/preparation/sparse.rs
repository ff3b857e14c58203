//! What is left out is what would have come out empty: preparation brick by brick equals the formulas voxel by voxel.

use gelray::components::{Classify, Clip, Contour, Form, Material, Tissue, TransferPoint};
use gelray::volume::bricks::EDGE;
use gelray::volume::classification::Classifier;
use gelray::volume::clipping::Cut;
use gelray::volume::gradients::Gradients;
use gelray::volume::grid::{Grid, Scalars};
use gelray::volume::layer::Opacity;
use glam::{DAffine3, DMat3, DVec3};
use hecs::World;
use proptest::prelude::*;

use super::{colors, prepare, spawn_volume, voxels};

/// Values that vary little but for a part of them that is steep, so that some bricks are empty and some are not.
fn lumps(grid: &Grid, seed: f64, height: f64) -> Vec<f32> {
    let value = |p: DVec3| {
        let away = (p - DVec3::splat(seed)).length();
        20.0 + height / (1.0 + away * away / 16.0) + (p.x * 1.7 + p.y * p.z + seed).sin()
    };
    voxels(grid)
        .map(|([x, y, z], _)| value(DVec3::new(x as f64, y as f64, z as f64)) as f32)
        .collect()
}

fn ways(level: f32, thickness_voxels: f32) -> [Classify; 4] {
    let contour = |value, opacity| Contour {
        value,
        opacity,
        thickness_voxels,
        form: Form::Around,
        color: None,
    };
    let tissue = |value, opacity| Tissue { value, opacity, color: None };
    let point = |value, opacity| TransferPoint { value, opacity, color: None };
    let transfer = vec![point(level, 0.0), point(level + 9.0, 0.5)];
    [
        Classify { iso: vec![contour(level, 1.0), contour(30.0, 0.2)], ..Classify::default() },
        Classify { regions: vec![tissue(25.0, 0.0), tissue(level, 0.7)], ..Classify::default() },
        Classify { transfer: transfer.clone(), ..Classify::default() },
        Classify { transfer, gradient: vec![[4.0, 0.0], [9.0, 1.0]], ..Classify::default() },
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn bricks_that_are_passed_over_are_those_that_would_be_empty(
        way in 0_usize..4,
        level in 26.0_f32..120.0,
        thickness in 0.1_f32..4.0,
        seed in 0.0_f64..20.0,
        height in 0.0_f64..200.0,
        nan in proptest::option::of(0_usize..1000),
        is_sheared in any::<bool>(),
        is_clipped in any::<bool>(),
    ) {
        let shear = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.5, 2.0, 0.0, -0.25, 0.5, 1.5]);
        let flipped = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 2.0));
        let matrix3 = if is_sheared { shear } else { flipped };
        let grid = Grid::new([21, 18, 17], DAffine3 { matrix3, translation: DVec3::ZERO }).unwrap();
        let mut values = lumps(&grid, seed, height);
        if let Some(at) = nan {
            values[at] = f32::NAN;
        }
        let classify = ways(level, thickness).into_iter().nth(way).unwrap();
        let unit = grid.spacing().min_element();
        let classifier = Classifier::new(&classify, &Material::default(), unit);
        let clip = Clip { planes: vec![[1.0, 0.5, 0.0, 12.0]], r#box: None };
        let mut world = World::new();
        let volume = spawn_volume(&mut world, grid, values, classify);
        if is_clipped {
            world.insert_one(volume, clip.clone()).unwrap();
        }
        prepare(&mut world);
        let colors = colors(&mut world, volume).base.bricks();
        let (opacity, scalars) =
            (world.get::<&Opacity>(volume).unwrap(), world.get::<&Scalars>(volume).unwrap());
        prop_assert_eq!(opacity.nan_voxels, u64::from(nan.is_some()));
        let (gradients, cut) = (Gradients::new(&grid), Cut::new(&clip, &grid));
        for (voxel, _) in voxels(&grid) {
            let value = scalars.value(grid.offset(voxel));
            let whole = classifier.opacity(value, gradients.of(&scalars, voxel));
            let expected = if is_clipped { whole * cut.factor(voxel) } else { whole };
            prop_assert_eq!(opacity.voxels.value(voxel).to_bits(), expected.to_bits());
            let is_stored = opacity.voxels.brick(voxel.map(|n| n / EDGE)).is_some();
            prop_assert!(is_stored || expected == 0.0);
            prop_assert_eq!(colors.value(voxel) != [0.0; 3], expected > 0.0);
        }
    }
}
