//! What numbers do at their extremes: scenes taken far from the middle, beside what they should be, for the report.

use gelray::Renderer;
use gelray::scene::{Scene, Source, load};
use gelray::view::picture::Picture;
use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::html::table;
use super::noted::VERSION;
use super::outputs::write_json;
use super::report_parts::Parts;
use super::report_scenes::{Truth, even, grazing, layers, perspective, stretched, world};

/// What is taken to its extreme.
struct Row {
    /// What it is, in words.
    what: &'static str,
    /// What the pictures are held against, in words.
    against: &'static str,
    /// The most that a channel may be off by; the crate's docs name the test that holds it over more scenes.
    promised: fn(f64) -> f64,
    values: &'static [f64],
    /// The scene of a value, and its truth.
    scene: fn(f64) -> (String, Truth),
}

const ROWS: [Row; 10] = [
    Row {
        what: "scale of the world",
        against: "the same at 1",
        promised: |_| 1e-4,
        values: &[1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9],
        scene: |scale| (world(scale, 0.0), Truth::Scene(world(1.0, 0.0))),
    },
    Row {
        what: "voxels from the origin",
        against: "the same at the origin",
        promised: |_| 1e-4,
        values: &[1e3, 1e4, 1e5, 1e6],
        // A third is no number of so many bits: the voxels' places are rounded.
        scene: |moved| (world(1.0, moved + 1.0 / 3.0), Truth::Scene(world(1.0, 0.0))),
    },
    Row {
        what: "opacity of sixteen squares",
        against: "the formula in 64 bits",
        promised: |opacity| 2e-7 * opacity.min(1.0 / 16.0) * 16.0 + 1e-15,
        values: &[1e-12, 1e-9, 1e-6, 1e-3, 0.5, 0.999_999_94],
        scene: |opacity| layers(16, opacity),
    },
    Row {
        what: "squares that let half through together",
        against: "the formula in 64 bits",
        promised: |count| 1e-7 + 6e-8 * count.sqrt(),
        values: &[1.0, 10.0, 100.0, 1000.0, 4000.0],
        scene: |count| layers(count as u32, 1.0 - 0.5_f64.powf(1.0 / count)),
    },
    Row {
        what: "samples of a voxel's width of even gel",
        against: "the formula in 64 bits",
        promised: |_| 1e-6,
        values: &[2.0, 10.0, 100.0, 1000.0],
        scene: |samples| even(1.0 / samples),
    },
    Row {
        what: "bits of a channel",
        against: "32 bits",
        promised: |bits| 6.0 * 0.5_f64.powf(bits),
        values: &[16.0, 8.0],
        scene: |bits| {
            let of = |texel: &str| world(1.0, 0.0) + &format!("texel = \"{texel}\"\n");
            (of(&format!("u{bits}")), Truth::Scene(of("f32")))
        },
    },
    Row {
        what: "longest edge of a voxel, of 1",
        against: "a quarter of the steps",
        promised: |_| 0.05,
        values: &[1.0, 10.0, 100.0],
        scene: |long| (stretched(long, 1.0), Truth::Scene(stretched(long, 0.25))),
    },
    Row {
        what: "field of view in degrees, narrow",
        against: "a parallel view",
        promised: |_| 1e-3,
        values: &[1e-9, 1e-6, 0.001],
        scene: |degrees| (perspective(degrees), Truth::Scene(world(1.0, 0.0))),
    },
    Row {
        what: "field of view in degrees, wide",
        against: SOUND,
        promised: |_| 0.0,
        values: &[0.1, 30.0, 90.0, 150.0, 179.0],
        scene: |degrees| (perspective(degrees), Truth::Sound),
    },
    Row {
        what: "degrees between a square and the line of sight",
        against: SOUND,
        promised: |_| 0.0,
        values: &[1.0, 1e-3, 1e-6, 1e-9, 0.0],
        scene: |degrees| (grazing(degrees), Truth::Sound),
    },
];

const SOUND: &str = "finite numbers, 0 ≤ α ≤ 1";

/// What was measured: `extremes.json`.
#[derive(Debug, Serialize, Deserialize)]
struct Kept {
    version: String,
    /// For each row and value, the most that a channel is off by.
    rows: Vec<Vec<f64>>,
}

