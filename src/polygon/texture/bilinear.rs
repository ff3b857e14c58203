//! The cheaper lookups: the nearest texel, the four nearest, and those of two levels (Williams 1983).

use glam::{DVec2, Vec4};

use super::footprint::{Footprint, longest};
use super::mip::MipLevel;
use crate::components::Wrap;

/// The texel that `uv` lies in.
pub(super) fn nearest(level: &MipLevel, wrap: [Wrap; 2], uv: DVec2) -> Vec4 {
    let at = (uv * size(level)).floor();
    level.texel(at.x as i64, at.y as i64, wrap).unwrap_or(Vec4::ZERO)
}

/// The bilinear interpolation of the texels whose centres are around `uv`; what has vanished counts as nothing.
pub(super) fn bilinear(level: &MipLevel, wrap: [Wrap; 2], uv: DVec2) -> Vec4 {
    let at = uv * size(level) - 0.5;
    let (first, part) = (at.floor(), (at - at.floor()).as_vec2());
    let (x, y) = (first.x as i64, first.y as i64);
    let texel = |x, y| level.texel(x, y, wrap).unwrap_or(Vec4::ZERO);
    let top = between(texel(x, y), texel(x + 1, y), part.x);
    let bottom = between(texel(x, y + 1), texel(x + 1, y + 1), part.x);
    between(top, bottom, part.y)
}

/// Bilinear in the two levels whose texels are as long as the footprint's longer axis, just below and just above.
pub(super) fn trilinear(
    levels: &[MipLevel],
    wrap: [Wrap; 2],
    uv: DVec2,
    footprint: &Footprint,
) -> Vec4 {
    let long = longest(footprint.in_texels(levels[0].size)).max(1.0);
    let number = libm::log2(long).min((levels.len() - 1) as f64);
    let (fine, part) = (number.floor() as usize, (number - number.floor()) as f32);
    let lower = bilinear(&levels[fine], wrap, uv);
    if part == 0.0 {
        return lower;
    }
    between(lower, bilinear(&levels[fine + 1], wrap, uv), part)
}

/// `a` and `b` mixed so that neither end is passed, and equal ends are kept exactly.
fn between(a: Vec4, b: Vec4, part: f32) -> Vec4 {
    (a + (b - a) * part).clamp(a.min(b), a.max(b))
}

/// Texels across and down.
fn size(level: &MipLevel) -> DVec2 {
    DVec2::new(level.size[0] as f64, level.size[1] as f64)
}
