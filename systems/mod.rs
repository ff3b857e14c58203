//! The systems: a stage of the paper's figures 1, 4 and 5 per folder, and the one table of jobs.

use crate::schedule::Job;

/// Declares the stages and their jobs: a line is a folder and the systems in it.
macro_rules! stages {
    ($($stage:ident :: $system:ident $(+ $other:ident)*,)*) => {
        $(pub mod $stage;)*

        /// Every job, in any order: the schedule derives it.
        pub static JOBS: &[Job] = &[$(Job::of::<$stage::$system>(), $(Job::of::<$stage::$other>(),)*)*];
    };
}

stages! {
    ranges::FindRanges,
    prefilter::Prefilter,
    classify::ClassifyVoxels,
    scan_convert::ScanConvert,
    matte::MattePolygons,
    light_sweep::LightSweep,
    relight::Relight,
    pyramid::StackPyramid,
    cast::Cast + Judge,
    furnish::Furnish,
    resample::Resample,
}
