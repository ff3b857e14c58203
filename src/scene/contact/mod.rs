//! First contact: a scene made for a volume that comes without one, with what was guessed said in sentences.

mod frame;
mod light;
mod mesh;

use std::fmt::Write;
use std::path::Path;

use super::source::{Ready, Source};
use crate::components::Preset;
use crate::error::Error;
use crate::formats::meshes::mesh_format;
use crate::formats::{Loaded, Stated, Survey, Voxels, read_volume, survey};
use crate::measure::histogram::{histogram, suggested_isovalues};
use crate::measure::kind::{Kind, kind};
use crate::volume::grid::{Grid, Scalars};
use frame::Frame;
use light::{LIGHTS, key};

/// Bins that values are counted in.
const BINS: usize = 4096;

/// Pixels across and down, where none are wished for.
const SIZE: [u32; 2] = [640, 640];

/// Turn and height of the observer, degrees: a little from the left and from above, which shows three sides.
const AZIMUTH: f64 = 25.0;
const ELEVATION: f64 = 12.0;

/// What is wanted of a volume without a scene; all of it may be left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wish {
    /// The value of a surface, in place of a guess.
    pub iso: Option<f32>,
    /// A classification by name, in place of a guess.
    pub preset: Option<Preset>,
    /// Pixels across and down; default 640 × 640.
    pub size: Option<[u32; 2]>,
    /// Which channel is read of several, 0 the first; default the first, and that is said.
    pub channel: Option<usize>,
    /// Which time is read of several, 0 the first; default the first, and that is said.
    pub time: Option<usize>,
    /// The most bytes that the voxels may take; `None`: as many as there are.
    pub most_bytes: Option<u64>,
}

impl Wish {
    /// What it says of the file.
    fn stated(&self) -> Stated {
        Stated { channel: self.channel, time: self.time, ..Stated::default() }
    }
}

/// How a volume is drawn.
struct Look {
    /// The line of its classification, or nothing for one that is painted.
    classify: String,
    /// Whether it is an opaque surface: then it is found between voxels, and is sharp however much it is magnified.
    sharp: bool,
    /// The least value that is seen; `None` where all of it is.
    seen_from: Option<f32>,
    /// What it is taken for, and so drawn as: a sentence without a subject.
    said: String,
}

/// A scene for the volume in a file or a folder, or the mesh in a file, and a sentence about what it was taken for.
///
/// The voxels are read once: loading the scene takes those that were looked at. Fails as [`read_volume`] does.
pub fn first_contact(path: &Path, wish: &Wish) -> Result<(Source, String), Error> {
    if mesh_format(path).is_some() {
        return Ok(mesh::scene(path, wish.size.unwrap_or(SIZE)));
    }
    let stated = wish.stated();
    let found = survey(path, &stated)?;
    match wish.most_bytes {
        Some(allowed) if found.bytes > allowed => {
            return Err(Error::Memory { needed: found.bytes, allowed });
        }
        _ => {}
    }
    let loaded = read_volume(path, &stated)?;
    let look = look(&loaded, &found, wish);
    let name = path.display().to_string();
    let text = text(path, &loaded, &look, wish);
    let said = format!("{name}: {}", look.said);
    let mut source = Source::inline(name, text);
    source.ready = Some(Ready { path: path.to_owned(), stated, loaded });
    Ok((source, said))
}

fn look(loaded: &Loaded, found: &Survey, wish: &Wish) -> Look {
    let scalars = match &loaded.voxels {
        Voxels::Painted(_) => {
            return Look {
                classify: String::new(),
                sharp: false,
                seen_from: None,
                said: "RGBA, classified and shaded already; drawn as it is".to_owned(),
            };
        }
        Voxels::Scalars(scalars) => scalars,
    };
    if let Some(value) = wish.iso {
        let said = format!("drawn as the surface of the value {value}, as asked for");
        return surface(value, said);
    }
    if let Some(preset) = wish.preset {
        return named(
            preset,
            scalars,
            format!("drawn by the preset {}, as asked for", preset.name()),
        );
    }
    guessed(scalars, found)
}

