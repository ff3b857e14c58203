//! What is measured: histograms of volumes, errors between pictures, the cost of stages.

pub mod busy;
pub mod cost;
#[cfg(feature = "cli")]
pub mod cost_table;
pub mod error;
pub mod first_hits;
pub mod front;
pub mod growth;
pub mod held;
pub mod histogram;
mod isovalues;
pub mod judged;
pub mod kind;
pub mod median;
pub mod paired;
pub mod sigma;
#[cfg(feature = "cli")]
pub mod spans;
mod ssim;
pub mod stopwatch;
pub mod survey;
pub mod variants;
