//! tbd
pub fn molecule() -> crate::formats::Loaded {
    super::simple::ramp()
}
