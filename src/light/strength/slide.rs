//! A slide in front of a light: the initial light strengths β_0 are the luminance of a texture (paper §4 and §7, figure 9).
//!
//! The texture stands in the plane perpendicular to the light, upright as seen from the light. A look-up is the average
//! over a box as wide as what it stands for (columns of a sweep, pixels), and at least a texel: over texels of constant
//! value a box of one texel *is* bilinear interpolation, and a wider one keeps fine textures from aliasing.

use glam::DVec3;

use super::Shear;
use crate::components::{Projects, Wrap};
use crate::shared::Shared;
use crate::view::picture::Picture;

/// `projects`, resolved: the picture itself and where it lies.
#[derive(Debug, Clone, PartialEq)]
pub struct ProjectedBy {
    /// As stated.
    pub projects: Projects,
    /// The slide's texels.
    pub picture: Picture,
    /// The world point that the middle of the texture falls on.
    pub center: DVec3,
    /// The direction that the texture's top points to, of any length above 0; may lie along the light.
    pub up: DVec3,
}

/// The brightest luminance that a slide has: that of the largest 16-bit float.
const BRIGHTEST: f32 = 65504.0;
/// The least width of a box in texels of the level that it averages.
const FINE: f64 = 4.0;
/// Texels across a box whose shares are found once for all its rows; few boxes have more.
const KEPT: usize = 16;

/// β_0 of a light at any world point. Equality is identity of the pictures made of the texture.
#[derive(Debug, Clone, PartialEq)]
pub struct Slide {
    center: DVec3,
    /// Unit vectors of the texture's plane, seen from the light.
    right: DVec3,
    up: DVec3,
    /// World units across and down.
    size: [f64; 2],
    wrap: Wrap,
    /// The texture's luminance, and each time half as many texels across and down.
    levels: Vec<SlideLevel>,
}

#[derive(Debug, Clone, PartialEq)]
struct SlideLevel {
    size: [usize; 2],
    light: Shared<f32>,
}

impl Slide {
    /// The slide of a light towards `toward` (unit vector).
    ///
    /// A size of 0 or less, or an empty picture, is an error: a sentence without a subject.
    pub fn new(stated: &ProjectedBy, toward: DVec3) -> Result<Self, String> {
        let ProjectedBy { projects, picture, center, up } = stated;
        let size = projects.size_mm;
        if !size.iter().all(|s| s.is_normal() && *s > 0.0) {
            return Err(format!("`projects` states a size_mm of {size:?}; both must be above 0"));
        }
        if picture.pixels.is_empty() {
            return Err("`projects` names a texture without a pixel; it needs at least one".into());
        }
        let (center, up) = (*center, upright(toward, *up));
        if !(center.is_finite() && up.is_finite() && toward.is_finite()) {
            return Err("`projects` states a `center` or `up` that is not finite".to_owned());
        }
        let light = Shared::new(picture.pixels.iter().map(luminance).collect());
        let mut levels = vec![SlideLevel { size: picture.size, light }];
        while let Some(coarser) = levels.last().and_then(SlideLevel::halved) {
            levels.push(coarser);
        }
        Ok(Self { center, right: up.cross(toward), up, size, wrap: projects.wrap, levels })
    }

    /// β_0 on the ray of light through `world`: the average over `footprint` (world units along the texture's width and
    /// height, 0 for a point). In 0..=`Slide::brightest`.
    #[must_use]
    pub fn at(&self, world: DVec3, footprint: [f64; 2]) -> f32 {
        let from = world - self.center;
        let place =
            [self.right.dot(from) / self.size[0] + 0.5, 0.5 - self.up.dot(from) / self.size[1]];
        let share = [footprint[0] / self.size[0], footprint[1] / self.size[1]];
        if !place.iter().chain(&share).all(|p| p.is_finite()) {
            return 0.0;
        }
        let texels = (0..2).map(|a| share[a].abs() * self.levels[0].size[a] as f64);
        let texels = texels.fold(f64::INFINITY, f64::min);
        let coarse = |level: &&SlideLevel| {
            let reduced = self.levels[0].size[0] as f64 / level.size[0] as f64;
            texels / reduced >= FINE
        };
        let level = self.levels.iter().rev().find(coarse).unwrap_or(&self.levels[0]);
        let size = level.size.map(|n| n as f64);
        let width = std::array::from_fn(|a| (share[a].abs() * size[a]).max(1.0));
        let low = std::array::from_fn(|a| place[a] * size[a] - width[a] / 2.0);
        level.average(low, width, self.wrap) as f32
    }

    /// The footprint of one column of a sweep.
    #[must_use]
    pub fn cell(&self, shear: &Shear) -> [f64; 2] {
        let [across, down] = shear.spacings();
        [self.right, self.up].map(|axis| axis.dot(across).hypot(axis.dot(down)))
    }

