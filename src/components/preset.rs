//! Classifications by name: `preset` and `colormap` of `classify`, for data whose values mean what they commonly mean.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A classification and its colors by name; those of CT are in Hounsfield units, or in these plus 1024 where no value is
/// negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// CT: the boundaries of bone (from 120 on) within those of skin, which are clear.
    CtBone,
    /// CT: the skin (−300), opaque.
    CtSkin,
    /// CT: lungs (−900 to −500) and bone.
    CtLung,
    /// CT with contrast: vessels (130 to 400) and bone.
    CtVessel,
    /// MR of a head: gray and white matter by their brightness, more opaque the brighter.
    MrBrain,
    /// Fluorescence: what glows, from the brightest hundredth of the voxels on down to where half of them are.
    Fluorescence,
    /// The density of a molecule: its contour at two standard deviations above the mean.
    Density,
}

impl Preset {
    /// Every preset, in the order in which messages list them.
    pub const ALL: [Self; 7] = [
        Self::CtBone,
        Self::CtSkin,
        Self::CtLung,
        Self::CtVessel,
        Self::MrBrain,
        Self::Fluorescence,
        Self::Density,
    ];

    /// Its name, as a scene states it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::CtBone => "ct-bone",
            Self::CtSkin => "ct-skin",
            Self::CtLung => "ct-lung",
            Self::CtVessel => "ct-vessel",
            Self::MrBrain => "mr-brain",
            Self::Fluorescence => "fluorescence",
            Self::Density => "density",
        }
    }

    /// The preset of that name; the error lists those that there are.
    pub fn named(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|preset| preset.name() == name);
        found.ok_or_else(|| {
            let known: Vec<_> = Self::ALL.iter().map(|preset| preset.name()).collect();
            format!("there is no preset `{name}`; expected one of {}", known.join(", "))
        })
    }
}

/// A color map of the field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Colormap {
    /// From black to white.
    Gray,
    /// Violet, green, yellow: even to the eye (van der Walt and Smith 2015).
    Viridis,
    /// Black, magenta, cream: even to the eye.
    Magma,
    /// Blue to yellow: the same to the color-blind (Nuñez, Anderton and Renslow 2018).
    Cividis,
    /// Blue over gray to red, for values on either side of a middle (Moreland 2009).
    CoolWarm,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_that_scenes_state() {
        for preset in Preset::ALL {
            assert_eq!(serde_json::to_value(preset).unwrap(), preset.name());
            assert_eq!(Preset::named(preset.name()), Ok(preset));
        }
        assert!(Preset::named("bone").unwrap_err().contains("ct-bone, ct-skin"));
    }
}
