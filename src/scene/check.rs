//! What the schema cannot say: keys of one component that must suit each other.

use crate::components::direction::unit;
use crate::components::{
    Classify, Clip, Level, Light, Mesh, Projects, Sampling, Texture, Textured, Toward, Volume,
};

/// The strongest light: thousands of them, focused by a falloff of 1e-12, still add up to a number.
const BRIGHTEST: f32 = 1e15;

/// What is wrong with a component: the dotted path inside it, and the rest of a sentence that the component's key begins.
#[derive(Debug)]
pub(super) struct Wrong {
    pub at: String,
    pub problem: String,
}

pub(super) fn wrong(at: impl Into<String>, problem: impl Into<String>) -> Result<(), Wrong> {
    Err(Wrong { at: at.into(), problem: problem.into() })
}

/// A component that can tell whether its keys suit each other.
pub(super) trait Check {
    /// Passes, or says what is wrong.
    fn check(&self) -> Result<(), Wrong>;
}

impl Check for Volume {
    fn check(&self) -> Result<(), Wrong> {
        if self.file.is_empty() {
            return wrong("file", "names no file; state a path or `phantom:NAME`");
        }
        if self.spacing_mm.is_some_and(|spacing| spacing.contains(&0.0)) {
            return wrong(
                "spacing_mm",
                "has a spacing of 0; state lengths above 0, or below to flip",
            );
        }
        if self.size.is_some_and(|size| size.iter().any(|&n| n < 2)) {
            return wrong(
                "size",
                "has an axis of fewer than 2 voxels; a volume needs at least 2 on each",
            );
        }
        match self.endian.as_deref() {
            None | Some("little" | "big") => Ok(()),
            Some(word) => wrong(
                "endian",
                format!("has the byte order \"{word}\"; state \"little\" or \"big\""),
            ),
        }
    }
}

impl Check for Classify<Level> {
    fn check(&self) -> Result<(), Wrong> {
        let ways = [
            ("iso", self.iso.is_empty()),
            ("regions", self.regions.is_empty()),
            ("transfer", self.transfer.is_empty()),
            ("materials", self.materials.is_empty()),
            ("preset", self.preset.is_none()),
            ("colormap", self.colormap.is_none()),
        ];
        let stated: Vec<_> = ways.iter().filter(|(_, empty)| !empty).map(|(key, _)| *key).collect();
        match stated[..] {
            [] => {
                return wrong(
                    "",
                    "classifies nothing; state one of `iso`, `regions`, `transfer`, `materials`, `preset`, `colormap`",
                );
            }
            [_] => {}
            [first, second, ..] => {
                return wrong(
                    second,
                    format!("states both `{first}` and `{second}`; keep exactly one of them"),
                );
            }
        }
        if !self.gradient.is_empty() && self.transfer.is_empty() {
            return wrong(
                "gradient",
                "has `gradient` without `transfer`, which it is a factor of; add `transfer`",
            );
        }
        let of_colormap = [
            ("level", self.level.is_some()),
            ("window", self.window.is_some()),
            ("peak_opacity", self.peak_opacity.is_some()),
        ];
        if let (None, Some((key, _))) = (self.colormap, of_colormap.iter().find(|row| row.1)) {
            return wrong(
                *key,
                format!("has `{key}` without the colors that it places; add `colormap`"),
            );
        }
        rising("regions", &self.regions.iter().map(|t| t.value).collect::<Vec<_>>())?;
        rising("transfer", &self.transfer.iter().map(|t| t.value).collect::<Vec<_>>())?;
        pairs("gradient", &self.gradient)?;
        for (i, material) in self.materials.iter().enumerate() {
            pairs(&format!("materials.{i}.probability"), &material.probability)?;
        }
        Ok(())
    }
}

/// Pairs rise in their first numbers and stay within 0 and 1 in their second, which the schema cannot bound.
fn pairs(at: &str, pairs: &[[f32; 2]]) -> Result<(), Wrong> {
    rising(at, &pairs.iter().map(|pair| pair[0]).collect::<Vec<_>>())?;
    match pairs.iter().position(|pair| !(0.0..=1.0).contains(&pair[1])) {
        Some(i) => wrong(
            format!("{at}.{i}"),
            format!("has {} in `{at}.{i}`, which must be within 0 and 1", pairs[i][1]),
        ),
        None => Ok(()),
    }
}

fn rising(at: &str, values: &[f32]) -> Result<(), Wrong> {
    match values.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(i) => wrong(
            format!("{at}.{}", i + 1),
            format!(
                "has {} after {} in `{at}`; state values in rising order",
                values[i + 1],
                values[i]
            ),
        ),
        None => Ok(()),
    }
}

impl Check for Clip {
    fn check(&self) -> Result<(), Wrong> {
        if self.planes.is_empty() && self.r#box.is_none() {
            return wrong("", "takes nothing away; state `planes` or `box`");
        }
        if let Some(i) = self.planes.iter().position(|&[a, b, c, _]| !is_direction([a, b, c])) {
            return wrong(
                format!("planes.{i}"),
                format!("has a plane {i} without a normal; [a, b, c] must not be all 0"),
            );
        }
        match self.r#box {
            Some([p, q]) if (0..3).any(|axis| p[axis] - q[axis] == 0.0) => {
                wrong("box", "has a box of no volume; its two corners must differ on each axis")
            }
            _ => Ok(()),
        }
    }
}

