//! What `trade` found as a table of numbers, and as part of a page: the front as a plot, and its pictures.

use std::fmt::Write;

use super::html::{escaped, image, table};
use super::plot::Plot;
use super::trade_others::Other;
use super::trade_points::{Point, Trade, on_front, psnr_db, stated};
use super::trade_run::Shown;

/// Comma-separated numbers, a line a choice.
pub fn csv(trade: &Trade) -> String {
    let front = on_front(&trade.points);
    let mut text =
        "choice,front,ms,times,times_low,times_high,rays,samples,gel_bytes,psnr_db,max,rmse,ssim\n"
            .to_owned();
    for (at, p) in trade.points.iter().enumerate() {
        let [low, high] = p
            .times_within
            .map_or([const { String::new() }; 2], |ends| ends.map(|end| end.to_string()));
        let times = p.times;
        let _ = writeln!(
            text,
            "\"{}\",{},{},{times},{low},{high},{},{},{},{},{},{},{}",
            p.name,
            front.contains(&at),
            p.milliseconds,
            p.rays,
            p.samples,
            p.gel_bytes,
            p.psnr_db(),
            p.max,
            p.rmse,
            p.ssim
        );
    }
    text
}

/// What was found, as part of a page: the plot, the front's pictures, all choices; `others` are what other programs reach,
/// as milliseconds, decibels and their names.
pub fn body(trade: &Trade, shown: &[Shown], others: &[Other]) -> String {
    let front = on_front(&trade.points);
    let points: Vec<[f64; 2]> =
        trade.points.iter().map(|p| [p.milliseconds, p.psnr_db()]).collect();
    let axes = ["ms a frame", "PSNR, dB"];
    let mut body = format!(
        "<p>{scene}: {choices} choices of settings, {} × {} pixels, views: {}, threads: {}, gelray {}. Errors are against a ray at every position, a quarter of the sample distance and 32-bit texels; that reference is itself within {:.1} dB of one at an eighth. Times are of casting and resampling: the median of the scene's own settings, times the ratio that each choice has to them in runs in turn.</p>\n",
        trade.size[0],
        trade.size[1],
        trade.views,
        trade.threads,
        trade.version,
        psnr_db(trade.reference_rmse),
        scene = escaped(&trade.scene),
        choices = trade.points.len(),
    );
    body.push_str(&Plot { axes, points: &points, front: &front, others }.svg());
    body.push_str("<p class=\"quiet\">The ring is what the scene states; the line joins the choices that no other beats in both, numbered as below; what is at the upper edge equals the reference.</p>\n<h3>On the front</h3>\n<div class=\"figures\">\n");
    for (number, (at, pngs)) in (1..).zip(shown) {
        body.push_str(&figure(&trade.points[*at], number, pngs));
    }
    body.push_str("</div>\n<h3>All choices</h3>\n");
    body.push_str(&table(&rows(trade), &[]));
    body
}

fn rows(trade: &Trade) -> Vec<[String; 9]> {
    let heading =
        ["choice", "ms", "times", "rays", "samples", "gel, MB", "PSNR, dB", "max", "SSIM"];
    let row = |p: &Point| {
        [
            p.name.clone(),
            format!("{:.1}", p.milliseconds),
            format!("{:.2}", p.times),
            p.rays.to_string(),
            p.samples.to_string(),
            format!("{:.1}", p.gel_bytes as f64 / 1e6),
            decibels(p),
            format!("{:.4}", p.max),
            format!("{:.4}", p.ssim),
        ]
    };
    std::iter::once(heading.map(str::to_owned)).chain(trade.points.iter().map(row)).collect()
}

fn figure(p: &Point, number: u32, [picture, off]: &[Vec<u8>; 2]) -> String {
    let images = image(picture, &p.name) + &image(off, "where it is off");
    format!(
        "<figure><div class=\"two\">{images}</div><figcaption><b>{number}. {}</b>: {:.1} ms, {} dB; at most {:.4} off (white), in column {} of row {}.<br><code>{}</code></figcaption></figure>\n",
        escaped(&p.name),
        p.milliseconds,
        decibels(p),
        p.max,
        p.worst_at[0],
        p.worst_at[1],
        escaped(&stated(&p.sampling))
    )
}

fn decibels(p: &Point) -> String {
    let psnr = p.psnr_db();
    if psnr.is_finite() { format!("{psnr:.2}") } else { "∞".to_owned() }
}
