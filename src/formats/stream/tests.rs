//! Facts about streams: what they hold back, and what they tell apart.

use super::super::made::gzip;
use super::*;

#[test]
fn a_promise_that_the_file_cannot_back_fails_before_it_is_allocated() {
    let said = Stream::of(vec![0; 100]).array::<u64>(1 << 45).unwrap_err();
    assert!(said.contains("truncated"), "{said}");
    let said = Stream::of(gzip(&[0; 100])).inflated().array::<u64>(1 << 45).unwrap_err();
    assert!(said.contains("at the most"), "{said}");
}

#[test]
fn an_inflated_array_grows_to_what_was_promised_and_no_further() {
    let bytes: Vec<u8> = (0..3_000_001_u32).map(|i| (i % 251) as u8).collect();
    let mut stream = Stream::of(gzip(&bytes)).inflated();
    let read = stream.array::<u8>(bytes.len()).unwrap();
    assert_eq!(read, bytes);
    assert_eq!(read.capacity(), bytes.len());
    assert_eq!(stream.finish().unwrap(), None);
}

#[test]
fn inflated_data_that_are_short_long_or_damaged_are_told_apart() {
    let packed = gzip(&[7; 5000]);
    let mut short = Stream::of(packed.clone()).inflated();
    assert!(short.array::<u8>(5001).unwrap_err().contains("5000 were found"));
    let mut long = Stream::of(packed.clone()).inflated();
    long.array::<u8>(4999).unwrap();
    assert!(long.finish().unwrap_err().contains("inflates past its header"));
    let mut cut = Stream::of(packed[..packed.len() - 12].to_vec()).inflated();
    assert!(cut.array::<u8>(5000).unwrap_err().contains("truncated"));
    let mut wrong = packed;
    let last = wrong.len() - 6;
    wrong[last] ^= 1;
    let mut damaged = Stream::of(wrong).inflated();
    let end = damaged.array::<u8>(5000).and_then(|_| damaged.finish());
    assert!(end.unwrap_err().contains("damaged"));
}

#[test]
fn peeked_bytes_stay_in_the_stream() {
    let mut stream = Stream::of(b"abcdef".to_vec());
    assert_eq!(stream.peek(3).unwrap(), b"abc");
    assert_eq!(stream.peek(99).unwrap(), b"abcdef");
    assert_eq!(stream.block::<6>("it").unwrap(), *b"abcdef");
    assert_eq!(stream.finish().unwrap(), None);
}
