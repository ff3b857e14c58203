//! The one table of knobs of accuracy: what each is turned from and to, and what it promises.
//!
//! [`Sampling::exact`], the schema, `gelray trade` and the tests of what is promised read this table: a knob that is added
//! here shows up in all of them.

use std::fmt;

use super::sampling::{Sampling, Skip, TexelKind};

/// What a knob is turned to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// So many times the distance between samples that the scene states, or takes without a statement.
    Times(f64),
    /// A number, of channels in linear light with peak 1.
    Number(f32),
    /// Positions of the sample array, four a pixel.
    Positions(u32),
    /// Rays for each face of a voxel; 0: of the pixels.
    PerVoxel(f64),
    /// On or off.
    Truth(bool),
    /// What steps over empty space.
    Skip(Skip),
    /// In which numbers the gel is kept.
    Texel(TexelKind),
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Times(times) => write!(f, "{times} × Δ"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Positions(positions) => write!(f, "{positions}"),
            Self::PerVoxel(rays) => write!(f, "{rays}"),
            Self::Truth(truth) => write!(f, "{truth}"),
            Self::Skip(Skip::Pyramid) => write!(f, "pyramid"),
            Self::Skip(Skip::None) => write!(f, "none"),
            Self::Texel(TexelKind::Auto) => write!(f, "auto"),
            Self::Texel(TexelKind::F32) => write!(f, "f32"),
            Self::Texel(TexelKind::U16) => write!(f, "u16"),
            Self::Texel(TexelKind::U8) => write!(f, "u8"),
        }
    }
}

/// What a knob promises of the rays of a view, wherever it is turned to, against its exact end with all others as they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// The same bytes.
    Lossless,
    /// No channel of a ray is off by more than the setting.
    Setting,
    /// No channel of a ray is off by more than this for each slab of gel that it passes, where slabs are at least an
    /// opacity unit thick: by the kind of texel, 16 and 8 bits.
    EachSlab([f64; 2]),
    /// Nothing that holds for every scene: what lies between the rays or samples that it leaves out is not seen.
    Nothing,
}

/// A knob of accuracy: a key of `sampling`.
pub struct Knob {
    /// The key.
    pub key: &'static str,
    /// What it is turned to, from the cheap end to the exact end.
    pub range: &'static [Setting],
    /// Whether [`Sampling::exact`] turns it to its exact end; else it stays as stated.
    pub of_exact: bool,
    /// What it promises.
    pub bound: Bound,
    /// Whether the error of a picture, as a root of the mean square, never rises along the range but for rounding.
    pub is_monotone: bool,
    /// A sentence for the schema: what is bought and what is promised.
    pub promise: &'static str,
    set: fn(&mut Sampling, Setting, f64),
}

impl Knob {
    /// Turns it; `distance` is the Δ that [`Setting::Times`] counts in, world units. A setting of another knob's kind does
    /// nothing.
    pub fn turn(&self, sampling: &mut Sampling, setting: Setting, distance: f64) {
        (self.set)(sampling, setting, distance);
    }

    /// Its exact end.
    #[must_use]
    pub fn exact(&self) -> Setting {
        self.range[self.range.len() - 1]
    }
}

/// The keys of `sampling` that are no knobs, and why: `filter` says what lies between voxels and `pixel_filter` what a pixel
/// is, not how well these are known.
pub const NO_KNOBS: [&str; 2] = ["filter", "pixel_filter"];

/// A bound's half step, for 16 and 8 bits: of the color, and of the opacity that veils what lies behind.
const HALF_STEPS: [f64; 2] = [2.0 / 131_072.0, 2.0 / 512.0];

