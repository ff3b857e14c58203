//! Which atoms are bonded: those that are as near to each other as their covalent radii and a tolerance.

use std::collections::{BTreeMap, BTreeSet};

use super::atom::{Atom, Element};

/// What bonds are longer than the sum of covalent radii at the most, Å.
const TOLERANCE: f64 = 0.45;
/// Atoms nearer than this are two readings of one, Å.
const LEAST: f64 = 0.4;
/// The side of the cells that atoms are sorted into: no bond is longer, Å.
const CELL: f64 = 2.7;
/// Bonds of an atom that distances may give at the most: a file of garbage has all atoms in one place.
const MOST: usize = 8;

/// The bonds of some atoms: those `stated`, and those that their distances tell.
pub(crate) fn bonds(atoms: &[Atom], stated: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    let count = atoms.len();
    let within = |pair: &[u32; 2]| pair[0] < pair[1] && (pair[1] as usize) < count;
    let mut found: BTreeSet<[u32; 2]> = stated.into_iter().filter(within).collect();
    // Casts saturate; cells so far out are as good as one.
    let cell =
        |atom: &Atom| (atom.place / CELL).floor().to_array().map(|n| n.clamp(-1e15, 1e15) as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let mut bonded = vec![0_usize; count];
    for (number, atom) in atoms.iter().enumerate() {
        let [x, y, z] = cell(atom);
        let near = (0..27).map(|n| [x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1]);
        for &other in near.filter_map(|cell| cells.get(&cell)).flat_map(|c| c.iter().rev().take(64))
        {
            let both = [other as usize, number];
            if are_near(&atoms[other as usize], atom) && both.iter().all(|&n| bonded[n] < MOST) {
                found.insert([other, number as u32]);
                for n in both {
                    bonded[n] += 1;
                }
            }
        }
        cells.entry([x, y, z]).or_default().push(number as u32);
    }
    found.into_iter().collect()
}

fn are_near(a: &Atom, b: &Atom) -> bool {
    let hydrogens = [a, b].iter().all(|atom| atom.element == Element::Hydrogen);
    let apart = a.place.distance(b.place);
    let most = a.element.covalent() + b.element.covalent() + TOLERANCE;
    apart > LEAST && apart < most && !hydrogens && a.is_water == b.is_water
}
