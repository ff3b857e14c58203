//! Where rays through voxels met anything, for what makes a picture of them.

use glam::DVec2;

use crate::view::voxel_rays::VoxelRays;

/// Which places have anything that rays met near, and what bounds them.
pub(super) struct MetRays {
    /// The first row and column of rays that met anything, and one past the last.
    bounds: [[f64; 2]; 2],
    /// Of each row of rays: the places behind a ray, from the first on and before the last, with four by four rays around of
    /// which one may have met anything.
    pub near: Vec<[i64; 2]>,
}

impl MetRays {
    pub fn of(rays: &VoxelRays) -> Self {
        let met = |[from, to]: &&[u32; 2]| from < to;
        let from = rays.met.iter().filter(met).map(|row| row[0]).min().unwrap_or(0);
        let to = rays.met.iter().filter(met).map(|row| row[1]).max().unwrap_or(0);
        let first = rays.met.iter().position(|row| met(&row)).unwrap_or(0);
        let last = rays.met.iter().rposition(|row| met(&row)).map_or(0, |last| last + 1);
        let bounds = [[f64::from(from), first as f64], [f64::from(to), last as f64]];
        let most = rays.size[0] as i64 - 2;
        let near = |j: usize| {
            let rows = rays.met.get(j.wrapping_sub(1)..j + 3).unwrap_or_default();
            let rows = || rows.iter().filter(met);
            let from = rows().map(|row| i64::from(row[0]) - 2).min().unwrap_or(0);
            let to = rows().map(|row| i64::from(row[1]) + 1).max().unwrap_or(0);
            [from.max(1), to.min(most)]
        };
        Self { bounds, near: (0..rays.met.len()).map(near).collect() }
    }

    /// The pixels `[from, to)` of a row, of which the first lies at `start`, outside which nothing that rays met is near.
    pub fn shown(&self, (start, right): (DVec2, DVec2), width: usize) -> [usize; 2] {
        let (mut from, mut to) = (0.0_f64, width as f64);
        for axis in 0..2 {
            // Strictly within two rays of one that met anything; a little more, for what is rounded.
            let (low, high) = (self.bounds[0][axis] - 2.001, self.bounds[1][axis] + 1.001);
            let (start, step) = (start[axis], right[axis]);
            let ends = [(low - start) / step, (high - start) / step];
            if ends.iter().all(|end| end.is_finite()) {
                from = from.max(ends[0].min(ends[1]).floor());
                to = to.min(ends[0].max(ends[1]).ceil() + 1.0);
            } else if !(low..=high).contains(&start) {
                return [0, 0];
            }
        }
        if from < to { [from as usize, (to as usize).min(width)] } else { [0, 0] }
    }
}
