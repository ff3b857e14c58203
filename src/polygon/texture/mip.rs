//! A texture's coarser levels, each the exact mean over areas of the one before (Williams 1983).

use glam::{DVec4, Vec4};

use crate::components::Wrap;
use crate::view::picture::Picture;

/// One level of a texture: square texels, row 0 at the top, x fastest; at least one texel.
#[derive(Debug, Clone)]
pub(super) struct MipLevel {
    /// Texels across and down.
    pub size: [usize; 2],
    /// Linear, associated RGBA.
    pub texels: Vec<Vec4>,
}

/// The texels of a picture, then levels of half the size each, rounded up, until a single texel is left.
pub(super) fn levels(picture: &Picture) -> Vec<MipLevel> {
    let texels: Vec<_> = picture.pixels.iter().copied().map(sound).collect();
    let mut levels = vec![if texels.is_empty() {
        MipLevel { size: [1, 1], texels: vec![Vec4::ZERO] }
    } else {
        MipLevel { size: picture.size, texels }
    }];
    while let Some(last) = levels.last().filter(|level| level.size != [1, 1]) {
        let next = last.coarser();
        levels.push(next);
    }
    levels
}

/// A texel that no file can break: finite colours, an opacity within 0..=1.
fn sound(texel: [f32; 4]) -> Vec4 {
    let [r, g, b, a] = texel.map(|x| if x.is_finite() { x } else { 0.0 });
    Vec4::new(r, g, b, a.clamp(0.0, 1.0))
}

impl MipLevel {
    /// Half as many texels along each axis, rounded up; each the mean over the area that it covers.
    fn coarser(&self) -> Self {
        let size = self.size.map(|n| n.div_ceil(2));
        let [columns, rows] = [0, 1].map(|axis| shares(self.size[axis], size[axis]));
        let mean = |row: &[(usize, f64)], column: &[(usize, f64)]| {
            let texel = |y: usize, x: usize| self.texels[y * self.size[0] + x].as_dvec4();
            let across = |y: usize| column.iter().map(move |&(x, share)| texel(y, x) * share);
            row.iter().map(|&(y, share)| across(y).sum::<DVec4>() * share).sum::<DVec4>().as_vec4()
        };
        let texels = rows.iter().flat_map(|r| columns.iter().map(move |c| (r, c)));
        Self { size, texels: texels.map(|(r, c)| mean(r, c)).collect() }
    }

    /// The texel at a column and row of the endless plane; `None` where the texture has vanished.
    pub fn texel(&self, x: i64, y: i64, wrap: [Wrap; 2]) -> Option<Vec4> {
        let (x, y) = (wrap[0].texel(x, self.size[0])?, wrap[1].texel(y, self.size[1])?);
        Some(self.texels[y * self.size[0] + x])
    }
}

/// For each of `coarse` equal parts of an axis: which of its `fine` parts it covers, and the share of each in it.
fn shares(fine: usize, coarse: usize) -> Vec<Vec<(usize, f64)>> {
    // In units of 1 / (fine · coarse) of the axis all borders are whole numbers, so that the shares add up to 1.
    let cover = |part: usize| {
        let (low, high) = (part * fine, (part + 1) * fine);
        (low / coarse..high.div_ceil(coarse))
            .map(|i| {
                let overlap = high.min((i + 1) * coarse) - low.max(i * coarse);
                (i, overlap as f64 / fine as f64)
            })
            .collect()
    };
    (0..coarse).map(cover).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: [usize; 2]) -> Picture {
        let value = |i: usize| ((i * 7919 + 13) % 101) as f32 / 100.0;
        let pixels = (0..size[0] * size[1]).map(|i| [0, 1, 2, 3].map(|c| value(4 * i + c)));
        Picture::new(size, pixels.collect()).unwrap()
    }

    fn mean(level: &MipLevel) -> DVec4 {
        level.texels.iter().map(|t| t.as_dvec4()).sum::<DVec4>() / level.texels.len() as f64
    }

    #[test]
    fn every_level_has_the_mean_of_the_texture_whatever_its_size() {
        for size in [[1, 1], [1, 9], [37, 1], [3, 5], [64, 64], [100, 31], [255, 257]] {
            let levels = levels(&picture(size));
            assert_eq!(levels.last().unwrap().size, [1, 1]);
            for level in &levels {
                let error = (mean(level) - mean(&levels[0])).abs().max_element();
                assert!(error < 1e-6, "{size:?}: {:?} is off by {error}", level.size);
            }
        }
    }

    #[test]
    fn a_texel_of_an_odd_axis_is_shared_by_the_areas_that_it_lies_in() {
        assert_eq!(
            shares(3, 2),
            [[(0, 2.0 / 3.0), (1, 1.0 / 3.0)], [(1, 1.0 / 3.0), (2, 2.0 / 3.0)]]
        );
        assert_eq!(shares(4, 2), [[(0, 0.5), (1, 0.5)], [(2, 0.5), (3, 0.5)]]);
        assert_eq!(shares(1, 1), [[(0, 1.0)]]);
    }

    #[test]
    fn texels_that_are_no_numbers_and_pictures_of_no_pixels_are_made_sound() {
        let pixels = vec![[f32::NAN, f32::INFINITY, 0.5, 7.0]];
        let levels_of = |size, pixels| levels(&Picture::new(size, pixels).unwrap());
        assert_eq!(levels_of([1, 1], pixels)[0].texels, [Vec4::new(0.0, 0.0, 0.5, 1.0)]);
        assert_eq!(levels_of([0, 5], vec![])[0].texels, [Vec4::ZERO]);
    }
}
