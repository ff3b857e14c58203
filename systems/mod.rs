//! The systems: a stage of the paper's figures 1, 4 and 5 per file, and the one table of jobs.

mod cast;
mod resample;

pub use cast::Cast;
pub use resample::Resample;

use crate::schedule::Job;

/// Every job, in any order: the schedule derives it.
pub static JOBS: &[Job] = &[Job::of::<Cast>(), Job::of::<Resample>()];
