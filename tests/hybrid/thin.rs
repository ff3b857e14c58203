//! Polygons thinner than a pixel: what they cover does not depend on where between rays they fall.

use glam::DVec3;

use super::support::{Mixture, flat};

/// Places of a strip `across` pixels wide and `down` high, opaque and turned by `turn` radians: the mean of what the picture
/// keeps of its area, and the part of the places in which nothing of it is seen.
fn kept(across: f64, down: f64, turn: f64) -> [f64; 2] {
    let places = 60;
    let (mut kept, mut missed) = (0.0, 0.0);
    for place in 0..places {
        let place = f64::from(place);
        let middle = DVec3::new((place * 0.618_034).fract(), 0.0, (place * 0.754_878).fract());
        let (sin, cos) = turn.sin_cos();
        let corner =
            |x: f64, z: f64| middle + DVec3::new(x * cos - z * sin, 0.0, x * sin + z * cos);
        let (x, z) = (across / 2.0, down / 2.0);
        let strip = vec![corner(-x, -z), corner(x, -z), corner(x, z), corner(-x, z)];
        let scene = Mixture::polygons(vec![(vec![strip], flat([1.0; 3], 1.0))]);
        let made = scene.seen((0.0, 0.0), 20, 20.0).render();
        let seen: f32 = made.picture.pixels.iter().map(|pixel| pixel[3]).sum();
        kept += f64::from(seen) / (across * down) / f64::from(places);
        missed += f64::from(u8::from(seen == 0.0)) / f64::from(places);
    }
    [kept, missed]
}

#[test]
fn thin_polygons_keep_their_area_in_the_mean_and_are_seldom_missed() {
    println!("across × down, turn: area kept, missed");
    for (across, down, turn, least_missed) in [
        (0.2, 12.0, 0.0, 0.25),
        (12.0, 0.2, 0.0, 0.25),
        (0.2, 12.0, 0.3, 0.0),
        (0.3, 12.0, 0.0, 0.0),
        (0.5, 0.5, 0.0, 0.0),
        (1.5, 1.5, 0.4, 0.0),
    ] {
        let [area, missed] = kept(across, down, turn);
        println!("{across} × {down}, {turn}: {area:.3} {missed:.3}");
        assert!((0.9..1.1).contains(&area), "{across} × {down}: {area} of its area");
        assert!(missed <= least_missed, "{across} × {down}: missed in {missed}");
    }
}
