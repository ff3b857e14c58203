//! What the schema of `animate` cannot say: moments that belong to values, in order, and values of one kind.

use super::check::{Check, Wrong, wrong};
use crate::components::{Animate, Keyed, Track};

impl Check for Animate {
    fn check(&self) -> Result<(), Wrong> {
        self.tracks.iter().enumerate().try_for_each(|(n, track)| check_track(n, track))
    }
}

fn check_track(n: usize, track: &Track) -> Result<(), Wrong> {
    if !track.key.contains('.') || track.key.starts_with("animate.") || track.key.contains('=') {
        return wrong(
            format!("tracks.{n}.key"),
            "has a `key` that is no value of the entity; write COMPONENT.KEY, such as `view.azimuth`",
        );
    }
    let shape = |value: &Keyed| match value {
        Keyed::Number(_) => Some(0),
        Keyed::Numbers(numbers) => Some(numbers.len()),
        Keyed::Color(_) => None,
    };
    if let Some(other) = track.to.iter().position(|value| shape(value) != shape(&track.to[0])) {
        return wrong(
            format!("tracks.{n}.to.{other}"),
            "mixes values of several kinds; state numbers, colors, or arrays of one length",
        );
    }
    let Some(at) = &track.at else { return Ok(()) };
    if at.len() != track.to.len() {
        let problem = format!(
            "has {} moments for {} values; state one for each, or leave `at` away",
            at.len(),
            track.to.len()
        );
        return wrong(format!("tracks.{n}.at"), problem);
    }
    match at.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(before) => wrong(
            format!("tracks.{n}.at.{}", before + 1),
            "has a moment that is not after the one before; state them in order",
        ),
        None => Ok(()),
    }
}
