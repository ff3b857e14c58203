//! Facts about composites: volume and polygons by every operator, in the order of the scene.

use gelray::components::{Clip, Color, Matte, Order, Surface, Voxelize};
use gelray::shared::Shared;
use gelray::volume::grid::{Grid, Painted};
use gelray::volume::layer::{Coverage, Layer};
use glam::{DVec3, Vec3};
use hecs::{Entity, World};

use crate::scene::{add, composite, cube, rectangle, run, world};

const SIZE: usize = 24;
const GREEN: Vec3 = Vec3::new(0.0, 1.0, 0.0);

/// A volume of opacity `opacity` and colour green where x < 16, and a red polygon through the middle.
fn scene(opacity: f32, matte: Matte, alpha: f32) -> (World, Entity) {
    let mut scene = world(cube(SIZE));
    let volume = scene.query::<(Entity, &Grid)>().iter().next().unwrap().0;
    let painted = |x: usize| if x < 16 { GREEN.extend(opacity).to_array() } else { [0.0; 4] };
    let painted = (0..SIZE * SIZE * SIZE).map(|at| painted(at % SIZE)).collect();
    scene.insert_one(volume, Painted::F32(Shared::new(painted))).unwrap();
    let face = rectangle(DVec3::splat(12.0), DVec3::Z, 9.0);
    let polygon = add(&mut scene, vec![face], alpha, true);
    redden(&mut scene, polygon, matte);
    (scene, polygon)
}

fn redden(scene: &mut World, polygon: Entity, matte: Matte) {
    let mut surface = scene.get::<&mut Surface>(polygon).unwrap();
    (surface.color, surface.ambient) = (Color(Vec3::X), 1.0);
    scene.get::<&mut Voxelize>(polygon).unwrap().matte = matte;
}

/// Associated colour and opacity of a voxel.
fn associated(layer: &Layer, voxel: [usize; 3]) -> (Vec3, f32) {
    let alpha = layer.opacity.value(voxel);
    (Vec3::from(layer.colors.base.value(voxel)) * alpha, alpha)
}

#[test]
fn every_operator_is_porter_and_duffs_where_the_polygon_is_and_leaves_the_volume_elsewhere() {
    for v in [0.0, 0.25, 1.0] {
        for matte in [Matte::Over, Matte::Under, Matte::In, Matte::Out, Matte::Atop] {
            let (mut scene, polygon) = scene(v, matte, 1.0);
            run(&mut scene).unwrap();
            let layer = composite(&scene).0;
            let covered = (*scene.get::<&Coverage>(polygon).unwrap()).clone().0.opacity;
            for voxel in [[9, 9, 12], [20, 9, 12], [9, 9, 13], [9, 9, 3], [9, 2, 12], [20, 20, 20]]
            {
                let (g, v) = (covered.value(voxel), if voxel[0] < 16 { v } else { 0.0 });
                assert!(g == 0.0 || g == 1.0, "{voxel:?} is a voxel wholly in or out: {g}");
                let (of_polygon, of_volume) = match matte {
                    _ if g == 0.0 => (0.0, 1.0),
                    Matte::Over => (1.0, 1.0 - g),
                    Matte::Under => (1.0 - v, 1.0),
                    Matte::In => (v, 0.0),
                    Matte::Out => (1.0 - v, 0.0),
                    Matte::Atop => (v, 1.0 - g),
                };
                let color = Vec3::X * g * of_polygon + GREEN * v * of_volume;
                let found = associated(&layer, voxel);
                assert!(found.0.abs_diff_eq(color, 1e-6), "{matte:?} {v} {voxel:?} {found:?}");
                assert!((found.1 - (g * of_polygon + v * of_volume)).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn composites_are_finite_in_range_and_black_where_clear_for_every_operator_and_opacity() {
    for (v, g) in
        [0.0, 1e-9, 0.4, 1.0].into_iter().flat_map(|v| [1e-9, 0.3, 0.97, 1.0].map(|g| (v, g)))
    {
        for matte in [Matte::Over, Matte::Under, Matte::In, Matte::Out, Matte::Atop] {
            let (mut scene, _) = scene(v, matte, g);
            run(&mut scene).unwrap();
            let layer = composite(&scene).0;
            for (place, brick) in layer.colors.base.bricks().stored() {
                for (at, voxel) in place.voxels() {
                    let (alpha, color) = (layer.opacity.value(voxel), Vec3::from(brick[at]));
                    assert!((0.0..=1.0).contains(&alpha) && color.is_finite());
                    assert!(color.cmpge(Vec3::ZERO).all() && color.cmple(Vec3::ONE).all());
                    assert!(alpha > 0.0 || color == Vec3::ZERO, "{matte:?} {voxel:?}");
                }
            }
        }
    }
}

#[test]
fn polygons_are_matted_in_the_order_of_the_scene() {
    for first_is_red in [true, false] {
        let (mut scene, red) = scene(0.0, Matte::Over, 1.0);
        let blue = add(&mut scene, vec![rectangle(DVec3::splat(12.0), DVec3::X, 9.0)], 1.0, true);
        redden(&mut scene, blue, Matte::Over);
        scene.get::<&mut Surface>(blue).unwrap().color = Color(Vec3::Z);
        let orders = if first_is_red { [5, 6] } else { [6, 5] };
        *scene.get::<&mut Order>(red).unwrap() = Order(orders[0]);
        *scene.get::<&mut Order>(blue).unwrap() = Order(orders[1]);
        run(&mut scene).unwrap();
        let crossing = composite(&scene).0.colors.base.value([12, 12, 12]);
        assert_eq!(crossing, if first_is_red { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] });
    }
}

#[test]
fn a_painted_volume_is_matted_in_linear_light_and_clipped() {
    let mut scene = world(cube(SIZE));
    let volume = scene.query::<(Entity, &Grid)>().iter().next().unwrap().0;
    let painted = Painted::U8(Shared::new(vec![[0, 188, 0, 51]; SIZE * SIZE * SIZE]));
    let clip = Clip { planes: vec![[1.0, 0.0, 0.0, 20.0]], r#box: None };
    scene.insert(volume, (painted, clip)).unwrap();
    let polygon = add(&mut scene, vec![rectangle(DVec3::splat(12.0), DVec3::Z, 5.0)], 1.0, true);
    redden(&mut scene, polygon, Matte::Under);
    run(&mut scene).unwrap();
    let layer = composite(&scene).0;
    let (color, alpha) = associated(&layer, [12, 12, 12]);
    assert!(
        (alpha - 1.0).abs() < 1e-6 && color.abs_diff_eq(Vec3::new(0.8, 0.2 * 0.5029, 0.0), 1e-4)
    );
    assert_eq!([2, 20, 21].map(|x| layer.opacity.value([x, 12, 2])), [0.2, 0.1, 0.0]);
}
