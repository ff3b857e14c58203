//! What is made of values: no opacity, color or gel of voxels; an edit of what is seen makes bits and a picture.

use gelray::components::Reconstruct;
use gelray::prelude::*;
use gelray::volume::gel::Gel;
use gelray::volume::layer::Opacity;

use super::{carrier, floats, made, world};

fn ball() -> World {
    let ball = floats([24; 3], |place| 12.0 - place.length() as f32);
    let view = View { size: [24, 24], ..View::default() };
    world(ball, Classify::iso(4.0), (view, Sampling::default()))
}

#[test]
fn an_edit_of_the_classification_makes_the_pyramid_and_the_picture_and_nothing_else() {
    let (mut world, renderer) = (ball(), Renderer::new().unwrap());
    let first = renderer.render(&mut world).unwrap();
    assert_eq!(made(&first.ran), ["ranges", "pyramid", "cast", "resample"]);
    let volume = carrier::<Reconstruct>(&world);
    world.insert_one(volume, Classify::iso(6.0)).unwrap();
    let edited = renderer.render(&mut world).unwrap();
    assert_eq!(made(&edited.ran), ["pyramid", "cast", "resample"]);
    assert!(edited.picture.pixels != first.picture.pixels);
    let red = Material { color: Color::from_srgb([1.0, 0.0, 0.0]), ..Material::default() };
    world.insert_one(volume, red).unwrap();
    assert_eq!(made(&renderer.render(&mut world).unwrap().ran), ["cast", "resample"]);
}

#[test]
fn voxels_are_classified_for_a_light_that_casts_shadows_alone_and_splines_filtered_once() {
    let (mut world, renderer) = (ball(), Renderer::new().unwrap());
    renderer.render(&mut world).unwrap();
    let products = |world: &World| {
        let volume = carrier::<Reconstruct>(world);
        [world.get::<&Opacity>(volume).is_ok(), world.get::<&Gel>(volume).is_ok()]
    };
    assert_eq!(products(&world), [false; 2]);
    let light = carrier::<Light>(&world);
    world.insert_one(light, CastsShadow::default()).unwrap();
    let shadowed = renderer.render(&mut world).unwrap();
    assert_eq!(made(&shadowed.ran), ["classify", "light_sweep", "cast", "resample"]);
    assert_eq!(products(&world), [true, false]);
    let view = carrier::<View>(&world);
    let interpolating = Sampling { filter: Filter::Interpolating, ..Sampling::default() };
    world.insert_one(view, interpolating).unwrap();
    let splines = renderer.render(&mut world).unwrap();
    assert_eq!(made(&splines.ran), ["prefilter", "pyramid", "cast", "resample"]);
    // And back to colors: all that was for values goes.
    let volume = carrier::<Reconstruct>(&world);
    world.remove_one::<Reconstruct>(volume).unwrap();
    let colors = renderer.render(&mut world).unwrap();
    assert_eq!(colors.notices.len(), 1, "{:?}", colors.notices);
    assert!(colors.notices[0].contains("sampling.filter"));
}

#[test]
fn polygons_are_not_scan_converted_into_values() {
    let mut world = ball();
    let square = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 2.0], [-9.0, 9.0, 2.0]];
    world.spawn((
        polygon(&square).unwrap(),
        Surface::default(),
        Voxelize { matte: Matte::Over, calibrated: true },
    ));
    let refused = Renderer::new().unwrap().render(&mut world).unwrap_err().to_string();
    assert!(refused.contains("reconstruct = \"colors\""), "{refused}");
}
