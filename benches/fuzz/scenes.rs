//! Scenes a few bytes beside sound ones, and overrides of them.

use std::path::Path;

use gelray::Renderer;
use gelray::scene::{Source, load_within};

use super::random::Random;

/// A scene of every kind of entity, small enough to be loaded thousands of times.
pub const MIXED: &str = r#"
[[entity]]
name = "v"
volume = { file = "v.raw", size = [4, 4, 4], voxel_type = "uint8", spacing_mm = [1, 1, -2] }
classify = { iso = [{ value = 9, opacity = 0.5 }] }
material = { color = "white", specular = 0.2, shininess = 9 }
clip = { box = [[0, 0, 0], [1, 1, 1]] }

[[entity]]
name = "p"
polygon = { vertices = [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]] }
surface = { color = [0.1, 0.2, 0.3], opacity = 0.5 }
voxelize = { matte = "over" }

[[entity]]
name = "m"
mesh = { vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 1, 3]] }
surface = { opacity = 1.0 }
textured = { texture = "grid", corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }

[[entity]]
name = "l"
light = { toward = [-0.4, -0.8, 0.5], strength = 0.9 }
casts_shadow = { bias_voxels = 2 }

[[entity]]
name = "o"
view = { azimuth = 30, elevation = 10, size = [9, 7], field_of_view = 40 }
sampling = { distance_mm = 1.0, stop_at = 0.02, tolerance = 0.02, coarsest = 8 }
"#;

const PATHS: [&str; 12] = [
    "v.classify.iso.0.value",
    "v.volume.spacing_mm.1",
    "o.view.size",
    "o.view.elevation",
    "o.sampling.distance_mm",
    "l.light.toward",
    "p.polygon.vertices.2",
    "m.mesh.faces.0",
    "v.material.color",
    "v.clip",
    "o.sampling.skip",
    "q.view.roll",
];

const VALUES: [&str; 14] = [
    "0",
    "-1",
    "1e308",
    "nan",
    "inf",
    "[1,2]",
    "[[]]",
    "\"2sigma\"",
    "white",
    "{}",
    "1e-300",
    "[0,0,0]",
    "true",
    "99999999999999999999",
];

