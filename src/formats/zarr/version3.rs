//! Version 3 of Zarr: an array's `zarr.json`, with a chain of codecs, of which one may make shards.

use std::path::Path;

use serde_json::Value;

use super::array::{Array, Chain, Content, Keys, Shard, Table, fill};
use super::json::{list, short, text, whole_numbers};
use super::packing::Packing;
use super::version2::separator;
use crate::formats::number::Order;
use crate::formats::numpy::element;

/// How deep shards may lie in shards.
const MOST_SHARDS: usize = 3;

/// The keys of an array that are known; others may be passed over only where they say so.
const KNOWN: [&str; 12] = [
    "zarr_format",
    "node_type",
    "shape",
    "data_type",
    "chunk_grid",
    "chunk_key_encoding",
    "fill_value",
    "codecs",
    "attributes",
    "storage_transformers",
    "dimension_names",
    "consolidated_metadata",
];

/// What `zarr.json` states of an array.
pub(super) fn array(folder: &Path, stated: &Value) -> Result<Array, String> {
    let stranger = |(key, value): (&String, &Value)| {
        let may_be_passed_over = value.get("must_understand") == Some(&Value::Bool(false));
        (!KNOWN.contains(&key.as_str()) && !may_be_passed_over).then(|| key.clone())
    };
    if let Some(key) = stated.as_object().into_iter().flatten().find_map(stranger) {
        return Err(format!(
            "has an extension `{key}`, which is not read; write it again without that"
        ));
    }
    if !list(stated, "storage_transformers").is_empty() {
        return Err("has `storage_transformers`, which are not read; write it without".to_owned());
    }
    let shape = whole_numbers(stated, "shape")?;
    let (grid, grid_stated) = named(stated.get("chunk_grid"), "chunk_grid")?;
    if grid != "regular" {
        return Err(format!(
            "its chunks are in a grid `{grid}`, and `regular` is read; write it with chunks of one size"
        ));
    }
    let (element, _) = element(number_type(stated.get("data_type"))?)?;
    let names = list(stated, "dimension_names").iter();
    Ok(Array {
        folder: folder.to_owned(),
        files: vec![folder.join("zarr.json")],
        chunk: whole_numbers(grid_stated, "chunk_shape")?,
        element,
        fill: fill(stated.get("fill_value"), element)?,
        chain: chain(list(stated, "codecs"), shape.len(), 0)?,
        keys: keys(stated.get("chunk_key_encoding"))?,
        names: names.map(|name| name.as_str().unwrap_or_default().to_owned()).collect(),
        attributes: stated.get("attributes").cloned().unwrap_or_default(),
        shape,
    })
}

/// The name of an extension, and its configuration.
fn named<'v>(value: Option<&'v Value>, key: &str) -> Result<(&'v str, &'v Value), String> {
    match value {
        Some(Value::String(name)) => Ok((name, &Value::Null)),
        Some(value) => {
            Ok((text(value, "name")?, value.get("configuration").unwrap_or(&Value::Null)))
        }
        None => Err(format!("states no `{key}`; write it again")),
    }
}

/// A number type as NumPy names it.
fn number_type(stated: Option<&Value>) -> Result<&'static str, String> {
    const TYPES: [(&str, &str); 12] = [
        ("bool", "b1"),
        ("int8", "i1"),
        ("int16", "i2"),
        ("int32", "i4"),
        ("int64", "i8"),
        ("uint8", "u1"),
        ("uint16", "u2"),
        ("uint32", "u4"),
        ("uint64", "u8"),
        ("float16", "f2"),
        ("float32", "f4"),
        ("float64", "f8"),
    ];
    let found = stated.and_then(Value::as_str);
    TYPES.iter().find(|(name, _)| Some(*name) == found).map(|(_, kind)| *kind).ok_or_else(|| {
        let found = stated.map_or("absent".to_owned(), short);
        format!("its `data_type` is {found}, and integers and floats of at most 64 bits are read; convert it with astype")
    })
}

