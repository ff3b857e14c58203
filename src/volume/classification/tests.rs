//! Facts about classification: its four ways in closed form, and what holds for all of them.

use proptest::prelude::*;

use super::*;
use crate::components::{Color, Contour, Form, MixtureMaterial, Tissue, TransferPoint};

const RED: Option<Color> = Some(Color(Vec3::X));

fn four_ways(value: f32, other: f32, opacity: f32, r: f32) -> [Classify; 4] {
    let contour = |value, form, color| Contour { value, opacity, thickness_voxels: r, form, color };
    let tissue = |value, opacity| Tissue { value, opacity, color: None };
    let point = |value, opacity| TransferPoint { value, opacity, color: RED };
    let curve = vec![[value, 0.0], [other, 1.0]];
    let material = MixtureMaterial { probability: curve, opacity, color: RED };
    [
        Classify {
            iso: vec![contour(value, Form::Around, None), contour(other, Form::Above, RED)],
            ..Classify::default()
        },
        Classify {
            regions: vec![tissue(value, opacity), tissue(other, 1.0)],
            ..Classify::default()
        },
        Classify {
            transfer: vec![point(value, opacity), point(other, 0.0)],
            gradient: vec![[0.0, 0.0], [r, 1.0]],
            ..Classify::default()
        },
        Classify { materials: vec![material.clone(), material], ..Classify::default() },
    ]
}

/// Numbers of every magnitude that a file may hold, and those that it had better not.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -2000.0_f32..2000.0,
        2 => any::<f32>(),
        1 => prop::sample::select(vec![0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX]),
    ]
}

proptest! {
    #[test]
    fn a_row_is_classified_as_each_of_its_voxels(
        stated in [number(), number(), number(), number()],
        values in [number(), number(), number(), number()],
        gradient in [number(), number(), number()],
        scale in -3_i32..=3,
    ) {
        let finite = gradient.map(|part| if part.is_finite() { part } else { 0.0 });
        let row = [values[0], values[1], stated[0], stated[1], stated[0], values[2], values[3], stated[1]];
        let mut gradients = [[0.0; 8]; 3];
        for (axis, part) in finite.into_iter().enumerate() {
            gradients[axis] = [part, part * 1e-3, part, 0.0, 0.0, part, part * 1e-6, part * 1e-3];
        }
        for classify in four_ways(stated[0], stated[1], stated[2], stated[3]) {
            let classifier = Classifier::new(&classify, &Material::default(), 10.0_f64.powi(scale));
            let made = classifier.opacities(&row, &gradients);
            for (at, value) in row.into_iter().enumerate() {
                let alone = classifier.opacity(value, gradients.map(|part| part[at]));
                prop_assert_eq!(made[at].to_bits(), alone.to_bits(), "{} {:?}", value, classify);
            }
        }
    }

    #[test]
    fn opacity_is_a_fraction_and_color_finite_whatever_the_input(
        stated in [number(), number(), number(), number()],
        value in number(),
        gradient in [number(), number(), number()],
        scale in -6_i32..=6,
    ) {
        for classify in four_ways(stated[0], stated[1], stated[2], stated[3]) {
            let unit = 10.0_f64.powi(scale);
            let classifier = Classifier::new(&classify, &Material::default(), unit);
            let steep = gradient.map(|c| c / unit as f32);
            for (f, g) in [(value, gradient), (value, steep), (stated[0], gradient), (stated[0], [0.0; 3])] {
                let alpha = classifier.opacity(f, g);
                prop_assert!((0.0..=1.0).contains(&alpha), "{alpha} of {classify:?}");
                prop_assert!(classifier.color(f, g).is_finite());
                let [low, high] = classifier.range();
                prop_assert!(alpha == 0.0 || (low..=high).contains(&f64::from(f)));
            }
        }
    }

    #[test]
    fn what_the_bounds_of_a_block_deny_no_voxel_of_it_shows(
        stated in [number(), number(), number(), number()],
        values in [number(), number(), number()],
        gradients in [[number(), number(), number()], [number(), number(), number()]],
        slope in 0.0_f32..50.0,
    ) {
        let unless_nan = |f: &f32| !f.is_nan();
        let low = values.into_iter().filter(unless_nan).fold(f32::INFINITY, f32::min);
        let high = values.into_iter().filter(unless_nan).fold(f32::NEG_INFINITY, f32::max);
        let range = Range { low, high, spread: 0.0 };
        let finite = |g: &[f32; 3]| g.iter().all(|c| c.is_finite());
        let mut gradients: Vec<_> = gradients.into_iter().filter(finite).collect();
        gradients.extend([[0.0; 3], [slope, 0.0, 0.0]]);
        for classify in four_ways(stated[0], stated[1], stated[2], stated[3]) {
            let classifier = Classifier::new(&classify, &Material::default(), 1.0);
            for g in &gradients {
                let steepest = numbers::square(*g).sqrt() * (1.0 + 1e-5);
                let shows = values.iter().any(|f| classifier.opacity(*f, *g) > 0.0);
                prop_assert!(!shows || classifier.may_show(range, steepest), "{classify:?} {g:?}");
            }
        }
    }

    #[test]
    fn a_classification_does_not_depend_on_the_unit_of_length(
        f in 0.0_f32..200.0,
        g in [-80.0_f32..80.0, -80.0_f32..80.0, -80.0_f32..80.0],
        scale in -6_i32..=6,
    ) {
        let length = 10.0_f64.powi(scale);
        let [contours, regions, ..] = four_ways(60.0, 150.0, 0.7, 2.0);
        for classify in [contours, regions] {
            let here = Classifier::new(&classify, &Material::default(), 1.0).opacity(f, g);
            let there = Classifier::new(&classify, &Material::default(), length)
                .opacity(f, g.map(|c| (f64::from(c) / length) as f32));
            prop_assert!((here - there).abs() < 1e-5, "{here} {there}");
        }
    }
}

