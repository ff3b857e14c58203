//! What is measured: histograms of volumes, errors between pictures, the cost of stages.

pub mod cost;
pub mod error;
pub mod histogram;
mod isovalues;
pub mod sigma;
mod ssim;
