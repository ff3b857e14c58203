//! How cost grows with what a frame is made of: exponents of power laws for the report, fitted with their bounds.

use gelray::Renderer;
use gelray::components::{Light, Toward, View};
use gelray::measure::cost::FRAME;
use gelray::measure::growth::growth;
use gelray::measure::median::median;
use gelray::scene::{Scene, Source, load};
use hecs::World;
use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::html::table;
use super::noted::VERSION;
use super::outputs::write_json;
use super::report_parts::Parts;
use super::report_scenes;

/// What varies, what the paper says of it, and how it is measured.
struct Row {
    /// What varies, in words.
    what: &'static str,
    /// What the paper claims.
    claim: &'static str,
    sizes: &'static [u32],
    /// The scene of a size.
    scene: fn(u32) -> String,
    /// Pixels a side of a size.
    side: fn(u32) -> u32,
    /// Stages that are timed.
    timed: &'static [&'static str],
}

const ROWS: [Row; 5] = [
    Row {
        what: "pixels across: a shell and a square",
        claim: "nearly in proportion to pixels (§7): 2",
        sizes: &[95, 190, 380, 760, 1520],
        scene: |_| format!("{BALL}{}{VIEW}", squares(1)),
        side: |n| n,
        timed: &FRAME,
    },
    Row {
        what: "depth complexity: half clear squares, rays never stopped",
        claim: "in proportion (§2): 1",
        sizes: &[4, 16, 64, 256],
        scene: |n| format!("{}{VIEW}stop_at = 0.0\n", squares(n)),
        side: |_| 128,
        timed: &FRAME,
    },
    Row {
        what: "depth complexity: half clear squares, rays stopped",
        claim: "flat where rays stop (§6): 0",
        sizes: &[16, 64, 256],
        scene: |n| format!("{}{VIEW}", squares(n)),
        side: |_| 128,
        timed: &FRAME,
    },
    Row {
        what: "lights that cast shadows: their sweeps",
        claim: "in proportion to lights (§4): 1",
        sizes: &[1, 2, 4, 8],
        scene: |n| format!("{BALL}{}{VIEW}", lights(n)),
        side: |_| 64,
        timed: &["light_sweep"],
    },
    Row {
        what: "lights that cast shadows: the frame",
        claim: "none, they are in the gel (§4): 0",
        sizes: &[1, 2, 4, 8],
        scene: |n| format!("{BALL}{}{VIEW}", lights(n)),
        side: |_| 190,
        timed: &FRAME,
    },
];

const BALL: &str = "[[entity]]\nname = \"ball\"\nvolume = { file = \"phantom:ball\" }\nclassify = { iso = [{ value = \"0.5sigma\", form = \"around\" }] }\n";
const VIEW: &str = "[[entity]]\nname = \"observer\"\nview = { azimuth = 30, elevation = 20 }\n[entity.sampling]\ndistance_mm = 1.0\n";

/// Half clear squares one behind the other.
fn squares(n: u32) -> String {
    report_scenes::squares(n, (24.0, 24.0), 0.5)
}

/// Lights around a scene.
fn lights(n: u32) -> String {
    let light = |at: u32| {
        let (y, x) = f64::from(at).sin_cos();
        format!(
            "[[entity]]\nname = \"light {at}\"\nlight = {{ toward = [{x:.6}, {y:.6}, 0.7], strength = {} }}\ncasts_shadow = {{}}\n",
            1.0 / f64::from(n)
        )
    };
    (0..n).map(light).collect()
}

/// A size, its milliseconds, and the samples, hits of polygons and steps of packets that its rays took.
type Measured = [f64; 3];

/// What was measured: `growth.json`.
#[derive(Debug, Serialize, Deserialize)]
struct Kept {
    version: String,
    threads: usize,
    repeat: usize,
    /// For each row, its sizes, milliseconds and what was counted.
    rows: Vec<Vec<Measured>>,
}

/// The section of the page, measured or as it was kept.
pub fn section(parts: &Parts) -> Result<String, Failure> {
    let known = parts.kept("growth").filter(|kept: &Kept| {
        kept.version == VERSION
            && kept.threads == rayon::current_num_threads()
            && kept.repeat == parts.repeat
            && kept.rows.len() == ROWS.len()
    });
    if let Some(kept) = known {
        return Ok(words(&kept.rows));
    }
    let kept = measured(parts)?;
    write_json(&parts.folder.join("growth.json"), &kept)?;
    Ok(words(&kept.rows))
}

