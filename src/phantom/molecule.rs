//! A map of electron density by formula: a helix of polypeptide with two rings as of tyrosines (the paper's figure 12).
//!
//! The density of an atom is a Gaussian whose integral is its number of electrons and whose width grows towards the
//! ends of side chains, as atoms there move more. Lengths are in ångström; the map's mean is 0, as of a measured map.

use glam::Vec3;
use rayon::prelude::*;

use super::simple::centred;
use crate::formats::Loaded;
use crate::grid::{Scalars, Shared};

const SIDE: usize = 96;
const SPACING: f32 = 0.42;

/// Residues of the helix; it rises 1.5 Å and turns 100° with each.
const RESIDUES: usize = 22;

/// The residues that carry a ring: on opposite sides of the helix, face-on when seen from the front.
const RINGS: [usize; 2] = [7, 16];

/// Atoms of a residue's backbone about the helix: radius, degrees, rise and electrons of N, Cα, C, O.
const BACKBONE: [[f32; 4]; 4] = [
    [1.55, -28.0, -0.88, 7.0],
    [2.29, 0.0, 0.0, 6.0],
    [1.66, 27.0, 1.10, 6.0],
    [2.00, 25.0, 2.30, 8.0],
];

/// Atoms of side chains beyond Cβ, residue by residue, over and over.
const CHAINS: [usize; 7] = [2, 0, 3, 1, 2, 4, 1];

/// Blobs of noise: their number, width and the electrons of the strongest.
const NOISE: (usize, f32, f32) = (900, 1.0, 3.0);

/// A Gaussian of density.
#[derive(Debug, Clone, Copy)]
struct Atom {
    place: Vec3,
    width: f32,
    electrons: f32,
}

/// The map; see the module.
pub fn molecule() -> Loaded {
    let mut atoms: Vec<Atom> = (0..RESIDUES).flat_map(residue).collect();
    atoms.extend(noise());
    let mut density = vec![0.0_f32; SIDE * SIDE * SIDE];
    density.par_chunks_mut(SIDE * SIDE).enumerate().for_each(|(k, slice)| {
        for atom in &atoms {
            add(atom, k, slice);
        }
    });
    // A sum in one order and in 64 bits: the same mean for any number of threads.
    let sum: f64 = density.iter().map(|&d| f64::from(d)).sum();
    let mean = (sum / density.len() as f64) as f32;
    density.par_iter_mut().for_each(|d| *d -= mean);
    centred([SIDE; 3], [f64::from(SPACING); 3], Scalars::F32(Shared::new(density)))
}

/// The atoms of one residue: backbone, Cβ, and a side chain or a ring.
fn residue(number: usize) -> Vec<Atom> {
    let turn = 100.0 * number as f32 + 20.0;
    let middle = 0.75 * (RESIDUES as f32 - 1.0) + 0.6;
    let place = |radius: f32, degrees: f32, rise: f32| {
        let (sine, cosine) = libm::sincosf((turn + degrees).to_radians());
        Vec3::new(radius * cosine, radius * sine, 1.5 * number as f32 + rise - middle)
    };
    let mut atoms: Vec<Atom> = BACKBONE
        .map(|[r, degrees, rise, electrons]| Atom {
            place: place(r, degrees, rise),
            width: 0.43,
            electrons,
        })
        .to_vec();
    let root = place(3.3, -18.0, -0.7);
    atoms.push(Atom { place: root, width: 0.48, electrons: 6.0 });
    let (sine, cosine) = libm::sincosf((turn - 20.0).to_radians());
    let out = Vec3::new(cosine, sine, -0.15).normalize();
    if RINGS.contains(&number) {
        atoms.extend(ring(root + out * 1.51, out));
    } else {
        atoms.extend(chain(root, out, CHAINS[number % CHAINS.len()]));
    }
    atoms
}

