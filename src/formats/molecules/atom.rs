//! Atoms, as far as they are drawn.

use glam::DVec3;

/// A molecule: its atoms and which of them are bonded.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Structure {
    /// In the order of the file.
    pub atoms: Vec<Atom>,
    /// Pairs of atoms, by their places in `atoms`, the lesser first; each once.
    pub bonds: Vec<[u32; 2]>,
}

/// An atom.
#[derive(Debug, Clone, PartialEq)]
pub struct Atom {
    /// Its place in the file's coordinates, Å; finite.
    pub place: DVec3,
    /// What it is.
    pub element: Element,
    /// Whether it is of water.
    pub is_water: bool,
    /// Where its chain's backbone runs through it: an alpha carbon or a phosphorus of a chain.
    pub backbone: Option<Residue>,
}

/// A residue of a chain: the chain's name and the residue's number in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Residue {
    /// The chain.
    pub chain: String,
    /// Counted in the chain.
    pub number: i64,
}

/// Chemical elements that have a color and a radius of their own here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the variants are the elements")]
pub enum Element {
    Hydrogen,
    Carbon,
    Nitrogen,
    Oxygen,
    Phosphorus,
    Sulfur,
    Halogen,
    Other,
}

impl Element {
    /// The element of a symbol, in either case.
    #[must_use]
    pub fn of(symbol: &str) -> Self {
        match symbol.trim().to_ascii_uppercase().as_str() {
            "H" | "D" => Self::Hydrogen,
            "C" => Self::Carbon,
            "N" => Self::Nitrogen,
            "O" => Self::Oxygen,
            "P" => Self::Phosphorus,
            "S" | "SE" => Self::Sulfur,
            "F" | "CL" | "BR" | "I" => Self::Halogen,
            _ => Self::Other,
        }
    }

    /// sRGB, `0xrrggbb`, after Corey, Pauling and Koltun.
    #[must_use]
    pub fn color(self) -> u32 {
        match self {
            Self::Hydrogen => 0xe8_e8e8,
            Self::Carbon => 0x90_9090,
            Self::Nitrogen => 0x30_50f8,
            Self::Oxygen => 0xf0_2010,
            Self::Phosphorus => 0xff_8000,
            Self::Sulfur => 0xf0_d020,
            Self::Halogen => 0x20_c020,
            Self::Other => 0xc0_60c0,
        }
    }

    /// The radius of van der Waals, Å (Bondi 1964).
    #[must_use]
    pub fn radius(self) -> f64 {
        match self {
            Self::Hydrogen => 1.2,
            Self::Carbon => 1.7,
            Self::Nitrogen => 1.55,
            Self::Oxygen => 1.52,
            Self::Phosphorus | Self::Sulfur | Self::Halogen => 1.8,
            Self::Other => 2.0,
        }
    }

    /// The covalent radius, Å (Cordero and others 2008).
    #[must_use]
    pub(crate) fn covalent(self) -> f64 {
        match self {
            Self::Hydrogen => 0.31,
            Self::Carbon => 0.76,
            Self::Nitrogen => 0.71,
            Self::Oxygen => 0.66,
            Self::Phosphorus => 1.07,
            Self::Sulfur => 1.05,
            Self::Halogen => 1.02,
            // Of metals, whose bonds to what is around them are none of covalence.
            Self::Other => 0.9,
        }
    }
}
