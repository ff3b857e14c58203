//! A row of voxels classified side by side: to the last bit what [`Classifier::opacity`] gives of each alone.
//!
//! Everything here is in plain arrays, and compiled anew within each instruction set of whoever calls it.
#![allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#![allow(
    clippy::needless_bitwise_bool,
    reason = "side by side nothing is left out: a choice is a mask, and no jump"
)]
#![allow(
    clippy::needless_range_loop,
    reason = "several arrays of as many numbers, so that loops run in lanes"
)]

use super::contour::Contours;
use super::curve::Curve;
use super::numbers::{fraction, square};
use super::regions::Regions;
use super::transfer::Transfer;
use super::{Classifier, How};
use crate::components::Form;

/// Numbers of `N` voxels.
type Row<const N: usize> = [f64; N];

impl Classifier {
    /// [`opacity`](Self::opacity) of `N` voxels, whose gradients are stated axis by axis.
    #[inline(always)]
    pub(crate) fn opacities<const N: usize>(
        &self,
        values: &[f32; N],
        gradients: &[[f32; N]; 3],
    ) -> [f32; N] {
        let f = values.map(f64::from);
        let alphas = match &self.how {
            How::Contours(contours) => contours.opacities(&f, &squares(gradients)),
            How::Regions(regions) => regions.opacities(&f, &squares(gradients)),
            How::Transfer(transfer) => transfer.opacities(&f, gradients),
            How::Mixture(mixture) => f.map(|f| mixture.opacity(f)),
        };
        let mut made = [0.0; N];
        for at in 0..N {
            let inside = (f[at] >= self.range[0]) & (f[at] <= self.range[1]);
            made[at] = if inside { fraction(alphas[at]) as f32 } else { 0.0 };
        }
        made
    }
}

/// [`square`] of `N` gradients.
#[inline(always)]
fn squares<const N: usize>(gradients: &[[f32; N]; 3]) -> Row<N> {
    let mut made = [0.0; N];
    for at in 0..N {
        made[at] = square([gradients[0][at], gradients[1][at], gradients[2][at]]);
    }
    made
}

impl Contours {
    #[inline(always)]
    fn opacities<const N: usize>(&self, f: &Row<N>, gg: &Row<N>) -> Row<N> {
        let mut alphas = [0.0; N];
        for line in self.lines().iter().filter(|line| !line.is_surface()) {
            let above = line.form == Form::Above;
            for at in 0..N {
                let away = line.value - f[at];
                let (square, reach) = (away * away, line.squared_reach * gg[at]);
                let part = (square / reach).sqrt();
                let within = line.opacity * if above { part } else { 1.0 - part };
                let beyond = if above | (square == 0.0) { line.opacity } else { 0.0 };
                let own = if square < reach { within } else { beyond };
                let below = above & ((away > 0.0) | away.is_nan());
                alphas[at] += (1.0 - alphas[at]) * if below { 0.0 } else { own };
            }
        }
        alphas
    }
}

impl Transfer {
    #[inline(always)]
    fn opacities<const N: usize>(&self, f: &Row<N>, gradients: &[[f32; N]; 3]) -> Row<N> {
        let (opacity, factor) = self.curves();
        let mut alphas = opacity.values(f);
        if let Some(factor) = factor {
            let factors = factor.values(&squares(gradients).map(f64::sqrt));
            for at in 0..N {
                alphas[at] *= if alphas[at] > 0.0 { factors[at] } else { 1.0 };
            }
        }
        alphas
    }
}

impl Regions {
    #[inline(always)]
    fn opacities<const N: usize>(&self, f: &Row<N>, gg: &Row<N>) -> Row<N> {
        let (opacity, unit) = self.curve();
        let Some([first, last]) = opacity.ends() else { return [0.0; N] };
        let alphas = opacity.values(f);
        // At the last tissue's own value the neighbours are that tissue and the one before it.
        let before = last.next_down();
        let [low, high] = opacity.all_around(&f.map(|f| if f == last { before } else { f }));
        let mut made = [0.0; N];
        for at in 0..N {
            let contrast = high.0[at] - low.0[at];
            let own = alphas[at] * (gg[at].sqrt() * unit / contrast).min(1.0);
            let seen = (gg[at] != 0.0) & (f[at] >= first) & (f[at] <= last) & (contrast > 0.0);
            made[at] = if seen { own } else { 0.0 };
        }
        made
    }
}

impl Curve<f64> {
    /// [`around`](Self::around) of several places: places and values of the points below and above. Of a curve without points,
    /// zeros; of a NaN, anything.
    #[inline(always)]
    fn all_around<const N: usize>(&self, places: &Row<N>) -> [(Row<N>, Row<N>); 2] {
        let Some(&(place, value)) = self.points().first() else {
            return [([0.0; N], [0.0; N]); 2];
        };
        let mut low = ([place; N], [value; N]);
        for &(place, value) in self.points() {
            for at in 0..N {
                let passed = place <= places[at];
                low.0[at] = if passed { place } else { low.0[at] };
                low.1[at] = if passed { value } else { low.1[at] };
            }
        }
        let mut high = low;
        for &(place, value) in self.points().iter().rev() {
            for at in 0..N {
                let ahead = place > places[at];
                high.0[at] = if ahead { place } else { high.0[at] };
                high.1[at] = if ahead { value } else { high.1[at] };
            }
        }
        [low, high]
    }

    /// The [`value`](Self::value) at several places; 0 where there is none.
    #[inline(always)]
    fn values<const N: usize>(&self, places: &Row<N>) -> Row<N> {
        let [low, high] = self.all_around(places);
        let mut made = [0.0; N];
        for at in 0..N {
            let span = high.0[at] - low.0[at];
            let toward = if span > 0.0 { (places[at] - low.0[at]) / span } else { 0.0 };
            let value = low.1[at] * (1.0 - toward) + high.1[at] * toward;
            made[at] = if places[at].is_nan() { 0.0 } else { value };
        }
        made
    }
}
