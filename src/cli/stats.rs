//! `--stats`: counts, bytes and seconds of a render, under keys that scripts of others depend on.

use gelray::light::strength::LightStrength;
use gelray::measure::judged::Judged;
use gelray::schedule::Ran;
use gelray::view::samples::Counts;
use gelray::volume::gel::Gel;
use gelray::volume::grid::{Painted, Scalars};
use gelray::volume::pyramid::Pyramid;
use gelray::volume::ranges::Ranges;
use hecs::World;
use serde::Serialize;

use super::memory::of_status;

/// All that `--stats` writes.
#[derive(Debug, Serialize)]
pub struct Stats<'a> {
    pub version: &'static str,
    pub scene: &'a str,
    /// Pixels across and down.
    pub size: [usize; 2],
    pub threads: usize,
    pub exact: bool,
    pub systems: &'a [Ran],
    pub counts: Counted,
    /// What the picture is off by, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<&'a Judged>,
    pub bytes: Bytes,
    pub seconds: Seconds,
}

/// Facts about the picture: the same on every machine, for any number of threads.
#[derive(Debug, Clone, Serialize)]
pub struct Counted {
    #[serde(flatten)]
    cast: Counts,
    pub rays_per_pixel: f64,
    nan_voxels: u64,
}

impl Counted {
    /// What was counted for a picture of that size.
    pub fn of(world: &World, cast: Counts, size: [usize; 2]) -> Self {
        let rays_per_pixel = cast.rays as f64 / (size[0] * size[1]) as f64;
        let nan_voxels = world.query::<&Ranges>().iter().map(Ranges::nan_voxels).sum();
        Self { cast, rays_per_pixel, nan_voxels }
    }
}

/// Bytes of what was read and made.
#[derive(Debug, Serialize)]
pub struct Bytes {
    scalars: u64,
    gel: u64,
    pyramid: u64,
    light: u64,
    /// The most memory that the program ever had; `None` where the system does not tell.
    peak_rss: Option<u64>,
}

impl Bytes {
    /// The bytes of what a world carries.
    pub fn of(world: &World) -> Self {
        let gel = |gel: &Gel| {
            gel.lit.bytes() + gel.ambient.as_ref().map_or(0, gelray::volume::gel::GelBricks::bytes)
        };
        Self {
            scalars: voxels(world),
            gel: world.query::<&Gel>().iter().map(gel).sum(),
            pyramid: world.query::<&Pyramid>().iter().map(Pyramid::bytes).sum(),
            light: world.query::<&LightStrength>().iter().map(LightStrength::bytes).sum(),
            peak_rss: of_status("VmHWM:"),
        }
    }
}

/// Bytes of the voxels of a scene, as they were read.
pub fn voxels(world: &World) -> u64 {
    let scalars: u64 = world.query::<&Scalars>().iter().map(Scalars::bytes).sum();
    let painted: u64 = world.query::<&Painted>().iter().map(Painted::bytes).sum();
    scalars + painted
}

/// Where the time went.
#[derive(Debug, Serialize)]
pub struct Seconds {
    load: f64,
    /// All systems that a turn of the view does not run again.
    prepare: f64,
    /// Casting rays and resampling.
    frame: f64,
    /// Estimating what the picture is off by.
    estimate: f64,
    /// Making the files of the picture and of its rays.
    encode: f64,
    /// From the start to the last byte of the picture.
    total: f64,
}

impl Seconds {
    /// The sums of what systems took, beside what was timed around them.
    pub fn of(ran: &[Ran], load: f64, encode: f64, total: f64) -> Self {
        let of_frame = |ran: &Ran| matches!(ran.name, "cast" | "resample");
        let add = |sum: f64, ran: &Ran| sum + ran.seconds;
        let frame = ran.iter().filter(|ran| of_frame(ran)).fold(0.0, add);
        let of_estimate = |ran: &Ran| ran.name == "judge";
        let estimate = ran.iter().filter(|ran| of_estimate(ran)).fold(0.0, add);
        let prepare = ran.iter().filter(|ran| !of_frame(ran) && !of_estimate(ran)).fold(0.0, add);
        Self { load, prepare, frame, estimate, encode, total }
    }
}
