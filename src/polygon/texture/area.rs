//! The mean of square texels over a parallelogram, each weighed by the area they share (Feibush, Levoy and Cook 1980).
//!
//! Within a row of texels the polygon's area left of a line x = X is the sum over its edges of ∫ min(X, x(y)) dy,
//! positive up one side and negative down the other; a texel's share is the difference between its two borders. So no
//! polygon is ever clipped to a texel, and the shares of a row add up to its area.

use std::ops::Range;

use glam::{DMat2, DVec2, DVec4, Vec4};

use super::footprint::{Footprint, MOST_TEXELS, widened};
use super::mip::MipLevel;
use crate::components::Wrap;

/// The mean over the footprint, at least a texel wide, in the finest level where it covers not too many texels.
pub(super) fn average(
    levels: &[MipLevel],
    wrap: [Wrap; 2],
    uv: DVec2,
    footprint: &Footprint,
) -> Vec4 {
    let fits = |level: &&MipLevel| {
        let sides = footprint.in_texels(level.size);
        let reach = sides.x_axis.abs() + sides.y_axis.abs();
        let met = sides.determinant().abs() + reach.x + reach.y;
        let ends = wrap.iter().all(|wrap| wrap.period().is_none());
        met <= MOST_TEXELS || ends && level.texels.len() as f64 <= MOST_TEXELS
    };
    match levels.iter().find(fits) {
        Some(level) => mean(level, wrap, uv, widened(footprint.in_texels(level.size))),
        // Hundreds of repetitions in each direction are their mean.
        None => levels[levels.len() - 1].texels[0],
    }
}

/// The mean over the parallelogram with the columns of `sides`, in texels, about `uv`.
fn mean(level: &MipLevel, wrap: [Wrap; 2], uv: DVec2, sides: DMat2) -> Vec4 {
    let size = DVec2::new(level.size[0] as f64, level.size[1] as f64);
    let (p, q) = (sides.x_axis / 2.0, sides.y_axis / 2.0);
    let reach = p.abs() + q.abs();
    // Wholly outside, how far outside makes no difference; near the texture the areas keep their digits.
    let end = size * DVec2::from(wrap.map(|wrap| wrap.period().unwrap_or(1.0)));
    let at = (uv * size).clamp(-reach - 1.0, end + reach + 1.0);
    let corners = [at - p - q, at + p - q, at + p + q, at - p + q];
    let rows = Cells::new(at.y - reach.y..at.y + reach.y, level.size[1], wrap[1]);
    let mut sum = DVec4::ZERO;
    for row in rows.numbers.clone() {
        let pieces = Pieces::new(&corners, rows.borders(row));
        if let (Some(y), Some(span)) = (wrap[1].texel(row, level.size[1]), pieces.span()) {
            let texels = &level.texels[y * level.size[0]..][..level.size[0]];
            sum += pieces.weighed(texels, &Cells::new(span, level.size[0], wrap[0]), wrap[0]);
        }
    }
    // Edges that run the other way round make all shares negative.
    (sum / sides.determinant()).as_vec4()
}

/// The rows or columns of texels that an interval meets. The outermost ones reach on for ever where a texture clamps.
struct Cells {
    numbers: Range<i64>,
    span: Range<f64>,
    size: i64,
    clamp: bool,
}

impl Cells {
    fn new(span: Range<f64>, size: usize, wrap: Wrap) -> Self {
        let (size, first, end) = (size as i64, span.start.floor() as i64, span.end.ceil() as i64);
        let numbers = match wrap {
            Wrap::Repeat | Wrap::Mirror => first..end,
            Wrap::Vanish => first.max(0)..end.min(size),
            Wrap::Clamp => first.clamp(0, size - 1)..end.clamp(1, size),
        };
        Self { numbers, span, size, clamp: wrap == Wrap::Clamp }
    }

    /// From where to where a row or column reaches.
    fn borders(&self, number: i64) -> Range<f64> {
        let low = if self.clamp && number == 0 { self.span.start.min(0.0) } else { number as f64 };
        let past = number + 1;
        let last = self.clamp && past == self.size;
        low..if last { self.span.end.max(past as f64) } else { past as f64 }
    }
}

