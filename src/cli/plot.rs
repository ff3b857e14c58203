//! Plots as SVG within a page: what each choice costs against what it buys.
//!
//! Colors are numbers that the page's style replaces by its own, so that a plot is read in the dark too.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::html::escaped;

const SIZE: (u32, u32) = (860, 440);
const INK: RGBColor = RGBColor(1, 1, 1);
const LINE: RGBColor = RGBColor(2, 2, 2);
const DOT: RGBColor = RGBColor(3, 3, 3);
const FRONT: RGBColor = RGBColor(4, 4, 4);
const QUIET: RGBColor = RGBColor(5, 5, 5);

/// Choices by cost and worth, and those of others beside them.
pub struct Plot<'a> {
    /// What is along the axis of cost, a logarithmic one, and along that of worth.
    pub axes: [&'a str; 2],
    /// Cost, above 0, and worth of each choice.
    pub points: &'a [[f64; 2]],
    /// Which of them lie on the front, from the cheapest on: they are numbered from 1 and joined.
    pub front: &'a [usize],
    /// Cost, worth and name of what others reach.
    pub others: &'a [(f64, f64, String)],
}

impl Plot<'_> {
    /// The plot; empty where nothing can be drawn. What is worth infinitely much lies at the upper edge.
    pub fn svg(&self) -> String {
        let mut text = String::new();
        let drawn = self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area());
        if drawn.is_none() {
            return String::new();
        }
        // Within a page the element needs no name of its language.
        let end = text.find('>').unwrap_or(0);
        let [x, y] = self.axes.map(escaped);
        let (width, height) = SIZE;
        let open = format!(
            "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{y} against {x}\""
        );
        format!("<div class=\"wide\">{open}{}</div>\n", &text[end..])
    }

    fn draw(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Option<()> {
        let all = || self.points.iter().copied().chain(self.others.iter().map(|o| [o.0, o.1]));
        let finite = || all().map(|p| p[1]).filter(|y| y.is_finite());
        let (least, most) = (finite().fold(f64::MAX, f64::min), finite().fold(f64::MIN, f64::max));
        let (first, last) =
            all().map(|p| p[0]).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        if !(first > 0.0 && last.is_finite() && least <= most) {
            return None;
        }
        let edge = most + ((most - least) * 0.08).max(1.0);
        let bottom = least - ((most - least) * 0.05).max(1.0);
        let mut chart = ChartBuilder::on(area)
            .margin(14)
            .x_label_area_size(42)
            .y_label_area_size(54)
            .build_cartesian_2d((first / 1.15..last * 1.15).log_scale(), bottom..edge)
            .ok()?;
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(self.axes[0]).y_desc(self.axes[1]).axis_style(INK);
        mesh.label_style(("sans-serif", 14).into_font().color(&INK));
        mesh.light_line_style(TRANSPARENT).bold_line_style(LINE);
        mesh.x_label_formatter(&|x| short(*x)).y_label_formatter(&|y| short(*y));
        mesh.draw().ok()?;
        let place = |[x, y]: [f64; 2]| (x, y.min(edge));
        let line = self.front.iter().map(|&at| place(self.points[at]));
        chart.draw_series(LineSeries::new(line, FRONT.stroke_width(2))).ok()?;
        let dots = self.points.iter().map(|p| Circle::new(place(*p), 4, DOT.filled()));
        chart.draw_series(dots).ok()?;
        let numbered = self.front.iter().zip(1..).map(|(&at, number): (_, u32)| {
            let (dot, below) = (Circle::new((0, 0), 5, FRONT.filled()), (7, 4));
            let name =
                Text::new(number.to_string(), below, ("sans-serif", 13).into_font().color(&INK));
            EmptyElement::at(place(self.points[at])) + dot + name
        });
        chart.draw_series(numbered).ok()?;
        let others = self.others.iter().map(|(x, y, name)| {
            let text = Text::new(name.clone(), (8, -6), ("sans-serif", 13).into_font().color(&INK));
            EmptyElement::at(place([*x, *y]))
                + TriangleMarker::new((0, 0), 7, QUIET.filled())
                + text
        });
        chart.draw_series(others).ok()?;
        // The scene's own settings come first.
        let own = self.points.first().map(|p| Circle::new(place(*p), 9, INK.stroke_width(2)));
        chart.draw_series(own).ok()?;
        area.present().ok()
    }
}

/// A number of an axis, without zeros that say nothing.
fn short(number: f64) -> String {
    let digits = if number.abs() >= 10.0 { 0 } else { 2 };
    let text = format!("{number:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_draws_every_choice_and_names_no_address() {
        let points = [[10.0, 40.0], [1.0, 20.0], [30.0, f64::INFINITY]];
        let others = [(5.0, 35.0, "peer <1>".to_owned())];
        let axes = ["ms a frame", "PSNR, dB"];
        let svg = Plot { axes, points: &points, front: &[1, 0, 2], others: &others }.svg();
        assert_eq!(svg.matches("<circle").count(), 3 + 3 + 1, "{svg}");
        assert!(
            !svg.contains("http") && svg.contains("PSNR, dB") && svg.contains("peer &lt;1&gt;")
        );
        assert!(Plot { axes, points: &[], front: &[], others: &[] }.svg().is_empty());
        let still = Plot { axes, points: &[[2.0, f64::INFINITY]], front: &[0], others: &[] };
        assert!(still.svg().is_empty());
    }

    #[test]
    fn numbers_of_axes_are_short() {
        assert_eq!([0.25, 2.0, 9.5, 10.0, 120.0].map(short), ["0.25", "2", "9.5", "10", "120"]);
    }
}
