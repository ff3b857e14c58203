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
    PaperCost { stage: "relight", seconds: 60.0, what: "shading" },
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

/// What a number of the paper says of ours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Claim {
    /// About as much.
    About,
    /// Less than it.
    Below,
    /// More than it.
    Above,
}

/// A number that the paper's §7 or §6 states or that follows from two of its seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperNumber {
    /// A word for it, a key of saved profiles.
    pub key: &'static str,
    /// What it is of.
    pub what: &'static str,
    /// How the number is meant.
    pub claim: Claim,
    /// The number: a ratio where no unit is stated.
    pub number: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// The paper's numbers that are of no single stage.
pub static PAPER_NUMBERS: [PaperNumber; 7] = [
    PaperNumber {
        key: "hybrid",
        what: "a frame with polygons traced : volume alone",
        claim: Claim::About,
        number: 1.6,
        unit: "",
    },
    PaperNumber {
        key: "scan_converted",
        what: "a frame with polygons scan-converted : volume alone",
        claim: Claim::About,
        number: 1.4,
        unit: "",
    },
    PaperNumber {
        key: "shadows",
        what: "total voxel colors with shadows : without",
        claim: Claim::About,
        number: 2.0,
        unit: "",
    },
    PaperNumber {
        key: "textures",
        what: "a frame with textures : without",
        claim: Claim::About,
        number: 1.5,
        unit: "",
    },
    PaperNumber {
        key: "rays_per_pixel",
        what: "rays a pixel",
        claim: Claim::Below,
        number: 1.0,
        unit: "",
    },
    PaperNumber {
        key: "brute_force",
        what: "a frame by brute force : as stated",
        claim: Claim::Above,
        number: 100.0,
        unit: "",
    },
    PaperNumber {
        key: "memory",
        what: "shaded volume and pyramid",
        claim: Claim::About,
        number: 18.0,
        unit: "MB",
    },
];

/// The stages that make the total voxel colors c_T: what shadows double (§7).
pub const COLORS: [&str; 6] =
    ["ranges", "classify", "scan_convert", "matte", "light_sweep", "relight"];
