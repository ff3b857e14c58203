//! `--estimate` and `--target`: how far a picture is off, told by itself, and settings for how far it may be.

use std::fmt;

use clap::Args;
use gelray::components::{Estimate, View};
use gelray::measure::judged::Judged;
use gelray::scene::Scene;
use hecs::{Entity, World};

use super::calibration::calibrated;
use super::failure::Failure;
use super::flags::Flags;
use super::goal::Goal;
use super::interrupt::Interrupt;

/// What `render` takes about the accuracy of its picture.
#[derive(Debug, Args)]
pub struct Accuracy {
    /// Tells how far the picture is off, as PSNR and maximum, from a few of its pixels that are cast exactly
    #[arg(long)]
    estimate: bool,
    /// Renders by settings that a short calibration finds: the cheapest for psnr=45, max=0.01 or ssim=0.99, the most exact for ms=20
    #[arg(long, value_name = "MEASURE=NUMBER", value_parser = Goal::parse)]
    target: Option<Goal>,
    /// Views of a turn that the target is kept at; the worst of them counts
    #[arg(long, value_name = "N", default_value = "1", requires = "target", value_parser = clap::value_parser!(u32).range(1..=360))]
    views: u32,
}

impl Accuracy {
    /// The scene, with the settings that keep the target if there is one.
    pub fn calibrate(
        &self,
        scene: Scene,
        interrupt: &Interrupt,
        flags: &Flags,
    ) -> Result<Scene, Failure> {
        match self.target {
            Some(_) if flags.exact => Err(Failure::Misused(
                "--exact states settings and --target looks for some; leave one of them away"
                    .to_owned(),
            )),
            Some(goal) => calibrated(scene, (goal, self.views), interrupt, flags),
            None => Ok(scene),
        }
    }

    /// Has the error of the picture estimated, if that was asked for; what the view states of it stays.
    pub fn state(&self, world: &mut World) {
        let views = world.query_mut::<Entity>().with::<&View>().without::<&Estimate>();
        let views: Vec<Entity> = views.into_iter().collect();
        for view in views.into_iter().filter(|_| self.estimate) {
            // It was found there a line ago.
            let _ = world.insert_one(view, Estimate::default());
        }
    }
}

/// What a picture's notes say of its error, where it was estimated.
pub fn note(judged: Option<&Judged>) -> Result<Option<(String, String)>, Failure> {
    let Some(judged) = judged else { return Ok(None) };
    let text = serde_json::to_string(judged)
        .map_err(|error| Failure::Said(format!("the error cannot be noted ({error})")))?;
    Ok(Some(("error".to_owned(), text)))
}

/// The estimate in the words of the last line.
pub struct Told<'a>(pub &'a Judged);

impl fmt::Display for Told<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Judged { psnr_db, low, high, max, beyond, pixels, .. } = self.0;
        if psnr_db.is_infinite() {
            return write!(f, "no error found in {pixels} pixels");
        }
        let part = 100.0 * (1.0 - beyond);
        write!(
            f,
            "about {psnr_db:.1} dB ({low:.1} to {high:.1} in nine of ten cases), a pixel off by {max:.3} and {part:.0} % of all by no more"
        )
    }
}