/// A six-membered ring of carbon from its first atom outwards, in the plane of `out` and the helix, with its oxygen.
fn ring(first: Vec3, out: Vec3) -> Vec<Atom> {
    let up = (Vec3::Z - out * out.z).normalize();
    let center = first + out * 1.39;
    let mut atoms: Vec<Atom> = (0..6)
        .map(|corner| {
            let (sine, cosine) = libm::sincosf((60.0 * corner as f32).to_radians());
            Atom { place: center - (out * cosine + up * sine) * 1.39, width: 0.43, electrons: 6.0 }
        })
        .collect();
    atoms.push(Atom { place: center + out * 2.76, width: 0.5, electrons: 8.0 });
    atoms
}

/// A zigzag of carbon outwards, each atom less sharp than the last.
fn chain(root: Vec3, out: Vec3, length: usize) -> Vec<Atom> {
    (1..=length)
        .map(|n| {
            let aside = if n % 2 == 1 { 0.85 } else { 0.0 };
            let place = root + out * (1.27 * n as f32) + Vec3::Z * aside;
            Atom { place, width: 0.48 + 0.06 * n as f32, electrons: 6.0 }
        })
        .collect()
}

/// Weak blobs, positive and negative, all over the map.
fn noise() -> Vec<Atom> {
    let (number, width, strongest) = NOISE;
    let mut state = 1_u32;
    // Numerical Recipes' linear congruential generator; its upper bits serve.
    let mut next = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 8_388_608.0 - 1.0
    };
    let half = SIDE as f32 * SPACING / 2.0;
    (0..number)
        .map(|_| {
            let place = Vec3::new(next(), next(), next()) * half;
            Atom { place, width, electrons: strongest * next() }
        })
        .collect()
}

/// Adds an atom's density to slice k, within five widths of its centre.
fn add(atom: &Atom, k: usize, slice: &mut [f32]) {
    let reach = 5.0 * atom.width;
    let position = |index: usize| (index as f32 - (SIDE - 1) as f32 / 2.0) * SPACING;
    let away = position(k) - atom.place.z;
    if away.abs() > reach {
        return;
    }
    let fall = |distance: f32| libm::expf(-0.5 * (distance / atom.width) * (distance / atom.width));
    let span = |center: f32| {
        let index = |at: f32| (at / SPACING + (SIDE - 1) as f32 / 2.0).max(0.0);
        let first = index(center - reach) as usize;
        first.min(SIDE)..(index(center + reach) as usize + 1).min(SIDE)
    };
    let columns = span(atom.place.x);
    let along: Vec<f32> = columns.clone().map(|i| fall(position(i) - atom.place.x)).collect();
    let peak = atom.electrons / (15.749_61 * atom.width * atom.width * atom.width);
    for j in span(atom.place.y) {
        let level = peak * fall(away) * fall(position(j) - atom.place.y);
        let row = &mut slice[j * SIDE..][columns.clone()];
        for (density, x) in row.iter_mut().zip(&along) {
            *density += level * x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_along_the_chain_are_a_bond_apart() {
        let chain: Vec<Vec3> =
            (0..RESIDUES).flat_map(|n| residue(n)[..3].to_vec()).map(|atom| atom.place).collect();
        for pair in chain.windows(2) {
            let bond = pair[0].distance(pair[1]);
            assert!((1.25..1.65).contains(&bond), "{bond} Å");
        }
    }

    #[test]
    fn both_rings_show_a_hole_at_one_and_a_half_sigma() {
        let loaded = molecule();
        let crate::formats::Voxels::Scalars(scalars) = &loaded.voxels else { unreachable!() };
        let square = |i| f64::from(scalars.value(i)) * f64::from(scalars.value(i));
        let sigma = ((0..scalars.len()).map(square).sum::<f64>() / scalars.len() as f64).sqrt();
        for number in RINGS {
            let atoms = residue(number);
            let at = |place: Vec3| {
                let index = loaded.grid.world_to_index().transform_point3(place.as_dvec3());
                let [x, y, z] = index.round().to_array().map(|i| i as usize);
                f64::from(scalars.value(loaded.grid.offset([x, y, z])))
            };
            let ring = &atoms[5..11];
            let center = ring.iter().map(|atom| atom.place).sum::<Vec3>() / 6.0;
            assert!(ring.iter().all(|atom| at(atom.place) > 1.5 * sigma));
            assert!(at(center) < 1.5 * sigma, "{} of {sigma}", at(center));
        }
    }
}
