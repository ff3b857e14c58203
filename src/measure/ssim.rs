//! Structural similarity of two grey pictures (Wang, Bovik, Sheikh and Simoncelli 2004).

use rayon::prelude::*;

/// Width of the window, in pixels.
const WINDOW: usize = 11;

/// Standard deviation of the window's Gaussian, in pixels.
const SIGMA: f64 = 1.5;

/// (K₁ L)² and (K₂ L)² with K₁ = 0.01, K₂ = 0.03 and a peak L of 1.
const STABILISERS: [f64; 2] = [0.01 * 0.01, 0.03 * 0.03];

/// The mean structural similarity of two pictures of one number a pixel, peak 1: at most 1, and exactly 1 for equal ones.
///
/// Both have `size[0] · size[1]` pixels, x fastest, and at least one. The window is a Gaussian of 11 × 11 pixels with
/// σ = 1.5, weights of sum 1 and no sample correction; the mean is over all windows that lie wholly inside. On an axis of
/// fewer than 11 pixels there is none: there the windows are centred on every pixel and cut off at the edges.
pub(super) fn ssim(a: &[f64], b: &[f64], size: [usize; 2]) -> f64 {
    let blurred = |value: fn(f64, f64) -> f64| {
        let values: Vec<f64> = a.iter().zip(b).map(|(&a, &b)| value(a, b)).collect();
        blur(&values, size)
    };
    let (mean_a, mean_b) = (blurred(|a, _| a), blurred(|_, b| b));
    let (square_a, square_b) = (blurred(|a, _| a * a), blurred(|_, b| b * b));
    let product = blurred(|a, b| a * b);
    let [c1, c2] = STABILISERS;
    let window = |i: usize| {
        let (ma, mb) = (mean_a[i], mean_b[i]);
        let (variances, covariance) =
            ((square_a[i] - ma * ma) + (square_b[i] - mb * mb), product[i] - ma * mb);
        (2.0 * ma * mb + c1) * (2.0 * covariance + c2)
            / ((ma * ma + mb * mb + c1) * (variances + c2))
    };
    (0..product.len()).map(window).sum::<f64>() / product.len() as f64
}

/// The weighted mean of each window, over x and then over y.
fn blur(values: &[f64], [width, height]: [usize; 2]) -> Vec<f64> {
    let (across, down) = (windows(width), windows(height));
    let row = |row: &[f64]| -> Vec<f64> {
        let sum = |(start, weights): &(usize, Vec<f64>)| {
            weights.iter().zip(&row[*start..]).map(|(w, v)| w * v).sum()
        };
        across.iter().map(sum).collect()
    };
    let rows: Vec<Vec<f64>> = values.par_chunks_exact(width).map(row).collect();
    let column = |(start, weights): &(usize, Vec<f64>)| {
        let mut sums = vec![0.0; across.len()];
        for (weight, row) in weights.iter().zip(&rows[*start..]) {
            sums.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
        }
        sums
    };
    debug_assert_eq!(rows.len(), height);
    down.par_iter().flat_map_iter(column).collect()
}

/// Where each window of an axis of `length` pixels begins, and its weights, of sum 1.
fn windows(length: usize) -> Vec<(usize, Vec<f64>)> {
    let half = WINDOW / 2;
    let centers = if length < WINDOW { 0..length } else { half..length - half };
    let window = |center: usize| {
        let start = center.saturating_sub(half);
        let end = (center + half + 1).min(length);
        let weight = |i: usize| libm::exp(-0.5 * ((i as f64 - center as f64) / SIGMA).powi(2));
        let weights: Vec<f64> = (start..end).map(weight).collect();
        let sum: f64 = weights.iter().sum();
        (start, weights.into_iter().map(|weight| weight / sum).collect())
    };
    centers.map(window).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_even_greys_differ_by_their_means_alone() {
        let even = |value: f64, size: [usize; 2]| vec![value; size[0] * size[1]];
        for size in [[20, 16], [1, 1], [3, 40], [11, 10]] {
            let expected = (2.0 * 0.3 * 0.7 + 1e-4) / (0.3 * 0.3 + 0.7 * 0.7 + 1e-4);
            assert!((ssim(&even(0.3, size), &even(0.7, size), size) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn one_window_is_the_formula_written_out() {
        let size = [11, 11];
        let a: Vec<f64> = (0..121).map(|i| f64::from(i * 31 % 17) / 16.0).collect();
        let b: Vec<f64> = (0..121).map(|i| f64::from(i * 13 % 23) / 22.0).collect();
        let weight = |i: usize| {
            let (x, y) = ((i % 11) as f64 - 5.0, (i / 11) as f64 - 5.0);
            (-(x * x + y * y) / (2.0 * 1.5 * 1.5)).exp()
        };
        let total: f64 = (0..121).map(weight).sum();
        let mean =
            |of: &dyn Fn(usize) -> f64| (0..121).map(|i| weight(i) * of(i)).sum::<f64>() / total;
        let (ma, mb) = (mean(&|i| a[i]), mean(&|i| b[i]));
        let va = mean(&|i| (a[i] - ma).powi(2));
        let vb = mean(&|i| (b[i] - mb).powi(2));
        let cov = mean(&|i| (a[i] - ma) * (b[i] - mb));
        let expected = (2.0 * ma * mb + 1e-4) * (2.0 * cov + 9e-4)
            / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
        assert!((ssim(&a, &b, size) - expected).abs() < 1e-12);
    }

    #[test]
    fn there_is_a_window_at_every_place_that_holds_a_whole_one() {
        let starts = |length| windows(length).iter().map(|w| w.0).collect::<Vec<_>>();
        assert_eq!(starts(13), [0, 1, 2]);
        assert_eq!(starts(4), [0; 4]);
        assert!(
            windows(13)
                .iter()
                .all(|w| w.1.len() == 11 && (w.1.iter().sum::<f64>() - 1.0).abs() < 1e-15)
        );
    }
}