/// Every knob.
pub static KNOBS: &[Knob] = &[
    Knob {
        key: "distance_mm",
        range: &[
            Setting::Times(4.0),
            Setting::Times(2.0),
            Setting::Times(1.5),
            Setting::Times(1.0),
            Setting::Times(0.5),
            Setting::Times(0.25),
        ],
        of_exact: false,
        bound: Bound::Nothing,
        is_monotone: true,
        promise: "The error falls with the square of the distance in smooth gel; what is thinner than it is missed or doubled.",
        set: |sampling, setting, distance| {
            if let Setting::Times(times) = setting {
                sampling.distance_mm = Some(times * distance);
            }
        },
    },
    Knob {
        key: "skip",
        range: &[Setting::Skip(Skip::None), Setting::Skip(Skip::Pyramid)],
        of_exact: false,
        bound: Bound::Lossless,
        is_monotone: true,
        promise: "Lossless: the same bytes, in other time; \"none\" is never on the front of time and error (on the head of figure 6a it takes six times as long).",
        set: |sampling, setting, _| {
            if let Setting::Skip(skip) = setting {
                sampling.skip = skip;
            }
        },
    },
    Knob {
        key: "stop_at",
        range: &[
            Setting::Number(0.2),
            Setting::Number(0.1),
            Setting::Number(0.05),
            Setting::Number(0.02),
            Setting::Number(0.005),
            Setting::Number(0.0),
        ],
        of_exact: true,
        bound: Bound::Setting,
        is_monotone: true,
        promise: "No channel of a ray is off by more than this. Turned alone, what is below 0.02 makes the head of figure 6a no better, and 0 takes eight times the samples; with others turned too, 0.005 is on its front.",
        set: |sampling, setting, _| number(&mut sampling.stop_at, setting),
    },
    Knob {
        key: "tolerance",
        range: &[
            Setting::Number(0.2),
            Setting::Number(0.1),
            Setting::Number(0.05),
            Setting::Number(0.02),
            Setting::Number(0.01),
            Setting::Number(0.0),
        ],
        of_exact: true,
        bound: Bound::Nothing,
        is_monotone: true,
        promise: "Corners of a region that is not split agree to this; what lies between them is not seen.",
        set: |sampling, setting, _| number(&mut sampling.tolerance, setting),
    },
    Knob {
        key: "edge_tolerance",
        range: &[
            Setting::Number(0.5),
            Setting::Number(0.2),
            Setting::Number(0.1),
            Setting::Number(0.02),
            Setting::Number(0.0),
        ],
        of_exact: true,
        bound: Bound::Nothing,
        is_monotone: false,
        promise: "Edges of polygons fainter than this are a ray a pixel.",
        set: |sampling, setting, _| number(&mut sampling.edge_tolerance, setting),
    },
    Knob {
        key: "coarsest",
        range: &[
            Setting::Positions(32),
            Setting::Positions(16),
            Setting::Positions(8),
            Setting::Positions(4),
            Setting::Positions(2),
            Setting::Positions(1),
        ],
        of_exact: true,
        bound: Bound::Nothing,
        is_monotone: false,
        promise: "What is smaller than this and touches no corner is not seen.",
        set: |sampling, setting, _| {
            if let Setting::Positions(positions) = setting {
                sampling.coarsest = positions;
                sampling.finest = sampling.finest.min(positions);
            }
        },
    },
    Knob {
        key: "finest",
        range: &[Setting::Positions(4), Setting::Positions(2), Setting::Positions(1)],
        of_exact: true,
        bound: Bound::Nothing,
        is_monotone: false,
        promise: "Edges of polygons are smooth to this.",
        set: |sampling, setting, _| {
            if let Setting::Positions(positions) = setting {
                sampling.finest = positions;
                sampling.coarsest = sampling.coarsest.max(positions);
            }
        },
    },
    Knob {
        key: "per_voxel",
        range: &[
            Setting::PerVoxel(0.5),
            Setting::PerVoxel(1.0),
            Setting::PerVoxel(2.0),
            Setting::PerVoxel(3.0),
            Setting::PerVoxel(4.0),
            Setting::PerVoxel(0.0),
        ],
        of_exact: true,
        bound: Bound::Nothing,
        is_monotone: false,
        promise: "Rays through voxels see what rays through pixels see there, sample by sample; what lies between them is interpolated.",
        set: |sampling, setting, _| {
            if let Setting::PerVoxel(rays) = setting {
                sampling.per_voxel = rays;
            }
        },
    },
    Knob {
        key: "outlines",
        range: &[Setting::Truth(false), Setting::Truth(true)],
        of_exact: false,
        bound: Bound::Nothing,
        is_monotone: false,
        promise: "With it no polygon falls between the first rays.",
        set: |sampling, setting, _| truth(&mut sampling.outlines, setting),
    },
    Knob {
        key: "integrate",
        range: &[Setting::Truth(false), Setting::Truth(true)],
        of_exact: false,
        bound: Bound::Nothing,
        is_monotone: true,
        promise: "Of values, a transfer function is exact for a scalar that is straight over each half of a slab.",
        set: |sampling, setting, _| truth(&mut sampling.integrate, setting),
    },
    Knob {
        key: "texel",
        range: &[
            Setting::Texel(TexelKind::U8),
            Setting::Texel(TexelKind::U16),
            Setting::Texel(TexelKind::F32),
        ],
        of_exact: true,
        bound: Bound::EachSlab(HALF_STEPS),
        is_monotone: true,
        promise: "A slab of gel is off by half a step of color and half a step of opacity; opacities under half a step vanish. On the head of figure 6a, at 50 dB, all kinds are alike in error and time: what they buy is memory.",
        set: |sampling, setting, _| {
            if let Setting::Texel(texel) = setting {
                sampling.texel = texel;
            }
        },
    },
];

impl Sampling {
    /// The settings of `--exact`: no stopping, a ray at every position, 32-bit texels; Δ as it was.
    ///
    /// What is lossless stays as stated: `skip` steps over empty space to the very same bytes.
    #[must_use]
    pub fn exact(&self) -> Self {
        let mut exact = self.clone();
        for knob in KNOBS.iter().filter(|knob| knob.of_exact) {
            knob.turn(&mut exact, knob.exact(), 1.0);
        }
        exact
    }
}

fn truth(knob: &mut bool, setting: Setting) {
    if let Setting::Truth(truth) = setting {
        *knob = truth;
    }
}

fn number(knob: &mut f32, setting: Setting) {
    if let Setting::Number(number) = setting {
        *knob = number;
    }
}

#[cfg(test)]
mod tests;
