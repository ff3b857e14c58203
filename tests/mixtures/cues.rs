//! Depth cues (algorithm §3) on gel and on polygons of both methods.

use glam::DVec3;

use crate::{
    EVERY_PIXEL, KEY, at, camera, difference, gel, level, made, nothing, polygon, rendered, view,
};

/// Gel, polygons of both methods, and shadows; `ambient` and `strength` are those of everything.
fn scene(strength: f64, cue: &str) -> gelray::view::picture::Picture {
    let gel =
        gel("ball", [0.0, 0.3], "material = { color = \"#e0c0a0\", ambient = 0.3, diffuse = 0.7 }");
    let hybrid = level("hybrid", 5.2, 29.0, "surface = { color = \"#a0c0ff\", opacity = 0.5 }");
    let upright =
        [[-25.0, 3.0, -25.0], [25.0, -3.0, -25.0], [25.0, -3.0, 25.0], [-25.0, 3.0, 25.0]];
    let scanned = polygon(
        "scanned",
        &upright,
        "surface = { color = \"#ff8060\", opacity = 0.7 }\nvoxelize = {}",
    );
    let key = KEY.replace("[0, 0, 1]", &format!("[0.3, -0.6, 0.7], strength = {strength}"));
    let view = format!("{}{cue}\n", view(30.0, 25.0, 64, 80.0, EVERY_PIXEL));
    rendered(&[&gel, &hybrid, &scanned, &key, &view])
}

fn most(a: &gelray::view::picture::Picture, b: impl Fn(usize) -> [f32; 4]) -> f32 {
    a.pixels.iter().enumerate().map(|(at, pixel)| difference(*pixel, b(at))).fold(0.0, f32::max)
}

#[test]
fn a_cue_that_divides_by_one_changes_nothing_but_rounding() {
    let (plain, cued) = (scene(0.9, ""), scene(0.9, "depth_cue = { k1 = 1, k2 = 0 }"));
    let most = most(&plain, |at| cued.pixels[at]);
    println!("greatest difference {most:e}");
    assert!(most < 2e-6);
}

#[test]
fn ambient_light_is_not_cued() {
    let (plain, ambient) = (scene(0.9, ""), scene(0.0, ""));
    let cued = scene(0.9, "depth_cue = { k1 = 2, k2 = 0 }");
    let half = |at: usize| {
        let (plain, ambient) = (plain.pixels[at], ambient.pixels[at]);
        std::array::from_fn(|c| {
            if c < 3 { ambient[c] + (plain[c] - ambient[c]) / 2.0 } else { plain[3] }
        })
    };
    let difference = most(&cued, half);
    println!("greatest difference from ambient + reflected / 2: {difference:e}");
    assert!(difference < 2e-6);
    // Without a light to be cued there is nothing to cue.
    let dark = scene(0.0, "depth_cue = { k1 = 1, k2 = 0.05 }");
    assert!(most(&dark, |at| ambient.pixels[at]) < 2e-6);
}

#[test]
fn reflected_light_falls_with_depth_by_the_same_law_on_polygons_of_both_methods() {
    println!("depth    expected  hybrid  scan-converted");
    let (k1, k2) = (0.8, 0.02);
    for y in [-20.0, 0.0, 17.0] {
        let square = [[-25.0, y, -25.0], [25.0, y, -25.0], [25.0, y, 25.0], [-25.0, y, 25.0]];
        let light = "[[entity]]\nname = \"key\"\nlight = { toward = [0, -1, 0] }\n";
        let seen = ["", "voxelize = {}"].map(|method| {
            let pane = polygon(
                "pane",
                &square,
                &format!("surface = {{ ambient = 0.2, diffuse = 0.6 }}\n{method}"),
            );
            let view = format!(
                "{}depth_cue = {{ k1 = {k1}, k2 = {k2} }}\n",
                view(0.0, 0.0, 64, 64.0, EVERY_PIXEL)
            );
            let world = made(&[&nothing(), &pane, light, &view]);
            let extent = *world.query::<&gelray::view::extent::Extent>().iter().next().unwrap();
            let camera = camera(&world);
            let near = camera.project(extent.center()).1 - extent.radius();
            let depth = camera.project(DVec3::new(0.0, y, 0.0)).1 - near;
            (0.2 + 0.6 / (k1 + k2 * depth), depth, f64::from(at(&world, [0.0, y, 0.0])[0]))
        });
        let [(expected, depth, hybrid), (_, _, scanned)] = seen;
        println!("{depth:<8.2} {expected:<9.4} {hybrid:<7.4} {scanned:.4}");
        assert!((hybrid - expected).abs() < 1e-5);
        // What is seen of a scan-converted polygon lies up to two voxels before it.
        assert!(
            (scanned - expected).abs() < 0.6 * 2.0 * k2 / (k1 * k1) + 1e-3
                && scanned >= expected - 1e-3
        );
    }
}