/// The section of the page, measured or as it was kept.
pub fn section(parts: &Parts) -> Result<String, Failure> {
    let known = parts
        .kept("extremes")
        .filter(|kept: &Kept| kept.version == VERSION && kept.rows.len() == ROWS.len());
    if let Some(kept) = known {
        return Ok(words(&kept.rows));
    }
    parts.steps.expect(1);
    parts.steps.begin("extremes");
    let renderer = Renderer::watched(parts.interrupt.watch.clone())?;
    let rows = ROWS.iter().map(|row| measured(row, &renderer)).collect::<Result<_, _>>()?;
    let kept = Kept { version: VERSION.to_owned(), rows };
    write_json(&parts.folder.join("extremes.json"), &kept)?;
    parts.steps.done();
    Ok(words(&kept.rows))
}

/// What a row is off by at each value.
fn measured(row: &Row, renderer: &Renderer) -> Result<Vec<f64>, Failure> {
    row.values.iter().map(|&value| off((row.scene)(value), renderer)).collect()
}

/// The most that a channel of a scene's picture is off by from its truth; ∞ where the picture is not sound.
fn off((text, truth): (String, Truth), renderer: &Renderer) -> Result<f64, Failure> {
    let picture = drawn(text, renderer)?;
    let is_sound = |pixel: &[f32; 4]| {
        pixel.iter().all(|channel| channel.is_finite()) && (0.0..=1.0).contains(&pixel[3])
    };
    if !picture.pixels.iter().all(is_sound) {
        return Ok(f64::INFINITY);
    }
    let pixels = picture.pixels.iter();
    Ok(match truth {
        Truth::Sound => 0.0,
        Truth::Opacity(alpha) => {
            pixels.map(|pixel| (f64::from(pixel[3]) - alpha).abs()).fold(0.0, f64::max)
        }
        Truth::Scene(text) => {
            let other = drawn(text, renderer)?;
            let channels = pixels.flatten().zip(other.pixels.iter().flatten());
            channels.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
        }
    })
}

fn drawn(text: String, renderer: &Renderer) -> Result<Picture, Failure> {
    let Scene { mut world, .. } = load(&Source::inline("extreme", text), &[], &[], false)?;
    Ok(renderer.render(&mut world)?.picture)
}

/// The table of extremes.
fn words(rows: &[Vec<f64>]) -> String {
    let heading = ["taken to its extreme", "to", "off by at most", "promised", "held against"];
    let mut cells = vec![heading.map(str::to_owned)];
    for (row, found) in ROWS.iter().zip(rows) {
        for (at, (&value, &off)) in row.values.iter().zip(found).enumerate() {
            let name = if at == 0 { row.what } else { "" };
            let is_sound = row.against == SOUND;
            let off = match off {
                off if off.is_infinite() => "no numbers".to_owned(),
                0.0 => "nothing".to_owned(),
                off => format!("{off:.1e}"),
            };
            let promised =
                if is_sound { String::new() } else { format!("{:.0e}", (row.promised)(value)) };
            cells.push([name.into(), short(value), off, promised, row.against.into()]);
        }
    }
    format!(
        "<h2>Numbers at their extremes</h2>\n<p>The most that a channel of any pixel is off by, of scenes that are taken far from the middle of what numbers can hold. The tests hold what is promised over more scenes.</p>\n{}",
        table(&cells, &[4])
    )
}

/// A value as people write it.
fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extreme_keeps_its_promise() {
        let renderer = Renderer::new().unwrap();
        for row in &ROWS {
            let found = measured(row, &renderer).unwrap();
            println!("{}: {found:?}", row.what);
            for (&value, off) in row.values.iter().zip(&found) {
                assert!(*off <= (row.promised)(value), "{}, {value}: {off:e}", row.what);
            }
        }
    }

    #[test]
    fn the_table_tells_what_is_no_number() {
        let rows: Vec<Vec<f64>> =
            ROWS.iter().map(|row| vec![f64::INFINITY; row.values.len()]).collect();
        let html = words(&rows);
        assert!(html.contains("no numbers") && html.contains("1e-9"), "{html}");
    }
}
