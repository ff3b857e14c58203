//! Scenes a few bytes beside sound ones, and overrides of them.

use std::path::Path;

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

/// A scene, loaded; whether it was taken.
pub fn load(random: &mut Random, folder: &Path) -> Result<bool, String> {
    std::fs::write(folder.join("v.raw"), [7; 64]).map_err(|error| error.to_string())?;
    let text = text(random);
    let path = folder.join("s.toml");
    std::fs::write(&path, text).map_err(|error| error.to_string())?;
    let Ok(source) = Source::read(&path) else { return Ok(false) };
    let changes: Vec<_> = (0..random.below(3)).map(|_| change(random)).collect();
    let exact = random.below(2) == 0;
    match load_within(&source, &changes, &[folder.to_owned()], exact, Some(64 << 20)) {
        Ok(_) => Ok(true),
        Err(error) if error.to_string().trim().is_empty() => {
            Err("an error without a word".to_owned())
        }
        Err(_) => Ok(false),
    }
}

/// The text of a scene: most often not quite that of [`MIXED`].
pub fn text(random: &mut Random) -> Vec<u8> {
    if random.below(8) == 0 { MIXED.into() } else { random.mutated(MIXED.into()) }
}

/// What `--set` may be given.
pub fn change(random: &mut Random) -> String {
    let sound = format!("{}={}", random.of(&PATHS), random.of(&VALUES));
    if random.below(4) > 0 {
        return sound;
    }
    String::from_utf8_lossy(&random.mutated(sound.into_bytes())).replace('\0', "")
}