#[test]
fn a_voxel_at_the_isovalue_of_a_constant_volume_has_the_stated_opacity() {
    let [contours, ..] = four_ways(60.0, 150.0, 0.7, 2.0);
    let classifier = Classifier::new(&contours, &Material::default(), 1.0);
    assert_eq!(classifier.opacity(60.0, [0.0; 3]), 0.7);
    assert_eq!(classifier.opacity(61.0, [0.0; 3]), 0.0);
}

#[test]
fn colors_are_the_stated_ones_and_else_the_material_s() {
    let material = Material { color: Color(Vec3::Z), ..Material::default() };
    let [contours, regions, ..] = four_ways(60.0, 150.0, 0.7, 2.0);
    let contours = Classifier::new(&contours, &material, 1.0);
    assert_eq!(contours.color(60.0, [1.0, 0.0, 0.0]), Vec3::Z);
    assert_eq!(contours.color(150.5, [1.0, 0.0, 0.0]), Vec3::X);
    assert_eq!(contours.color(f32::NAN, [1.0, 0.0, 0.0]), Vec3::Z);
    assert_eq!(Classifier::new(&regions, &material, 1.0).color(90.0, [0.0; 3]), Vec3::Z);
}

#[test]
fn a_classification_that_states_nothing_is_clear() {
    let nothing = Classifier::new(&Classify::default(), &Material::default(), 1.0);
    assert_eq!(nothing.opacity(60.0, [1.0; 3]), 0.0);
    assert!(nothing.range()[0] > nothing.range()[1]);
}

#[test]
fn bounds_deny_what_is_far_from_every_level_in_value_or_in_slope() {
    let way = |at: usize| {
        let classify = four_ways(60.0, 150.0, 0.7, 2.0).into_iter().nth(at).unwrap();
        Classifier::new(&classify, &Material::default(), 1.0)
    };
    let between = |low, high| Range { low, high, spread: high - low };
    let [contours, regions, transfer, mixture] = [0, 1, 2, 3].map(way);
    assert!(
        contours.may_show(between(50.0, 55.0), 2.6) && contours.may_show(between(59.0, 61.0), 0.0)
    );
    assert!(
        !contours.may_show(between(50.0, 55.0), 2.4)
            && !contours.may_show(between(80.0, 90.0), 9.0)
    );
    assert!(regions.may_show(between(0.0, 70.0), 1.0));
    assert!(
        !regions.may_show(between(80.0, 90.0), 0.0) && !regions.may_show(between(0.0, 59.0), 9.0)
    );
    assert!(
        transfer.may_show(between(100.0, 120.0), 1.0)
            && !transfer.may_show(between(100.0, 120.0), 0.0)
    );
    assert!(!transfer.may_show(between(150.0, 190.0), 9.0));
    assert!(
        mixture.may_show(between(61.0, 70.0), 0.0) && !mixture.may_show(between(0.0, 60.0), 9.0)
    );
    let nothing = Range { low: f32::INFINITY, high: f32::NEG_INFINITY, spread: 0.0 };
    assert!([contours, regions, transfer, mixture].iter().all(|c| !c.may_show(nothing, 1.0)));
}
