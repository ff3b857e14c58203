//! Units of length as OME-Zarr and others name them, in millimeters.

/// Names of units, in lower case, and how many millimeters they are.
const UNITS: &[(&[&str], f64)] = &[
    (&["picometer", "pm"], 1e-9),
    (&["angstrom", "å"], 1e-7),
    (&["nanometer", "nm"], 1e-6),
    (&["micrometer", "micron", "microns", "um", "µm", "μm"], 1e-3),
    (&["millimeter", "mm"], 1.0),
    (&["centimeter", "cm"], 10.0),
    (&["inch"], 25.4),
    (&["decimeter", "dm"], 100.0),
    (&["foot"], 304.8),
    (&["yard"], 914.4),
    (&["meter", "m"], 1e3),
    (&["kilometer", "km"], 1e6),
    (&["mile"], 1_609_344.0),
];

/// Millimeters of a unit, in the singular or plural, in American or British letters; `None` for one that is not known.
pub(super) fn millimeters(name: &str) -> Option<f64> {
    let name = name.trim().to_lowercase().replace("metre", "meter");
    let singular = name.strip_suffix('s').unwrap_or(&name);
    let is_it =
        |(names, _): &&(&[&str], f64)| names.iter().any(|own| *own == name || *own == singular);
    UNITS.iter().find(is_it).map(|(_, length)| *length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_in_their_spellings() {
        for (name, length) in [
            ("micrometer", 1e-3),
            ("Micrometres", 1e-3),
            ("um", 1e-3),
            ("angstrom", 1e-7),
            ("nm", 1e-6),
        ] {
            assert_eq!(millimeters(name), Some(length), "{name}");
        }
        assert_eq!(millimeters("pixel"), None);
    }
}
