//! Numbers that look random and follow from the number of a run (SplitMix64), and what is made of them.

/// A sequence of its own for each run.
pub struct Random(u64);

/// Bytes that readers take for something.
const TELLING: [&[u8]; 12] = [
    b"\n\n",
    b"\0",
    b"\xff\xff\xff\xff",
    b"\x7f\xff\xff\xff",
    b"NaN",
    b"-1",
    b"1e400",
    b"99999999999999999999",
    b"\x1b[31m",
    b"\xef\xbb\xbf",
    b"[[",
    b"inf",
];

impl Random {
    /// The sequence of a run.
    pub fn new(run: u64) -> Self {
        Self(run.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ 0x1234_5678)
    }

    /// Any 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ bits >> 31
    }

    /// A number below `end`, which is not 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.bits() % end as u64) as usize
    }

    /// One of some things.
    pub fn of<'a, T>(&mut self, things: &'a [T]) -> &'a T {
        &things[self.below(things.len())]
    }

    /// The bytes with a few of them changed, put in, left out, doubled, or with the end cut off.
    pub fn mutated(&mut self, mut bytes: Vec<u8>) -> Vec<u8> {
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len() + 1);
            let end = (at + self.below(16)).min(bytes.len());
            match self.below(7) {
                0 if at < bytes.len() => bytes[at] = self.bits() as u8,
                1 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
                2 => drop(bytes.splice(at..at, self.of(&TELLING).iter().copied())),
                3 => drop(bytes.splice(at..end, self.of(&TELLING).iter().copied())),
                4 => drop(bytes.drain(at..end)),
                5 => drop(bytes.splice(at..at, bytes[at..end].to_vec())),
                6 if self.below(4) == 0 => bytes.truncate(at),
                _ => (),
            }
        }
        bytes
    }
}
