//! Version 2 of Zarr: an array's `.zarray`, with a compressor and filters, in C's order or Fortran's.

use std::path::Path;

use serde_json::Value;

use super::array::{Array, Chain, Content, Keys, fill};
use super::json::{list, short, text, whole_numbers};
use super::packing::Packing;
use crate::formats::numpy::element;

/// What `.zarray` states; `attributes` are those beside it.
pub(super) fn array(folder: &Path, stated: &Value, attributes: Value) -> Result<Array, String> {
    let shape = whole_numbers(stated, "shape")?;
    let kind = stated.get("dtype").and_then(Value::as_str).ok_or_else(|| {
        let found = stated.get("dtype").map_or("absent".to_owned(), short);
        format!(
            "its `dtype` is {found}, and that of plain numbers is expected; write one field alone"
        )
    })?;
    let (element, order) = element(kind)?;
    let mut axes: Vec<_> = (0..shape.len()).collect();
    match stated.get("order").and_then(Value::as_str) {
        None | Some("C") => {}
        Some("F") => axes.reverse(),
        Some(other) => {
            return Err(format!(
                "its `order` is `{other}`, and `C` or `F` is expected; correct it"
            ));
        }
    }
    let mut packings = Vec::new();
    let compressor = stated.get("compressor").filter(|stated| !stated.is_null());
    for way in list(stated, "filters").iter().chain(compressor) {
        packings.push(Packing::named(text(way, "id")?, way)?);
    }
    let separator = match stated.get("dimension_separator").and_then(Value::as_str) {
        None | Some(".") => '.',
        Some("/") => '/',
        Some(other) => return Err(separator(other)),
    };
    // xarray's convention.
    let names = list(&attributes, "_ARRAY_DIMENSIONS").iter();
    Ok(Array {
        folder: folder.to_owned(),
        files: [".zarray", ".zattrs"].map(|name| folder.join(name)).into(),
        chunk: whole_numbers(stated, "chunks")?,
        shape,
        element,
        fill: fill(stated.get("fill_value"), element)?,
        chain: Chain { axes, content: Content::Numbers(order, packings) },
        keys: Keys { prefixed: false, separator },
        names: names.map(|name| name.as_str().unwrap_or_default().to_owned()).collect(),
        attributes,
    })
}

/// The sentence about a separator that is none.
pub(super) fn separator(found: &str) -> String {
    format!("its chunks' names are separated by `{found}`, and `/` or `.` is expected; correct it")
}
