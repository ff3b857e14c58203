//! OME-Zarr: an image at several resolutions, with what its axes are and where its voxels lie (versions 0.1 to 0.5).

use std::path::{Component, Path, PathBuf};

use serde_json::Value;

use super::axes::{Axis, Kind};
use super::json::{list, short, text};
use super::node::Node;
use super::units::millimeters;

/// How many folders up from an array its image is looked for.
const MOST_UP: usize = 4;

/// The axes of images before version 0.3.
const FIVE: [&str; 5] = ["t", "c", "z", "y", "x"];

/// An image: what a group says of its arrays.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Image {
    stated: Value,
    /// Names of its channels.
    pub labels: Vec<String>,
    /// The folders of its levels in that of the group, the finest first.
    pub levels: Vec<PathBuf>,
    /// Sentences about what was chosen of it.
    pub said: Vec<String>,
}

impl Image {
    /// The image of a group's attributes, if it is one.
    pub fn of(attributes: &Value) -> Result<Option<Self>, String> {
        let own = attributes.get("ome").unwrap_or(attributes);
        let images = list(own, "multiscales");
        let Some(stated) = images.first() else { return Ok(None) };
        let levels = list(stated, "datasets").iter().map(level).collect::<Result<Vec<_>, _>>()?;
        if levels.is_empty() {
            return Err("its `multiscales` name no `datasets`; name an array in it".to_owned());
        }
        let mut said = Vec::new();
        if images.len() > 1 {
            said.push(format!(
                "of its {} images the first is read; name an array in it to read another",
                images.len()
            ));
        }
        let channels = own.get("omero").map_or(&[][..], |omero| list(omero, "channels"));
        let label =
            |channel: &Value| channel.get("label").and_then(Value::as_str).map(str::to_owned);
        let labels = channels.iter().map(|channel| label(channel).unwrap_or_default()).collect();
        Ok(Some(Self { stated: stated.clone(), labels, levels, said }))
    }

    /// The image that an array is a level of, and which level: by the groups around it.
    pub fn around(array: &Path) -> Option<(Self, usize)> {
        let whole = std::path::absolute(array).ok()?;
        whole.ancestors().skip(1).take(MOST_UP).find_map(|folder| {
            let Ok(Some(Node::Group(attributes))) = Node::read(folder) else { return None };
            let image = Self::of(&attributes).ok()??;
            let own = whole.strip_prefix(folder).ok()?;
            let level = image.levels.iter().position(|level| level == own)?;
            Some((image, level))
        })
    }

    /// The axes of a level; sentences about what they lack are added to those that are said.
    pub fn axes(&mut self, level: usize, count: usize) -> Result<Vec<Axis>, String> {
        let stated = list(&self.stated, "axes");
        let mut axes: Vec<Axis> = if stated.is_empty() {
            FIVE[5 - count.min(5)..].iter().map(|name| Axis::named(name)).collect()
        } else {
            stated.iter().map(axis).collect::<Result<_, _>>()?
        };
        let own = list(&self.stated, "datasets").get(level);
        let own = own.map_or(&[][..], |own| list(own, "coordinateTransformations"));
        let of_all = list(&self.stated, "coordinateTransformations");
        own.iter().chain(of_all).try_for_each(|stated| transform(stated, &mut axes))?;
        if own.is_empty() && of_all.is_empty() {
            self.said.push("its metadata state no spacing, and 1 is taken on each axis; state `spacing_mm` (x, y, z)".to_owned());
        } else {
            self.said.extend(in_millimeters(&mut axes, stated));
        }
        Ok(axes)
    }
}

/// The folder of a level, which lies in the group's own.
fn level(stated: &Value) -> Result<PathBuf, String> {
    let name = text(stated, "path")?;
    let path = Path::new(name);
    let inside = path.components().all(|part| matches!(part, Component::Normal(_)));
    if name.is_empty() || !inside {
        return Err(format!("its level `{name}` is not in it; correct its `multiscales`"));
    }
    Ok(path.components().collect())
}

/// An axis by its name, or by its name, type and unit.
fn axis(stated: &Value) -> Result<Axis, String> {
    if let Some(name) = stated.as_str() {
        return Ok(Axis::named(name));
    }
    let axis = Axis::named(text(stated, "name")?);
    let kind = match stated.get("type").and_then(Value::as_str) {
        None => axis.kind,
        Some("space") => Kind::Space,
        Some("channel") => Kind::Channel,
        Some("time") => Kind::Time,
        Some(_) => Kind::Other,
    };
    Ok(Axis { kind, ..axis })
}

