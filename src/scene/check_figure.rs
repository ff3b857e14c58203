//! What the schema cannot say of labels, molecules and the furniture of figures.

use super::check::{Check, Wrong, wrong};
use crate::components::{Labels, Legend, Molecule};

impl Check for Labels {
    fn check(&self) -> Result<(), Wrong> {
        let repeated = |i: &usize| self.table[..*i].iter().any(|l| l.label == self.table[*i].label);
        match (0..self.table.len()).find(repeated) {
            Some(i) => wrong(
                format!("table.{i}"),
                format!("has label {} twice; keep one of them", self.table[i].label),
            ),
            None => Ok(()),
        }
    }
}

impl Check for Molecule {
    fn check(&self) -> Result<(), Wrong> {
        if self.file.is_empty() {
            return wrong("file", "names no file; state the path of a PDB or mmCIF file");
        }
        Ok(())
    }
}

impl Check for Legend {
    fn check(&self) -> Result<(), Wrong> {
        if self.entries.is_empty() && self.of.is_none() {
            return wrong("", "explains nothing; state `entries` or `of`");
        }
        Ok(())
    }
}
