//! tbd
use crate::picture::Picture;
/// tbd
pub fn texture(name: &str) -> Result<Picture, String> {
    Err(format!("there is no texture formula `{name}`"))
}