/// Applies a transformation to what went before.
fn transform(stated: &Value, axes: &mut [Axis]) -> Result<(), String> {
    let kind = text(stated, "type")?;
    if kind == "identity" {
        return Ok(());
    }
    if !["scale", "translation"].contains(&kind) {
        return Err(format!(
            "its coordinates are transformed by `{kind}`, and `scale` and `translation` are read; name an array in it and place it by `spacing_mm` and `center`"
        ));
    }
    let numbers: Option<Vec<f64>> = list(stated, kind).iter().map(Value::as_f64).collect();
    let numbers = numbers.filter(|numbers| numbers.len() == axes.len()).ok_or_else(|| {
        let found = stated.get(kind).map_or("absent".to_owned(), short);
        format!("its `{kind}` is {found}, and {} numbers are expected; correct it", axes.len())
    })?;
    for (axis, number) in axes.iter_mut().zip(numbers) {
        if kind == "scale" {
            axis.scale *= number;
            axis.offset *= number;
        } else {
            axis.offset += number;
        }
    }
    Ok(())
}

/// Puts axes of space into millimeters by their units; a sentence where one has none.
fn in_millimeters(axes: &mut [Axis], stated: &[Value]) -> Option<String> {
    let mut lacking = Vec::new();
    for (at, axis) in axes.iter_mut().enumerate().filter(|(_, axis)| axis.kind == Kind::Space) {
        let unit = stated.get(at).and_then(|stated| stated.get("unit")).and_then(Value::as_str);
        match unit.and_then(millimeters) {
            Some(length) => {
                axis.scale *= length;
                axis.offset *= length;
            }
            None => lacking.push(format!(
                "`{}`{}",
                axis.name,
                unit.map_or(String::new(), |unit| format!(" (`{unit}`)"))
            )),
        }
    }
    (!lacking.is_empty()).then(|| {
        let names = lacking.join(", ");
        format!("of its axes {names} no unit is known, and their numbers are taken as millimeters; state `spacing_mm` (x, y, z) if they are not")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn image(stated: &Value) -> Result<Image, String> {
        Image::of(stated).map(Option::unwrap)
    }

    #[test]
    fn transformations_are_applied_in_their_order_and_put_into_millimeters() {
        let axes = json!([
            { "name": "c", "type": "channel" },
            { "name": "z", "type": "space", "unit": "micrometer" },
            { "name": "y", "type": "space", "unit": "nanometer" },
            { "name": "x", "type": "space", "unit": "millimeter" },
        ]);
        let level = json!({ "path": "0", "coordinateTransformations": [
            { "type": "scale", "scale": [1, 2, 500, 0.25] },
            { "type": "translation", "translation": [0, 10, 0, 1] },
        ]});
        let stated = json!({ "axes": axes, "datasets": [level],
            "coordinateTransformations": [{ "type": "scale", "scale": [1, 1, 2, 2] }] });
        for attributes in [
            json!({ "multiscales": [stated], "omero": { "channels": [{ "label": "DAPI" }] } }),
            json!({ "ome": { "multiscales": [stated], "omero": { "channels": [{ "label": "DAPI" }] } } }),
        ] {
            let mut image = image(&attributes).unwrap();
            let axes = image.axes(0, 4).unwrap();
            let found: Vec<_> = axes.iter().map(|axis| (axis.scale, axis.offset)).collect();
            assert_eq!(found, [(1.0, 0.0), (2e-3, 1e-2), (1e-3, 0.0), (0.5, 2.0)]);
            assert_eq!((image.labels, image.said), (vec!["DAPI".to_owned()], vec![]));
        }
    }

    #[test]
    fn what_an_old_image_lacks_is_said() {
        let mut old =
            image(&json!({ "multiscales": [{ "datasets": [{ "path": "0" }] }] })).unwrap();
        let axes = old.axes(0, 4).unwrap();
        assert_eq!(axes.iter().map(|axis| axis.name.as_str()).collect::<String>(), "czyx");
        assert!(old.said[0].contains("spacing_mm"));
        let scaled = [json!({ "type": "scale", "scale": [3, 2, 1] })];
        let stated = json!({ "axes": ["z", "y", "x"], "datasets": [{ "path": "0", "coordinateTransformations": scaled }] });
        let mut named = image(&json!({ "multiscales": [stated] })).unwrap();
        assert_eq!(named.axes(0, 3).unwrap()[0].scale, 3.0);
        assert!(named.said[0].contains("`z`, `y`, `x`"), "{:?}", named.said);
    }

    #[test]
    fn what_an_image_must_not_say_is_refused() {
        for path in ["../other", "/etc", "", ".", "a/../../b"] {
            let stated = json!({ "multiscales": [{ "datasets": [{ "path": path }] }] });
            assert!(image(&stated).unwrap_err().contains("is not in it"), "{path}");
        }
        for (turned, said) in [
            (json!({ "type": "affine" }), "`affine`"),
            (json!({ "type": "scale", "scale": [1, 2] }), "3 numbers"),
            (json!({ "type": "scale", "path": "scale" }), "absent"),
        ] {
            let stated = json!({ "axes": ["z", "y", "x"], "datasets": [{ "path": "0", "coordinateTransformations": [turned] }] });
            let problem =
                image(&json!({ "multiscales": [stated] })).unwrap().axes(0, 3).unwrap_err();
            assert!(problem.contains(said), "{problem}");
        }
    }
}
