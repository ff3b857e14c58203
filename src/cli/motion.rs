//! The flags of sequences: how many frames, about which axis, which part of them, and how fast they are shown.

use clap::{Args, ValueEnum};
use gelray::formats::moving::Rate;
use gelray::sequence::range::{FrameRange, Shard};
use gelray::sequence::turn;

/// What `animate` takes beside the flags of all verbs.
#[derive(Debug, Args)]
pub struct Motion {
    /// Frames of a full turn (72), or degrees FROM..TOxSTEP (0..90x5)
    #[arg(long, value_name = "N|FROM..TOxSTEP", default_value = "72", value_parser = FrameRange::parse, allow_hyphen_values = true)]
    pub frames: FrameRange,
    /// What the observer turns about [default: azimuth; keyframes, where the scene states `animate`]
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// Frames a second of an animation in one file (24, 29.97, 30000/1001)
    #[arg(long, value_name = "RATE", default_value = "24", value_parser = Rate::parse)]
    pub fps: Rate,
    /// Leaves frames as they are that are there already and whole, and show what they are to show
    #[arg(long)]
    pub resume: bool,
    /// Renders a part of the frames: 2/8 is the second of eight machines that share a folder
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    pub shard: Option<Shard>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Axis {
    /// Around the scene
    Azimuth,
    /// Over the scene, past the poles too
    Elevation,
    /// About upwards in the picture
    ViewUp,
}

impl Motion {
    /// What the observer is to turn about, if that was said.
    pub fn axis(&self) -> Option<turn::Axis> {
        self.axis.map(|axis| match axis {
            Axis::Azimuth => turn::Axis::Azimuth,
            Axis::Elevation => turn::Axis::Elevation,
            Axis::ViewUp => turn::Axis::ViewUp,
        })
    }
}