impl Check for Mesh {
    fn check(&self) -> Result<(), Wrong> {
        let of_file = [("space", self.space.is_some()), ("unit_mm", self.unit_mm.is_some())];
        if let (None, Some((key, _))) = (&self.file, of_file.iter().find(|row| row.1)) {
            return wrong(*key, format!("has `{key}`, which describes a `file`; state one"));
        }
        let ways = [
            self.file.is_some(),
            !self.faces.is_empty(),
            self.ellipsoid.is_some(),
            self.prism.is_some(),
        ];
        if ways.iter().filter(|&&stated| stated).count() != 1 {
            return wrong(
                "",
                "needs exactly one of `file`, `faces` (with `vertices`), `ellipsoid` or `prism`",
            );
        }
        if self.faces.is_empty() && !self.vertices.is_empty() {
            return wrong(
                "vertices",
                "has `vertices` without `faces`; state which vertices make a face",
            );
        }
        for (i, face) in self.faces.iter().enumerate() {
            if let Some(index) = face.iter().find(|&&v| v as usize >= self.vertices.len()) {
                let count = self.vertices.len();
                return wrong(
                    format!("faces.{i}"),
                    format!(
                        "has vertex {index} in face {i}, but there are {count} vertices, counted from 0"
                    ),
                );
            }
        }
        if self.ellipsoid.as_ref().is_some_and(|e| e.radii.iter().any(|&r| r <= 0.0)) {
            return wrong(
                "ellipsoid.radii",
                "has a semi-axis that is not above 0; state three lengths in world units",
            );
        }
        if self
            .prism
            .as_ref()
            .is_some_and(|p| !is_direction(std::array::from_fn(|axis| p.to[axis] - p.from[axis])))
        {
            return wrong("prism.to", "has a prism of no length; `from` and `to` must differ");
        }
        Ok(())
    }
}

impl Check for Textured {
    fn check(&self) -> Result<(), Wrong> {
        if self.repeats.iter().any(|&r| r <= 0.0) {
            return wrong(
                "repeats",
                "lays its texture 0 times or fewer; `repeats` must be above 0",
            );
        }
        Ok(())
    }
}

impl Check for Light {
    fn check(&self) -> Result<(), Wrong> {
        match self.toward {
            Toward::Direction(d) if !is_direction(d) => wrong(
                "toward",
                format!(
                    "has no direction in {d:?}; state where the light is, of any length above 0"
                ),
            ),
            _ if self.strength > BRIGHTEST => wrong(
                "strength",
                format!(
                    "has a strength of {}, and the sum of several such lights is no number; state at most {BRIGHTEST:e} (1 lights a facing white surface to `diffuse`)",
                    self.strength
                ),
            ),
            _ => Ok(()),
        }
    }
}

impl Check for Projects {
    fn check(&self) -> Result<(), Wrong> {
        if self.size_mm.iter().any(|&s| s <= 0.0) {
            return wrong("size_mm", "has a slide of no area; `size_mm` must be above 0");
        }
        if self.up.is_some_and(|up| !is_direction(up)) {
            return wrong(
                "up",
                "has the direction [0, 0, 0]; state where the slide's top points to",
            );
        }
        Ok(())
    }
}

impl Check for Texture {
    fn check(&self) -> Result<(), Wrong> {
        match (&self.file, &self.formula) {
            (Some(_), Some(_)) => wrong(
                "formula",
                "states both `file` and `formula`; a `file` may have a `stand_in` instead",
            ),
            (None, None) => wrong("", "has no picture; state `file` or `formula`"),
            (None, Some(_)) if self.stand_in.is_some() => {
                wrong("stand_in", "has a `stand_in` for no file; state `file` too or remove it")
            }
            _ => Ok(()),
        }
    }
}

impl Check for Sampling {
    fn check(&self) -> Result<(), Wrong> {
        for (key, n) in [("coarsest", self.coarsest), ("finest", self.finest)] {
            if !n.is_power_of_two() {
                return wrong(key, format!("has `{key}` = {n}; it must be 1, 2, 4, 8, 16 or 32"));
            }
        }
        if self.finest > self.coarsest {
            return wrong(
                "finest",
                format!(
                    "has `finest` = {} above `coarsest` = {}; swap them",
                    self.finest, self.coarsest
                ),
            );
        }
        if self.per_voxel > 0.0 && self.per_voxel < 0.5 {
            return wrong(
                "per_voxel",
                format!(
                    "has `per_voxel` = {}; it must be 0, or from 0.5, every second row of voxels, on",
                    self.per_voxel
                ),
            );
        }
        Ok(())
    }
}

/// Whether a vector has a direction.
fn is_direction(v: [f64; 3]) -> bool {
    unit(v).is_some()
}
