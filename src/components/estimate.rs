//! `estimate`: a picture tells how far it is off, from a few of its pixels that are cast exactly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Has the error of a view's picture estimated, as [`Judged`](crate::measure::judged::Judged). Equal seeds give equal bytes.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Estimate {
    /// Which pixels are drawn.
    pub seed: u32,
    /// The most that it may cost, as a part of what the picture's own rays cost; the more, the narrower the interval. A few
    /// pixels are cast however small the picture is.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1000.0))]
    pub share: f64,
}

impl Default for Estimate {
    fn default() -> Self {
        Self { seed: 0, share: 0.2 }
    }
}
