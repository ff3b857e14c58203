//! Where furniture stands in a picture: each corner is filled from its edge towards the middle.

use glam::Vec2;

use crate::components::{Callout, Color, Corner, Legend, ScaleBar, Title};
use crate::view::axes::round;
use crate::view::lettering::{Line, set};
use crate::view::overlay::{Canvas, rim_of};

/// A picture being furnished.
pub(crate) struct Sheet {
    /// What is drawn on.
    pub canvas: Canvas,
    /// Pixels across and down.
    pub size: [f32; 2],
    /// How far each corner is filled, pixels.
    filled: [f32; 4],
    /// What is taken by something: its least and greatest corner, pixels.
    taken: Vec<[Vec2; 2]>,
}

impl Sheet {
    /// An empty picture of so many pixels across and down, before a color if there is one.
    pub fn new(size: [usize; 2], background: Option<Color>) -> Self {
        let canvas = Canvas::new(size, background.map(|color| color.0));
        let size = size.map(|n| n as f32);
        let margin = size[1] * 0.03;
        Self { canvas, size, filled: [margin; 4], taken: Vec::new() }
    }

    /// The height of letters, as stated or else a part of the picture's height.
    pub fn letters(&self, stated: Option<f32>, part: f32) -> f32 {
        stated.unwrap_or((self.size[1] * part).clamp(8.0, 400.0))
    }

    /// The place for something of `width` by `height` pixels in a corner: its top left. The place is then taken.
    pub fn place(&mut self, corner: Corner, [width, height]: [f32; 2]) -> [f32; 2] {
        let filled = &mut self.filled[corner as usize];
        let margin = self.size[1] * 0.03;
        let y = match corner {
            Corner::TopLeft | Corner::TopRight => *filled,
            Corner::BottomLeft | Corner::BottomRight => self.size[1] - *filled - height,
        };
        *filled += height + margin / 2.0;
        let x = match corner {
            Corner::TopLeft | Corner::BottomLeft => margin,
            Corner::TopRight | Corner::BottomRight => self.size[0] - margin - width,
        };
        self.take([x.round(), y.round()].into(), [width, height].into());
        [x.round(), y.round()]
    }

    /// Keeps others from a place.
    pub fn take(&mut self, corner: Vec2, size: Vec2) {
        self.taken.push([corner, corner + size]);
    }

    /// Whether something of that size, with its top left at `corner`, is in the picture and on nothing else.
    pub fn is_free(&self, corner: Vec2, size: Vec2) -> bool {
        let high = corner + size;
        let inside = corner.cmpge(Vec2::ZERO).all() && high.cmple(self.size.into()).all();
        let apart = |own: &[Vec2; 2]| corner.cmpgt(own[1]).any() || high.cmplt(own[0]).any();
        inside && self.taken.iter().all(apart)
    }

    /// A title in the middle of the top; what else stands at the top stands below it.
    pub fn title(&mut self, title: &Title) {
        let line = set(&title.text, self.letters(title.letters_pixels, 0.05));
        let filled = self.filled[0].max(self.filled[1]);
        let at = [((self.size[0] - line.width) / 2.0).round(), filled.round()];
        self.canvas.text(&line, at, title.color.0);
        self.take(at.into(), [line.width, line.height].into());
        self.filled[0] = filled + line.height * 1.2;
        self.filled[1] = self.filled[0];
    }

    /// A bar with its length over it; a pixel is `pixel` world units wide.
    pub fn scale_bar(&mut self, bar: &ScaleBar, pixel: f64) {
        let length = bar.length_mm.unwrap_or_else(|| round(f64::from(self.size[0]) * pixel / 4.0));
        let pixels = (length / pixel) as f32;
        let letters = self.letters(bar.letters_pixels, 1.0 / 30.0);
        let line = set(&format!("{length} {}", bar.unit), letters);
        let (width, thick) = (line.width.max(pixels), (letters / 5.0).max(2.0).round());
        let [x, y] = self.place(bar.corner, [width, line.height * 1.1 + thick]);
        let color = bar.color.0;
        self.canvas.text(&line, [x + ((width - line.width) / 2.0).round(), y], color);
        let (left, top) = (x + (width - pixels) / 2.0, (y + line.height * 1.1).round());
        self.canvas.rectangle([left, top], [left + pixels, top + thick], color);
    }

    /// A bar of colors with the values at its ends, and a line for each entry.
    pub fn legend(&mut self, legend: &Legend, colors: &[(f32, Color)]) {
        let letters = self.letters(legend.letters_pixels, 1.0 / 30.0);
        if let (Some(first), Some(last)) = (colors.first(), colors.last()) {
            self.color_bar(legend, letters, (first.0, last.0), colors);
        }
        let lines: Vec<Line> = legend.entries.iter().map(|e| set(&e.text, letters)).collect();
        if lines.is_empty() {
            return;
        }
        let widest = lines.iter().map(|line| line.width).fold(0.0, f32::max);
        let (pitch, patch) = (letters * 1.35, letters * 0.8);
        let [x, y] =
            self.place(legend.corner, [widest + 1.4 * letters, pitch * lines.len() as f32]);
        for (at, (line, entry)) in lines.iter().zip(&legend.entries).enumerate() {
            let y = (y + pitch * at as f32).round();
            let top = y + (line.height - patch) / 2.0;
            self.canvas.rectangle([x, top], [x + patch, top + patch], entry.color.0);
            self.canvas.text(line, [x + 1.4 * letters, y], legend.color.0);
        }
    }

