//! What lines of an OBJ and of its materials have in common: a word that says what follows, and colors of three numbers.

use crate::components::Color;

/// What follows the first word of a line, which may have blanks in it.
pub(super) fn argument(line: &str) -> &str {
    line.trim().split_once(char::is_whitespace).map_or("", |(_, rest)| rest.trim())
}

/// The color of sRGB channels that are 0..=1.
pub(super) fn color_of(channels: [f64; 3]) -> Color {
    Color::from_srgb(channels.map(|channel| (channel as f32).clamp(0.0, 1.0)))
}
