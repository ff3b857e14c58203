//! Classification: the opacity and colour of a voxel from its scalar and gradient (algorithm §2).

mod contour;
mod curve;
mod integral;
mod mixture;
mod numbers;
mod regions;
mod row;
mod transfer;

use glam::{DVec3, Vec3};

use crate::components::{Classify, Material};
use crate::volume::ranges::Range;
use contour::Contours;
pub use contour::SharpContour;
use curve::Risen;
pub use integral::Piece;
use mixture::Mixture;
use numbers::fraction;
use regions::Regions;
use transfer::Transfer;

/// A stated classification, made ready to be asked voxel by voxel.
///
/// Whatever is asked (NaN, infinite, constant), opacities are in 0..=1 and colours are finite. Stated numbers outside
/// their range are taken as the nearest within it.
#[derive(Debug, Clone, PartialEq)]
pub struct Classifier {
    how: How,
    range: [f64; 2],
    /// c_p where the classification states no colour of its own.
    color: Vec3,
    /// Whether it states any.
    colored: bool,
}

#[derive(Debug, Clone, PartialEq)]
enum How {
    Contours(Contours),
    Regions(Regions),
    Transfer(Transfer),
    Mixture(Mixture),
}

impl Classifier {
    /// The classification of a volume of opacity unit `unit` (world units); `material` gives the default colour.
    ///
    /// Of several ways stated at once the first in the order of [`Classify`] counts; of none, all is clear.
    #[must_use]
    pub fn new(stated: &Classify, material: &Material, unit: f64) -> Self {
        let Classify { iso, regions, transfer, gradient, materials, .. } = stated;
        let color = material.color.0.as_dvec3();
        let (how, range, colored) = if !iso.is_empty() {
            let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
            let colored = iso.iter().any(|contour| contour.color.is_some());
            (How::Contours(Contours::new(iso, color, unit)), everywhere, colored)
        } else if !regions.is_empty() {
            let made = Regions::new(regions, color, unit);
            let (range, colored) = (made.range(), regions.iter().any(|t| t.color.is_some()));
            (How::Regions(made), range, colored)
        } else if !transfer.is_empty() {
            let made = Transfer::new(transfer, gradient, color);
            let (range, colored) = (made.range(), transfer.iter().any(|p| p.color.is_some()));
            (How::Transfer(made), range, colored)
        } else {
            let made = Mixture::new(materials, color);
            let (range, colored) = (made.range(), materials.iter().any(|m| m.color.is_some()));
            (How::Mixture(made), range, colored)
        };
        Self { how, range, color: material.color.0, colored }
    }

    /// α in 0..=1 per opacity unit of a voxel of scalar `value` and world `gradient`; 0 for a NaN.
    #[must_use]
    #[inline]
    pub fn opacity(&self, value: f32, gradient: [f32; 3]) -> f32 {
        let f = f64::from(value);
        if !self.is_in_range(value) {
            return 0.0;
        }
        let alpha = match &self.how {
            How::Contours(contours) => contours.opacity(f, gradient),
            How::Regions(regions) => regions.opacity(f, gradient),
            How::Transfer(transfer) => transfer.opacity(f, gradient),
            How::Mixture(mixture) => mixture.opacity(f),
        };
        fraction(alpha) as f32
    }

    /// Whether a voxel may be seen (have an opacity above 0) whose scalar lies in `range` and whose gradient is no longer
    /// than `steepest`, world units. Where this is denied, [`Classifier::opacity`] is 0.
    #[must_use]
    pub fn may_show(&self, range: Range, steepest: f64) -> bool {
        self.show(&[range.low], &[range.high], &[steepest]) == [1]
    }

    /// Whether every voxel surely has an opacity of 1 whose scalar lies in `range` and whose gradient is no longer than
    /// `steepest`, world units: of contours of what is above, and of transfer functions without a factor of the gradient.
    #[must_use]
    pub(crate) fn is_opaque(&self, range: Range, steepest: f64) -> bool {
        let [low, high] = [range.low, range.high].map(f64::from);
        low <= high
            && match &self.how {
                How::Contours(contours) => contours.are_opaque(low, steepest),
                How::Transfer(transfer) => transfer.is_opaque([low, high]),
                How::Regions(_) | How::Mixture(_) => false,
            }
    }

    /// Whether [`is_opaque`](Self::is_opaque) says so of any range.
    #[must_use]
    pub(crate) fn may_be_opaque(&self) -> bool {
        match &self.how {
            How::Contours(contours) => contours.may_be_opaque(),
            How::Transfer(transfer) => transfer.may_be_opaque(),
            How::Regions(_) | How::Mixture(_) => false,
        }
    }

