//! Shadows between volumes and polygons of both methods (paper §4).

use crate::{
    EVERY_PIXEL, KEY, at, frame, gel, level, made, nothing, pixels, polygon, strength, view,
};

const WHITE: &str = "surface = { ambient = 0.25, diffuse = 0.75 }";
const VOXELIZE: &str = "voxelize = {}";

fn keys(opacity: f64, method: &str) -> String {
    format!("surface = {{ ambient = 0.25, diffuse = 0.75, opacity = {opacity} }}\n{method}")
}

/// An opaque slab, of which the half at x > 0 is cut away.
fn half_slab() -> String {
    gel("slab", [0.0, 1.0], "clip = { planes = [[1, 0, 0, 0]] }")
}

#[test]
fn a_hybrid_polygon_behind_opaque_gel_is_ambient_and_beside_it_fully_lit() {
    let floor = level("floor", -24.0, 28.0, WHITE);
    let world = made(&[&half_slab(), &floor, KEY, &view(0.0, 10.0, 128, 70.0, EVERY_PIXEL)]);
    let row: Vec<f32> = (-26..=26).map(|x| at(&world, [f64::from(x), 0.0, -24.0])[0]).collect();
    let edge =
        row.windows(2).position(|pair| pair[0] < 0.625 && pair[1] >= 0.625).unwrap() as i64 - 26;
    println!(
        "behind {:.4}, beside {:.4}, edge between x = {edge} and {}",
        row[4],
        row[48],
        edge + 1
    );
    assert!(row[..24].iter().all(|c| (c - 0.25).abs() < 1e-3), "{row:?}");
    assert!(row[29..].iter().all(|c| (c - 1.0).abs() < 1e-3), "{row:?}");
    assert!((-1..=1).contains(&edge), "the cut is at x = 0");
}

#[test]
fn what_is_clipped_away_casts_no_shadow() {
    let floor = level("floor", -24.0, 28.0, WHITE);
    let beneath = |gel: &str| {
        let world = made(&[gel, &floor, KEY, &view(0.0, 10.0, 128, 70.0, EVERY_PIXEL)]);
        at(&world, [-12.0, 0.0, -24.0])[0]
    };
    let whole = beneath(&gel("slab", [0.0, 1.0], ""));
    let gone =
        beneath(&gel("slab", [0.0, 1.0], "clip = { box = [[-99, -99, -99], [99, 99, 99]] }"));
    println!("beneath the slab {whole:.4}, beneath where it was {gone:.4}");
    assert!((whole - 0.25).abs() < 1e-3 && (gone - 1.0).abs() < 1e-3);
}

#[test]
fn a_translucent_polygon_lets_its_part_of_the_light_through_whichever_method_draws_which() {
    println!("opacity  caster          receiver        lit part: expected, found");
    for opacity in [0.25, 0.5, 0.9, 1.0] {
        for (caster, receiver) in [("", ""), (VOXELIZE, ""), ("", VOXELIZE), (VOXELIZE, VOXELIZE)] {
            let caster_part = level("caster", 20.3, 16.0, &keys(opacity, caster));
            let floor = level("floor", -20.2, 28.0, &keys(1.0, receiver));
            let view = view(0.0, 20.0, 128, 70.0, EVERY_PIXEL);
            let world = made(&[&nothing(), &caster_part, &floor, KEY, &view]);
            let lit = |x: f64| (f64::from(at(&world, [x, 0.0, -20.2])[0]) - 0.25) / 0.75;
            let (found, beside) = (lit(0.0), lit(24.0));
            let name = |method: &str| if method.is_empty() { "hybrid" } else { "scan-converted" };
            println!(
                "{opacity:<8} {:<15} {:<15} {:.3} {found:.3}, beside {beside:.3}",
                name(caster),
                name(receiver),
                1.0 - opacity
            );
            assert!((found - (1.0 - opacity)).abs() < 0.03, "{found}");
            assert!((beside - 1.0).abs() < 0.02, "{beside}");
        }
    }
}

#[test]
fn a_polygon_casts_no_shadow_on_itself_at_the_default_bias() {
    println!("method          opacity  degrees  least lit part over phases between voxels");
    for method in ["", VOXELIZE] {
        for opacity in [1.0, 0.5] {
            for degrees in [0.0_f64, 30.0, 45.0, 60.0, 75.0] {
                let lit = [0.0, 0.25, 0.5, 0.75]
                    .map(|phase| lit_alone(phase, &keys(opacity, method), degrees));
                let least = lit.into_iter().fold(f64::INFINITY, f64::min);
                let name = if method.is_empty() { "hybrid" } else { "scan-converted" };
                println!("{name:<15} {opacity:<8} {degrees:<8} {least:.3}");
                // Voxels get the strength of a point a bias nearer along the light: aslant it is still in the layer, whose
                // half thickness the bias then clears by its cosine alone.
                let expected = match (method, degrees) {
                    ("", _) => 0.9995,
                    (_, ..1.0) => 0.96,
                    (_, ..31.0) => 0.93,
                    (_, ..46.0) => 0.88,
                    (_, ..61.0) => 0.71,
                    _ => 0.38,
                };
                assert!(least > expected, "{name} {opacity} {degrees}: {least}");
            }
        }
    }
}

