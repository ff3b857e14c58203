//! Slabs of values, integrated: what the transfer function is from the value at a slab's beginning over that at its sample to
//! that at its end, as if it went evenly from each to the next. Gradients, and so shading, are those of the sample.

use fearless_simd::Level;
use glam::{DVec3, Vec3};

use super::crossing::{Stretch, spot};
use super::lanes::{LANES, Lanes, each};
use crate::view::composite::{Gathered, thicken};
use crate::view::walk::Tile;
use crate::volume::classification::{Classifier, Piece};
use crate::volume::field::{Field, Sampled, Spot};

/// A slab by what the scalar is at its ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ends {
    /// At its beginning and at its end.
    pub values: [f32; 2],
    /// Its thickness, opacity units.
    pub ratio: f64,
}

impl Ends {
    /// Whether they and what is between them are finite.
    pub fn are_finite(&self, middle: f32) -> bool {
        self.values[0].is_finite() && middle.is_finite() && self.values[1].is_finite()
    }

    /// The colour, and the opacity per opacity unit, of all that a ray sees on its way through the slab.
    pub fn integral(&self, classifier: &Classifier, middle: &Sampled) -> (Vec3, f32) {
        let [front, back] = self.values;
        let mut ray = Gathered::NOTHING;
        for half in [[front, middle.value], [middle.value, back]] {
            classifier.along(half, middle.gradient, |Piece { part, depth, color }| {
                let opacity = -libm::expm1(-0.5 * self.ratio * part * depth);
                ray.under(color * opacity, opacity);
            });
        }
        let opacity = ray.opacity();
        let color = if opacity > 0.0 { ray.color / opacity } else { DVec3::ZERO };
        (color.as_vec3(), thicken(opacity, 1.0 / self.ratio) as f32)
    }
}

/// The values where the slabs of some rays begin and end; a slab begins as the one before it ended, which `known` knows by the
/// number of the slab that begins there.
pub fn ends(
    (field, level): (&Field, Level),
    tile: &Tile,
    (k, lanes): (i64, Lanes),
    known: &mut [(i64, f32); LANES],
) -> [[f32; 2]; LANES] {
    let (mut spots, mut found) = ([Spot::default(); 2 * LANES], [0.0; 2 * LANES]);
    let mut count = 0;
    let mut ask = |place| {
        spots[count] = spot(place);
        count += 1;
    };
    for lane in each(lanes) {
        let stretch = Stretch::of(tile, lane, k);
        if known[lane].0 != k {
            ask(stretch.ends()[0]);
        }
        ask(stretch.ends()[1]);
    }
    field.values(level, &spots[..count], &mut found);
    let (mut made, mut answers) = ([[0.0; 2]; LANES], found.into_iter());
    let mut next = || answers.next().unwrap_or(f32::NAN);
    for lane in each(lanes) {
        let front = if known[lane].0 == k { known[lane].1 } else { next() };
        let back = next();
        known[lane] = (k + 1, back);
        made[lane] = [front, back];
    }
    made
}
