//! What the stages cost in the paper (§7), in its own words.

/// What the paper says that a stage took on a Sun 4/280, for three polygons in a head of 256 × 256 × 113 voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperCost {
    /// The stage; `frame` is adaptive ray tracing, interpolation and resampling together.
    pub stage: &'static str,
    /// Seconds.
    pub seconds: f64,
    /// What was timed, in the paper's words.
    pub what: &'static str,
}

/// The stages that make a frame from the gel.
pub const FRAME: [&str; 2] = ["cast", "resample"];

/// The seconds of the paper's §7, stage by stage. It states none for gradients (a part of shading) and shadows.
pub static PAPER: [PaperCost; 7] = [
    PaperCost { stage: "classify", seconds: 60.0, what: "classifying" },
    PaperCost { stage: "shade", seconds: 60.0, what: "shading" },
    PaperCost { stage: "scan_convert", seconds: 1.0, what: "a polygon" },
    PaperCost { stage: "pyramid", seconds: 60.0, what: "pyramid construction" },
    PaperCost { stage: "frame", seconds: 50.0, what: "volume alone" },
    PaperCost { stage: "frame", seconds: 70.0, what: "polygons scan-converted" },
    PaperCost { stage: "frame", seconds: 80.0, what: "polygons traced" },
];

/// The paper's costs of a stage, in the order of [`PAPER`].
pub fn paper_costs(stage: &str) -> impl Iterator<Item = &'static PaperCost> {
    PAPER.iter().filter(move |cost| cost.stage == stage)
}
