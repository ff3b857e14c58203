//! What `trade` found as a table of numbers and as a page that needs no network: the front as a plot, and its pictures.

use std::fmt::Write;

use super::trade_points::{Point, Trade, on_front, psnr_db, stated};

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

const STYLE: &str = "
:root { color-scheme: light dark; --ink: #1a1a1a; --paper: #fff; --faint: #8888; --dot: #2b6cb0; --front: #c05621 }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e8e8; --paper: #151515; --dot: #63b3ed; --front: #f6ad55 } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); max-width: 60rem; margin: auto; padding: 1rem }
svg { width: 100%; height: auto } svg text { fill: var(--ink); font-size: 12px } .table { overflow-x: auto }
table { border-collapse: collapse; font-variant-numeric: tabular-nums } td, th { padding: .15rem .6rem; text-align: right; white-space: nowrap }
td:first-child, th:first-child { text-align: left } tr.front { font-weight: 600 } code { overflow-wrap: anywhere }
figure { display: inline-block; margin: .5rem .5rem 1rem 0; max-width: 100%; vertical-align: top } figure img { width: 15rem; max-width: 46%; background: #000 }
figcaption { max-width: 31rem; font-size: 14px }";

/// The page.
pub fn page(trade: &Trade) -> String {
    let front = on_front(&trade.points);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>{name}: the trade</title><style>{STYLE}</style></head><body>\n<h1>{name}: speed against accuracy</h1>\n<p>{choices} choices of settings, {} × {} pixels, {} views, {} threads, gelray {}. Errors are against a ray at every position, a quarter of the sample distance and 32-bit texels; that reference is itself within {:.1} dB of one at an eighth. Times are of casting and resampling: the median of the scene's own settings, times the ratio that each choice has to them in runs in turn.</p>\n",
        trade.size[0],
        trade.size[1],
        trade.views,
        trade.threads,
        trade.version,
        psnr_db(trade.reference_rmse),
        name = escaped(&trade.scene),
        choices = trade.points.len(),
    );
    page.push_str(&plot(&trade.points, &front));
    page.push_str("<h2>On the front</h2>\n");
    for &at in &front {
        page.push_str(&figure(&trade.points[at], at));
    }
    page.push_str("<h2>All choices</h2>\n<div class=\"table\"><table><tr><th>choice</th><th>ms</th><th>times</th><th>rays</th><th>samples</th><th>gel, MB</th><th>PSNR</th><th>max</th><th>SSIM</th></tr>\n");
    for (at, point) in trade.points.iter().enumerate() {
        page.push_str(&row(point, front.contains(&at)));
    }
    page.push_str("</table></div>\n</body></html>\n");
    page
}

fn row(p: &Point, is_front: bool) -> String {
    format!(
        "<tr{}><td>{}</td><td>{:.1}</td><td>{:.2}</td><td>{}</td><td>{}</td><td>{:.1}</td><td>{}</td><td>{:.4}</td><td>{:.4}</td></tr>\n",
        if is_front { " class=\"front\"" } else { "" },
        escaped(&p.name),
        p.milliseconds,
        p.times,
        p.rays,
        p.samples,
        p.gel_bytes as f64 / 1e6,
        decibels(p),
        p.max,
        p.ssim
    )
}

fn figure(p: &Point, at: usize) -> String {
    format!(
        "<figure><img src=\"pictures/{at}.png\" alt=\"picture\"> <img src=\"pictures/{at}_off.png\" alt=\"where it is off\"><figcaption><b>{}</b>: {:.1} ms, {}; at most {:.4} off (white), in column {} of row {}.<br><code>{}</code></figcaption></figure>\n",
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
    if psnr.is_finite() { format!("{psnr:.2} dB") } else { "∞ dB".to_owned() }
}

/// The plot's size, and the room around its axes.
const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 420.0;
const ROOM: f64 = 50.0;

/// Milliseconds, on a scale of their logarithm, against decibels; the front is a line.
fn plot(points: &[Point], front: &[usize]) -> String {
    let most =
        1.0 + points.iter().map(Point::psnr_db).filter(|p| p.is_finite()).fold(0.0, f64::max);
    let least = points.iter().map(Point::psnr_db).fold(most - 1.0, f64::min).floor() - 1.0;
    let times = || points.iter().map(|p| p.milliseconds.max(1e-3).log2());
    let (first, last) =
        (times().fold(f64::MAX, f64::min).floor(), times().fold(f64::MIN, f64::max).ceil());
    let x = |ms: f64| {
        ROOM + (WIDTH - 2.0 * ROOM) * (ms.max(1e-3).log2() - first) / (last - first).max(1.0)
    };
    let y =
        |db: f64| HEIGHT - ROOM - (HEIGHT - 2.0 * ROOM) * (db.min(most) - least) / (most - least);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"milliseconds against decibels\">\n"
    );
    for tick in first as i32..=last as i32 {
        let (at, ms) = (x(f64::from(tick).exp2()), f64::from(tick).exp2());
        let _ = writeln!(
            svg,
            "<path d=\"M{at:.1} {ROOM}V{}\" stroke=\"var(--faint)\"/><text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{ms}</text>",
            HEIGHT - ROOM,
            HEIGHT - ROOM + 18.0
        );
    }
    for tick in (least as i32..=most as i32).filter(|tick| tick % 5 == 0) {
        let at = y(f64::from(tick));
        let _ = writeln!(
            svg,
            "<path d=\"M{ROOM} {at:.1}H{}\" stroke=\"var(--faint)\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{tick}</text>",
            WIDTH - ROOM,
            ROOM - 6.0,
            at + 4.0
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">ms a frame</text><text x=\"4\" y=\"{}\">PSNR, dB</text>",
        WIDTH - ROOM,
        HEIGHT - 10.0,
        ROOM - 14.0
    );
    let line: Vec<String> = front
        .iter()
        .map(|&at| format!("{:.1},{:.1}", x(points[at].milliseconds), y(points[at].psnr_db())))
        .collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"var(--front)\" stroke-width=\"2\"/>",
        line.join(" ")
    );
    for (at, p) in points.iter().enumerate() {
        let color = if front.contains(&at) { "var(--front)" } else { "var(--dot)" };
        let radius = if at == 0 { 7 } else { 4 };
        let _ = writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{color}\"><title>{}: {:.1} ms, {}</title></circle>",
            x(p.milliseconds),
            y(p.psnr_db()),
            escaped(&p.name),
            p.milliseconds,
            decibels(p)
        );
    }
    svg + "</svg>\n<p>The large dot is what the scene states; what is at the top edge is equal to the reference. Point at a dot for its settings.</p>\n"
}

/// Text within HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
