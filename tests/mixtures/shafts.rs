//! Shafts of light in dust (paper §8): closed forms, what stops them, and polygons in them.

use crate::{at, gel, level, made, nothing, polygon, strength, view};

const OPACITY: f64 = 0.02;
const FINE: &str = "coarsest = 4, finest = 4, tolerance = 0, stop_at = 0, distance_mm = 0.125";

/// A light from above whose beam is a soft disc of radius 13, with dust.
fn lamp(attenuated: bool) -> String {
    let shadow = if attenuated { "casts_shadow = {}" } else { "" };
    format!(
        "[[entity]]\nname = \"lamp\"\nlight = {{ toward = [0, 0, 1] }}\n{shadow}\n\
         shaft = {{ opacity = {OPACITY}, color = \"#ff0000\", attenuated = {attenuated} }}\n\
         projects = {{ texture = \"disc\", size_mm = [32, 32], wrap = \"vanish\" }}\n"
    )
}

/// What is let through by the dust along y from `from` to `to` at x: `Π (1 - opacity β)^dy` over the profile of the disc.
fn through(x: f64, from: f64, to: f64) -> f64 {
    let steps = 20_000;
    let dy = (to - from) / f64::from(steps);
    let depth = |i: i32| {
        let y = from + (f64::from(i) + 0.5) * dy;
        let t = (0.5 + (104.0 - x.hypot(y) * 8.0) / 32.0).clamp(0.0, 1.0);
        let inside = x.abs() < 16.0 && y.abs() < 16.0;
        if inside { (1.0 - OPACITY * t * t * (3.0 - 2.0 * t)).ln() * dy } else { 0.0 }
    };
    (0..steps).map(depth).sum::<f64>().exp()
}

#[test]
fn a_shaft_through_an_empty_volume_is_as_opaque_as_the_dust_it_lights() {
    println!("x     expected  unattenuated  attenuated (opacity)");
    let worlds = [false, true]
        .map(|attenuated| made(&[&nothing(), &lamp(attenuated), &view(0.0, 0.0, 128, 64.0, FINE)]));
    // Middles of pixels.
    for x in [0.25, 4.25, -8.25, 10.75, -12.75, 17.25, -24.75] {
        let expected = 1.0 - through(x, -31.5, 31.5);
        let seen =
            worlds.each_ref().map(|world| [-20.0, 0.0, 20.0].map(|z| at(world, [x, 0.0, z])));
        println!("{x:<5} {expected:<9.4} {:<13.4} {:.4}", seen[0][1][3], seen[1][1][3]);
        for (seen, most) in seen.iter().zip([0.002, 0.01]) {
            for pixel in seen {
                assert!((f64::from(pixel[3]) - expected).abs() < most, "{x}: {pixel:?}");
                // Lit dust is as bright as it is opaque.
                assert!((pixel[0] - pixel[3]).abs() < 1e-6 && pixel[1] == 0.0);
            }
        }
        assert!(x.abs() < 16.5 || seen.iter().flatten().all(|pixel| pixel[3] == 0.0));
    }
}

#[test]
fn the_opacity_of_a_shaft_does_not_depend_on_the_sample_distance() {
    let seen = [1.0, 0.25].map(|distance| {
        let sampling = format!(
            "coarsest = 4, finest = 4, tolerance = 0, stop_at = 0, distance_mm = {distance}"
        );
        at(&made(&[&nothing(), &lamp(true), &view(0.0, 0.0, 64, 64.0, &sampling)]), [0.5, 0.0, 0.0])
            [3]
    });
    println!("at 1 and 1/4 voxel: {seen:?}");
    assert!((seen[0] - seen[1]).abs() < 0.005);
}

#[test]
fn behind_an_opaque_slab_there_is_no_shaft_unless_it_is_not_attenuated() {
    let slab = gel("slab", [0.0, 1.0], "");
    println!("attenuated  opacity over the slab, under it; strengths made");
    for attenuated in [true, false] {
        let world = made(&[&slab, &lamp(attenuated), &view(0.0, 0.0, 128, 64.0, FINE)]);
        let [over, under] = [24.0, -24.0].map(|z| f64::from(at(&world, [0.25, 0.0, z])[3]));
        println!("{attenuated:<11} {over:.4} {under:.4}; {}", strength(&world).is_some());
        let whole = 1.0 - through(0.25, -31.5, 31.5);
        assert!((over - whole).abs() < 0.01);
        assert!((under - if attenuated { 0.0 } else { whole }).abs() < 0.01);
        assert_eq!(strength(&world).is_some(), attenuated);
    }
}

#[test]
fn a_hybrid_polygon_stops_an_attenuated_shaft() {
    let lid = level("lid", 10.0, 31.0, "");
    let world = made(&[&nothing(), &lid, &lamp(true), &view(0.0, 0.0, 128, 64.0, FINE)]);
    let [over, under] = [24.0, -10.0].map(|z| at(&world, [0.25, 0.0, z])[3]);
    println!("over the lid {over:.4}, under it {under:.4}");
    assert!(over > 0.3 && under < 1e-3);
}

#[test]
fn polygons_split_a_shaft_at_their_depths() {
    println!("at y   opacity  expected and found: opacity, red of the dust, green of the polygon");
    for y in [-9.3, 0.0, 6.1] {
        for opacity in [0.5, 1.0] {
            let surface = format!(
                "surface = {{ color = \"#00ff00\", ambient = 1, diffuse = 0, opacity = {opacity} }}"
            );
            let pane = polygon(
                "pane",
                &[[-30.0, y, -30.0], [30.0, y, -30.0], [30.0, y, 30.0], [-30.0, y, 30.0]],
                &surface,
            );
            let world = made(&[&nothing(), &pane, &lamp(false), &view(0.0, 0.0, 128, 64.0, FINE)]);
            let [red, green, _, alpha] = at(&world, [4.25, 0.0, 5.0]).map(f64::from);
            let (before, behind) = (through(4.25, -31.5, y), through(4.25, y, 31.5));
            let passed = before * (1.0 - opacity);
            let expected =
                [1.0 - passed * behind, 1.0 - before + passed * (1.0 - behind), before * opacity];
            println!("{y:<6} {opacity:<8} {expected:.4?} {:.4?}", [alpha, red, green]);
            let error = [alpha, red, green]
                .iter()
                .zip(expected)
                .map(|(f, e)| (f - e).abs())
                .fold(0.0, f64::max);
            assert!(error < 0.002, "{error}");
        }
    }
}
