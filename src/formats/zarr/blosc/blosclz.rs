//! BloscLZ, Blosc's own packing, a kin of FastLZ: runs of bytes as they are, and copies of what lies up to 73,726 bytes back.

/// The farthest that a copy of the short form lies back, bytes.
const NEAR: usize = 8191;

/// Unpacks into exactly `into`; `None` where the bytes are damaged.
///
/// A token below 32 says that one byte more than it follow as they are. In others the upper three bits are the length of a
/// copy less 2, where 7 says that bytes to be added follow, up to the first that is not 255; the lower five and the next byte
/// are how far back it lies, less 1. If all of these thirteen bits are set, two bytes more say how much farther. The first token is always of bytes as they are.
pub(super) fn unpacked(bytes: &[u8], into: &mut [u8]) -> Option<()> {
    let mut rest = bytes.iter();
    let mut token = usize::from(*rest.next()?) & 31;
    let mut at = 0;
    loop {
        if token < 32 {
            let end = at + token + 1;
            let (plain, after) = rest.as_slice().split_at_checked(token + 1)?;
            into.get_mut(at..end)?.copy_from_slice(plain);
            (at, rest) = (end, after.iter());
        } else {
            let mut next = || rest.next().map(|&byte| usize::from(byte));
            let mut length = (token >> 5) + 2;
            if token >> 5 == 7 {
                loop {
                    let more = next()?;
                    length += more;
                    if more != 255 {
                        break;
                    }
                }
            }
            let mut back = (token & 31) << 8 | next()?;
            if back == NEAR {
                back += next()? << 8 | next()?;
            }
            at = copied(into, at, back + 1, length)?;
        }
        match rest.next() {
            Some(&byte) => token = usize::from(byte),
            None => return (at == into.len()).then_some(()),
        }
    }
}

/// Copies what lies `back` bytes before `at`, which may be what is only just copied; where the copy ends.
fn copied(into: &mut [u8], at: usize, back: usize, length: usize) -> Option<usize> {
    let from = at.checked_sub(back)?;
    let end = at.checked_add(length).filter(|&end| end <= into.len())?;
    if back >= length {
        into.copy_within(from..from + length, at);
    } else {
        (at..end).for_each(|at| into[at] = into[at - back]);
    }
    Some(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(bytes: &[u8], length: usize) -> Option<Vec<u8>> {
        let mut into = vec![0; length];
        unpacked(bytes, &mut into).map(|()| into)
    }

    #[test]
    fn bytes_and_copies_of_them_are_unpacked() {
        assert_eq!(of(&[2, 1, 2, 3], 3).unwrap(), [1, 2, 3]);
        // Three from two back: the last of them is the first that was just copied.
        assert_eq!(of(&[1, 7, 8, 1 << 5, 1], 5).unwrap(), [7, 8, 7, 8, 7]);
        // A run: one back, of 9 and 255 and 2 bytes.
        assert_eq!(of(&[0, 5, 7 << 5, 255, 2, 0], 267).unwrap(), vec![5; 267]);
    }

    #[test]
    fn what_lies_far_back_is_found() {
        let mut packed: Vec<u8> = Vec::new();
        let plain: Vec<u8> = (0..9024_u32).map(|i| (i * i / 7) as u8).collect();
        for run in plain.chunks(32) {
            packed.push(run.len() as u8 - 1);
            packed.extend(run);
        }
        let far = 9000 - NEAR - 1;
        packed.extend([1 << 5 | 31, 255, (far >> 8) as u8, far as u8]);
        let unpacked = of(&packed, 9027).unwrap();
        assert_eq!(unpacked[9024..], plain[24..27]);
    }

    #[test]
    fn damage_is_found_out() {
        for (bytes, length) in [
            (&[][..], 0),
            (&[2, 1, 2][..], 3),
            (&[2, 1, 2, 3][..], 2),
            (&[2, 1, 2, 3][..], 4),
            (&[0, 1, 1 << 5, 1][..], 4),
            (&[0, 1, 7 << 5, 255][..], 400),
        ] {
            assert_eq!(of(bytes, length), None, "{bytes:?}");
        }
    }
}
