//! The systems: a stage of the paper's figures 1, 4 and 5 per file, and the one table of jobs.

pub mod light_sweep;

use crate::schedule::Job;

/// Every job, in any order: the schedule derives it.
pub static JOBS: &[Job] = &[Job::of::<light_sweep::LightSweep>()];