/// The part of an edge within a row.
#[derive(Clone, Copy, Default)]
struct Piece {
    /// The least and the greatest x.
    low: f64,
    high: f64,
    /// How far it goes in y, signed.
    dy: f64,
    /// dy / (2 (high − low)).
    bend: f64,
}

impl Piece {
    /// The signed area between the piece and the axis x = 0, where it reaches past x = `border` only up to there.
    fn left_of(&self, border: f64) -> f64 {
        if border >= self.high {
            self.dy * f64::midpoint(self.low, self.high)
        } else if border <= self.low {
            self.dy * border
        } else {
            self.dy * border - self.bend * (border - self.low) * (border - self.low)
        }
    }
}

/// The parts of a parallelogram's edges within a row.
struct Pieces {
    parts: [Piece; 4],
    count: usize,
}

impl Pieces {
    fn new(corners: &[DVec2; 4], row: Range<f64>) -> Self {
        let mut pieces = Self { parts: [Piece::default(); 4], count: 0 };
        for (i, &from) in corners.iter().enumerate() {
            let to = corners[(i + 1) % 4];
            let (y, end) = (from.y.clamp(row.start, row.end), to.y.clamp(row.start, row.end));
            if y != end {
                // Parts of 0 and of 1 keep the corners as they are, however flat the edge.
                let part = |y: f64| (y - from.y) / (to.y - from.y);
                let x = |y: f64| from.x + (to.x - from.x) * part(y);
                let (a, b) = (x(y), x(end));
                let (low, high, dy) = (a.min(b), a.max(b), end - y);
                pieces.parts[pieces.count] =
                    Piece { low, high, dy, bend: dy / (2.0 * (high - low)) };
                pieces.count += 1;
            }
        }
        pieces
    }

    fn iter(&self) -> impl Iterator<Item = &Piece> {
        self.parts[..self.count].iter()
    }

    /// The least and the greatest x; `None` where no edge passes the row.
    fn span(&self) -> Option<Range<f64>> {
        let low = self.iter().map(|piece| piece.low).reduce(f64::min)?;
        let high = self.iter().map(|piece| piece.high).reduce(f64::max)?;
        Some(low..high)
    }

    /// The signed area left of `border`.
    fn left_of(&self, border: f64) -> f64 {
        self.iter().map(|piece| piece.left_of(border)).sum()
    }

    /// From where to where a column lies between the edges, so that its share is its width times `height`, signed.
    fn between(&self) -> (Range<f64>, f64) {
        let (mut downwards, mut upwards) = ((f64::MAX, f64::MIN), (f64::MAX, f64::MIN));
        let mut height = 0.0;
        for piece in self.iter() {
            let side = if piece.dy > 0.0 { &mut downwards } else { &mut upwards };
            *side = (side.0.min(piece.low), side.1.max(piece.high));
            height += piece.dy.max(0.0);
        }
        if downwards.0 >= upwards.1 {
            (upwards.1..downwards.0, height)
        } else {
            (downwards.1..upwards.0, -height)
        }
    }

    /// The sum of a row's texels, each times its share.
    fn weighed(&self, texels: &[Vec4], columns: &Cells, wrap: Wrap) -> DVec4 {
        let texel = |column| wrap.texel(column, texels.len()).map(|x| texels[x].as_dvec4());
        let Range { start, end } = columns.numbers;
        let (full, height) = self.between();
        // The outermost columns may be wider than a texel; those between, from edge to edge, count alike.
        let inner_start = (full.start.ceil() as i64).max(start + 1).min(end);
        let inner_end = (full.end.floor() as i64).min(end - 1).max(inner_start);
        let mut sum = (inner_start..inner_end).filter_map(texel).sum::<DVec4>() * height;
        for outer in [start..inner_start, inner_end..end] {
            let mut left = self.left_of(columns.borders(outer.start).start);
            for column in outer {
                let right = self.left_of(columns.borders(column).end);
                sum += texel(column).map_or(DVec4::ZERO, |texel| texel * (right - left));
                left = right;
            }
        }
        sum
    }
}
