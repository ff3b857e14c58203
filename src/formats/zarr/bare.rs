//! Arrays that are of no image: what their own names and attributes say of their axes.

use serde_json::Value;

use super::array::Array;
use super::axes::{Axis, Kind};
use super::json::list;
use super::units::millimeters;

/// The axes of an array that is of no image, and a sentence about an attribute that says how far apart voxels are.
pub(super) fn bare(array: &Array) -> (Vec<Axis>, Option<String>) {
    let name = |axis| array.names.get(axis).map_or("", String::as_str);
    let mut axes: Vec<_> = (0..array.shape.len()).map(|axis| Axis::named(name(axis))).collect();
    let Some((key, numbers)) = spacing(array) else { return (axes, None) };
    let unit = ["unit", "units"].into_iter().find_map(|key| {
        let stated = array.attributes.get(key)?;
        stated.as_str().or_else(|| stated.as_array()?.last()?.as_str())
    });
    let length = unit.and_then(millimeters).unwrap_or(1.0);
    for (axis, number) in axes.iter_mut().zip(&numbers) {
        axis.scale = if axis.kind == Kind::Space { number * length } else { *number };
    }
    let unit = unit.map_or("no unit".to_owned(), |unit| format!("the unit `{unit}`"));
    let said =
        format!("its attribute `{key}` of {unit} is taken as the spacing of its axes, {numbers:?}");
    (axes, Some(said))
}

/// What an attribute of an array says of its spacing, in the order of its axes: its name and the numbers.
fn spacing(array: &Array) -> Option<(&'static str, Vec<f64>)> {
    ["spacing", "scale", "voxel_size"].into_iter().find_map(|key| {
        let numbers = list(&array.attributes, key).iter();
        let numbers: Vec<f64> = numbers.map(Value::as_f64).collect::<Option<_>>()?;
        (numbers.len() == array.shape.len() && numbers.iter().all(|n| n.is_normal()))
            .then_some((key, numbers))
    })
}
