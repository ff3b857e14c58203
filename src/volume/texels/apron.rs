//! The aprons of bricks: the ninth texel of each row, column and pillar is the next brick's first.
//!
//! What a brick gives to others is its three first faces. They are set apart as it is filled, layer by layer of bricks, while it
//! is near; then all bricks of the layer before are completed side by side.

use std::ops::Range;

use rayon::prelude::*;

use crate::volume::texel::{CELLS, EMPTY, FACES, ROW, TEXELS, Texel};

/// Texels of a face.
const FACE: usize = FACES / 3;

/// The first faces of a brick: those at x = 0 (y fastest), at y = 0 and at z = 0 (x fastest).
struct Faces<T>([[T; FACE]; 3]);

impl<T: Texel> Faces<T> {
    fn of(texels: &[T; TEXELS]) -> Self {
        let mut faces = [[T::default(); FACE]; 3];
        for line in 0..CELLS {
            for at in 0..CELLS {
                faces[0][line * CELLS + at] = texels[(line * ROW + at) * ROW];
            }
            let to = line * CELLS..(line + 1) * CELLS;
            faces[1][to.clone()].copy_from_slice(&texels[line * ROW * ROW..][..CELLS]);
            faces[2][to].copy_from_slice(&texels[line * ROW..][..CELLS]);
        }
        Self(faces)
    }

    /// Copies what a brick has of this one, which comes after it along the axes that `after` says.
    fn copy(&self, [x, y, z]: [bool; 3], texels: &mut [T; TEXELS]) {
        let lines = |after: bool| if after { CELLS..ROW } else { 0..CELLS };
        for (to_z, from_z) in lines(z).zip(0..CELLS) {
            for (to_y, from_y) in lines(y).zip(0..CELLS) {
                let to = (to_z * ROW + to_y) * ROW;
                if x {
                    texels[to + CELLS] = self.0[0][from_z * CELLS + from_y];
                } else {
                    let row =
                        if z { &self.0[2][from_y * CELLS..] } else { &self.0[1][from_z * CELLS..] };
                    texels[to..][..CELLS].copy_from_slice(&row[..CELLS]);
                }
            }
        }
    }
}

/// Fills bricks, x fastest, that `table` gives the numbers of on a grid of `counts` bricks: their own texels by `fill`, which
/// gets them clear, and then their aprons; what is not stored is clear.
pub(super) fn fill<T: Texel>(
    counts: [usize; 3],
    table: &[u32],
    stored: &[[usize; 3]],
    bricks: &mut [[T; TEXELS]],
    fill: impl Fn(&mut [T; TEXELS], [usize; 3]) + Sync,
) {
    let [nx, ny, nz] = counts;
    let layer = |z: usize| -> Range<usize> {
        stored.partition_point(|brick| brick[2] < z)..stored.partition_point(|brick| brick[2] <= z)
    };
    let own_texels = |bricks: &mut [[T; TEXELS]], places: Range<usize>| -> Vec<Faces<T>> {
        let bricks = bricks[places.clone()].par_iter_mut().zip(&stored[places]);
        let filled = bricks.map(|(texels, brick)| {
            fill(texels, *brick);
            Faces::of(texels)
        });
        filled.collect()
    };
    let mut own = own_texels(bricks, layer(0));
    for z in 0..nz {
        let (here, above) = (layer(z), layer(z + 1));
        let next = own_texels(bricks, above.clone());
        let after = |[x, y, _]: [usize; 3], [by_x, by_y, by_z]: [bool; 3]| {
            let (x, y) = (x + usize::from(by_x), y + usize::from(by_y));
            let entry = (x < nx && y < ny && z + usize::from(by_z) < nz)
                .then(|| table[((z + usize::from(by_z)) * ny + y) * nx + x]);
            let number = entry.filter(|number| *number != EMPTY)? as usize;
            Some(if by_z { &next[number - above.start] } else { &own[number - here.start] })
        };
        let bricks = bricks[here.clone()].par_iter_mut().with_min_len(32);
        bricks.zip(&stored[here.clone()]).for_each(|(texels, brick)| {
            for corner in 1..8 {
                let by = [0, 1, 2].map(|axis| corner >> axis & 1 == 1);
                if let Some(faces) = after(*brick, by) {
                    faces.copy(by, texels);
                }
            }
        });
        own = next;
    }
}
