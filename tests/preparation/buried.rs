//! What no ray comes to is not made, and no picture shows it.

use gelray::Renderer;
use gelray::components::{CastsShadow, Clip, Skip, TransferPoint};
use gelray::volume::layer::Opacity;

use super::*;

/// The picture of a ball in a shadow's light, bit for bit, and how many of its bricks were classified and kept.
fn seen(
    classify: &Classify,
    add: impl Fn(&mut World, Entity),
    change: impl Fn(&mut View, &mut Sampling),
) -> (Vec<[u32; 4]>, usize) {
    let grid = Grid::axis_aligned([100, 96, 82], [1.0, 1.0, 1.25], [-49.0, -47.0, -50.0]).unwrap();
    let mut world = World::new();
    let ball = spawn_volume(
        &mut world,
        grid,
        sampled(&grid, |p| (44.0 - p.length() as f32).min(5.0)),
        classify.clone(),
    );
    add(&mut world, ball);
    let light = spawn_light(&mut world, 1, Toward::Direction([0.3, -0.8, 0.5]));
    world.insert_one(light, CastsShadow::default()).unwrap();
    let (mut view, mut sampling) =
        (View { size: [40, 40], ..View::default() }, Sampling::default());
    (view.azimuth, view.elevation) = (25.0, 35.0);
    change(&mut view, &mut sampling);
    let extent = Extent::of(grid.corners()).unwrap();
    world.spawn((Name("view".into()), Order(9), view, sampling, extent));
    let picture = Renderer::new().unwrap().render(&mut world).unwrap().picture;
    let bits = picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect();
    let stored = world.get::<&Opacity>(ball).unwrap().voxels.stored().count();
    (bits, stored)
}

fn above(value: f32, opacity: f32) -> Classify {
    let form = Form::Above;
    let contour = Contour { value, opacity, thickness_voxels: 2.0, form, color: None };
    Classify { iso: vec![contour], ..Classify::default() }
}

fn transfer() -> Classify {
    let point = |value: f32, opacity: f32| TransferPoint { value, opacity, color: None };
    Classify { transfer: vec![point(0.0, 0.0), point(3.0, 1.0)], ..Classify::default() }
}

#[test]
fn a_ball_is_seen_alike_where_its_inside_is_not_made() {
    for classify in [above(0.0, 1.0), transfer()] {
        for (distance, stop_at) in [(None, None), (Some(2.0), None), (Some(0.4), Some(0.0))] {
            let change = |skip: Skip| {
                move |_: &mut View, sampling: &mut Sampling| {
                    (sampling.skip, sampling.distance_mm) = (skip, distance);
                    sampling.stop_at = stop_at.unwrap_or(sampling.stop_at);
                }
            };
            let (picture, kept) = seen(&classify, |_, _| (), change(Skip::Pyramid));
            let (whole, all) = seen(&classify, |_, _| (), change(Skip::None));
            assert!(picture == whole, "{distance:?} {stop_at:?}");
            assert!(kept + 8 <= all, "{kept} of {all}");
        }
    }
}

#[test]
fn all_is_made_where_a_ray_may_come_to_it() {
    let kept = |opacity: f32,
                add: &dyn Fn(&mut World, Entity),
                change: &dyn Fn(&mut View, &mut Sampling)| {
        seen(&above(0.0, opacity), add, change).1
    };
    let all = kept(1.0, &|_, _| (), &|_, sampling| sampling.skip = Skip::None);
    let cut = |world: &mut World, ball: Entity| {
        let planes = vec![[0.0, 0.0, 1.0, 100.0]];
        world.insert_one(ball, Clip { planes, ..Clip::default() }).unwrap();
    };
    assert_eq!(kept(1.0, &cut, &|_, _| ()), all);
    for matte in [Matte::In, Matte::Out] {
        let matted = |world: &mut World, _: Entity| {
            spawn_far(world, matte);
        };
        assert_eq!(kept(1.0, &matted, &|_, _| ()), all);
    }
    assert_eq!(kept(0.99, &|_, _| (), &|_, _| ()), all);
    assert_eq!(kept(1.0, &|_, _| (), &|view, _| view.field_of_view = Some(30.0)), all);
    let far = |_: &mut View, sampling: &mut Sampling| sampling.distance_mm = Some(2.5);
    assert_eq!(kept(1.0, &|_, _| (), &far), all);
}
