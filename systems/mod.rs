//! The systems: a stage of the paper's figures 1, 4 and 5 per file, and the one table of jobs.

pub mod cast;
pub mod classify;
pub mod gradient;
pub mod light_sweep;
pub mod matte;
pub mod pyramid;
pub mod relight;
pub mod resample;
pub mod scan_convert;
pub mod shade;

use crate::schedule::Job;

/// Every job, in any order: the schedule derives it.
pub static JOBS: &[Job] = &[
    Job::of::<gradient::TakeGradient>(),
    Job::of::<classify::Classify>(),
    Job::of::<shade::Shade>(),
    Job::of::<scan_convert::ScanConvert>(),
    Job::of::<matte::Matte>(),
    Job::of::<light_sweep::LightSweep>(),
    Job::of::<relight::Relight>(),
    Job::of::<pyramid::StackPyramid>(),
    Job::of::<cast::Cast>(),
    Job::of::<resample::Resample>(),
];
