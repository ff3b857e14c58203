//! The pixels of a slice as whole numbers, out of native, run-length or JPEG packing.

use super::super::number::Order;
use super::super::stream::room;
use super::elements::{Elements, Pixels, long, short};
use super::slice::{Packing, Slice};

/// The stored numbers of a slice, row by row, before its slope and intercept.
pub(super) fn stored(
    slice: &Slice,
    elements: &mut Elements,
    pixels: Pixels,
) -> Result<Vec<i32>, String> {
    let count = usize::from(slice.size[0]) * usize::from(slice.size[1]);
    let each = usize::from(slice.bits_allocated / 8);
    let (bytes, order) = match (slice.packing, pixels) {
        (Packing::Native, Pixels::Native(length)) => {
            if u64::from(length) < (count * each) as u64 {
                return Err(format!(
                    "its pixels are {length} bytes where its size needs {}; fetch the file again",
                    count * each
                ));
            }
            (elements.stream.array::<u8>(count * each)?, slice.order)
        }
        (Packing::Runs, Pixels::Packed) => (runs(&elements.fragments()?, count, each)?, Order::Big),
        (Packing::Jpeg, Pixels::Packed) => return jpeg(slice, &elements.fragments()?, count),
        _ => {
            return Err(
                "its pixels are not packed as its transfer syntax says; fetch the file again"
                    .to_owned(),
            );
        }
    };
    let number = |bytes: &[u8]| match each {
        1 => u32::from(bytes[0]),
        2 => u32::from(short(bytes, order)),
        _ => long(bytes, order),
    };
    Ok(bytes.chunks_exact(each).map(|bytes| taken(slice, number(bytes))).collect())
}

/// The bits that a number is stored in, with its sign.
fn taken(slice: &Slice, number: u32) -> i32 {
    let bits = u32::from(slice.bits_stored);
    let low = u32::from(slice.high_bit) + 1 - bits;
    let up = 32 - bits;
    let number = number >> low << up;
    if slice.signed { number as i32 >> up } else { (number >> up) as i32 }
}

/// The planes of bytes of a run-length picture, from the most significant on, as numbers of that order.
fn runs(bytes: &[u8], count: usize, each: usize) -> Result<Vec<u8>, String> {
    let damaged = || "its run lengths are damaged; fetch the file again".to_owned();
    let header: &[u8; 64] = bytes.first_chunk().ok_or_else(damaged)?;
    let word = |at: usize| long(&header[4 * at..], Order::Little) as usize;
    if word(0) != each {
        return Err(damaged());
    }
    let mut numbers = Vec::new();
    room(&mut numbers, count * each)?;
    numbers.resize(count * each, 0);
    for plane in 0..each {
        let from = word(plane + 1);
        let to = if plane + 1 < each { word(plane + 2) } else { bytes.len() };
        let packed = bytes.get(from..to).ok_or_else(damaged)?;
        unpack(packed, numbers.iter_mut().skip(plane).step_by(each)).ok_or_else(damaged)?;
    }
    Ok(numbers)
}

/// Unpacks runs until all places are filled; `None` where the bytes end before.
fn unpack<'n>(packed: &[u8], mut places: impl Iterator<Item = &'n mut u8>) -> Option<()> {
    let mut packed = packed.iter().copied();
    let mut next = places.next();
    while next.is_some() {
        let control = packed.next()?;
        let (length, repeated) = match control {
            0..=127 => (usize::from(control) + 1, None),
            128 => continue,
            129.. => (257 - usize::from(control), Some(packed.next()?)),
        };
        for _ in 0..length {
            let byte = match repeated {
                Some(byte) => byte,
                None => packed.next()?,
            };
            // What is beyond the last pixel is padding.
            let Some(place) = next else { break };
            *place = byte;
            next = places.next();
        }
    }
    Some(())
}

fn jpeg(slice: &Slice, bytes: &[u8], count: usize) -> Result<Vec<i32>, String> {
    let wrong = |error: &dyn std::fmt::Display| {
        format!(
            "its JPEG cannot be unpacked ({error}); unpack the series with dcmdjpeg or gdcmconv --raw"
        )
    };
    let mut decoder = jpeg_decoder::Decoder::new(bytes);
    decoder.read_info().map_err(|error| wrong(&error))?;
    let info = decoder.info().ok_or_else(|| wrong(&"it has no header"))?;
    if [info.width, info.height] != slice.size {
        return Err(wrong(&"its size is not that of the slice"));
    }
    let decoded = decoder.decode().map_err(|error| wrong(&error))?;
    let numbers: Vec<u32> = match info.pixel_format {
        jpeg_decoder::PixelFormat::L8 => decoded.into_iter().map(u32::from).collect(),
        jpeg_decoder::PixelFormat::L16 => {
            let number = |pair: &[u8]| u32::from(u16::from_ne_bytes([pair[0], pair[1]]));
            decoded.chunks_exact(2).map(number).collect()
        }
        _ => return Err(wrong(&"it has colors")),
    };
    if numbers.len() != count {
        return Err(wrong(&"it is cut short"));
    }
    Ok(numbers.into_iter().map(|number| taken(slice, number)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_literal_or_repeated_and_padding_is_left_out() {
        let mut places = [0_u8; 6];
        unpack(&[1, 7, 8, 254, 9, 0, 5, 0, 0], places.iter_mut()).unwrap();
        assert_eq!(places, [7, 8, 9, 9, 9, 5]);
        assert_eq!(unpack(&[1, 7], [0_u8; 2].iter_mut()), None);
        assert_eq!(unpack(&[129, 7], [0_u8; 200].iter_mut()), None);
    }

    #[test]
    fn planes_of_bytes_become_numbers() {
        let mut header = [0_u8; 64];
        header[..12].copy_from_slice(&[2, 0, 0, 0, 64, 0, 0, 0, 66, 0, 0, 0]);
        let bytes = [&header[..], &[255, 1], &[1, 2, 3]].concat();
        assert_eq!(runs(&bytes, 2, 2).unwrap(), [1, 2, 1, 3]);
        assert!(runs(&bytes[..65], 2, 2).is_err());
        assert!(runs(&bytes, 2, 1).is_err());
    }
}
