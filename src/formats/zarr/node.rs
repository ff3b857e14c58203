//! What a folder of Zarr is: an array, or a group of other folders.

use std::path::Path;

use serde_json::Value;

use super::array::Array;
use super::json::read;
use super::{version2, version3};

/// Files of metadata, any of which makes a folder one of Zarr.
pub(super) const METADATA: [&str; 4] = ["zarr.json", ".zarray", ".zgroup", ".zattrs"];

/// What a folder is.
#[derive(Debug, Clone)]
pub(super) enum Node {
    Array(Box<Array>),
    /// A group's attributes.
    Group(Value),
}

impl Node {
    /// What a folder is; `None` where it holds no metadata.
    pub fn read(folder: &Path) -> Result<Option<Self>, String> {
        if let Some(stated) = read(folder, METADATA[0])? {
            return match stated.get("node_type").and_then(Value::as_str) {
                Some("group") => {
                    Ok(Some(Self::Group(stated.get("attributes").cloned().unwrap_or_default())))
                }
                _ => Self::array(version3::array(folder, &stated)?).map(Some),
            };
        }
        let array = read(folder, METADATA[1])?;
        let attributes = read(folder, METADATA[3])?;
        match array {
            Some(stated) => {
                let attributes = attributes.unwrap_or_default();
                Self::array(version2::array(folder, &stated, attributes)?).map(Some)
            }
            None if attributes.is_some() || folder.join(METADATA[2]).exists() => {
                Ok(Some(Self::Group(attributes.unwrap_or_default())))
            }
            None => Ok(None),
        }
    }

    fn array(array: Array) -> Result<Self, String> {
        array.check()?;
        Ok(Self::Array(Box::new(array)))
    }
}
