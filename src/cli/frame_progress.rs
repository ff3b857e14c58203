//! How far a sequence is: a bar with frames, rate and time left on a terminal, a line a frame in a log, nothing with `-q`.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::animate_stats::FrameStats;
use super::failure::tell;
use super::flags::Flags;

/// What is shown while frames are rendered.
pub enum FrameProgress {
    /// Nothing.
    Nothing,
    /// A bar.
    Bar(ProgressBar),
    /// Lines, with the systems that ran.
    Lines { systems: bool },
}

impl FrameProgress {
    /// Shows the progress of `count` frames in the way that the flags and standard error ask for.
    pub fn show(count: usize, flags: &Flags) -> Self {
        if flags.quiet {
            return Self::Nothing;
        }
        if !std::io::stderr().is_terminal() || flags.verbose {
            return Self::Lines { systems: flags.verbose };
        }
        let target = ProgressDrawTarget::stderr();
        let bar = ProgressBar::with_draw_target(Some(count as u64), target);
        if let Ok(style) =
            ProgressStyle::with_template("{pos}/{len} frames {wide_bar} {per_sec}, {eta} left")
        {
            bar.set_style(style);
        }
        bar.tick();
        Self::Bar(bar)
    }

    /// A frame was rendered, one of `count` of the sequence.
    pub fn frame(&self, frame: &FrameStats, count: usize) {
        let FrameStats { number, seconds, .. } = frame;
        match self {
            Self::Nothing => (),
            Self::Bar(bar) => bar.inc(1),
            Self::Lines { systems } => {
                let ran = if *systems {
                    format!(", {} ran", frame.made().join(", "))
                } else {
                    String::new()
                };
                tell(format_args!("frame {number} of {count}: {seconds:.3} s{ran}"));
            }
        }
    }
}

impl Drop for FrameProgress {
    fn drop(&mut self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}
