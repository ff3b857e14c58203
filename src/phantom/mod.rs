//! Volumes made by formula: the same bits on every machine.

use crate::formats::Loaded;
use crate::picture::Picture;

/// The phantom called `name`, or the names that there are.
pub fn phantom(name: &str) -> Result<Loaded, String> {
    Err(format!("there is no phantom `{name}`"))
}

/// The texture made by the formula called `name`, or the names that there are.
pub fn texture(name: &str) -> Result<Picture, String> {
    Err(format!("there is no texture formula `{name}`"))
}
