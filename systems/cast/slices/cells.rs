//! Bits of a brick's cells, slice by slice.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use crate::volume::gel::{CELLS, EMPTY};
use crate::volume::pyramid::PyramidSlices;

/// The cells of a stored brick that are sampled: those of interest, or all where no pyramid tells them; `None` for a brick
/// that is not stored.
#[inline(always)]
pub(super) fn sampled(pyramid: Option<PyramidSlices<'_>>, stored: u32) -> Option<&[u64; CELLS]> {
    match pyramid {
        Some(pyramid) => pyramid.words(stored),
        None => (stored != EMPTY).then_some(&[u64::MAX; CELLS]),
    }
}

/// The bits of a brick's cells, by what is to be w: bit `8 v + u` of word w, of bit `8 y + x` of word z.
#[inline(always)]
pub(super) fn turned<const W: usize>(words: &[u64; CELLS]) -> [u64; CELLS] {
    match W {
        2 => *words,
        1 => bytes_turned(words),
        _ => bytes_turned(&words.map(bits_turned)),
    }
}

/// Byte n of word m becomes byte m of word n.
#[inline(always)]
fn bytes_turned(words: &[u64; CELLS]) -> [u64; CELLS] {
    let mut turned = [0; CELLS];
    for (n, turned) in turned.iter_mut().enumerate() {
        for (m, word) in words.iter().enumerate() {
            *turned |= (word >> (CELLS * n) & 0xff) << (CELLS * m);
        }
    }
    turned
}

/// Bit n of byte m becomes bit m of byte n: by squares of bits, of two, of four (Warren, "Hacker's Delight", §7-3).
#[inline(always)]
fn bits_turned(word: u64) -> u64 {
    let mut word = word;
    for (shift, mask) in
        [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)]
    {
        let differs = (word ^ (word >> shift)) & mask;
        word ^= differs ^ (differs << shift);
    }
    word
}

/// Which cells of a slice have all their corners in the grid: the first `inside` along u and v, of eight.
pub(super) fn within(inside: [usize; 2]) -> u64 {
    let [u, v] = inside.map(|n| n.min(CELLS));
    if u == 0 || v == 0 {
        return 0;
    }
    ((0xff_u64 >> (CELLS - u)) * 0x0101_0101_0101_0101) & (u64::MAX >> (CELLS * (CELLS - v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cell_keeps_its_bit_whatever_axis_slices_lie_across() {
        for seed in 0..50_u64 {
            let word = |z: u64| (seed * 8 + z).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31);
            let words = std::array::from_fn(|z| word(z as u64));
            let bit = |words: &[u64; CELLS], [u, v, w]: [usize; 3]| words[w] >> (8 * v + u) & 1;
            for at in 0..512_usize {
                let [x, y, z] = [at % 8, at / 8 % 8, at / 64];
                let expected = bit(&words, [x, y, z]);
                assert_eq!(bit(&turned::<2>(&words), [x, y, z]), expected);
                assert_eq!(bit(&turned::<1>(&words), [x, z, y]), expected);
                assert_eq!(bit(&turned::<0>(&words), [y, z, x]), expected);
            }
        }
    }

    #[test]
    fn cells_at_the_border_of_the_grid_are_left_out() {
        assert_eq!(within([8, 9]), u64::MAX);
        assert_eq!(within([0, 5]), 0);
        assert_eq!(within([2, 3]), 0x0003_0303);
    }
}
