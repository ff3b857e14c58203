//! What formats without alpha show: the frame over black, mixed in linear light.

use crate::components::color::{to_linear, to_srgb};

/// The sRGB codes of a frame of straight RGBA codes over black.
pub(crate) fn over_black(frame: &[u8]) -> Vec<[u8; 3]> {
    let linear: Vec<f32> = (0..=255_u8).map(|code| to_linear(f32::from(code) / 255.0)).collect();
    let seen = |&[r, g, b, alpha]: &[u8; 4]| match alpha {
        255 => [r, g, b],
        0 => [0; 3],
        _ => [r, g, b].map(|code| {
            let light = linear[usize::from(code)] * (f32::from(alpha) / 255.0);
            (to_srgb(light) * 255.0).round() as u8
        }),
    };
    frame.as_chunks::<4>().0.iter().map(seen).collect()
}
