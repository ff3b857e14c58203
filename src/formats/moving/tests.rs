//! Clips read back by other decoders than those that wrote them, or byte by byte.

use std::io::Cursor;

use image::AnimationDecoder;
use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;

use super::*;

const CLIP: Movie = Movie { size: [40, 30], count: 3, rate: Rate { frames: 24, seconds: 1 } };

/// Smooth ramps of more than 256 colors over a black border; alpha on the left half.
fn frame(number: usize) -> Vec<u8> {
    let pixel = |at: usize| {
        let (x, y) = (at % 40, at / 40);
        if x < 2 || y < 2 {
            return [0; 4];
        }
        [(6 * x) as u8, (8 * y) as u8, (40 * number) as u8, if x < 20 { 128 } else { 255 }]
    };
    (0..1200).flat_map(pixel).collect()
}

fn written(name: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_clip(&path, &CLIP, &mut (0..3).map(|number| Ok(frame(number)))).unwrap();
    std::fs::read(&path).unwrap()
}

#[test]
fn an_apng_holds_every_frame_to_the_bit_and_its_delay() {
    let decoder = PngDecoder::new(Cursor::new(written("a.png"))).unwrap();
    assert!(decoder.is_apng().unwrap());
    let frames = decoder.apng().unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 3);
    for (number, found) in frames.iter().enumerate() {
        assert_eq!(found.buffer().as_raw(), &frame(number));
        assert_eq!(found.delay().numer_denom_ms(), (125, 3));
    }
}

#[test]
fn a_gif_shows_256_colors_a_frame_near_those_that_were_meant_and_an_even_background() {
    let decoder = GifDecoder::new(Cursor::new(written("a.gif"))).unwrap();
    let frames = decoder.into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 3);
    for (number, found) in frames.iter().enumerate() {
        let meant = opaque::over_black(&frame(number));
        let (mut squares, mut colors) = (0.0, std::collections::HashSet::new());
        for (pixel, meant) in found.buffer().pixels().zip(&meant) {
            let [shown @ .., alpha] = pixel.0;
            assert_eq!(alpha, 255);
            assert!(*meant != [0; 3] || shown == [0; 3], "the background is even");
            colors.insert(shown);
            squares += shown
                .iter()
                .zip(meant)
                .map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2))
                .sum::<f64>();
        }
        let rmse = (squares / 3600.0).sqrt();
        assert!(colors.len() <= 256 && rmse < 6.0, "{} colors, {rmse}", colors.len());
    }
}

#[test]
fn a_y4m_has_a_header_and_three_planes_a_frame() {
    let bytes = written("a.y4m");
    let header = b"YUV4MPEG2 W40 H30 F24:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    assert!(bytes.starts_with(header));
    assert_eq!(bytes.len(), header.len() + 3 * (6 + 3 * 1200));
    assert_eq!(bytes[header.len() + 6..][..2], [16, 16], "black above");
}

#[test]
fn a_frame_that_fails_leaves_no_file() {
    for name in ["a.png", "a.gif", "a.y4m"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        let mut frames = [Ok(frame(0)), Err(Error::Interrupted)].into_iter();
        let failed = write_clip(&path, &CLIP, &mut frames);
        assert!(matches!(failed, Err(Error::Interrupted)), "{failed:?}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}

#[test]
fn rates_are_whole_or_have_two_decimals_or_are_fractions() {
    let rate = |text| Rate::parse(text).map(|rate| (rate.frames, rate.seconds));
    assert_eq!(rate("24"), Ok((24, 1)));
    assert_eq!(rate("29.97"), Ok((2997, 100)));
    assert_eq!(rate("30000/1001"), Ok((30000, 1001)));
    assert_eq!(Rate::parse("30000/1001").unwrap().to_string(), "30000/1001");
    for text in ["", "0", "-24", "1001", "1/0", "nan", "24.123", "60001/1", "0.001"] {
        assert!(Rate::parse(text).is_err(), "{text}");
    }
}

#[test]
fn names_that_are_no_clips_are_told_those_that_are() {
    let error = moving_format(Path::new("a.avi")).unwrap_err().to_string();
    assert!(error.contains(".gif") && error.contains(".mp4"), "{error}");
}
