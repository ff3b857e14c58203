//! Adaptive sampling against a ray at every position: what a tolerance costs and buys (paper §6, algorithm §5).

use gelray::components::{Sampling, View};
use gelray::measure::error::{Errors, compare};

use super::support::{
    Rendered, Shown, bits, data, every_position, head, sampling_of_the_head, worst,
};

/// A ray at every position, never stopped.
fn exactly() -> Sampling {
    Sampling { distance_mm: Some(1.0), ..every_position() }
}

fn errors(made: &Rendered, exact: &Rendered) -> Errors {
    compare(&exact.picture, &made.picture).unwrap().linear
}

#[test]
fn a_tighter_tolerance_costs_rays_and_buys_accuracy() {
    let mut shown = head();
    let small = |view: &mut View| view.size = [120; 2];
    let exact = shown.render(small, exactly());
    assert!(exact.rays_per_pixel() > 16.0);
    println!("phantom, figure 6a at 120²: tolerance, PSNR, greatest error, rays a pixel");
    let mut last: Option<(f64, f64)> = None;
    for tolerance in [0.005, 0.01, 0.02, 0.05, 0.1] {
        let sampling = Sampling { tolerance, edge_tolerance: tolerance, ..sampling_of_the_head() };
        let made = shown.render(small, sampling);
        let (Errors { psnr_db, max, .. }, rays) = (errors(&made, &exact), made.rays_per_pixel());
        println!("{tolerance:6} {psnr_db:6.2} dB {max:7.4} {rays:6.3}");
        assert!(psnr_db > 30.0 && rays < 4.0);
        if let Some((psnr_before, rays_before)) = last {
            assert!(psnr_db < psnr_before + 0.1 && rays < rays_before);
        }
        last = Some((psnr_db, rays));
    }
}

#[test]
fn splitting_always_down_to_one_ray_a_pixel_is_casting_one_ray_a_pixel() {
    let mut shown = head();
    let small = |view: &mut View| view.size = [61, 47];
    let plain = Sampling { coarsest: 4, finest: 4, ..sampling_of_the_head() };
    let expected = shown.render(small, plain.clone());
    for coarsest in [8, 16, 32] {
        let made = shown.render(small, Sampling { coarsest, tolerance: 0.0, ..plain.clone() });
        assert!(bits(&made.picture) == bits(&expected.picture), "{coarsest}");
    }
}

#[test]
fn every_position_once_is_the_limit_of_refinement() {
    // Edge tolerances of nothing leave rays out only where C_G or C_A are constant to the last bit.
    let mut shown = head();
    let small = |view: &mut View| view.size = [40; 2];
    let all = Sampling { tolerance: 0.0, ..exactly() };
    let expected = shown.render(small, all.clone());
    let two = shown.render(small, Sampling { coarsest: 2, edge_tolerance: -1.0, ..all.clone() });
    assert!(bits(&two.picture) == bits(&expected.picture));
    let eight = shown.render(small, Sampling { coarsest: 8, edge_tolerance: -1.0, ..all });
    assert!(worst(&eight.picture, &expected.picture) == 0.0);
}

#[test]
fn figure_6a_is_above_40_decibels_with_fewer_than_1_2_rays_a_pixel() {
    let Some(folder) = data("figure 6a at 380² against every position") else { return };
    let mut shown = Shown::embedded("figure_06a", &[folder]);
    let full = |view: &mut View| view.size = [380; 2];
    let made = shown.render(full, sampling_of_the_head());
    let exact = shown.render(full, exactly());
    let Errors { psnr_db, max, ssim, .. } = errors(&made, &exact);
    println!(
        "CThead, figure 6a at 380²: {psnr_db:.2} dB, greatest error {max:.4}, similarity {ssim:.5}, {:.3} rays a pixel",
        made.rays_per_pixel()
    );
    assert!(psnr_db >= 40.0);
    assert!(made.rays_per_pixel() < 1.2);
}
