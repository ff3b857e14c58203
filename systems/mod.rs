//! The systems: a stage of the paper's figures 1, 4 and 5 per file, and the one table of jobs.

use crate::schedule::Job;

pub mod classify;
pub mod gradient;
pub mod pyramid;
pub mod relight;
pub mod shade;

/// Every job, in any order: the schedule derives it.
pub static JOBS: &[Job] = &[
    Job::of::<gradient::TakeGradient>(),
    Job::of::<classify::Classify>(),
    Job::of::<shade::Shade>(),
    Job::of::<relight::Relight>(),
    Job::of::<pyramid::StackPyramid>(),
];
