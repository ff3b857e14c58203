//! The report as one page: figures beside the paper's words, pairs to lay over each other, tables, and the trade.

use std::fmt::Write;

use super::html::{escaped, image, page, slider, table};
use super::noted::VERSION;
use super::profile_saved::Profile;
use super::profile_table;
use super::report_figures::{PAIRS, claim};
use super::report_parts::{Exact, Figure};

/// All that a report shows.
pub struct Report {
    /// Figures by the names of their scenes, and their titles.
    pub figures: Vec<(String, String, Figure)>,
    /// The first figure's scene with every ray cast.
    pub exact: Option<(Exact, Vec<u8>)>,
    /// What was found of the trade of the first figure's scene, of how cost grows and of extremes: the last part of the page.
    pub measured: String,
}

/// The page.
pub fn words(report: &Report) -> String {
    let threads = rayon::current_num_threads();
    let mut body = format!(
        "<p>What gelray {VERSION} makes of the scenes of Levoy's <cite>Rendering mixtures of geometric and volumetric data</cite> (TR88-052, 1988), on {threads} threads. Every number was measured in the run that wrote this page.</p>\n"
    );
    body.push_str("<h2>Figures</h2>\n<div class=\"figures\">\n");
    for (name, title, figure) in &report.figures {
        body.push_str(&shown(name, title, figure));
    }
    body.push_str("</div>\n");
    body.push_str(&pairs(report));
    if let Some((_, _, first)) = report.figures.first() {
        body.push_str(&stages(&first.profile));
        body.push_str(&numbers(report));
    }
    body.push_str(&report.measured);
    page("Volumes and polygons, after Levoy 1988", &body)
}

/// A figure, what the paper says of it, and what was measured.
fn shown(name: &str, title: &str, figure: &Figure) -> String {
    let quote = claim(name).map_or_else(String::new, |claim| {
        format!("<blockquote>“{}”</blockquote>", escaped(claim.quote))
    });
    let image = image(&figure.png, title);
    let mut said = measured(&figure.profile);
    let rays = claim(name).is_some_and(|claim| claim.shows_rays);
    if rays {
        said.push_str(" The dots are brightened for this page.");
    }
    let class = if rays { " class=\"rays\"" } else { "" };
    format!(
        "<figure id=\"{name}\"{class}>{image}<figcaption><b>{name}</b>: {}{quote}{}</figcaption></figure>\n",
        escaped(title),
        escaped(&said)
    )
}

/// What was measured of a figure, in a sentence or two.
fn measured(profile: &Profile) -> String {
    let find =
        |name: &str| profile.stages.iter().find(|stage| stage.name == name && stage.made > 0);
    let rays = find("cast").and_then(|cast| cast.counts.get("rays")).copied().unwrap_or(0);
    let [width, height] = profile.size;
    let mut said = format!(
        "Here: {width} × {height} pixels, {:.2} rays a pixel, {:.1} ms a frame, {:.2} s from the scene's file to the picture's",
        rays as f64 / (width * height) as f64,
        profile.frame.median * 1e3,
        profile.run.median
    );
    for (stage, what) in
        [("scan_convert", "to scan-convert a polygon"), ("light_sweep", "to sweep a light")]
    {
        if let Some(stage) = find(stage) {
            let _ = write!(said, "; {:.1} ms {what}", stage.median * 1e3 / stage.made as f64);
        }
    }
    said.push('.');
    if !profile.missing.is_empty() {
        let _ = write!(
            said,
            " {} was not found; what is made by formula stands in.",
            profile.missing.join(", ")
        );
    }
    said
}

/// Pairs of pictures to lay over each other.
fn pairs(report: &Report) -> String {
    let png = |name: &str| {
        let found = report.figures.iter().find(|(known, _, _)| known == name);
        found.map(|(_, _, figure)| &figure.png[..])
    };
    let mut html = String::new();
    for (names, what) in &PAIRS {
        if let [Some(left), Some(right)] = names.map(png) {
            let _ = write!(html, "<figure>{}", slider([left, right], *names));
            let [left, right] = names;
            let _ = writeln!(
                html,
                "<figcaption>{what}: {left} on the left, {right} on the right.</figcaption></figure>"
            );
        }
    }
    if let (Some((exact, png)), Some((name, _, first))) = (&report.exact, report.figures.first()) {
        let psnr = exact.psnr_db.map_or_else(|| "∞".to_owned(), |psnr| format!("{psnr:.1}"));
        let _ = writeln!(
            html,
            "<figure>{}<figcaption>{name} as stated on the left; with a ray at every position, never stopped, on the right. PSNR {psnr} dB, at most {:.3} off; {:.1} and {:.1} ms a frame.</figcaption></figure>",
            slider([&first.png, png], ["as stated", "every ray"]),
            exact.max,
            first.profile.frame.median * 1e3,
            exact.seconds * 1e3
        );
    }
    if html.is_empty() {
        return html;
    }
    format!(
        "<h2>Side by side</h2>\n<p class=\"quiet\">Drag the edge.</p>\n<div class=\"figures\">\n{html}</div>\n"
    )
}

/// The cost table of §7.
fn stages(profile: &Profile) -> String {
    let runs = profile.run.seconds.len();
    format!(
        "<h2>Where the time goes</h2>\n<p>{}: medians over whole runs ({runs}), from the scene's file to the bytes of the picture's, by the spans of the stages. The last column is the paper's §7.</p>\n{}",
        escaped(&profile.scene),
        table(&profile_table::rows(profile), &[2, 6, 8])
    )
}

/// The paper's numbers, each of the first figure that has what it is of.
fn numbers(report: &Report) -> String {
    let heading = ["", "ours", "in 19 of 20 cases", "the paper", "measured of"].map(str::to_owned);
    let mut rows = vec![heading];
    let all = || {
        report.figures.iter().flat_map(|(name, _, figure)| {
            figure.profile.numbers.iter().map(move |number| (name, number))
        })
    };
    for (name, number) in all().filter(|(_, number)| number.ours.is_some()) {
        let [what, ours, within, paper] = profile_table::number(number);
        rows.push([what, ours, within, paper, name.clone()]);
    }
    format!("<h2>The paper's numbers</h2>\n{}", table(&rows, &[3, 4]))
}
