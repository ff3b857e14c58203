//! `profile --resume`: what a saved measurement that was stopped holds, and the runs that it lacks.

use gelray::Error;
use serde::Deserialize;

use super::failure::Failure;
use super::flags::Flags;
use super::noted::VERSION;
use super::outputs;
use super::profile_run::{Run, Subject, profile};
use super::profile_saved::Profile;

/// What was measured before of `N` subjects by turns; of none of them where the measurement begins.
pub struct Begun<const N: usize>(Option<[Profile; N]>);

/// A profile as it is saved, alone or beside another.
#[derive(Deserialize)]
#[serde(untagged)]
enum Saved {
    Pair { a: Box<Profile>, b: Box<Profile> },
    One(Box<Profile>),
}

/// What the file that `-o` names holds of the same measurement, if it is asked for; a file that is not there holds nothing.
///
/// The failure is a sentence: there is no file to go on with, or it holds something else.
pub fn begun<const N: usize>(
    resume: bool,
    subjects: [&Subject; N],
    flags: &Flags,
) -> Result<Begun<N>, Failure> {
    if !resume {
        return Ok(Begun(None));
    }
    let path =
        flags.output.as_deref().filter(|path| !outputs::is_standard(path)).ok_or_else(|| {
            Failure::Misused(
                "--resume goes on with a saved profile; name it with -o FILE.json".to_owned(),
            )
        })?;
    let Ok(text) = std::fs::read_to_string(path) else { return Ok(Begun(None)) };
    let other = |what: &str| {
        Failure::Said(format!("{}: {what}; leave --resume away to measure anew", path.display()))
    };
    let saved =
        serde_json::from_str(&text).map_err(|error| other(&format!("is no profile ({error})")))?;
    let saved = match saved {
        Saved::Pair { a, b } => vec![*a, *b],
        Saved::One(one) => vec![*one],
    };
    let of_as_many = |_| other("is a profile of another number of scenes");
    let saved: [Profile; N] = saved.try_into().map_err(of_as_many)?;
    for (profile, subject) in saved.iter().zip(subjects) {
        if !is_of(profile, subject)? {
            return Err(other("was measured of other settings, threads or by another version"));
        }
    }
    Ok(Begun(Some(saved)))
}

fn is_of(profile: &Profile, subject: &Subject) -> Result<bool, Failure> {
    let scene = subject.load()?;
    Ok(profile.settings == scene.resolved
        && profile.missing == scene.missing
        && profile.version == VERSION
        && profile.threads == rayon::current_num_threads())
}

impl<const N: usize> Begun<N> {
    /// How many of `repeat` runs are left to be made.
    pub fn left(&self, repeat: u32) -> u32 {
        let runs = |profile: &Profile| profile.run.seconds.len() as u32;
        let done = self.0.iter().flatten().map(runs).min().unwrap_or(0);
        repeat.saturating_sub(done)
    }

    /// All runs of each subject, those that were made now last; interrupted, if there is none.
    pub fn then(self, runs: Vec<[Run; N]>) -> Result<[Profile; N], Failure> {
        let mut of_each: [Vec<Run>; N] = std::array::from_fn(|_| Vec::new());
        for turn in runs {
            of_each.iter_mut().zip(turn).for_each(|(runs, run)| runs.push(run));
        }
        let new: Vec<Profile> = of_each.iter().filter_map(|runs| profile(runs)).collect();
        match (self.0, <[Profile; N]>::try_from(new)) {
            (None, Ok(new)) => Ok(new),
            (Some(before), Err(_)) => Ok(before),
            (Some(before), Ok(new)) => {
                let mut before = before.into_iter();
                Ok(new.map(|new| match before.next() {
                    Some(before) => new.after(before),
                    None => new,
                }))
            }
            (None, Err(_)) => Err(Error::Interrupted.into()),
        }
    }
}