    fn color_bar(
        &mut self,
        legend: &Legend,
        letters: f32,
        (low, high): (f32, f32),
        colors: &[(f32, Color)],
    ) {
        let ends = [high, low].map(|value| set(&rounded(value, high - low), letters));
        let (height, thick) = (letters * 7.0, letters * 0.9);
        let widest = ends[0].width.max(ends[1].width);
        let [x, y] = self.place(legend.corner, [thick + letters * 0.5 + widest, height]);
        for row in 0..height as usize {
            let value = high + (low - high) * ((row as f32 + 0.5) / height);
            let top = y + row as f32;
            self.canvas.rectangle([x, top], [x + thick, top + 1.0], at(colors, value).0);
        }
        let beside = x + thick + letters * 0.5;
        self.canvas.text(&ends[0], [beside, y], legend.color.0);
        self.canvas.text(&ends[1], [beside, y + height - ends[1].height], legend.color.0);
    }

    /// The text of a callout beside the window position where its line begins, on the side away from the line; where the line begins
    /// in the picture, the text does not stick out of it.
    pub fn callout(&mut self, callout: &Callout, is_left: bool, from: Vec2) {
        let letters = self.letters(callout.letters_pixels, 1.0 / 30.0);
        let line = set(&callout.text, letters);
        let gap = letters * 0.3;
        let x = if is_left { from.x - gap - line.width } else { from.x + gap };
        let at = Vec2::new(x, from.y - line.height / 2.0);
        let own = Vec2::new(line.width, line.height);
        let at = if self.holds(from) { self.within(at, own, rim_of(&line)) } else { at }.round();
        self.canvas.label(&line, at.to_array(), callout.color.0);
        self.take(at, own);
    }

    /// Whether a window position is in the picture.
    fn holds(&self, at: Vec2) -> bool {
        at.cmpge(Vec2::ZERO).all() && at.cmple(self.size.into()).all()
    }

    /// The top left nearest to `corner` of something of that size that lies within the picture, `margin` from its borders; what is
    /// too large begins at the left or the top.
    fn within(&self, corner: Vec2, own: Vec2, margin: f32) -> Vec2 {
        let last = Vec2::from(self.size) - own - margin;
        corner.min(last.floor()).max(Vec2::splat(margin.ceil()))
    }
}

/// A number as it is written beside a tick.
pub(crate) fn short(value: f64) -> String {
    let text = format!("{:.6}", value + 0.0);
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "−")
}

/// A value in digits enough to tell apart what lies `span` away.
fn rounded(value: f32, span: f32) -> String {
    let digits = (2.0 - span.abs().max(1e-30).log10().floor()).clamp(0.0, 8.0);
    let text = format!("{value:.*}", digits as usize);
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}

/// The color of a value among rising ones, linear in between.
fn at(colors: &[(f32, Color)], value: f32) -> Color {
    let behind = colors.partition_point(|(at, _)| *at < value).clamp(1, colors.len() - 1);
    let ((low, first), (high, last)) = (colors[behind - 1], colors[behind]);
    let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
    Color(first.0.lerp(last.0, if part.is_nan() { 0.0 } else { part }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_short() {
        assert_eq!([short(-20.0), short(0.25), short(-0.0)], ["−20", "0.25", "0"]);
        assert_eq!([rounded(-160.0, 400.0), rounded(0.25, 0.5)], ["−160", "0.25"]);
    }

    #[test]
    fn the_text_of_a_callout_whose_line_begins_in_the_picture_is_in_it_too() {
        let callout = |from: [f32; 2]| {
            let mut sheet = Sheet::new([200, 100], None);
            let text = "suture".to_owned();
            let callout = Callout {
                text,
                at: [0.0; 3],
                from: [1.0; 3],
                color: Color::WHITE,
                width_mm: None,
                letters_pixels: Some(20.0),
            };
            sheet.callout(&callout, false, from.into());
            sheet.taken[0]
        };
        let size = Vec2::new(200.0, 100.0);
        let place = |[low, _]: [Vec2; 2]| low;
        assert_eq!(
            place(callout([20.0, 50.0])),
            Vec2::new(26.0, 40.0),
            "where there is room it is beside its line"
        );
        for from in [[199.0, 50.0], [150.0, 1.0], [1.0, 99.0]] {
            let [low, high] = callout(from);
            assert!(low.cmpge(Vec2::ONE).all() && high.cmple(size - 1.0).all(), "{low} {high}");
        }
        assert!(
            callout([230.0, 50.0])[0].x > 200.0,
            "what is not in the picture is not drawn into it"
        );
    }

    #[test]
    fn what_stands_in_one_corner_stands_apart() {
        let mut layout = Sheet::new([200, 100], None);
        let first = layout.place(Corner::BottomRight, [50.0, 20.0]);
        let second = layout.place(Corner::BottomRight, [30.0, 10.0]);
        assert_eq!(first, [147.0, 77.0]);
        assert!(second[1] + 10.0 < first[1] && second[0] == 167.0);
    }
}
