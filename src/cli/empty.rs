//! A picture that shows nothing: said, with the likeliest reason, for it is seldom what was wanted.

use gelray::components::{Classify, Name};
use gelray::measure::histogram::histogram;
use gelray::view::samples::SampleArray;
use gelray::volume::grid::Scalars;
use hecs::World;

use super::number::number;

/// A sentence about a picture in which no ray met anything; `None` if one did.
pub fn warning(world: &World, samples: &SampleArray) -> Option<String> {
    if samples.meets_anything() {
        return None;
    }
    let mut volumes = world.query::<(&Name, &Scalars, &Classify)>();
    let reasons: Vec<_> = volumes.iter().filter_map(|(n, s, c)| unseen(&n.0, s, c)).collect();
    let reason = match reasons.join("; ") {
        none if none.is_empty() => {
            "nothing that is stated lies in the view; check its `focal_point` and `height_mm`, and opacities of 0".to_owned()
        }
        some => some,
    };
    Some(format!("the picture is empty: {reason}"))
}

/// Why nothing of a volume is seen, if its contours lie outside of its values.
fn unseen(name: &str, scalars: &Scalars, classify: &Classify) -> Option<String> {
    let counted = histogram(scalars, 1);
    let levels = || classify.iso.iter().map(|contour| contour.value);
    let (least, greatest) =
        (levels().fold(f32::INFINITY, f32::min), levels().fold(f32::NEG_INFINITY, f32::max));
    let told = |value: f32| number(f64::from(value));
    if counted.counts == [0] {
        Some(format!("`{name}` has no finite value"))
    } else if least > counted.high && least.is_finite() {
        Some(format!(
            "no voxel of `{name}` reaches {}: the greatest is {}",
            told(least),
            told(counted.high)
        ))
    } else if greatest < counted.low && greatest.is_finite() {
        Some(format!(
            "every voxel of `{name}` is above {}: the least is {}",
            told(greatest),
            told(counted.low)
        ))
    } else {
        None
    }
}