#[test]
fn a_scan_converted_polygon_casts_no_shadow_on_itself_where_the_bias_clears_its_layer() {
    println!("degrees  bias in voxels  least lit part over phases between voxels");
    for degrees in [0.0_f64, 30.0, 45.0, 60.0, 75.0] {
        // The layer is as thick aslant as its part along the light.
        let bias = 4.0 / degrees.to_radians().cos();
        let shadow = format!("casts_shadow = {{ bias_voxels = {bias} }}");
        let lit = [0.0, 0.25, 0.5, 0.75]
            .map(|phase| lit_alone_under(phase, &keys(1.0, VOXELIZE), degrees, &shadow));
        let least = lit.into_iter().fold(f64::INFINITY, f64::min);
        println!("{degrees:<8} {bias:<15.2} {least:.4}");
        assert!(least > 0.995, "{degrees}: {least}");
    }
}

/// The part of the light from so many degrees aslant that falls on a level polygon alone, at the middle.
fn lit_alone(z: f64, keys: &str, degrees: f64) -> f64 {
    lit_alone_under(z, keys, degrees, "casts_shadow = {}")
}

fn lit_alone_under(z: f64, keys: &str, degrees: f64, shadow: &str) -> f64 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let light = KEY.replace("[0, 0, 1]", &format!("[{sin}, 0, {cos}]"));
    let light = light.replace("casts_shadow = {}", shadow);
    let floor = level("floor", z, 28.0, keys);
    let world = made(&[&nothing(), &floor, &light, &view(0.0, 90.0, 32, 64.0, EVERY_PIXEL)]);
    let [red, _, _, alpha] = at(&world, [0.0; 3]);
    (f64::from(red / alpha) - 0.25) / 0.75 / cos
}

#[test]
fn a_volume_is_shadowed_by_a_hybrid_polygon_as_by_the_same_scan_converted() {
    let ball = gel("ball", [0.0, 1.0], "material = { ambient = 0.2, diffuse = 0.8 }");
    println!(
        "opacity  mean and greatest difference: of beta at voxels, of pixels of the ball alone"
    );
    for opacity in [0.3, 0.7, 1.0] {
        let vertices =
            [[-30.0, -30.0, 28.2], [2.0, -30.0, 28.2], [2.0, 30.0, 28.2], [-30.0, 30.0, 28.2]];
        let cast = |method: &str| {
            let caster = polygon("caster", &vertices, &keys(opacity, method));
            made(&[&ball, &caster, KEY, &view(0.0, 5.0, 96, 64.0, EVERY_PIXEL)])
        };
        let (hybrid, scanned) = (cast(""), cast(VOXELIZE));
        let (a, b) = (strength(&hybrid).unwrap(), strength(&scanned).unwrap());
        let (a, b) = (&a.volumes[0].1, &b.volumes[0].1);
        // Under the polygon the top of the ball is dimmer than beside it.
        let top = |x: usize| f64::from(a.voxels.value([x, 31, 54])) / 65535.0 * f64::from(a.full);
        assert!((top(26) / top(37) - (1.0 - opacity)).abs() < 0.03, "{} {}", top(26), top(37));
        let (mut sum, mut most, mut count) = (0.0, 0.0_f64, 0.0);
        for (place, brick) in a.voxels.stored() {
            for (within, voxel) in place.voxels().filter(|(_, voxel)| voxel[2] < 56) {
                let beta = |raw: u16, full: f32| f64::from(raw) / 65535.0 * f64::from(full);
                let difference =
                    (beta(brick[within], a.full) - beta(b.voxels.value(voxel), b.full)).abs();
                sum += difference;
                most = most.max(difference);
                count += 1.0;
            }
        }
        let (first, second) = (frame(&hybrid), frame(&scanned));
        // Rows below the polygon's lowest.
        let seen: Vec<f32> = pixels(&first)
            .filter(|[_, y]| *y > 20)
            .map(|[x, y]| crate::difference(first.pixel(x, y), second.pixel(x, y)))
            .collect();
        let greatest = seen.iter().copied().fold(0.0, f32::max);
        let mean = seen.iter().sum::<f32>() / seen.len() as f32;
        println!("{opacity:<8} {:.5} {most:.5}  {mean:.5} {greatest:.5}", sum / count);
        assert!(sum / count < 1e-4 && most < 1e-3 && mean < 1e-4 && greatest < 1e-3);
    }
}
