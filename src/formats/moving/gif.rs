//! GIF: 256 colors a frame, the best that there are, dithered in a pattern that stays where it is; over black, without end.

use std::io::Write;

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, RgbaImage};

use super::dither::dithered;
use super::format::{By, Frames, Movie, MovingFormat, Rate};
use super::opaque::over_black;
use super::palette::{palette, points};
use crate::formats::whole::Failure;

/// Written only.
pub(crate) const FORMAT: MovingFormat =
    MovingFormat { name: "GIF", extensions: &["gif"], made: By::Writer(write) };

fn write(sink: &mut dyn Write, clip: &Movie, frames: Frames) -> Result<(), Failure> {
    let [width, height] = clip.size;
    if width > usize::from(u16::MAX) || height > usize::from(u16::MAX) {
        return Err("a GIF has at most 65535 pixels a side".into());
    }
    // Frames come with 256 colors at the most, which the encoder keeps as they are.
    let mut encoder = GifEncoder::new_with_speed(sink, 30);
    encoder.set_repeat(Repeat::Infinite)?;
    for (number, frame) in frames.enumerate() {
        let pixels = over_black(&frame?);
        let palette = palette(&pixels);
        let places = dithered(&pixels, width, &points(&palette));
        let shown = places.into_iter().flat_map(|place| {
            let [r, g, b] = palette[place];
            [r, g, b, 255]
        });
        let image = RgbaImage::from_raw(width as u32, height as u32, shown.collect());
        let image = image.ok_or("a frame has another size than the clip")?;
        let delay = Delay::from_numer_denom_ms(10 * delay(clip.rate, number), 1);
        encoder.encode_frame(Frame::from_parts(image, 0, 0, delay))?;
    }
    Ok(())
}

/// How long a frame is shown, in hundredths of a second: whole ones, so that all together keep the rate. No player shows
/// a frame for less than two.
fn delay(rate: Rate, number: usize) -> u32 {
    let end = |count: usize| {
        let hundredths = 100 * count as u64 * u64::from(rate.seconds);
        (hundredths + u64::from(rate.frames) / 2) / u64::from(rate.frames)
    };
    ((end(number + 1) - end(number)) as u32).max(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_keep_the_rate_however_long_the_clip() {
        let rate = Rate { frames: 24, seconds: 1 };
        assert_eq!((0..240).map(|number| delay(rate, number)).sum::<u32>(), 1000);
        assert!((0..240).all(|number| [4, 5].contains(&delay(rate, number))));
        assert_eq!(delay(Rate { frames: 1000, seconds: 1 }, 5), 2);
    }
}