    /// [`may_show`](Self::may_show) of several ranges at once, from `low` to `high` each: 1 for those, else 0.
    #[must_use]
    #[inline]
    pub(crate) fn show<const N: usize>(
        &self,
        low: &[f32; N],
        high: &[f32; N],
        steepest: &[f64; N],
    ) -> [u64; N] {
        let low = low.map(|low| f64::from(low).max(self.range[0]));
        let high = high.map(|high| f64::from(high).min(self.range[1]));
        let mut shown = [0; N];
        match &self.how {
            How::Contours(contours) => contours.show([&low, &high, steepest], &mut shown),
            How::Regions(regions) => regions.risen().show(&low, &high, &mut shown),
            How::Transfer(transfer) => transfer.risen().show(&low, &high, &mut shown),
            How::Mixture(mixture) => {
                mixture.risen().for_each(|risen| risen.show(&low, &high, &mut shown));
            }
        }
        let least = self.least_gradient();
        for n in 0..N {
            shown[n] &= u64::from(low[n] <= high[n]) & u64::from(steepest[n] >= least);
        }
        shown
    }

    /// No gradient shorter than this shows anything.
    fn least_gradient(&self) -> f64 {
        match &self.how {
            How::Contours(_) | How::Mixture(_) => 0.0,
            How::Regions(_) => 0.0_f64.next_up(),
            How::Transfer(transfer) => transfer.factor_from(),
        }
    }

    /// The contours that have no thickness: no opacity is of them, they are met where values cross theirs.
    #[must_use]
    pub fn surfaces(&self) -> Vec<SharpContour> {
        match &self.how {
            How::Contours(contours) => contours.surfaces(),
            _ => Vec::new(),
        }
    }

    /// Whether anything but [surfaces](Self::surfaces) may be seen.
    #[must_use]
    pub(crate) fn has_gel(&self) -> bool {
        match &self.how {
            How::Contours(contours) => contours.has_gel(),
            _ => true,
        }
    }

    /// Whether slabs may be integrated [`along`](Self::along): a transfer function, of a scalar alone.
    #[must_use]
    pub fn integrates(&self) -> bool {
        matches!(self.how, How::Transfer(_))
    }

    /// What a ray sees as the scalar goes evenly from one finite value to another, piece by piece in that order; a factor of the
    /// gradient is that of `gradient` all along. Of what does not [integrate](Self::integrates), nothing.
    pub fn along(&self, [from, to]: [f32; 2], gradient: [f32; 3], mut see: impl FnMut(Piece)) {
        let How::Transfer(transfer) = &self.how else { return };
        transfer.along([f64::from(from), f64::from(to)], gradient, |piece| {
            let stated = Some(piece.color).filter(|color| self.colored && color.is_finite());
            see(Piece { color: stated.unwrap_or(self.color.as_dvec3()), ..piece });
        });
    }

    /// The scalars at which anything may be seen, from one end to another each, if that does not depend on the gradient.
    #[must_use]
    pub(crate) fn risen(&self) -> Option<Vec<[f64; 2]>> {
        match &self.how {
            How::Contours(contours) => contours.risen(),
            How::Transfer(transfer) => {
                (!transfer.is_of_gradient()).then(|| transfer.risen().intervals().to_vec())
            }
            How::Mixture(mixture) => {
                Some(mixture.risen().flat_map(Risen::intervals).copied().collect())
            }
            How::Regions(_) => None,
        }
    }

    /// Whether what a sample shows is found around it: surfaces, or what slabs [integrate](Self::integrates), if they are to.
    #[must_use]
    pub(crate) fn looks_around(&self, integrate: bool) -> bool {
        integrate && self.integrates() || !self.surfaces().is_empty()
    }

    /// Whether the opacity depends on the gradient at all.
    #[must_use]
    pub(crate) fn is_of_gradient(&self) -> bool {
        match &self.how {
            How::Contours(_) | How::Regions(_) => true,
            How::Transfer(transfer) => transfer.is_of_gradient(),
            How::Mixture(_) => false,
        }
    }

    /// c_p of every voxel, where the classification states no color of its own.
    #[must_use]
    #[inline]
    pub(crate) fn only_color(&self) -> Option<Vec3> {
        (!self.colored).then_some(self.color)
    }

    /// c_p, linear, of a voxel of scalar `value` and world `gradient`.
    ///
    /// The stated colours of contours, tissues and materials count by their part in the opacity; those of transfer points
    /// are interpolated. Where nothing is seen it is the material's.
    #[must_use]
    pub fn color(&self, value: f32, gradient: [f32; 3]) -> Vec3 {
        if !self.colored {
            return self.color;
        }
        let f = f64::from(value);
        let own = match &self.how {
            How::Contours(contours) => contours.color(f, gradient),
            How::Regions(regions) => regions.color(f),
            How::Transfer(transfer) => transfer.color(f),
            How::Mixture(mixture) => mixture.color(f),
        };
        own.map(DVec3::as_vec3).filter(|color| color.is_finite()).unwrap_or(self.color)
    }

    /// Whether a scalar lies in the [range](Self::range) outside of which the opacity is surely 0; a NaN does not.
    #[must_use]
    #[inline]
    pub(crate) fn is_in_range(&self, value: f32) -> bool {
        let f = f64::from(value);
        f >= self.range[0] && f <= self.range[1]
    }

    /// The scalars outside of which the opacity is surely 0, whatever the gradient; `low > high` if it is 0 everywhere.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        self.range
    }
}

#[cfg(test)]
mod tests;
