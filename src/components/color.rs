//! Colours: sRGB in scenes (`"#rrggbb"`, a name of CSS or three numbers 0–1), linear light everywhere else.

mod names;

use glam::Vec3;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// A colour in linear light, each channel in 0..=1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Color(pub Vec3);

impl Color {
    /// White, 1 in every channel.
    pub const WHITE: Self = Self(Vec3::ONE);

    /// From sRGB channels in 0..=1.
    #[must_use]
    pub fn from_srgb(srgb: [f32; 3]) -> Self {
        Self(Vec3::from(srgb.map(to_linear)))
    }

    /// The color of a number `0xrrggbb`, in sRGB; higher bits are of no account.
    #[must_use]
    pub fn from_number(number: u32) -> Self {
        Self::from_srgb([16, 8, 0].map(|shift| (number >> shift & 0xff) as f32 / 255.0))
    }

    /// To sRGB channels in 0..=1.
    #[must_use]
    pub fn to_srgb(self) -> [f32; 3] {
        self.0.to_array().map(to_srgb)
    }
}

/// The linear intensity of an sRGB channel in 0..=1 (IEC 61966-2-1).
#[must_use]
pub fn to_linear(channel: f32) -> f32 {
    if channel <= 0.040_45 { channel / 12.92 } else { libm::powf((channel + 0.055) / 1.055, 2.4) }
}

/// The sRGB channel of a linear intensity in 0..=1 (IEC 61966-2-1).
#[must_use]
pub fn to_srgb(intensity: f32) -> f32 {
    if intensity <= 0.003_130_8 {
        intensity * 12.92
    } else {
        1.055 * libm::powf(intensity, 1.0 / 2.4) - 0.055
    }
}

#[derive(Deserialize, Serialize)]
#[serde(untagged)]
enum Written {
    Text(String),
    Channels([f32; 3]),
}

const EXPECTED: &str =
    "a colour is \"#rrggbb\", a name of CSS such as \"white\", or three numbers in 0..=1, in sRGB";

/// The number of `#rrggbb`.
fn hex(text: &str) -> Option<u32> {
    let digits = text.strip_prefix('#').filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit()))?;
    if digits.len() == 6 { u32::from_str_radix(digits, 16).ok() } else { None }
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = Written::deserialize(deserializer)
            .map_err(|_| D::Error::custom(format!("found no colour: {EXPECTED}")))?;
        let srgb = match written {
            Written::Channels(channels) => channels,
            Written::Text(text) => {
                let number = hex(&text).or_else(|| names::named(&text)).ok_or_else(|| {
                    D::Error::custom(format!("\"{text}\" is no colour: {EXPECTED}"))
                })?;
                [16, 8, 0].map(|shift| (number >> shift & 0xff) as f32 / 255.0)
            }
        };
        if srgb.iter().any(|c| !(0.0..=1.0).contains(c)) {
            return Err(D::Error::custom(format!("{srgb:?} is no colour: {EXPECTED}")));
        }
        Ok(Self::from_srgb(srgb))
    }
}

impl Serialize for Color {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Written::Channels(self.to_srgb()).serialize(serializer)
    }
}

impl JsonSchema for Color {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Color".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "sRGB: \"#rrggbb\", a name of CSS or three numbers in 0..=1",
            "anyOf": [
                { "type": "string", "pattern": names::pattern() },
                { "type": "string", "pattern": "^#[0-9a-fA-F]{6}$" },
                { "type": "array", "items": { "type": "number", "minimum": 0, "maximum": 1 }, "minItems": 3, "maxItems": 3 }
            ]
        })
    }
}
