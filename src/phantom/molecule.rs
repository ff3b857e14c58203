//! A map of electron density by formula: a strand of polypeptide with two tyrosines (the paper's figure 12).
//!
//! The density of an atom is a Gaussian whose integral is its number of electrons and whose width grows towards the
//! ends of side chains, as atoms there move more. Lengths are in ångström; the map's mean is 0, as of a measured map.
//! The strand lies in the map as that of residues 78 to 83 lies in a map of ribonuclease Sa, for which it stands in.

use glam::Vec3;
use rayon::prelude::*;

use super::simple::centred;
use crate::formats::Loaded;
use crate::shared::Shared;
use crate::volume::grid::Scalars;

const SIDE: usize = 96;
const SPACING: f32 = 0.42;

/// Residues of the strand; it rises 3.4 Å with each, and side chains leave it to the right and to the left in turn.
const RESIDUES: usize = 12;
const RISE: f32 = 3.4;

/// The residues that carry a ring: neighbours, and so on opposite sides.
const RINGS: [usize; 2] = [5, 6];

/// The middle of the strand, from that of the map.
const MIDDLE: Vec3 = Vec3::new(-1.0, 1.5, -2.6);
/// Where the strand leads, and the direction from which its side chains and rings are seen spread out; nearly at right
/// angles.
const ALONG: Vec3 = Vec3::new(0.2, 0.92, 0.33);
const FACE: Vec3 = Vec3::new(0.0, -0.32, 0.95);

/// How far a Cα stands to the side of the strand's axis.
const PLEAT: f32 = 0.85;

/// Atoms of a peptide from one Cα to the next: along the line between them, aside towards the face, and electrons of C,
/// O and N.
const PEPTIDE: [[f32; 3]; 3] = [[1.42, 0.52, 6.0], [1.72, 1.70, 8.0], [2.42, -0.36, 7.0]];

/// Atoms of side chains beyond Cβ, residue by residue; short ones leave the rings free.
const CHAINS: [usize; RESIDUES] = [2, 1, 3, 0, 0, 0, 0, 0, 0, 3, 1, 2];

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

/// Unit vectors: to the right of the strand as seen from its face, along it, and towards the face.
fn frame() -> [Vec3; 3] {
    let face = FACE.normalize();
    let along = (ALONG - face * face.dot(ALONG)).normalize();
    [along.cross(face), along, face]
}

/// 1 where a residue's side chain leaves to the right, −1 to the left.
fn side(number: usize) -> f32 {
    if number.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// The Cα of a residue; the strand is pleated.
fn alpha_carbon(number: f32, side: f32) -> Vec3 {
    let [right, along, _] = frame();
    let rise = RISE * (number - 0.5 * (RESIDUES as f32 - 1.0));
    MIDDLE + along * rise + right * (PLEAT * side)
}

/// The atoms of one residue: backbone, Cβ, and a side chain or a ring.
fn residue(number: usize) -> Vec<Atom> {
    let [right, along, face] = frame();
    let (n, side) = (number as f32, side(number));
    let alpha = alpha_carbon(n, side);
    // Peptides face one way and the other in turn; the N belongs to the peptide before.
    let peptide = |from: Vec3, to: Vec3, towards: f32, [far, aside, electrons]: [f32; 3]| {
        let place = from + (to - from).normalize() * far + face * (aside * towards);
        Atom { place, width: 0.43, electrons }
    };
    let [before, after] = [n - 1.0, n + 1.0].map(|n| alpha_carbon(n, -side));
    let out = (right + along * 0.8).normalize() * side;
    let root = alpha + (out - face * (0.4 * side)).normalize() * 1.53;
    let mut atoms = vec![
        peptide(before, alpha, -side, PEPTIDE[2]),
        Atom { place: alpha, width: 0.43, electrons: 6.0 },
        peptide(alpha, after, side, PEPTIDE[0]),
        peptide(alpha, after, side, PEPTIDE[1]),
        Atom { place: root, width: 0.48, electrons: 6.0 },
    ];
    if RINGS.contains(&number) {
        atoms.extend(ring(root + out * 1.51, out));
    } else {
        atoms.extend(chain(root, out, CHAINS[number]));
    }
    atoms
}

/// A six-membered ring of carbon from its first atom outwards, face-on to the face, with its oxygen.
fn ring(first: Vec3, out: Vec3) -> Vec<Atom> {
    let up = FACE.normalize().cross(out);
    let center = first + out * 1.39;
    let mut atoms: Vec<Atom> = (0..6)
        .map(|corner| {
            let (sine, cosine) = libm::sincosf((60.0 * corner as f32).to_radians());
            Atom { place: center - (out * cosine + up * sine) * 1.39, width: 0.4, electrons: 6.0 }
        })
        .collect();
    atoms.push(Atom { place: center + out * 2.76, width: 0.5, electrons: 8.0 });
    atoms
}

/// A zigzag of carbon outwards, each atom less sharp than the last.
fn chain(root: Vec3, out: Vec3, length: usize) -> Vec<Atom> {
    let [_, along, _] = frame();
    (1..=length)
        .map(|n| {
            let aside = if n % 2 == 1 { 0.85 } else { 0.0 };
            let place = root + out * (1.27 * n as f32) + along * aside;
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
