//! Surfaces without thickness: where a ray crosses an isovalue within its slab, found on the reconstructed values themselves.

use fearless_simd::Level;
use glam::{DVec3, Vec3, Vec4};

use super::lanes::{LANES, Lanes, each};
use crate::view::composite::{Gathered, recolor, thicken};
use crate::view::walk::{FRACTION_BITS, Tile, part};
use crate::volume::field::{Field, Sampled, Spot};

/// Halvings of a stretch that holds a crossing, at the most: each is at least as good as the middle of the last two.
const HALVINGS: usize = 12;

/// How much of a turn counts in C_G: two normals at more than some 25° are as an edge of the default `edge_tolerance`.
const TURN: f32 = 0.05;

/// A surface that a ray crosses: the part of the slab before it, its colour, its opacity and its normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CrossedSurface {
    /// 0..=1.
    pub part: f64,
    /// Lit.
    pub color: Vec3,
    /// Its own.
    pub opacity: f32,
    /// Of length 1, or zero.
    pub normal: Vec3,
}

/// What rays cross within their slabs.
#[derive(Debug, Clone, Default)]
pub(crate) struct Crossings {
    /// Room for what one of them crosses.
    pub met: Vec<CrossedSurface>,
    /// What each crosses in the slab that was met last.
    pub sheets: [Sheet; LANES],
    /// The gel of that slab without what is crossed: associated RGBA per opacity unit.
    pub bare: [Vec4; LANES],
    /// The value where the slab that was met last ends, and the number of the slab that begins there.
    pub ends: [(i64, f32); LANES],
    /// How far from samples what they show is looked for, cells.
    pub reach: f64,
}

impl Crossings {
    /// Forgets where slabs ended: other rays begin, which show what is as near to them as `reach`.
    pub fn begin(&mut self, reach: f64) {
        self.ends = [(i64::MIN, 0.0); LANES];
        self.reach = reach;
    }
}

/// All surfaces within a slab, without the gel between them: what C_A and C_G see of it, as they see polygons.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sheet {
    /// Associated colour.
    pub color: DVec3,
    /// The normal in place of a colour, associated: where a surface hides another, colours and normals jump, and where it
    /// only bends or is unevenly lit, one of both does not.
    pub turn: DVec3,
    /// Their opacity.
    pub opacity: f64,
    /// Where in the slab the first of them is, 0..=1.
    pub part: f64,
}

impl Sheet {
    /// Surfaces, the nearest first.
    fn of(surfaces: &[CrossedSurface]) -> Self {
        let (mut seen, mut turn) = (Gathered::NOTHING, Gathered::NOTHING);
        for crossed in surfaces {
            let opacity = f64::from(crossed.opacity);
            seen.under(crossed.color.as_dvec3() * opacity, opacity);
            turn.under((crossed.normal * TURN).as_dvec3() * opacity, opacity);
        }
        let part = surfaces.first().map_or(0.0, |first| first.part);
        Self { color: seen.color, turn: turn.color, opacity: seen.opacity(), part }
    }

    /// Those of volumes that overlap: none hides another.
    pub fn beside(&self, other: &Self) -> Self {
        Self {
            color: self.color + other.color,
            turn: self.turn + other.turn,
            opacity: 1.0 - (1.0 - self.opacity) * (1.0 - other.opacity),
            part: match [self, other].map(|sheet| sheet.opacity > 0.0) {
                [true, true] => self.part.min(other.part),
                [true, false] => self.part,
                _ => other.part,
            },
        }
    }
}

/// The stretch of a ray that a sample stands for, from its beginning to its end: fixed-point voxel indices.
pub(crate) struct Stretch {
    from: [i64; 3],
    to: [i64; 3],
}

impl Stretch {
    /// That of a ray of a tile at sample `k`: it ends where the next one begins, to the last bit.
    #[inline]
    pub fn of(tile: &Tile, lane: usize, k: i64) -> Self {
        let middle: [i64; 3] = std::array::from_fn(|axis| tile.place(axis, lane, k));
        let half: [i64; 3] = std::array::from_fn(|axis| tile.step[axis][lane] >> 1);
        let from = std::array::from_fn(|axis| middle[axis] - (tile.step[axis][lane] - half[axis]));
        Self { from, to: std::array::from_fn(|axis| middle[axis] + half[axis]) }
    }

    /// That between two places.
    #[inline]
    pub fn between(from: [i64; 3], to: [i64; 3]) -> Self {
        Self { from, to }
    }

    /// The fixed-point indices of its ends.
    #[inline]
    pub fn ends(&self) -> [[i64; 3]; 2] {
        [self.from, self.to]
    }

    /// The fixed-point index a part of the way along it, 0..=1.
    #[inline]
    pub fn at(&self, part: f64) -> [i64; 3] {
        if part == 1.0 {
            return self.to;
        }
        std::array::from_fn(|axis| {
            self.from[axis] + ((self.to[axis] - self.from[axis]) as f64 * part) as i64
        })
    }
}

