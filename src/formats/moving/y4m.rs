//! YUV4MPEG2: uncompressed video for pipes; every program that makes or plays videos reads it.
//!
//! ITU-R BT.709 in 8 bits of limited range with a chroma sample a pixel: whoever reads it may halve them, nothing is lost here.

use std::io::Write;

use super::format::{By, Frames, Movie, MovingFormat};
use super::opaque::over_black;
use crate::formats::whole::Failure;

/// Written only.
pub(crate) const FORMAT: MovingFormat =
    MovingFormat { name: "YUV4MPEG2", extensions: &["y4m"], made: By::Writer(write) };

/// A header, then each frame over black as three planes.
pub fn write(sink: &mut dyn Write, clip: &Movie, frames: Frames) -> Result<(), Failure> {
    let ([width, height], rate) = (clip.size, clip.rate);
    let (frames_, seconds) = (rate.frames, rate.seconds);
    writeln!(
        sink,
        "YUV4MPEG2 W{width} H{height} F{frames_}:{seconds} Ip A1:1 C444 XCOLORRANGE=LIMITED"
    )?;
    for frame in frames {
        let pixels: Vec<[u8; 3]> = over_black(&frame?).into_iter().map(to_ycbcr).collect();
        sink.write_all(b"FRAME\n")?;
        for plane in 0..3 {
            let plane: Vec<u8> = pixels.iter().map(|pixel| pixel[plane]).collect();
            sink.write_all(&plane)?;
        }
    }
    Ok(sink.flush()?)
}

/// Y', C_B and C_R of BT.709 (items 3.2 to 3.5) in limited range, rounded to nearest.
fn to_ycbcr(rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|code| f32::from(code) / 255.0);
    let luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let (blue, red) = ((b - luma) / 1.8556, (r - luma) / 1.5748);
    [219.0 * luma + 16.0, 224.0 * blue + 128.0, 224.0 * red + 128.0].map(|code| code.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::to_ycbcr;

    #[test]
    fn codes_are_those_of_the_standards_color_bars() {
        let bars = [
            ([255, 255, 255], [235, 128, 128]),
            ([0, 0, 0], [16, 128, 128]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 255, 0], [173, 42, 26]),
            ([0, 0, 255], [32, 240, 118]),
        ];
        for (rgb, expected) in bars {
            assert_eq!(to_ycbcr(rgb), expected);
        }
    }
}
