//! Files of molecules: atoms and bonds as PDB and mmCIF have them.

mod atom;
mod bonds;
mod cif;
mod pdb;

#[cfg(test)]
mod tests;

use std::path::Path;

use super::stream::Stream;
use crate::error::Error;
pub use atom::{Atom, Element, Structure};

/// Reads the atoms of a PDB or mmCIF file (its contents tell which), and finds their bonds: those that it states, and
/// those between atoms as near as bonded ones are.
///
/// Of several models the first is read, and of alternate places of an atom the first. Fails where the file is missing,
/// is neither, or has no atom.
pub(crate) fn read_molecule(path: &Path) -> Result<Structure, Error> {
    let read = || {
        let bytes = Stream::open(path)?.rest()?;
        molecule(&String::from_utf8_lossy(&bytes))
    };
    read().map_err(|problem| Error::file(path, problem))
}

fn molecule(text: &str) -> Result<Structure, String> {
    let is_cif = text.lines().any(|line| line.trim_start().starts_with("_atom_site."));
    let (atoms, stated) = if is_cif { (cif::atoms(text)?, Vec::new()) } else { pdb::atoms(text)? };
    if atoms.is_empty() {
        return Err("holds no atom; expected a PDB file (ATOM and HETATM lines) or an mmCIF file (an _atom_site table)".to_owned());
    }
    let bonds = bonds::bonds(&atoms, stated);
    Ok(Structure { atoms, bonds })
}
