//! Each effect of a scene of everything taken away alone: nothing changes but what it did.

use gelray::view::picture::Picture;
use glam::DVec3;

use crate::composing::{CUT, Mixture, SCANNED, TEXTURED};
use crate::{
    EVERY_PIXEL, camera, difference, near, nothing, pixels, polygon, rendered, stated, view,
};

const FROM: [f64; 2] = [35.0, 20.0];

fn whole() -> Mixture {
    Mixture { sampling: EVERY_PIXEL.to_owned(), ..Mixture::whole() }
}

/// Opaque where a polygon is seen if nothing hides it.
fn covered(vertices: &[[f64; 3]]) -> Picture {
    let [azimuth, elevation] = FROM;
    rendered(&[
        &nothing(),
        &polygon("alone", vertices, ""),
        &view(azimuth, elevation, 96, 96.0, EVERY_PIXEL),
    ])
}

/// How many pixels change, and how far the greatest change goes, within `reach` of what `mask` covers and beyond.
fn changes(a: &Picture, b: &Picture, mask: &Picture, reach: usize) -> [(usize, f32); 2] {
    let mut found = [(0, 0.0_f32); 2];
    for [x, y] in pixels(a) {
        let change = difference(a.pixel(x, y), b.pixel(x, y));
        let (count, most) =
            &mut found[usize::from(!near(mask, [x, y], reach, |pixel| pixel[3] > 0.0))];
        *count += usize::from(change > 1e-6);
        *most = most.max(change);
    }
    found
}

fn same_alpha(a: &Picture, b: &Picture) -> bool {
    a.pixels.iter().zip(b.pixels.iter()).all(|(a, b)| a[3].to_bits() == b[3].to_bits())
}

#[test]
fn without_its_texture_only_what_the_polygon_covers_changes() {
    let (with, without) =
        (whole().rendered(FROM), Mixture { texture: "", ..whole() }.rendered(FROM));
    // A pixel is interpolated from its neighbours' rays.
    let [on, off] = changes(&with, &without, &covered(&TEXTURED), 1);
    println!("pixels changed, and by how much at most: on the polygon {on:?}, off it {off:?}");
    assert!(on.0 > 500 && off == (0, 0.0));
}

#[test]
fn without_its_shadow_no_opacity_changes_and_nothing_gets_darker() {
    let with = Mixture { shaft: "", ..whole() };
    let without = Mixture { shadow: "", ..with.clone() };
    // A light without a shadow has no slide either: the same beam, without it.
    let (with, without) = (with.rendered(FROM), without.rendered(FROM));
    assert!(same_alpha(&with, &without));
    let mut brighter = 0;
    for (with, without) in with.pixels.iter().zip(without.pixels.iter()) {
        let darker = (0..3).any(|c| without[c] < with[c] - 1e-5);
        assert!(!darker, "{with:?} {without:?}");
        brighter += usize::from(without[1] > with[1] + 0.02);
    }
    println!("{brighter} pixels brighter by more than 0.02");
    assert!(brighter > 500);
}

#[test]
fn without_the_cut_there_is_gel_where_it_was_and_elsewhere_only_shadows_change() {
    for shadow in ["casts_shadow = {}", ""] {
        let with = Mixture { shaft: "", shadow, ..whole() };
        let without = Mixture { clip: "", ..with.clone() };
        let parts = with.parts(FROM);
        let world = stated(&parts.iter().map(String::as_str).collect::<Vec<_>>(), &[]);
        let (cut, uncut) = (with.rendered(FROM), without.rendered(FROM));
        let corner = |n: usize| DVec3::new(CUT[n & 1][0], CUT[n >> 1 & 1][1], CUT[n >> 2][2]);
        let window = (0..8).map(|n| camera(&world).project(corner(n)).0);
        let (low, high) = window
            .fold((glam::DVec2::INFINITY, glam::DVec2::NEG_INFINITY), |(l, h), w| {
                (l.min(w), h.max(w))
            });
        let (mut gained, mut changed) = (0, 0.0_f32);
        for [x, y] in pixels(&cut) {
            let (cut, uncut) = (cut.pixel(x, y), uncut.pixel(x, y));
            assert!(uncut[3] >= cut[3] - 1e-6, "{x} {y}: {cut:?} {uncut:?}");
            gained += usize::from(uncut[3] > cut[3] + 0.05);
            let [px, py] = [x as f64 + 0.5, y as f64 + 0.5];
            let within =
                px > low.x - 3.0 && px < high.x + 3.0 && py > low.y - 3.0 && py < high.y + 3.0;
            if !within {
                assert!(uncut[3].to_bits() == cut[3].to_bits(), "{x} {y}");
                changed = changed.max(difference(cut, uncut));
            }
        }
        println!(
            "{:<20} {gained} pixels gain opacity; colours beside the cut change by {changed:.4} at most",
            format!("{shadow:?}:")
        );
        assert!(gained > 200 && (changed == 0.0) == shadow.is_empty());
    }
}

#[test]
fn without_voxelize_the_polygon_moves_to_the_hybrid_tracer_and_pixels_far_from_it_stay() {
    let mask = covered(&SCANNED);
    println!("shadow                  changes near the polygon, far from it (pixels, at most)");
    for shadow in ["casts_shadow = {}", ""] {
        let scanned = Mixture { shaft: "", shadow, ..whole() };
        let hybrid = Mixture { method: "", ..scanned.clone() };
        // The tent reaches 2 voxels and interpolation one more; a pixel is a voxel wide.
        let [close, far] = changes(&scanned.rendered(FROM), &hybrid.rendered(FROM), &mask, 5);
        println!("{:<23} {close:?}, {far:?}", format!("{shadow:?}"));
        assert!(close.0 > 500);
        assert!(far.1 < if shadow.is_empty() { 1e-6 } else { 0.03 });
    }
}

#[test]
fn without_the_shaft_pixels_only_lose_dust() {
    let (with, without) = (whole().rendered(FROM), Mixture { shaft: "", ..whole() }.rendered(FROM));
    let mut lost = 0;
    for (with, without) in with.pixels.iter().zip(without.pixels.iter()) {
        assert!(without[3] <= with[3] + 1e-6, "{with:?} {without:?}");
        lost += usize::from(with[3] > without[3] + 0.02);
    }
    println!("{lost} pixels lose more than 0.02 of opacity");
    assert!(lost > 500);
}

#[test]
fn from_another_light_no_opacity_changes() {
    let mixture = Mixture { shaft: "", ..whole() };
    let first = mixture.rendered(FROM);
    for toward in [[0.0, 0.0, 1.0], [-1.0, 0.2, 0.1], [0.0, 1.0, -1.0]] {
        let other = Mixture { toward, ..mixture.clone() }.rendered(FROM);
        assert!(same_alpha(&first, &other) && first.pixels[..] != other.pixels[..], "{toward:?}");
    }
}