fn guessed(scalars: &Scalars, found: &Survey) -> Look {
    let counted = histogram(scalars, BINS);
    if found.format == "MRC or CCP4" {
        let said = "a map of a molecule by its format, so drawn by the preset density";
        return named(Preset::Density, scalars, said.to_owned());
    }
    match kind(scalars, &counted) {
        Kind::Ct => {
            let said = "CT in Hounsfield units by its values, so drawn by the preset ct-bone";
            named(Preset::CtBone, scalars, said.to_owned())
        }
        Kind::ShiftedCt => {
            let said = "CT whose values are Hounsfield units plus 1024 by its values, so drawn by the preset ct-bone";
            named(Preset::CtBone, scalars, said.to_owned())
        }
        Kind::Labels => {
            let value = counted.low + 0.5;
            let said = format!(
                "labels by its values (few whole numbers in flat regions), so drawn as the surface of all above {}",
                counted.low
            );
            surface(value, said)
        }
        Kind::Other => match suggested_isovalues(scalars).first() {
            None => surface(counted.low, "all its voxels are alike or not numbers".to_owned()),
            Some(&value) => {
                let said = format!(
                    "of no kind that its values tell, so drawn as the surface that its histogram suggests, at {value}"
                );
                surface(value, said)
            }
        },
    }
}

/// An opaque surface.
fn surface(value: f32, said: String) -> Look {
    Look {
        classify: format!(
            "classify = {{ iso = [{{ value = {value:?}, thickness_voxels = 0 }}] }}\n"
        ),
        sharp: true,
        seen_from: Some(value),
        said,
    }
}

fn named(preset: Preset, scalars: &Scalars, said: String) -> Look {
    Look {
        classify: format!("classify = {{ preset = \"{}\" }}\n", preset.name()),
        sharp: matches!(preset, Preset::CtSkin | Preset::Density),
        seen_from: super::named::least_seen(preset, scalars),
        said,
    }
}

/// The scene: light that models form comes from one side, and little of it from everywhere.
fn text(path: &Path, loaded: &Loaded, look: &Look, wish: &Wish) -> String {
    let file = path.display().to_string();
    let quoted = toml::Value::String(file.clone()).to_string();
    let size = wish.size.unwrap_or(SIZE);
    let Grid { size: [x, y, z], .. } = loaded.grid;
    let mut text = format!("# {} ({x} × {y} × {z} voxels).\n# {}.\n", one_line(&file), look.said);
    let choice = |key: &str, stated: Option<usize>| {
        stated.map_or(String::new(), |number| format!(", {key} = {number}"))
    };
    let which = choice("channel", wish.channel) + &choice("time", wish.time);
    let how = if look.sharp { ", reconstruct = \"values\"" } else { "" };
    let volume = format!("volume = {{ file = {quoted}{which}{how} }}");
    let _ = write!(text, "[[entity]]\nname = \"volume\"\n{volume}\n");
    if !look.classify.is_empty() {
        text += &look.classify;
        text += "material = { color = \"#efe6d8\", ambient = 0.06, diffuse = 0.86, specular = 0.12, shininess = 24 }\n";
    }
    let frame = Frame::around(&loaded.grid, &loaded.voxels, look.seen_from);
    let height = frame.height([AZIMUTH, ELEVATION], size);
    let [fx, fy, fz] = frame.center.to_array().map(rounded);
    let lights = if look.classify.is_empty() { String::new() } else { key(true) + LIGHTS };
    let _ = write!(
        text,
        "{lights}\n[[entity]]\nname = \"observer\"\nview = {{ azimuth = {AZIMUTH:?}, elevation = {ELEVATION:?}, focal_point = [{fx:?}, {fy:?}, {fz:?}], height_mm = {:?}, size = [{}, {}], background = \"#101418\" }}\n",
        rounded(height),
        size[0],
        size[1]
    );
    text
}

/// A name for a comment: a control character in it would end the line.
fn one_line(name: &str) -> String {
    name.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect()
}

/// Six digits, so that scenes are read by people.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests;
