//! PDB: lines of fixed columns (wwPDB format 3.3), of which those of atoms and of stated bonds are read.

use std::collections::HashMap;

use glam::DVec3;

use super::atom::{Atom, Element, Residue};

/// The atoms of the first model, and the bonds that are stated between them.
pub fn atoms(text: &str) -> Result<(Vec<Atom>, Vec<[u32; 2]>), String> {
    let (mut atoms, mut bonds, mut serials) = (Vec::new(), Vec::new(), HashMap::new());
    // Atoms of further models are others' places of the same; bonds come behind all models.
    let mut is_first_model = true;
    for (number, line) in text.lines().enumerate() {
        match column(line, 0, 6) {
            "ATOM" | "HETATM" if is_first_model => {
                let atom = atom(line).ok_or_else(|| {
                    format!("line {} is no atom of a PDB file: columns 31 to 54 are to be three coordinates", number + 1)
                })?;
                if !matches!(column(line, 16, 17), "" | "A" | "1") {
                    continue;
                }
                serials.insert(column(line, 6, 11).to_owned(), atoms.len() as u32);
                atoms.push(atom);
            }
            "CONECT" => {
                let serial = |from: usize| serials.get(column(line, from, from + 5)).copied();
                if let Some(first) = serial(6) {
                    let others = [11, 16, 21, 26].into_iter().filter_map(serial);
                    bonds.extend(others.map(|other| [first.min(other), first.max(other)]));
                }
            }
            "ENDMDL" => is_first_model = false,
            _ => {}
        }
    }
    Ok((atoms, bonds))
}

/// Columns `from..to` of a line, counted from 0, without blanks around; empty where the line is shorter.
fn column(line: &str, from: usize, to: usize) -> &str {
    line.get(from..to.min(line.len())).unwrap_or("").trim()
}

fn atom(line: &str) -> Option<Atom> {
    let number = |from: usize| column(line, from, from + 8).parse::<f64>().ok();
    let place = DVec3::new(number(30)?, number(38)?, number(46)?);
    if !place.is_finite() {
        return None;
    }
    let name = column(line, 12, 16);
    let residue = column(line, 17, 20);
    let stated = column(line, 76, 78);
    let element = if stated.is_empty() { by_name(line) } else { Element::of(stated) };
    let is_backbone = (name == "CA" && element == Element::Carbon) || name == "P";
    let number = column(line, 22, 26).parse().ok();
    let backbone = number
        .filter(|_| is_backbone)
        .map(|number| Residue { chain: column(line, 21, 22).to_owned(), number });
    Some(Atom { place, element, is_water: is_water(residue), backbone })
}

/// Whether a residue is water.
pub(crate) fn is_water(residue: &str) -> bool {
    matches!(residue, "HOH" | "WAT" | "DOD" | "H2O")
}

/// The element of a line that does not state it: names of one letter begin in the second column of the name.
fn by_name(line: &str) -> Element {
    let letters = line.get(12..14).unwrap_or("");
    let first = letters.trim_start_matches(|c: char| c.is_ascii_digit()).trim();
    match Element::of(first) {
        Element::Other => Element::of(first.get(..1).unwrap_or("")),
        known => known,
    }
}