/// The spot of a fixed-point voxel index; before the grid it is the grid's first.
#[inline]
pub fn spot(place: [i64; 3]) -> Spot {
    let cell = place.map(|place| (place >> FRACTION_BITS).max(0) as usize);
    let part = place.map(|place| part(place.max(0) & ((1 << FRACTION_BITS) - 1)));
    Spot { cell, part }
}

/// The spots of some rays of a tile at sample `k`, in their order: to the last bit what [`spot`] gives of each.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
pub fn spots_of<'a>(
    tile: &Tile,
    (k, lanes): (i64, Lanes),
    made: &'a mut [Spot; LANES],
) -> &'a [Spot] {
    let steps = k.wrapping_sub(tile.middle);
    // Axis by axis, and no loop: that would go over the axes side by side.
    let (x, of_x) = on_axis(&tile.at[0], &tile.step[0], steps);
    let (y, of_y) = on_axis(&tile.at[1], &tile.step[1], steps);
    let (z, of_z) = on_axis(&tile.at[2], &tile.step[2], steps);
    let mut count = 0;
    for lane in each(lanes) {
        made[count] =
            Spot { cell: [x[lane], y[lane], z[lane]], part: [of_x[lane], of_y[lane], of_z[lane]] };
        count += 1;
    }
    &made[..count]
}

/// The cells that rays are in on one axis so many steps from where they are, and the way through them.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn on_axis(at: &[i64; LANES], step: &[i64; LANES], steps: i64) -> ([usize; LANES], [f32; LANES]) {
    let (mut cells, mut parts) = ([0; LANES], [0.0; LANES]);
    for lane in 0..LANES {
        let place = at[lane].wrapping_add(step[lane].wrapping_mul(steps)).max(0);
        cells[lane] = (place >> FRACTION_BITS) as usize;
        parts[lane] = part(place & ((1 << FRACTION_BITS) - 1));
    }
    (cells, parts)
}

/// The index of a place, in voxels.
#[inline]
pub fn index(place: [i64; 3]) -> DVec3 {
    DVec3::from(place.map(|place| place as f64)) / (1_u64 << FRACTION_BITS) as f64
}

/// How far from its samples a stretch of any ray of a tile reaches, cells.
pub fn reach(tile: &Tile) -> f64 {
    let steps = tile.step.as_flattened().iter().map(|step| step.unsigned_abs());
    (steps.max().unwrap_or(0) / 2 + 2) as f64 / (1_u64 << FRACTION_BITS) as f64
}

/// Where on a stretch a field takes a value, and what it is there; between two parts of it, at which it lies on both sides.
pub fn crossing(
    (field, level): (&Field, Level),
    stretch: &Stretch,
    value: f32,
    ends: [(f64, f32); 2],
) -> Option<(f64, Sampled)> {
    let [(mut a, fa), (mut b, fb)] = ends;
    let (mut fa, mut fb) = (f64::from(fa - value), f64::from(fb - value));
    if (fa >= 0.0) == (fb >= 0.0) || !(fa - fb).is_finite() {
        return None;
    }
    let (near, mut last) = (1e-6 * (fa - fb).abs(), 0);
    let (mut found, mut part) = ([0.0], a);
    for _ in 0..HALVINGS {
        // Where a straight line crosses; an end that stays twice counts half (Illinois), so that both come nearer.
        part = (a * fb - b * fa) / (fb - fa);
        field.values(level, &[spot(stretch.at(part))], &mut found);
        let f = f64::from(found[0] - value);
        if f.is_nan() {
            return None;
        }
        if f.abs() <= near {
            break;
        }
        if (f >= 0.0) == (fa >= 0.0) {
            (a, fa) = (part, f);
            fb *= if last == 1 { 0.5 } else { 1.0 };
            last = 1;
        } else {
            (b, fb) = (part, f);
            fa *= if last == 2 { 0.5 } else { 1.0 };
            last = 2;
        }
    }
    let mut made = [Sampled::default()];
    field.sample(level, &[spot(stretch.at(part))], &mut made);
    Some((part, made[0]))
}

/// The slab of some gel with surfaces in it, `ratio` opacity units thick: associated RGBA per opacity unit, of which it is
/// made again by thickening; and the surfaces alone.
pub fn slab(gel: Vec4, surfaces: &mut [CrossedSurface], ratio: f64) -> (Vec4, Sheet) {
    surfaces.sort_by(|a, b| a.part.total_cmp(&b.part));
    let (mut ray, mut passed) = (Gathered::NOTHING, 0.0);
    let (color, opacity) = (gel.truncate().as_dvec3(), f64::from(gel.w));
    let through = |ray: &mut Gathered, part: f64| {
        let thick = thicken(opacity, part * ratio);
        ray.under(color * recolor(opacity, thick, part * ratio), thick);
    };
    for &CrossedSurface { part, color, opacity, .. } in &*surfaces {
        through(&mut ray, (part - passed).max(0.0));
        ray.under(color.as_dvec3() * f64::from(opacity), f64::from(opacity));
        passed = part;
    }
    through(&mut ray, (1.0 - passed).max(0.0));
    let unit = thicken(ray.opacity(), 1.0 / ratio);
    let color = ray.color * recolor(ray.opacity(), unit, 1.0 / ratio);
    (color.as_vec3().extend(unit as f32), Sheet::of(surfaces))
}
