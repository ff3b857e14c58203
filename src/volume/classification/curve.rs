//! Piecewise-linear functions, as classifications state them: straight between points, constant beyond the ends.

use std::ops::{Add, Mul};

/// Points in rising order; two at one place are a step, and the later counts from there on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Curve<V>(Vec<(f64, V)>);

impl<V: Copy + Add<Output = V> + Mul<f64, Output = V>> Curve<V> {
    /// A curve through points `(place, value)`. They are sorted; a place that is not finite is left out.
    pub fn new(points: impl IntoIterator<Item = (f32, V)>) -> Self {
        let finite = points.into_iter().filter(|(place, _)| place.is_finite());
        let mut points: Vec<_> = finite.map(|(place, value)| (f64::from(place), value)).collect();
        points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        Self(points)
    }

    /// Its points.
    pub fn points(&self) -> &[(f64, V)] {
        &self.0
    }

    /// The points that `place` lies between, and how far it is from the first to the second, 0..=1.
    ///
    /// Beyond an end both are that end. `None` without points or for a NaN.
    pub fn around(&self, place: f64) -> Option<[&(f64, V); 2]> {
        if place.is_nan() {
            return None;
        }
        let next = self.0.partition_point(|(at, _)| *at <= place);
        let low = self.0.get(next.saturating_sub(1))?;
        Some([low, self.0.get(next).filter(|_| next > 0).unwrap_or(low)])
    }

    /// The value at `place`, infinite ones included; `None` without points or for a NaN.
    pub fn value(&self, place: f64) -> Option<V> {
        let [low, high] = self.around(place)?;
        let span = high.0 - low.0;
        let toward = if span > 0.0 { (place - low.0) / span } else { 0.0 };
        Some(low.1 * (1.0 - toward) + high.1 * toward)
    }

    /// The straight pieces between two places that are finite and not the same, in the order in which they are passed: the
    /// places and values of their ends.
    pub fn pieces(&self, [from, to]: [f64; 2]) -> impl Iterator<Item = [(f64, V); 2]> {
        let (points, [low, high]) = (&self.0, [from.min(to), from.max(to)]);
        let first = points.partition_point(|(at, _)| *at <= low);
        let last = points.partition_point(|(at, _)| *at < high).max(first);
        let count = if points.is_empty() { 0 } else { last + 1 - first };
        (0..count).filter_map(move |n| {
            let right = if from < to { first + n } else { last - n };
            let ends = [right.checked_sub(1).and_then(|left| points.get(left)), points.get(right)];
            let at = |place: f64| {
                let [left, right] = [ends[0].or(ends[1]), ends[1].or(ends[0])];
                // A curve without a point has no piece.
                let (left, right) = (left.unwrap_or(&points[0]), right.unwrap_or(&points[0]));
                let span = right.0 - left.0;
                let toward = if span > 0.0 { (place - left.0) / span } else { 0.0 };
                (place, left.1 * (1.0 - toward) + right.1 * toward)
            };
            let begin = ends[0].map_or(low, |left| left.0.max(low));
            let end = ends[1].map_or(high, |right| right.0.min(high));
            (begin < end)
                .then(|| if from < to { [at(begin), at(end)] } else { [at(end), at(begin)] })
        })
    }

    /// The first and last place; none without points.
    pub fn ends(&self) -> Option<[f64; 2]> {
        Some([self.0.first()?.0, self.0.last()?.0])
    }
}

impl Curve<f64> {
    /// Where the value is above 0, for a curve that is nowhere below 0.
    pub fn risen(&self) -> Risen {
        // It is straight between points: an end where it is 0 does not belong to the piece beside it.
        let from = |(at, value): (f64, f64)| if value > 0.0 { at } else { at.next_up() };
        let to = |(at, value): (f64, f64)| if value > 0.0 { at } else { at.next_down() };
        let mut risen = Risen(Vec::new());
        if let (Some(first), Some(last)) = (self.0.first(), self.0.last()) {
            let before = (f64::NEG_INFINITY, first.1);
            let behind = (f64::INFINITY, last.1);
            let points = [&[before], &self.0[..], &[behind]].concat();
            for piece in points.windows(2).filter(|piece| piece[0].1 > 0.0 || piece[1].1 > 0.0) {
                risen.add([from(piece[0]), to(piece[1])]);
            }
        }
        risen
    }

