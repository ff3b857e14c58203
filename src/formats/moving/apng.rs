//! APNG: an animation that is a PNG; 8-bit sRGB with straight alpha, without end.

use std::io::Write;

use png::{BitDepth, BlendOp, ColorType, Encoder, SrgbRenderingIntent};

use super::format::{By, Frames, Movie, MovingFormat};
use crate::formats::whole::Failure;

/// Written only: read as a PNG, it is its first frame.
pub(crate) const FORMAT: MovingFormat =
    MovingFormat { name: "APNG", extensions: &["png", "apng"], made: By::Writer(write) };

/// Each frame whole, in place of the one before.
fn write(sink: &mut dyn Write, clip: &Movie, frames: Frames) -> Result<(), Failure> {
    let [width, height] = clip.size;
    let mut encoder = Encoder::new(sink, u32::try_from(width)?, u32::try_from(height)?);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    encoder.set_animated(u32::try_from(clip.count)?, 0)?;
    encoder.set_frame_delay(u16::try_from(clip.rate.seconds)?, u16::try_from(clip.rate.frames)?)?;
    encoder.set_blend_op(BlendOp::Source)?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(&frame?)?;
    }
    Ok(writer.finish()?)
}
