//! Slices to a grid: in order of their places, with a step between them that may be sheared, and what is odd said.

use glam::{DAffine3, DMat3, DVec3};

use super::slice::Slice;

/// Slices as near to each other as this part of the usual distance are at one place.
const ONE_PLACE: f64 = 0.02;

/// Distances that differ from the usual one by less than this part of it are even.
const EVEN: f64 = 0.02;

/// The most slices that uneven distances are filled up to, times those that there are.
const MOST_FILLED: usize = 4;

/// Degrees from which on a shear is said.
const TILTED: f64 = 0.1;

/// Slices in order, and where they are.
#[derive(Debug)]
pub(super) struct Stack {
    /// From the first to the last along the normal of the slices.
    pub slices: Vec<Slice>,
    /// Voxels on each axis: along rows, along columns, slices of the grid.
    pub size: [usize; 3],
    /// From voxel index to LPS.
    pub placed: DAffine3,
    /// For each slice of the grid, the two slices that it is between, and how far it is from the first to the second;
    /// `None` where each is a slice of its own.
    pub between: Option<Vec<(usize, f32)>>,
    pub warnings: Vec<String>,
}

impl Stack {
    /// Orders slices of one series, of one size and direction; at least two at different places.
    pub fn of(mut slices: Vec<Slice>) -> Result<Self, String> {
        let mut warnings = Vec::new();
        let [rows, columns] = directions(&slices, &mut warnings);
        let normal = rows.cross(columns).normalize_or(DVec3::Z);
        let mut places = places(&mut slices, normal, &mut warnings);
        let duplicates = without_duplicates(&mut slices, &mut places);
        if duplicates > 0 {
            warnings.push(format!(
                "{duplicates} of its slices are at the place of another and are left out"
            ));
        }
        let count = slices.len();
        let (Some(first), Some(last)) = (slices.first(), slices.last()) else {
            return Err("holds no slice".to_owned());
        };
        if count < 2 {
            return Err("is a single slice, and a volume needs at least 2; name the folder of the whole series".to_owned());
        }
        let length = places[count - 1] - places[0];
        let (number, between) = steps(&places, &mut warnings);
        let way = match (first.position, last.position) {
            (Some(from), Some(to)) => to - from,
            _ => normal * length,
        };
        tilt(way, normal, &mut warnings);
        let [across, down] = first.spacing;
        let step = way / (number - 1) as f64;
        let matrix3 = DMat3::from_cols(rows * across, columns * down, step);
        let size = [usize::from(first.size[0]), usize::from(first.size[1]), number];
        let translation = first.position.unwrap_or_default();
        let placed = DAffine3 { matrix3, translation };
        Ok(Self { slices, size, placed, between, warnings })
    }
}

fn directions(slices: &[Slice], warnings: &mut Vec<String>) -> [DVec3; 2] {
    if let Some(ways) = slices.first().and_then(|slice| slice.directions) {
        return ways.map(|way| way.normalize_or(DVec3::X));
    }
    warnings.push("states no orientation: its rows are taken as running to the left and its columns to the back".to_owned());
    [DVec3::X, DVec3::Y]
}

/// Sorts the slices by where they are along the normal, and tells where that is; by number where they do not say.
fn places(slices: &mut [Slice], normal: DVec3, warnings: &mut Vec<String>) -> Vec<f64> {
    if slices.iter().all(|slice| slice.position.is_some()) {
        let along = |slice: &Slice| slice.position.map_or(0.0, |place| place.dot(normal));
        slices.sort_by(|a, b| along(a).total_cmp(&along(b)).then(a.instance.cmp(&b.instance)));
        return slices.iter().map(along).collect();
    }
    slices.sort_by(|a, b| a.instance.cmp(&b.instance).then(a.path.cmp(&b.path)));
    let stated = slices.first().and_then(|slice| slice.between).map(f64::abs);
    let step = stated.filter(|step| step.is_normal()).unwrap_or(1.0);
    warnings.push(format!(
        "states no place of its slices: they are taken in order of their numbers, {step} mm apart"
    ));
    for slice in slices.iter_mut() {
        slice.position = None;
    }
    (0..slices.len()).map(|number| number as f64 * step).collect()
}

/// The middle one of the distances between neighbors.
fn usual(places: &[f64]) -> f64 {
    let mut steps: Vec<f64> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}

/// Leaves out slices at the place of the one before; tells how many.
fn without_duplicates(slices: &mut Vec<Slice>, places: &mut Vec<f64>) -> usize {
    let mut apart = places.clone();
    apart.dedup_by(|b, a| *b - *a < 1e-6);
    let least = (usual(&apart) * ONE_PLACE).max(1e-6);
    let before = slices.len();
    let mut kept: Vec<f64> = Vec::new();
    let mut place = places.iter().copied();
    slices.retain(|_| {
        let here = place.next().unwrap_or_default();
        let keep = kept.last().is_none_or(|last| here - last >= least);
        if keep {
            kept.push(here);
        }
        keep
    });
    *places = kept;
    before - slices.len()
}

/// How many slices the grid has, and which slices each is between where the distances are not even.
fn steps(places: &[f64], warnings: &mut Vec<String>) -> (usize, Option<Vec<(usize, f32)>>) {
    let count = places.len();
    let usual = usual(places);
    let steps = || places.windows(2).map(|pair| pair[1] - pair[0]);
    if steps().all(|step| (step - usual).abs() <= EVEN * usual) {
        return (count, None);
    }
    let length = places[count - 1] - places[0];
    let wanted = (length / usual).round() as usize + 1;
    let number = wanted.clamp(2, MOST_FILLED * count);
    let step = length / (number - 1) as f64;
    let (least, most) = steps().fold((f64::INFINITY, 0.0), |(a, b), s| (s.min(a), s.max(b)));
    warnings.push(format!(
        "its {count} slices are {least:.2} to {most:.2} mm apart along their normal: they are interpolated to {number} at even distances of {step:.2} mm"
    ));
    let mut below = 0;
    let between = (0..number).map(|index| {
        let here = places[0] + step * index as f64;
        while below + 2 < count && places[below + 1] <= here {
            below += 1;
        }
        let part = (here - places[below]) / (places[below + 1] - places[below]);
        (below, part.clamp(0.0, 1.0) as f32)
    });
    (number, Some(between.collect()))
}

fn tilt(way: DVec3, normal: DVec3, warnings: &mut Vec<String>) {
    let degrees = way.angle_between(normal).to_degrees();
    if degrees > TILTED {
        warnings.push(format!(
            "its slices are not stacked along their normal but {degrees:.1}° from it, as by a tilted gantry: its grid is sheared, and nothing is resampled for it"
        ));
    }
}