    /// The brightest texel: no strength is above it.
    #[must_use]
    pub(crate) fn brightest(&self) -> f32 {
        self.levels[0].light.iter().copied().fold(0.0, f32::max)
    }

    /// Bytes that the luminance takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.levels.iter().map(|level| level.light.bytes()).sum()
    }
}

/// The unit vector nearest to `up` in the plane perpendicular to `toward`; +y then x where `up` points to the light.
fn upright(toward: DVec3, up: DVec3) -> DVec3 {
    let behind = DVec3::Y * if toward.z < 0.0 { -1.0 } else { 1.0 };
    let flat = |v: DVec3| {
        let v = v.normalize_or_zero();
        v - toward * toward.dot(v)
    };
    let candidates = [up, DVec3::Z, behind].map(flat);
    candidates.into_iter().find(|v| v.length() > 1e-6).unwrap_or(DVec3::X).normalize()
}

/// Rec. 709 luminance of linear colour, times alpha: texels are associated. Never NaN.
fn luminance(&[r, g, b, _]: &[f32; 4]) -> f32 {
    let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    if luminance > 0.0 { luminance.min(BRIGHTEST) } else { 0.0 }
}

impl SlideLevel {
    /// Half as many texels each way, rounded up; `None` for a single texel.
    fn halved(&self) -> Option<Self> {
        if self.size == [1, 1] {
            return None;
        }
        let size = self.size.map(|n| n.div_ceil(2));
        let width = [0, 1].map(|a| self.size[a] as f64 / size[a] as f64);
        let texel = |at: usize| {
            let low = [(at % size[0]) as f64 * width[0], (at / size[0]) as f64 * width[1]];
            self.average(low, width, Wrap::Clamp) as f32
        };
        let light = Shared::new((0..size[0] * size[1]).map(texel).collect());
        Some(Self { size, light })
    }

    /// The exact average over a box, in texels, of the texture taken as texels of constant value.
    ///
    /// A box over more than the whole of a repeated texture sees its mean.
    fn average(&self, low: [f64; 2], width: [f64; 2], wrap: Wrap) -> f64 {
        let [columns, rows] = [0, 1].map(|a| Overlap::new(low[a], width[a], self.size[a], wrap));
        let (mut kept, mut count) = ([(0, 0.0); KEPT], 0);
        for texel in columns.texels() {
            if let Some(kept) = kept.get_mut(count) {
                *kept = texel;
            }
            count += 1;
        }
        let mut sum = 0.0;
        for (y, down) in rows.texels() {
            let row = &self.light[y * self.size[0]..][..self.size[0]];
            let part = |(x, across): (usize, f64)| across * f64::from(row[x]);
            sum += down
                * match kept.get(..count) {
                    Some(kept) => kept.iter().copied().map(part).sum::<f64>(),
                    None => columns.texels().map(part).sum(),
                };
        }
        sum
    }
}

/// The texels under an interval, and their shares of it.
#[derive(Clone, Copy)]
struct Overlap {
    low: f64,
    width: f64,
    count: usize,
    wrap: Wrap,
}

impl Overlap {
    fn new(low: f64, width: f64, count: usize, wrap: Wrap) -> Self {
        let all = count as f64;
        if let Some(period) = wrap.period() {
            let period = period * all;
            return Self { low: low.rem_euclid(period), width: width.min(period), count, wrap };
        }
        // Farther out there is nothing new, and differences of large numbers would lose the width.
        Self { low: low.clamp(-width - 1.0, all + 1.0), width, count, wrap }
    }

    /// Texels and shares; the shares sum to 1, or to less where the texture vanishes.
    fn texels(self) -> impl Iterator<Item = (usize, f64)> {
        let Self { low, width, count, wrap } = self;
        let (high, all) = (low + width, count as f64);
        // Clamping makes the outermost texels endless; vanishing cuts the interval; repeating wraps it round, mirrored or not.
        let (first, end) = match wrap {
            Wrap::Repeat | Wrap::Mirror => (low.floor(), high.ceil()),
            Wrap::Clamp => (low.floor().clamp(0.0, all - 1.0), high.ceil().clamp(1.0, all)),
            Wrap::Vanish => (low.floor().clamp(0.0, all), high.ceil().clamp(0.0, all)),
        };
        (first as usize..end as usize).filter_map(move |texel| {
            let (mut from, mut to) = (texel as f64, texel as f64 + 1.0);
            if wrap == Wrap::Clamp {
                from = if texel == 0 { f64::NEG_INFINITY } else { from };
                to = if texel + 1 == count { f64::INFINITY } else { to };
            }
            let share = (high.min(to) - low.max(from)).max(0.0) / width;
            Some((wrap.texel(texel as i64, count)?, share))
        })
    }
}

#[cfg(test)]
mod tests;
