//! Keyframes: the value of a track at any part of a sequence.

use crate::components::{Color, Ease, Keyed, Track};
use glam::Vec3;

/// The value of a track at `part` of the sequence, 0..=1, as TOML; exactly what is stated at each of its moments, and
/// before the first and after the last.
#[must_use]
pub fn value(track: &Track, part: f64) -> String {
    let moments = moments(track);
    let values: Vec<Vec<f64>> = track.to.iter().map(numbers).collect();
    let at = moments.iter().position(|moment| *moment == part);
    if let Some(exact) = at.and_then(|at| track.to.get(at)) {
        return written(exact, &numbers(exact));
    }
    let channel = |n: usize| {
        let values: Vec<f64> = values.iter().map(|value| value[n]).collect();
        between(&moments, &values, track.ease, part)
    };
    match (track.to.first(), values.first()) {
        (Some(kind), Some(first)) => {
            written(kind, &(0..first.len()).map(channel).collect::<Vec<_>>())
        }
        _ => String::new(),
    }
}

/// The moments of a track: as stated, or at equal distances from 0 to 1.
fn moments(track: &Track) -> Vec<f64> {
    let last = track.to.len().saturating_sub(1).max(1) as f64;
    let even = || (0..track.to.len()).map(|n| n as f64 / last).collect();
    track.at.clone().unwrap_or_else(even)
}

/// The channels that are interpolated, each alone: of a color its linear light.
fn numbers(value: &Keyed) -> Vec<f64> {
    match value {
        Keyed::Number(number) => vec![*number],
        Keyed::Numbers(numbers) => numbers.clone(),
        Keyed::Color(color) => color.0.to_array().map(f64::from).to_vec(),
    }
}

/// Channels as TOML, in the form that `kind` has.
fn written(kind: &Keyed, channels: &[f64]) -> String {
    let list = |numbers: &[f64]| {
        let words: Vec<_> = numbers.iter().map(|number| format!("{number}")).collect();
        format!("[{}]", words.join(", "))
    };
    match kind {
        Keyed::Number(_) => channels.first().map(f64::to_string).unwrap_or_default(),
        Keyed::Numbers(_) => list(channels),
        Keyed::Color(_) => {
            let light = [0, 1, 2].map(|n| channels.get(n).map_or(0.0, |c| *c as f32));
            let srgb = Color(Vec3::from(light)).to_srgb();
            // Nine digits tell any two 32-bit floats apart.
            list(&srgb.map(|c| (f64::from(c.clamp(0.0, 1.0)) * 1e9).round() / 1e9))
        }
    }
}

fn between(moments: &[f64], values: &[f64], ease: Ease, part: f64) -> f64 {
    let after = moments.partition_point(|moment| *moment <= part);
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return 0.0 };
    if after == 0 {
        return first;
    }
    if after == moments.len() {
        return last;
    }
    let (from, to) = (values[after - 1], values[after]);
    let length = moments[after] - moments[after - 1];
    let x = (part - moments[after - 1]) / length;
    match ease {
        Ease::Linear => from + (to - from) * x,
        Ease::Smooth => {
            let slope = |n: usize| slope(moments, values, n) * length;
            hermite(x, [from, to], [slope(after - 1), slope(after)])
        }
    }
}

/// The slope of a smooth track at a moment: 0 at both ends and where it turns, else the harmonic mean of the slopes to its
/// sides (Fritsch and Butland 1984), which keeps the curve between the values around it.
fn slope(moments: &[f64], values: &[f64], n: usize) -> f64 {
    if n == 0 || n + 1 == moments.len() {
        return 0.0;
    }
    let secant = |n: usize| (values[n + 1] - values[n]) / (moments[n + 1] - moments[n]);
    let (left, right) = (secant(n - 1), secant(n));
    if left * right <= 0.0 {
        return 0.0;
    }
    let (before, behind) = (moments[n] - moments[n - 1], moments[n + 1] - moments[n]);
    let (heavy, light) = (2.0 * behind + before, behind + 2.0 * before);
    (heavy + light) / (heavy / left + light / right)
}

fn hermite(x: f64, [from, to]: [f64; 2], [leaving, arriving]: [f64; 2]) -> f64 {
    let (square, cube) = (x * x, x * x * x);
    let rise = 3.0 * square - 2.0 * cube;
    from + (to - from) * rise + leaving * (cube - 2.0 * square + x) + arriving * (cube - square)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(to: &[f64], at: Option<&[f64]>, ease: Ease) -> Track {
        let to = to.iter().copied().map(Keyed::Number).collect();
        Track { key: "view.azimuth".to_owned(), to, at: at.map(<[f64]>::to_vec), ease }
    }

    fn at(track: &Track, part: f64) -> f64 {
        value(track, part).parse().unwrap()
    }

    #[test]
    fn moments_show_exactly_what_is_stated_and_so_do_the_parts_outside() {
        for ease in [Ease::Linear, Ease::Smooth] {
            let track = track(&[0.1, 0.7, 0.2], Some(&[0.2, 0.3, 0.9]), ease);
            for (part, value) in [(0.0, 0.1), (0.2, 0.1), (0.3, 0.7), (0.9, 0.2), (1.0, 0.2)] {
                assert_eq!(at(&track, part), value);
            }
        }
        let even = track(&[0.0, 10.0, 30.0], None, Ease::Linear);
        assert_eq!([0.25, 0.5, 0.75].map(|part| at(&even, part)), [5.0, 10.0, 20.0]);
    }

    #[test]
    fn smooth_tracks_begin_and_end_at_rest_and_never_overshoot() {
        let track = track(&[0.0, 1.0, 1.5, 0.5], Some(&[0.0, 0.2, 0.8, 1.0]), Ease::Smooth);
        let values: Vec<f64> = (0..=1000).map(|n| at(&track, f64::from(n) / 1000.0)).collect();
        assert!(values.iter().all(|value| (0.0..=1.5).contains(value)));
        assert!(values[..=800].is_sorted() && values[800..].iter().rev().is_sorted());
        assert!(values[1] < 1e-3 && values[999] - 0.5 < 1e-3);
        let steps = values.windows(3).map(|v| (v[2] - 2.0 * v[1] + v[0]).abs());
        assert!(steps.fold(0.0, f64::max) < 1e-2, "no step of the pace");
    }

    #[test]
    fn light_is_mixed_between_colors_and_arrays_go_number_by_number() {
        let color = |srgb| Keyed::Color(Color::from_srgb(srgb));
        let to = vec![color([0.0, 0.0, 0.0]), color([1.0, 1.0, 1.0])];
        let fade = Track { to, ..track(&[], None, Ease::Linear) };
        let half: toml::Value =
            format!("c = {}", value(&fade, 0.5)).parse::<toml::Table>().unwrap()["c"].clone();
        assert!((half[0].as_float().unwrap() - 0.735_357).abs() < 1e-5, "half the light: {half}");
        let to = vec![Keyed::Numbers(vec![0.0, 1.0]), Keyed::Numbers(vec![1.0, 0.0])];
        let plane = Track { to, ..track(&[], None, Ease::Linear) };
        assert_eq!(value(&plane, 0.25), "[0.25, 0.75]");
    }
}