    /// The interval outside of which the value is surely 0; from ∞ to −∞ if it is 0 everywhere.
    pub fn support(&self) -> [f64; 2] {
        let some = |point: &(f64, f64)| point.1 > 0.0;
        let (first, last) = (self.0.iter().position(some), self.0.iter().rposition(some));
        let (Some(first), Some(last)) = (first, last) else {
            return [f64::INFINITY, f64::NEG_INFINITY];
        };
        let low = if first == 0 { f64::NEG_INFINITY } else { self.0[first - 1].0 };
        [low, self.0.get(last + 1).map_or(f64::INFINITY, |point| point.0)]
    }
}

/// Where a curve is above 0: intervals in rising order, both ends among them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Risen(Vec<[f64; 2]>);

impl Risen {
    /// The intervals.
    pub fn intervals(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Adds an interval behind all others; it may touch the last.
    fn add(&mut self, [low, high]: [f64; 2]) {
        match self.0.last_mut() {
            _ if low > high => {}
            Some(last) if last[1] >= low => last[1] = last[1].max(high),
            _ => self.0.push([low, high]),
        }
    }

    /// Of some ranges, from `low` to `high` each, adds 1 to `shown` where one meets an interval and it is 0.
    #[inline]
    pub fn show<const N: usize>(&self, low: &[f64; N], high: &[f64; N], shown: &mut [u64; N]) {
        for [from, to] in &self.0 {
            for n in 0..N {
                shown[n] |= u64::from(low[n] <= *to) & u64::from(high[n] >= *from);
            }
        }
    }

    /// The least place from `low` on; ∞ if there is none.
    pub fn least(&self, low: f64) -> f64 {
        let behind = self.0.iter().find(|[_, to]| *to >= low);
        behind.map_or(f64::INFINITY, |[from, _]| from.max(low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_straight_between_points_and_constant_beyond() {
        let curve = Curve::new([(4.0, 1.0), (2.0, 0.0), (f32::NAN, 9.0)]);
        let at = |place: f64| curve.value(place).unwrap();
        assert_eq!([at(1.0), at(2.5), at(4.0), at(f64::INFINITY)], [0.0, 0.25, 1.0, 1.0]);
        assert_eq!(at(f64::NEG_INFINITY), 0.0);
        assert_eq!(curve.value(f64::NAN), None);
        assert_eq!(Curve::<f64>::new([]).value(0.0), None);
    }

    #[test]
    fn two_points_at_one_place_are_a_step() {
        let curve = Curve::new([(0.0, 0.0), (1.0, 0.25), (1.0, 0.75), (2.0, 1.0)]);
        let at = |place: f64| curve.value(place).unwrap();
        assert_eq!([at(0.5), at(1.0), at(1.5)], [0.125, 0.75, 0.875]);
        assert_eq!(Curve::new([(1.0, 0.25), (1.0, 0.75)]).value(1.0), Some(0.75));
    }

    #[test]
    fn pieces_are_passed_in_order_and_a_step_is_between_two_of_them() {
        let curve = Curve::new([(0.0, 0.0), (1.0, 0.25), (1.0, 0.75), (2.0, 1.0)]);
        let rising = [[(0.5, 0.125), (1.0, 0.25)], [(1.0, 0.75), (1.5, 0.875)]];
        assert_eq!(curve.pieces([0.5, 1.5]).collect::<Vec<_>>(), rising);
        let falling: Vec<_> = rising.iter().rev().map(|[a, b]| [*b, *a]).collect();
        assert_eq!(curve.pieces([1.5, 0.5]).collect::<Vec<_>>(), falling);
        assert_eq!(curve.pieces([3.0, 5.0]).collect::<Vec<_>>(), [[(3.0, 1.0), (5.0, 1.0)]]);
        let all: Vec<_> = curve.pieces([-1.0, 1.0]).collect();
        assert_eq!(all, [[(-1.0, 0.0), (0.0, 0.0)], [(0.0, 0.0), (1.0, 0.25)]]);
        assert_eq!(Curve::<f64>::new([]).pieces([0.0, 1.0]).count(), 0);
    }

    #[test]
    fn outside_its_support_a_curve_is_zero() {
        let hill = Curve::new([(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 0.0), (4.0, 0.0)]);
        assert_eq!(hill.support(), [1.0, 3.0]);
        let step = Curve::new([(0.0, 0.0), (0.0, 1.0)]);
        assert_eq!(step.support(), [0.0, f64::INFINITY]);
        let nothing = Curve::new([(0.0, 0.0)]).support();
        assert!(nothing[0] > nothing[1]);
    }
}
