//! Bytes written as base64 in files of text.

/// The first `count` bytes of base64, blanks left out; what pads it ends it. `None` where there are fewer.
pub(super) fn decoded(text: &[u8], count: usize) -> Option<Vec<u8>> {
    if count / 3 > text.len() / 4 + 1 {
        return None;
    }
    let mut bytes = Vec::with_capacity(count);
    let (mut bits, mut held) = (0_u32, 0);
    for &letter in text.iter().filter(|letter| !letter.is_ascii_whitespace()) {
        if bytes.len() == count {
            break;
        }
        let six = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => break,
        };
        bits = bits << 6 | u32::from(six);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
        }
    }
    (bytes.len() == count).then_some(bytes)
}

/// All bytes of base64, as [`decoded`] has them.
pub(super) fn all_decoded(text: &[u8]) -> Vec<u8> {
    let blank = |letter: &&u8| !letter.is_ascii_whitespace();
    let is_code = |letter: &&u8| letter.is_ascii_alphanumeric() || matches!(letter, b'+' | b'/');
    let letters = text.iter().filter(blank).take_while(is_code).count();
    decoded(text, letters / 4 * 3 + [0, 0, 1, 2][letters % 4]).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::super::made::base64;
    use super::*;

    #[test]
    fn what_is_written_is_read_and_no_more_than_is_there() {
        for count in 0..9 {
            let bytes: Vec<u8> = (0..count).map(|n: u8| n.wrapping_mul(37)).collect();
            let text = base64(&bytes);
            assert_eq!(decoded(text.as_bytes(), bytes.len()), Some(bytes.clone()));
            assert_eq!(decoded(text.as_bytes(), bytes.len() + 1), None);
            assert_eq!(all_decoded(text.as_bytes()), bytes);
        }
        assert_eq!(decoded(b"QQ==", usize::MAX), None);
    }
}
