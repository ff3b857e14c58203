//! Numbers whose bytes or bits were put in the order of their places, so that they pack better, put back.

/// Puts bytes back: in `from` lie the first bytes of all numbers of `width` bytes, then all second ones, and so on; what is
/// left over at the end lies as it was. Both are of one length.
pub(super) fn unshuffled(from: &[u8], into: &mut [u8], width: usize) {
    let count = from.len() / width.max(1);
    if width < 2 || count == 0 {
        return into.copy_from_slice(from);
    }
    let whole = count * width;
    for (place, bytes) in from[..whole].chunks_exact(count).enumerate() {
        let own = into[place..whole].iter_mut().step_by(width);
        own.zip(bytes).for_each(|(into, byte)| *into = *byte);
    }
    into[whole..].copy_from_slice(&from[whole..]);
}

/// Puts bits back: in `from` lie the first bits of the first bytes of all numbers of `width` bytes, then all second ones, and
/// so on. Where the numbers are no multiple of eight, all lies as it was.
pub(super) fn bits_unshuffled(from: &[u8], into: &mut [u8], width: usize) {
    let count = from.len() / width.max(1);
    if width == 0 || count == 0 || !count.is_multiple_of(8) {
        return into.copy_from_slice(from);
    }
    let row = count / 8;
    for place in 0..width {
        let rows = &from[place * 8 * row..][..8 * row];
        for eight in 0..row {
            let bits =
                (0..8).fold(0, |sum, bit| sum | u64::from(rows[bit * row + eight]) << (8 * bit));
            for (number, byte) in turned(bits).to_le_bytes().into_iter().enumerate() {
                into[(eight * 8 + number) * width + place] = byte;
            }
        }
    }
    let whole = count * width;
    into[whole..].copy_from_slice(&from[whole..]);
}

/// Eight by eight bits, rows as columns: bit 8 r + c becomes bit 8 c + r (Hacker's Delight, 7-3).
fn turned(bits: u64) -> u64 {
    [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)]
        .into_iter()
        .fold(bits, |bits, (by, mask)| {
            let changed = (bits ^ bits >> by) & mask;
            bits ^ changed ^ changed << by
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_turned_about_the_diagonal() {
        for bit in 0..64 {
            assert_eq!(turned(1 << bit), 1 << (bit % 8 * 8 + bit / 8));
        }
    }

    #[test]
    fn bytes_go_back_where_they_were_and_the_rest_stays() {
        let mut into = [0; 7];
        unshuffled(&[1, 3, 5, 2, 4, 6, 7], &mut into, 2);
        assert_eq!(into, [1, 2, 3, 4, 5, 6, 7]);
        unshuffled(&[9; 7], &mut into, 1);
        assert_eq!(into, [9; 7]);
        unshuffled(&[8; 7], &mut into, 200);
        assert_eq!(into, [8; 7]);
    }

    #[test]
    fn bits_go_back_where_they_were() {
        let plain: Vec<u8> = (0..48_u32).map(|i| (i * i * 37 + i) as u8).collect();
        let mut shuffled = vec![0; 48];
        for (number, own) in plain.chunks(2).enumerate() {
            for bit in 0..16 {
                let set = own[bit / 8] >> (bit % 8) & 1;
                shuffled[bit * 3 + number / 8] |= set << (number % 8);
            }
        }
        let mut into = vec![0; 48];
        bits_unshuffled(&shuffled, &mut into, 2);
        assert_eq!(into, plain);
        let mut seven = [0; 7];
        bits_unshuffled(&[1, 2, 3, 4, 5, 6, 7], &mut seven, 1);
        assert_eq!(seven, [1, 2, 3, 4, 5, 6, 7]);
    }
}
