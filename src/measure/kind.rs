//! What kind of data a volume seems to be, from its values and from where it came.

use super::histogram::Histogram;
use crate::volume::grid::{Scalar, Scalars};
use crate::with_scalars;

/// What a volume seems to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// CT in Hounsfield units.
    Ct,
    /// CT whose values are Hounsfield units plus 1024.
    ShiftedCt,
    /// Few whole numbers in flat regions: the labels of a segmentation.
    Labels,
    /// None of these.
    Other,
}

/// Different values that labels may have at the most.
const MOST_LABELS: usize = 256;

/// The part of neighbors along a row that are alike, from which on regions count as flat.
const FLAT: f64 = 0.6;

/// Guesses from the values alone; `counted` is their histogram.
///
/// Air at −1000 with tissue near 0 is CT; with air near 0 and tissue near 1024, both within what 12 bits hold, it is CT
/// as scanners store it.
#[must_use]
pub fn kind(scalars: &Scalars, counted: &Histogram) -> Kind {
    if with_scalars!(scalars, values => are_labels(values, counted.low)) {
        return Kind::Labels;
    }
    let within = |low: f32, high: f32| {
        let bins = (0..counted.counts.len())
            .filter(|&bin| counted.center(bin) >= low && counted.center(bin) <= high);
        let voxels: u64 = bins.map(|bin| counted.counts[bin]).sum();
        voxels as f64 / counted.counts.iter().sum::<u64>().max(1) as f64
    };
    let whole = !matches!(scalars, Scalars::U8(_) | Scalars::I8(_));
    // Air, and water or soft tissue, are most of what a scanner of the body sees.
    if whole && counted.low <= -900.0 && counted.low >= -33_000.0 && counted.high > 0.0 {
        let seen = within(-1100.0, -850.0) > 0.02 || counted.low <= -1500.0;
        if seen && within(-250.0, 300.0) > 0.02 {
            return Kind::Ct;
        }
    }
    let stored = counted.low >= 0.0 && (1500.0..=4200.0).contains(&counted.high);
    if whole && stored && within(0.0, 200.0) > 0.05 && within(850.0, 1250.0) > 0.05 {
        // The gap between fat and air, where nothing but borders is, tells CT from what merely fills 12 bits.
        let gap = within(350.0, 700.0);
        if gap < 0.5 * within(850.0, 1250.0) {
            return Kind::ShiftedCt;
        }
    }
    Kind::Other
}

/// Whether whole numbers of few values fill flat regions, apart from that of the least value, which is background.
fn are_labels<T: Scalar>(values: &[T], least: f32) -> bool {
    let mut seen: Vec<f32> = Vec::new();
    let (mut alike, mut within) = (0_usize, 0_usize);
    let mut last = f32::NAN;
    for value in values.iter().map(|value| value.value()) {
        within += usize::from(value != least);
        if value == last {
            alike += usize::from(value != least);
            continue;
        }
        last = value;
        if value.fract() != 0.0 || !value.is_finite() {
            return false;
        }
        if let Err(at) = seen.binary_search_by(|known| known.total_cmp(&value)) {
            if seen.len() == MOST_LABELS {
                return false;
            }
            seen.insert(at, value);
        }
    }
    seen.len() > 1 && alike as f64 > FLAT * within as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::Voxels;
    use crate::measure::histogram::histogram;
    use crate::phantom::phantom;
    use crate::shared::Shared;

    fn of(scalars: &Scalars) -> Kind {
        kind(scalars, &histogram(scalars, 4096))
    }

    /// Runs of noisy values, one material after another.
    fn bodies(materials: &[i16], noise: i16) -> Vec<i16> {
        let run = |&value: &i16| (0..97_i16).map(move |i| value + i * 31 % 53 * noise / 53);
        materials.iter().cycle().take(600).flat_map(run).collect()
    }

    #[test]
    fn air_and_water_tell_ct_with_and_without_the_shift() {
        let signed = bodies(&[-1000, -1000, -80, 40, 900], 40);
        assert_eq!(of(&Scalars::I16(Shared::new(signed.clone()))), Kind::Ct);
        let stored = signed.iter().map(|&v| (v + 1024) as u16).collect();
        assert_eq!(of(&Scalars::U16(Shared::new(stored))), Kind::ShiftedCt);
    }

    #[test]
    fn the_phantom_of_a_head_is_ct_as_it_is_stored() {
        let Voxels::Scalars(head) = phantom("head").unwrap().voxels else { unreachable!() };
        assert_eq!(of(&head), Kind::ShiftedCt);
    }

    #[test]
    fn few_whole_numbers_in_flat_regions_are_labels() {
        assert_eq!(of(&Scalars::I16(Shared::new(bodies(&[0, 0, 1, 7], 0)))), Kind::Labels);
        assert_eq!(of(&Scalars::I16(Shared::new(bodies(&[0, 0, 1, 7], 9)))), Kind::Other);
        let halves = vec![0.5, 0.5, 1.0, 1.0];
        assert_eq!(of(&Scalars::F32(Shared::new(halves))), Kind::Other);
    }

    #[test]
    fn a_density_is_none_of_these() {
        let Voxels::Scalars(map) = phantom("molecule").unwrap().voxels else { unreachable!() };
        assert_eq!(of(&map), Kind::Other);
        assert_eq!(of(&Scalars::F32(Shared::new(vec![f32::NAN; 9]))), Kind::Other);
    }
}
