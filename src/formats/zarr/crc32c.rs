//! CRC-32C, Castagnoli's checksum (RFC 3720, appendix B.4), by which Zarr checks chunks and tables of shards.

/// The polynomial, its bits turned about.
const POLYNOMIAL: u32 = 0x82f6_3b78;

const TABLE: [u32; 256] = table();

const fn table() -> [u32; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut sum = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            sum = if sum & 1 == 1 { sum >> 1 ^ POLYNOMIAL } else { sum >> 1 };
            bit += 1;
        }
        table[byte] = sum;
        byte += 1;
    }
    table
}

/// The checksum of some bytes.
pub(super) fn crc32c(bytes: &[u8]) -> u32 {
    let step = |sum: u32, byte: &u8| sum >> 8 ^ TABLE[usize::from(sum as u8 ^ byte)];
    !bytes.iter().fold(!0, step)
}

/// The bytes before the checksum at their end, if it is theirs.
pub(super) fn checked(bytes: &[u8]) -> Result<&[u8], String> {
    let damaged = || "is damaged: its checksum is another's; fetch the file again".to_owned();
    let (body, sum) = bytes.split_last_chunk::<4>().ok_or_else(damaged)?;
    if u32::from_le_bytes(*sum) == crc32c(body) { Ok(body) } else { Err(damaged()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_standard() {
        assert_eq!(crc32c(b"123456789"), 0xe306_9283);
        assert_eq!(crc32c(&[0; 32]), 0x8a91_36aa);
        assert_eq!(crc32c(&[0xff; 32]), 0x62a8_ab43);
    }

    #[test]
    fn a_changed_byte_is_damage() {
        let mut bytes = [b"123456789".to_vec(), 0xe306_9283_u32.to_le_bytes().to_vec()].concat();
        assert_eq!(checked(&bytes).unwrap(), b"123456789");
        bytes[3] ^= 1;
        assert!(checked(&bytes).unwrap_err().contains("damaged"));
        assert!(checked(&[1, 2, 3]).is_err());
    }
}
