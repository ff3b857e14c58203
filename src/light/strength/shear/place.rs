//! Strengths read between columns and slices: the one place where they are resampled.

use super::{Shear, Window};

/// A place between kept columns and between slices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    lower: Near,
    /// How far towards the next slice, in 0..=1, and the place there.
    upper: Option<(f64, Near)>,
}

/// A place in a slice: the kept column before it, across and down, and the part of the way to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Near {
    slice: usize,
    low: [i64; 2],
    part: [f64; 2],
    phase: [f64; 2],
}

impl Place {
    /// The place so many whole columns farther across and down, exactly.
    #[must_use]
    #[inline]
    pub fn moved(&self, [x, y]: [usize; 2]) -> Self {
        let moved = |near: Near| {
            let low = [near.low[0].saturating_add(x as i64), near.low[1].saturating_add(y as i64)];
            Near { low, ..near }
        };
        let upper = self.upper.map(|(part, near)| (part, moved(near)));
        Self { lower: moved(self.lower), upper }
    }
}

impl Shear {
    /// Where strengths are read at a column and a place along it; `None` before slice 0, where light has met nothing.
    #[must_use]
    pub fn place(&self, column: [f64; 2], along: f64) -> Option<Place> {
        if along.is_nan() || along < 0.0 {
            return None;
        }
        let last = self.size[2] - 1;
        let slice = (along as usize).min(last);
        let part = along - slice as f64;
        let upper = (part > 0.0 && slice < last).then(|| (part, self.near(column, slice + 1)));
        Some(Place { lower: self.near(column, slice), upper })
    }

    fn near(&self, column: [f64; 2], slice: usize) -> Near {
        let Window { low, phase } = self.window(slice);
        let at = [column[0] - low[0] as f64, column[1] - low[1] as f64];
        let low = at.map(f64::floor);
        let part = [at[0] - low[0], at[1] - low[1]];
        Near { slice, low: low.map(|l| l as i64), part, phase }
    }

    /// Reads stored strengths at a place: bilinear between columns, linear between slices.
    ///
    /// `plane` gives what is stored of a slice at its kept columns, x fastest; `before` what light has that the volume has
    /// not met: all of it before slice 0 and before a column enters through a side.
    #[inline]
    pub fn interpolate<'a, T: Copy + Into<f64> + 'a>(
        &self,
        place: Option<&Place>,
        plane: impl Fn(usize) -> &'a [T],
        before: impl Fn() -> f64,
    ) -> f64 {
        let Some(Place { lower, upper }) = place else {
            return before();
        };
        let value = self.across(lower, plane(lower.slice), &before);
        match upper {
            Some((part, upper)) => {
                value + part * (self.across(upper, plane(upper.slice), &before) - value)
            }
            None => value,
        }
    }

    /// [`interpolate`](Self::interpolate) at so many places, each a whole column farther across than the one before; `None` where
    /// one of them is not amid the kept columns.
    #[inline]
    #[must_use]
    pub fn interpolate_row<'a, T: Copy + Into<f64> + 'a, const N: usize>(
        &self,
        place: &Place,
        plane: impl Fn(usize) -> &'a [T],
    ) -> Option<[f64; N]> {
        let Place { lower, upper } = place;
        let mut values = self.row_across(lower, plane(lower.slice))?;
        if let Some((part, upper)) = upper {
            let behind: [f64; N] = self.row_across(upper, plane(upper.slice))?;
            for n in 0..N {
                values[n] += part * (behind[n] - values[n]);
            }
        }
        Some(values)
    }

    #[inline]
    fn row_across<T: Copy + Into<f64>, const N: usize>(
        &self,
        near: &Near,
        plane: &[T],
    ) -> Option<[f64; N]> {
        let ([width, height], [x, y]) = (self.width(), near.low);
        let [u, v] = near.part;
        let inner = |first: i64, count: usize, width: usize| {
            first > 0 && first.saturating_add(count as i64) < width as i64 - 1
        };
        if !(inner(x, N, width) && inner(y, 1, height)) {
            return None;
        }
        let first = y as usize * width + x as usize;
        let (low, high) = (plane.get(first..=first + N)?, plane.get(first + width..)?);
        let (low, high) = (low, high.get(..=N)?);
        let mut values = [0.0; N];
        for n in 0..N {
            let row = |plane: &[T]| -> f64 {
                let (low, high): (f64, f64) = (plane[n].into(), plane[n + 1].into());
                low + u * (high - low)
            };
            let (low, high) = (row(low), row(high));
            values[n] = low + v * (high - low);
        }
        Some(values)
    }

    #[inline]
    fn across<T: Copy + Into<f64>>(
        &self,
        near: &Near,
        plane: &[T],
        before: &impl Fn() -> f64,
    ) -> f64 {
        match self.row_across(near, plane) {
            Some([value]) => value,
            None => self.at_border(near, plane, before),
        }
    }

    fn at_border<T: Copy + Into<f64>>(
        &self,
        near: &Near,
        plane: &[T],
        before: &impl Fn() -> f64,
    ) -> f64 {
        let ([width, height], [x, y]) = (self.width(), near.low);
        let [u, v] = [0, 1].map(|a| self.hold(a, near.phase[a], near.low[a], near.part[a]));
        let value = |x: i64, y: i64| match (self.kept(0, x, width), self.kept(1, y, height)) {
            (Some(x), Some(y)) => plane[y * width + x].into(),
            _ => before(),
        };
        let row = |y: i64| {
            let low = value(x, y);
            if u > 0.0 { low + u * (value(x.saturating_add(1), y) - low) } else { low }
        };
        let low = row(y);
        if v > 0.0 { low + v * (row(y.saturating_add(1)) - low) } else { low }
    }

    /// The part of the way from kept column `low` to the next, where the border that light enters through lies between
    /// them: what the outer of the two holds is so up to the border.
    #[inline]
    fn hold(&self, axis: usize, phase: f64, low: i64, part: f64) -> f64 {
        if phase == 0.0 {
            part
        } else if self.slope[axis] > 0.0 && low == 0 {
            ((part - phase) / (1.0 - phase)).max(0.0)
        } else if self.slope[axis] < 0.0 && low == self.size[axis] as i64 - 1 {
            (part / phase).min(1.0)
        } else {
            part
        }
    }

    /// The kept column for `at`: the outermost past the side where columns leave, none where they have not entered.
    #[inline]
    fn kept(&self, axis: usize, at: i64, width: usize) -> Option<usize> {
        let inside = at.clamp(0, width as i64 - 1);
        let early = if at < inside { self.slope[axis] > 0.0 } else { self.slope[axis] < 0.0 };
        (at == inside || !early).then_some(inside as usize)
    }
}
