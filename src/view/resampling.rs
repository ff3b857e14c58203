//! Interpolation and resampling: the array of sample colours becomes the picture (paper §6).
//!
//! A colour between positions is the bilinear interpolation of the corners of the smallest region it lies in. A box
//! one pixel wide over that is integrated exactly, quadrant by quadrant; other pixel filters sum over positions.

use std::borrow::Cow;

use glam::{DVec4, Vec4};
use rayon::prelude::*;

use super::picture::{Picture, within_opacity};
use super::samples::{POSITIONS, SampleArray};
use super::voxel_resampling;
use crate::components::{Color, PixelFilter};

/// The picture of a sample array: a pixel is what `filter` makes of the positions around it, over `background` if there is
/// one; linear associated RGBA.
#[must_use]
pub fn resample(array: &SampleArray, filter: PixelFilter, background: Option<Color>) -> Picture {
    let size = array.layout.size;
    let pixels = match &array.voxel_rays {
        Some(rays) => voxel_resampling::pixels(rays, size, filter),
        None => of_positions(array, filter),
    };
    let picture = Picture { size, pixels: crate::shared::Shared::new(pixels) };
    background.map_or(picture.clone(), |color| picture.over(color.0))
}

/// The pixels of rays at positions.
fn of_positions(array: &SampleArray, filter: PixelFilter) -> Vec<[f32; 4]> {
    let size = array.layout.size;
    let mut pixels = vec![[0.0; 4]; size[0] * size[1]];
    let lattice = Lattice::of(array);
    let kernel = (filter != PixelFilter::Box).then(|| kernel(filter));
    pixels.par_chunks_mut(size[0] * ROWS).enumerate().for_each(|(chunk, rows)| match &kernel {
        None => boxed_rows(array, &lattice, chunk * ROWS, rows),
        Some(kernel) => {
            for (at, pixel) in rows.iter_mut().enumerate() {
                let (x, y) = (at % size[0], chunk * ROWS + at / size[0]);
                *pixel = convolved(array, &lattice, kernel, x, y);
            }
        }
    });
    pixels
}

/// Rows of pixels that are resampled together.
const ROWS: usize = 16;

/// C at every fourth position: cast, or interpolated where no ray was.
struct Lattice<'a> {
    across: usize,
    colors: Cow<'a, [[f32; 4]]>,
}

impl<'a> Lattice<'a> {
    fn of(array: &'a SampleArray) -> Self {
        let colors = Cow::Borrowed(&array.colors.lattice[..]);
        let mut lattice = Self { across: array.layout.blocks()[0], colors };
        let mut step = array.layout.coarsest / POSITIONS / 2;
        while step > 0 {
            lattice.fill(array, step);
            step /= 2;
        }
        lattice
    }

    /// Interpolates where no ray was cast, half-way on the edges and in the middles of regions of twice `step`.
    fn fill(&mut self, array: &SampleArray, step: usize) {
        let down = self.colors.len() / self.across;
        for y in (0..down).step_by(step) {
            let odd_row = y / step % 2 == 1;
            let first = if odd_row { 0 } else { step };
            for x in (first..self.across).step_by(if odd_row { step } else { 2 * step }) {
                if array.cast[y * self.across + x] & 1 == 0 {
                    let color = match (x / step % 2 == 1, odd_row) {
                        (true, false) => (self.color(x - step, y) + self.color(x + step, y)) * 0.5,
                        (false, _) => (self.color(x, y - step) + self.color(x, y + step)) * 0.5,
                        (true, true) => {
                            let row = |y: usize| self.color(x - step, y) + self.color(x + step, y);
                            (row(y - step) * 0.5 + row(y + step) * 0.5) * 0.5
                        }
                    };
                    self.colors.to_mut()[y * self.across + x] = color.to_array();
                }
            }
        }
    }

    /// The colour of position (4 x, 4 y).
    fn color(&self, x: usize, y: usize) -> Vec4 {
        Vec4::from_array(self.colors[y * self.across + x])
    }
}

fn cast_color(array: &SampleArray, i: usize, j: usize) -> Vec4 {
    Vec4::from_array(array.color(i, j))
}

/// The colour of a position of the lattice of `step` positions: cast there, or interpolated from the next coarser
/// lattice (half-way on an edge of its regions, or in the middle of one).
fn between(array: &SampleArray, i: usize, j: usize, step: usize) -> Vec4 {
    if array.is_cast(i, j) || step >= array.layout.coarsest {
        return cast_color(array, i, j);
    }
    let coarse = 2 * step;
    let ends = |p: usize| if p.is_multiple_of(coarse) { [p, p] } else { [p - step, p + step] };
    let (across, down) = (ends(i), ends(j));
    let at = |x: usize, y: usize| between(array, x, y, coarse);
    match (across[0] == across[1], down[0] == down[1]) {
        (true, true) => at(i, j),
        (false, true) => (at(across[0], j) + at(across[1], j)) * 0.5,
        (true, false) => (at(i, down[0]) + at(i, down[1])) * 0.5,
        (false, false) => {
            let rows = down.map(|y| (at(across[0], y) + at(across[1], y)) * 0.5);
            (rows[0] + rows[1]) * 0.5
        }
    }
}

