//! Letters: lines of text as how much of each pixel they cover, in the embedded font (a subset of DejaVu Sans).

use ab_glyph::{Font, FontRef, GlyphId, Point, PxScale, ScaleFont, point};

/// Latin, Greek, and signs of units. Its license stands beside it.
static FONT: &[u8] = include_bytes!("dejavu_sans_subset.ttf");

/// A line of text, set.
pub struct Line {
    glyphs: Vec<(GlyphId, Point)>,
    scale: PxScale,
    /// Pixels across.
    pub width: f32,
    /// Pixels from the top of the highest letters to the bottom of the lowest.
    pub height: f32,
}

/// Sets `text` in letters of `height` pixels; a sign that the font lacks is a box. Control characters are blanks.
#[must_use]
pub fn set(text: &str, height: f32) -> Line {
    let scale = PxScale::from(height);
    let Ok(font) = FontRef::try_from_slice(FONT) else {
        return Line { glyphs: Vec::new(), scale, width: 0.0, height };
    };
    let scaled = font.as_scaled(scale);
    let (mut glyphs, mut x, mut last) = (Vec::new(), 0.0, None);
    for letter in text.chars() {
        let id = font.glyph_id(if letter.is_control() { ' ' } else { letter });
        x += last.map_or(0.0, |last| scaled.kern(last, id));
        glyphs.push((id, point(x, scaled.ascent())));
        x += scaled.h_advance(id);
        last = Some(id);
    }
    Line { glyphs, scale, width: x, height: scaled.height() }
}

impl Line {
    /// Calls `cover` with each pixel that the line covers some part of, 0..=1, where its top left corner is at `(x, y)` pixels.
    pub fn draw(&self, [x, y]: [f32; 2], mut cover: impl FnMut([i64; 2], f32)) {
        let Ok(font) = FontRef::try_from_slice(FONT) else { return };
        for (id, at) in &self.glyphs {
            let glyph = id.with_scale_and_position(self.scale, point(at.x + x, at.y + y));
            let Some(outline) = font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, part| {
                let pixel = [corner.x as i64 + i64::from(dx), corner.y as i64 + i64::from(dy)];
                cover(pixel, part.clamp(0.0, 1.0));
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(text: &str, height: f32, at: [f32; 2]) -> f32 {
        let mut sum = 0.0;
        set(text, height).draw(at, |_, part| sum += part);
        sum
    }

    #[test]
    fn letters_cover_an_area_that_grows_with_their_height_squared_wherever_they_stand() {
        let [small, large] = [20.0, 40.0].map(|height| covered("Åµ3 mm", height, [5.0, 7.0]));
        assert!(small > 50.0 && (large / small - 4.0).abs() < 0.05, "{small} {large}");
        let moved = covered("Åµ3 mm", 20.0, [5.4, 7.3]);
        assert!((moved / small - 1.0).abs() < 0.02);
        assert_eq!(covered(" \n\t", 20.0, [0.0; 2]), 0.0);
    }

    #[test]
    fn a_longer_line_is_wider_and_the_font_has_the_signs_of_units() {
        assert!(set("10 mm", 20.0).width > set("1 mm", 20.0).width);
        let font = FontRef::try_from_slice(FONT).unwrap();
        assert!("Åµ°²³±×−αβσΔ".chars().all(|letter| font.glyph_id(letter).0 != 0));
    }
}