fn keys(stated: Option<&Value>) -> Result<Keys, String> {
    let (name, stated) = named(stated, "chunk_key_encoding")?;
    let (prefixed, usual) = match name {
        "default" => (true, "/"),
        "v2" => (false, "."),
        other => {
            return Err(format!(
                "its chunks are named by `{other}`, and `default` or `v2` is read; write it with one of these"
            ));
        }
    };
    match stated.get("separator").and_then(Value::as_str).unwrap_or(usual) {
        "/" => Ok(Keys { prefixed, separator: '/' }),
        "." => Ok(Keys { prefixed, separator: '.' }),
        other => Err(separator(other)),
    }
}

/// Codecs: first those of axes, then one that makes bytes of numbers, then those of bytes.
fn chain(codecs: &[Value], count: usize, deep: usize) -> Result<Chain, String> {
    let mut axes: Vec<usize> = (0..count).collect();
    let mut content = None;
    for codec in codecs {
        let (name, stated) = named(Some(codec), "codecs")?;
        match (&mut content, name) {
            (None, "transpose") => {
                let order = whole_numbers(stated, "order")?;
                let turned: Option<Vec<_>> =
                    order.iter().map(|&at| axes.get(at).copied()).collect();
                let all = (0..count).all(|axis| order.contains(&axis)) && order.len() == count;
                axes = turned.filter(|_| all).ok_or_else(|| {
                    format!("its codec `transpose` has the order {order:?}, and each of {count} axes once is expected; correct it")
                })?;
            }
            (None, "bytes") => {
                let order = stated.get("endian").and_then(Value::as_str).unwrap_or("little");
                content = Some(Content::Numbers(Order::named(order)?, Vec::new()));
            }
            (None, "sharding_indexed") => {
                if !axes.iter().copied().eq(0..count) {
                    return Err("has axes turned about before its shards, which is not read; put `transpose` into the codecs of the shards".to_owned());
                }
                content = Some(Content::Shard(Box::new(shard(stated, count, deep + 1)?)));
            }
            (Some(Content::Numbers(_, packings)), name) => {
                packings.push(Packing::named(name, stated)?);
            }
            (Some(Content::Shard(_)), _) => {
                return Err(format!(
                    "has shards packed as a whole by `{name}`, which is not read; put it into the codecs of the shards"
                ));
            }
            (None, _) => {
                return Err(format!(
                    "has numbers made bytes by `{name}`, and `bytes` and `sharding_indexed` are read; write it with one of these"
                ));
            }
        }
    }
    let content = content.ok_or("its `codecs` make no bytes of numbers; write it again")?;
    Ok(Chain { axes, content })
}

fn shard(stated: &Value, count: usize, deep: usize) -> Result<Shard, String> {
    if deep > MOST_SHARDS {
        return Err(format!("has shards in shards, deeper than {MOST_SHARDS}; write it with one"));
    }
    let first = match stated.get("index_location").and_then(Value::as_str) {
        None | Some("end") => false,
        Some("start") => true,
        Some(other) => {
            return Err(format!(
                "its shards' `index_location` is `{other}`, and `start` or `end` is expected; correct it"
            ));
        }
    };
    let table = match chain(list(stated, "index_codecs"), 1, MOST_SHARDS)?.content {
        Content::Numbers(order, packings) if packings.is_empty() => {
            Table { order, summed: false, first }
        }
        Content::Numbers(order, packings) if packings == [Packing::Crc32c] => {
            Table { order, summed: true, first }
        }
        _ => {
            return Err("has a packed table of shards, and `bytes` and `crc32c` are read; write it with these as `index_codecs`".to_owned());
        }
    };
    let chunk = whole_numbers(stated, "chunk_shape")?;
    Ok(Shard { chunk, chain: chain(list(stated, "codecs"), count, deep)?, table })
}