/// What a key of the scene may be set to, in the ranges that are stated for it.
type Sound = (&'static str, fn(&mut Random) -> String);

const SOUND: [Sound; 30] = [
    ("v.classify.iso.0.value", |r| number(r, -20.0, 300.0)),
    ("v.classify.iso.0.opacity", fraction),
    ("v.classify.iso.0.thickness_voxels", |r| number(r, 0.0, 5.0)),
    ("v.classify.iso.0.form", |r| word(r, &["above", "around"])),
    ("v.volume.spacing_mm", |r| vector(r, 0.01, 9.0)),
    ("v.volume.opacity_unit_mm", |r| number(r, 0.01, 9.0)),
    ("v.material.color", color),
    ("v.material.specular", fraction),
    ("v.material.shininess", |r| number(r, 1.0, 200.0)),
    ("v.clip.box.1", |r| vector(r, 1.0, 9.0)),
    ("p.surface.opacity", fraction),
    ("p.surface.color", color),
    ("p.voxelize.matte", |r| word(r, &["over", "under", "in", "out", "atop"])),
    ("p.voxelize.calibrated", |r| (*r.of(&["true", "false"])).to_owned()),
    ("l.light.toward", |r| vector(r, -1.0, 1.5)),
    ("l.light.strength", |r| number(r, 0.0, 9.0)),
    ("l.casts_shadow.bias_voxels", |r| number(r, 0.0, 9.0)),
    ("l.casts_shadow.k1", |r| number(r, 0.1, 2.0)),
    ("o.view.azimuth", |r| number(r, -720.0, 720.0)),
    ("o.view.elevation", |r| number(r, -90.0, 90.0)),
    ("o.view.size", |r| format!("[{}, {}]", 1 + r.below(24), 1 + r.below(24))),
    ("o.view.field_of_view", |r| number(r, 1.0, 120.0)),
    ("o.view.background", color),
    ("o.sampling.distance_mm", |r| number(r, 0.05, 3.0)),
    ("o.sampling.stop_at", |r| number(r, 0.0, 0.9)),
    ("o.sampling.tolerance", fraction),
    ("o.sampling.coarsest", |r| (1 << r.below(6)).to_string()),
    ("o.sampling.skip", |r| word(r, &["pyramid", "none"])),
    ("o.sampling.texel", |r| word(r, &["auto", "f32", "u16", "u8"])),
    ("o.sampling.pixel_filter", |r| word(r, &["box", "tent", "mitchell"])),
];

fn number(random: &mut Random, low: f64, high: f64) -> String {
    let ends = [low, high, low + (high - low) * (random.bits() as f64 / u64::MAX as f64)];
    // The ends of a range, and whole numbers, are met more often than by chance.
    let number = ends[random.below(8).min(2)];
    if random.below(4) == 0 && number.round() >= low { number.round() } else { number }.to_string()
}

fn fraction(random: &mut Random) -> String {
    number(random, 0.0, 1.0)
}

fn vector(random: &mut Random, low: f64, high: f64) -> String {
    let axes: [String; 3] = std::array::from_fn(|_| number(random, low, high));
    format!("[{}]", axes.join(", "))
}

fn color(random: &mut Random) -> String {
    if random.below(2) == 0 {
        return word(random, &["white", "#102030", "rebeccapurple"]);
    }
    let channels: [String; 3] = std::array::from_fn(|_| fraction(random));
    format!("[{}]", channels.join(", "))
}

fn word(random: &mut Random, words: &[&str]) -> String {
    format!("\"{}\"", random.of(words))
}

/// A scene, loaded and, where it was taken, rendered; whether it was taken.
pub fn load(random: &mut Random, folder: &Path) -> Result<bool, String> {
    std::fs::write(folder.join("v.raw"), [7, 9, 30, 200].repeat(16)).map_err(|e| e.to_string())?;
    let path = folder.join("s.toml");
    let (text, changes) = stated(random);
    std::fs::write(&path, text).map_err(|error| error.to_string())?;
    let Ok(source) = Source::read(&path) else { return Ok(false) };
    let exact = random.below(4) == 0;
    let loaded = load_within(&source, &changes, &[folder.to_owned()], exact, Some(64 << 20));
    let rendered = loaded.and_then(|mut scene| {
        let made = Renderer::new()?.render(&mut scene.world)?;
        Ok(made.picture.pixels.iter().flatten().all(|channel| channel.is_finite()))
    });
    match rendered {
        Ok(true) => Ok(true),
        Ok(false) => Err(format!("a pixel is no number: {changes:?}")),
        Err(error) if error.to_string().trim().is_empty() => {
            Err("an error without a word".to_owned())
        }
        Err(_) => Ok(false),
    }
}

/// The text of a scene and changes of it: two of three such as people make, the others hostile.
pub fn stated(random: &mut Random) -> (Vec<u8>, Vec<String>) {
    if random.below(3) == 0 {
        let changes = (0..random.below(3)).map(|_| change(random)).collect();
        return (random.mutated(MIXED.into()), changes);
    }
    let mut entities: Vec<&str> = MIXED.trim().split("\n\n").collect();
    for _ in 0..random.below(4) {
        let (a, b) = (random.below(entities.len()), random.below(entities.len()));
        entities.swap(a, b);
    }
    if random.below(3) == 0 && entities.len() > 1 {
        entities.remove(random.below(entities.len()));
    }
    let known: Vec<&Sound> = SOUND
        .iter()
        .filter(|(path, _)| {
            let named = path.split('.').next().map(|name| format!("name = \"{name}\""));
            entities.iter().any(|entity| named.as_ref().is_some_and(|name| entity.contains(name)))
        })
        .collect();
    let changes = (0..random.below(6)).filter(|_| !known.is_empty()).map(|_| {
        let (path, value) = random.of(&known);
        format!("{path}={}", value(random))
    });
    let changes = changes.collect();
    (entities.join("\n\n").into(), changes)
}

/// What `--set` may be given by somebody who means harm.
fn change(random: &mut Random) -> String {
    let sound = format!("{}={}", random.of(&PATHS), random.of(&VALUES));
    if random.below(4) > 0 {
        return sound;
    }
    String::from_utf8_lossy(&random.mutated(sound.into_bytes())).replace('\0', "")
}
