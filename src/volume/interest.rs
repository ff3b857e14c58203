//! Which cells of a layer are interesting, before any gel is made of it: level 0 of the paper's pyramid, from opacities alone.

use rayon::prelude::*;

use super::bricks::{Bricks, EDGE, VOXELS};
use super::texel::{CELLS, EMPTY, Texel};
use crate::components::TexelKind;

/// The first of each row of eight bits.
const FIRSTS: u64 = 0x0101_0101_0101_0101;

/// The interesting cells of gel that is made of some opacities: those of whose eight voxels one is not clear.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Interest {
    /// Bricks on each axis.
    pub counts: [usize; 3],
    /// For each brick, x fastest: its number among those with interesting cells, or `EMPTY`.
    pub table: Vec<u32>,
    /// Of those bricks: bit `8 y + x` of word `z`.
    pub cells: Vec<[u64; CELLS]>,
}

impl Interest {
    /// Of `opacity`, kept in numbers of `kind` (in 32 bits where that is left open): what is clear in them is clear.
    #[must_use]
    pub fn of(opacity: &Bricks<f32>, kind: TexelKind) -> Self {
        match kind {
            TexelKind::Auto | TexelKind::F32 => Self::of_texels::<[f32; 4]>(opacity),
            TexelKind::U16 => Self::of_texels::<[u16; 4]>(opacity),
            TexelKind::U8 => Self::of_texels::<[u8; 4]>(opacity),
        }
    }

    /// Whether a brick, by its place in the table, has any interesting cell.
    #[must_use]
    pub fn holds(&self, entry: usize) -> bool {
        self.table[entry] != EMPTY
    }

    fn of_texels<T: Texel>(opacity: &Bricks<f32>) -> Self {
        let counts = opacity.counts();
        let [nx, ny, nz] = counts;
        let place = |at: usize| [at % nx, at / nx % ny, at / (nx * ny)];
        let entry = |[x, y, z]: [usize; 3]| (z * ny + y) * nx + x;
        // Of the bricks that there are alone: most of a large grid has none.
        let own: Vec<_> = opacity.stored().collect();
        let mut numbers = vec![EMPTY; nx * ny * nz];
        for (number, (place, _)) in own.iter().enumerate() {
            numbers[entry(place.brick)] = number as u32;
        }
        let seen: Vec<_> = own.par_iter().map(|(_, opacity)| seen::<T>(opacity)).collect();
        let cells = |at: usize| {
            let [x, y, z] = place(at);
            let after = [x + 1 < nx, y + 1 < ny, z + 1 < nz];
            let cells = around(|step| {
                let inside = (0..3).all(|axis| step[axis] == 0 || after[axis]);
                let number = if inside { numbers[at + entry(step)] } else { EMPTY };
                seen.get(number as usize)
            });
            (cells != [0; CELLS]).then_some((at, cells))
        };
        let made: Vec<_> = (0..nx * ny * nz).into_par_iter().filter_map(cells).collect();
        let mut table = vec![EMPTY; nx * ny * nz];
        for (number, (at, _)) in made.iter().enumerate() {
            table[*at] = number as u32;
        }
        let stored = made.into_iter().map(|(_, cells)| cells).collect();
        Self { counts, table, cells: stored }
    }
}

/// Which voxels of a brick are not clear: bit `8 y + x` of word `z`.
fn seen<T: Texel>(opacity: &[f32; VOXELS]) -> [u64; EDGE] {
    let slices = opacity.as_chunks::<{ EDGE * EDGE }>().0;
    std::array::from_fn(|z| {
        let bits = slices[z].iter().enumerate();
        bits.fold(0, |bits, (at, alpha)| bits | u64::from(T::is_seen(*alpha)) << at)
    })
}

/// The interesting cells of a brick from the voxels of it and of the seven after it, of which `seen` gives those that are.
fn around<'a>(seen: impl Fn([usize; 3]) -> Option<&'a [u64; EDGE]>) -> [u64; CELLS] {
    let bricks: [Option<&[u64; EDGE]>; 8] =
        std::array::from_fn(|n| seen([n & 1, n >> 1 & 1, n >> 2]));
    let slice = |n: usize, z: usize| bricks[n].map_or(0, |words| words[z]);
    // A voxel or the next along x is seen, in a slice of the bricks n and n + 1.
    let across = |n: usize, z: usize| {
        let own = slice(n, z);
        own | own >> 1 & !(FIRSTS << 7) | (slice(n + 1, z) & FIRSTS) << 7
    };
    let down = |n: usize, z: usize| {
        let own = across(n, z);
        own | own >> EDGE | across(n + 2, z) << (EDGE * (EDGE - 1))
    };
    let slices: [u64; EDGE + 1] =
        std::array::from_fn(|z| if z < EDGE { down(0, z) } else { down(4, 0) });
    std::array::from_fn(|z| slices[z] | slices[z + 1])
}

#[cfg(test)]
mod tests {
    use glam::Vec4;
    use proptest::prelude::*;

    use super::*;
    use crate::volume::texels::Texels;

    fn check<T: Texel>(voxels: &[f32], size: [usize; 3], kind: TexelKind) {
        let at = |[x, y, z]: [usize; 3]| (z * size[1] + y) * size[0] + x;
        let opacity = Bricks::make(size, |place, brick| {
            place.voxels().for_each(|(within, voxel)| brick[within] = voxels[at(voxel)]);
            brick.iter().any(|alpha| *alpha > 0.0)
        });
        let interest = Interest::of(&opacity, kind);
        let gel = Texels::<T>::make(size, |_| true, &|first: [usize; 3], row: &mut [Vec4]| {
            row.iter_mut().enumerate().for_each(|(x, texel)| texel.w = voxels[at(first) + x]);
        });
        for (brick, entry) in interest.table.iter().enumerate() {
            let expected = gel.interesting_cells(brick as u32);
            assert_eq!(interest.holds(brick), expected != [0; CELLS]);
            assert!(*entry == EMPTY || interest.cells[*entry as usize] == expected, "{brick}");
        }
    }

    proptest! {
        #[test]
        fn cells_of_opacities_are_those_of_the_gel_that_is_made_of_them(
            size in [1_usize..20, 1_usize..20, 1_usize..20], seed in any::<u64>(), thin in 1_u64..200,
        ) {
            let mut state = seed | 1;
            let mut next = || {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                state
            };
            let faint = [1.0, 0.3, 1e-4, 1e-5, 7.6e-6, 1e-30, 0.002, 0.0019];
            let voxels: Vec<f32> = (0..size.iter().product())
                .map(|_| if next() % thin == 0 { faint[(next() % 8) as usize] } else { 0.0 })
                .collect();
            check::<[f32; 4]>(&voxels, size, TexelKind::F32);
            check::<[u16; 4]>(&voxels, size, TexelKind::U16);
            check::<[u8; 4]>(&voxels, size, TexelKind::U8);
        }
    }
}
