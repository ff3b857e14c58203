//! What is measured: histograms of volumes, errors between pictures, the cost of stages.

pub mod histogram;
mod isovalues;