/// The means over the pixels of some rows, from row `y` on.
fn boxed_rows(array: &SampleArray, lattice: &Lattice<'_>, y: usize, rows: &mut [[f32; 4]]) {
    let (width, first) = (array.layout.size[0], array.layout.margin / POSITIONS);
    let height = rows.len() / width;
    if array.layout.coarsest < POSITIONS {
        // Every region is split, and those beside the picture need not be whole.
        for (at, pixel) in rows.iter_mut().enumerate() {
            *pixel = boxed(array, lattice, at % width, y + at / width);
        }
        return;
    }
    // Where no region is split, the weights are (1, 6, 1) / 8 along each axis: along x first, for each row of the lattice.
    let mut lines = Vec::with_capacity((height + 2) * width);
    for row in y + first - 1..=y + first + height {
        let row = &lattice.colors[row * lattice.across + first - 1..][..width + 2];
        lines.extend(row.windows(3).map(|line| {
            let line = [line[0], line[1], line[2]].map(Vec4::from_array);
            (line[0] + line[2]) * 0.125 + line[1] * 0.75
        }));
    }
    let across = array.layout.blocks()[0];
    for (down, row) in rows.chunks_exact_mut(width).enumerate() {
        let split = |row: usize| &array.splits[row * across + first - 1..][..=width];
        let splits = [split(y + down + first - 1), split(y + down + first)];
        let line = |row: usize| &lines[(down + row) * width..][..width];
        let (above, own, below) = (line(0), line(1), line(2));
        for (x, pixel) in row.iter_mut().enumerate() {
            let split = splits.iter().any(|row| (row[x] | row[x + 1]) & 1 == 1);
            *pixel = if split {
                boxed(array, lattice, x, y + down)
            } else {
                ((above[x] + below[x]) * 0.125 + own[x] * 0.75).to_array()
            };
        }
    }
}

/// The mean over a pixel: the mean of its four quadrants, each within one region of 4 × 4 positions.
fn boxed(array: &SampleArray, lattice: &Lattice<'_>, x: usize, y: usize) -> [f32; 4] {
    let first = array.layout.margin / POSITIONS;
    let (x, y) = (x + first, y + first);
    let row = array.layout.blocks()[0];
    let quadrant = |right: usize, below: usize| {
        // The region left of or right of the pixel's middle, above or below it.
        let (i, j) = (x - 1 + right, y - 1 + below);
        let split = array.splits[j * row + i];
        if split & 1 == 0 {
            let at = |dx: usize, dy: usize| lattice.color(i + dx, j + dy);
            // The pixel's middle is the corner away from (right, below).
            let (cx, cy) = (1 - right, 1 - below);
            return at(cx, cy) * 0.5625
                + (at(1 - cx, cy) + at(cx, 1 - cy)) * 0.1875
                + at(1 - cx, 1 - cy) * 0.0625;
        }
        let (child_x, child_y) = (1 - right, 1 - below);
        let child = [i * POSITIONS + 2 * child_x, j * POSITIONS + 2 * child_y];
        let fine = split >> (1 + 2 * child_y + child_x) & 1 == 1;
        child_mean(array, child, fine)
    };
    let sum = quadrant(0, 0) + quadrant(1, 0) + (quadrant(0, 1) + quadrant(1, 1));
    (sum * 0.25).to_array()
}

/// The mean over a region of 2 × 2 positions, whose inner positions were cast too if it is `fine`.
fn child_mean(array: &SampleArray, [i, j]: [usize; 2], fine: bool) -> Vec4 {
    let at = |dx: usize, dy: usize| cast_color(array, i + dx, j + dy);
    let corners = at(0, 0) + at(2, 0) + (at(0, 2) + at(2, 2));
    if !fine {
        return corners * 0.25;
    }
    let edges = at(1, 0) + at(0, 1) + (at(2, 1) + at(1, 2));
    corners * 0.0625 + edges * 0.125 + at(1, 1) * 0.25
}

/// The colour of any position.
fn anywhere(array: &SampleArray, lattice: &Lattice<'_>, i: usize, j: usize) -> Vec4 {
    if array.is_cast(i, j) {
        return cast_color(array, i, j);
    }
    let (x, y) = (i / POSITIONS, j / POSITIONS);
    let (right, below) = ((i % POSITIONS) as f32 / 4.0, (j % POSITIONS) as f32 / 4.0);
    let split = array.splits[y * array.layout.blocks()[0] + x];
    if split & 1 == 1 {
        return between(array, i, j, 1);
    }
    let next = |n: usize, part: f32| if part > 0.0 { n + 1 } else { n };
    let row = |y: usize| lattice.color(x, y).lerp(lattice.color(next(x, right), y), right);
    row(y).lerp(row(next(y, below)), below)
}

/// Weights of the positions `-reach ..= reach` around a pixel's middle along one axis; they sum to 1.
fn kernel(filter: PixelFilter) -> Vec<f64> {
    let reach = filter.reach() as i32;
    let weights: Vec<f64> =
        (-reach..=reach).map(|p| f64::from(filter.weight(p as f32 / POSITIONS as f32))).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|w| w / sum).collect()
}

/// The sum over positions, in 64 bits: what is constant stays so to the last bit.
fn convolved(
    array: &SampleArray,
    lattice: &Lattice<'_>,
    kernel: &[f64],
    x: usize,
    y: usize,
) -> [f32; 4] {
    let reach = kernel.len() / 2;
    let first = |pixel: usize| pixel * POSITIONS + array.layout.margin - reach;
    let (mut sum, mut excess) = (DVec4::ZERO, 0.0_f32);
    for (dy, wy) in kernel.iter().enumerate() {
        for (dx, wx) in kernel.iter().enumerate().filter(|(_, w)| **w != 0.0) {
            let color = anywhere(array, lattice, first(x) + dx, first(y) + dy);
            excess = excess.max(color.max_element() - color.w);
            sum += color.as_dvec4() * (wx * wy);
        }
    }
    within_opacity(sum.as_vec4(), excess).to_array()
}
