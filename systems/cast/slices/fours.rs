//! Where of some slices' cells any of four neighbors is set.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::u64x8;

/// Slices that are looked at together.
pub(super) const TOGETHER: usize = 16;

/// Which fours of the bits of each word have any set: 16 bits a word, four words in one.
#[inline(always)]
pub(super) fn fours<S: Simd>(simd: S, words: &[u64; TOGETHER]) -> [u64; TOGETHER / 4] {
    let mut fours = [0; TOGETHER / 4];
    for (n, eight) in words.chunks_exact(8).enumerate() {
        let mut word = u64x8::from_slice(simd, eight);
        word = word | (word >> 1);
        word = (word | (word >> 2)) & 0x1111_1111_1111_1111;
        word = (word | (word >> 3)) & 0x0303_0303_0303_0303;
        word = (word | (word >> 6)) & 0x000f_000f_000f_000f;
        word = (word | (word >> 12)) & 0x0000_00ff_0000_00ff;
        word = (word | (word >> 24)) & 0xffff;
        for (k, word) in word.as_slice().iter().enumerate() {
            fours[2 * n + k / 4] |= word << (16 * (k % 4));
        }
    }
    fours
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::field::tests::levels;
    use fearless_simd::dispatch;

    #[test]
    fn fours_of_bits_are_found_wherever_one_is_set() {
        let seed = |n: usize| (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let words: [u64; TOGETHER] = std::array::from_fn(|n| seed(n) & seed(n).rotate_left(23));
        for level in levels() {
            let found = dispatch!(level, simd => fours(simd, &words));
            for (n, word) in words.iter().enumerate() {
                for four in 0..16 {
                    let any = found[n / 4] >> (16 * (n % 4) + four) & 1 == 1;
                    assert_eq!(any, word >> (4 * four) & 0xf != 0, "{level:?} {n} {four}");
                }
            }
        }
    }
}