fn measured(parts: &Parts) -> Result<Kept, Failure> {
    parts.steps.expect(ROWS.len());
    let mut rows = Vec::new();
    for row in &ROWS {
        parts.steps.begin(row.what);
        // Of few runs the greatest sizes are left out.
        let sizes = if parts.repeat > 1 { row.sizes } else { &row.sizes[..3] };
        rows.push(sizes.iter().map(|&n| timed(row, n, parts)).collect::<Result<_, _>>()?);
        parts.steps.done();
    }
    let (version, threads) = (VERSION.to_owned(), rayon::current_num_threads());
    Ok(Kept { version, threads, repeat: parts.repeat, rows })
}

/// A size: the median of some runs, each made anew.
fn timed(row: &Row, n: u32, parts: &Parts) -> Result<Measured, Failure> {
    let source = Source::inline("growth", (row.scene)(n));
    let Scene { mut world, .. } = load(&source, &[], &[], false)?;
    for view in world.query_mut::<&mut View>() {
        view.size = [(row.side)(n); 2];
    }
    let renderer = Renderer::watched(parts.interrupt.watch.clone())?;
    let counts = renderer.render(&mut world)?.samples.counts;
    let counted = counts.samples + counts.polygon_hits + counts.packet_steps;
    let mut milliseconds = Vec::new();
    for _ in 0..parts.repeat + 2 {
        turn(&mut world);
        let ran = renderer.render(&mut world)?.ran;
        let of_row = ran.iter().filter(|ran| row.timed.contains(&ran.name));
        milliseconds.push(of_row.map(|ran| ran.seconds * 1e3).sum());
    }
    Ok([f64::from(n), median(&milliseconds), counted as f64])
}

/// Changes a view and its lights by what nobody sees, so that nothing that was made of them is kept.
fn turn(world: &mut World) {
    for view in world.query_mut::<&mut View>() {
        view.azimuth += 1e-4;
    }
    for light in world.query_mut::<&mut Light>() {
        if let Toward::Direction(toward) = &mut light.toward {
            toward[0] += 1e-5;
        }
    }
}

/// The table of exponents.
fn words(rows: &[Vec<Measured>]) -> String {
    let heading =
        ["what grows", "sizes", "ms", "exponent of time", "of what is counted", "the paper"];
    let mut cells = vec![heading.map(str::to_owned)];
    for (row, points) in ROWS.iter().zip(rows) {
        let list = |axis: usize, digits: usize| {
            let each = points.iter().map(|point| format!("{:.digits$}", point[axis]));
            each.collect::<Vec<_>>().join(", ")
        };
        let [what, claim] = [row.what, row.claim].map(str::to_owned);
        // Rays know nothing of sweeps.
        let counted = if row.timed == FRAME { exponent(points, 2) } else { String::new() };
        cells.push([what, list(0, 0), list(1, 2), exponent(points, 1), counted, claim]);
    }
    format!(
        "<h2>How cost grows</h2>\n<p>Cost as a power of a size, in 19 of 20 cases between the bounds, fitted through the medians of frames of scenes that are made by formula. Counted are samples, hits of polygons and steps of packets, which no busy machine changes; where a fixed part stands beside what grows, exponents are smaller.</p>\n{}",
        table(&cells, &[1, 2, 5])
    )
}

/// The exponent of a measure over the sizes, and its bounds.
fn exponent(points: &[Measured], axis: usize) -> String {
    let pairs: Vec<[f64; 2]> = points.iter().map(|point| [point[0], point[axis]]).collect();
    growth(&pairs).map_or_else(String::new, |found| {
        format!("{:.2} ({:.2} to {:.2})", found.exponent, found.low, found.high)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_a_scene_at_every_size() {
        for row in &ROWS {
            for &n in row.sizes {
                let source = Source::inline("growth", (row.scene)(n));
                let loaded = load(&source, &[], &[], false);
                assert!(loaded.is_ok(), "{}, {n}: {:?}", row.what, loaded.err());
            }
        }
    }

    #[test]
    fn the_table_tells_exponents() {
        let points = vec![[1.0, 2.0, 5.0], [2.0, 4.0, 5.0], [4.0, 8.0, 5.0]];
        let html = words(&[points, Vec::new()]);
        assert!(html.contains("1.00 (1.00 to 1.00)"), "{html}");
        assert!(html.contains("0.00 (0.00 to 0.00)") && html.contains("1, 2, 4"), "{html}");
    }
}
