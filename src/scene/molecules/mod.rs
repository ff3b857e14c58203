//! The molecules of a scene: their atoms read, and made into faces with colors.

mod shapes;

use std::sync::Arc;

use glam::DVec3;

use super::kept::KeptMolecule;
use super::loading::Loading;
use crate::components::{Color, Molecule, MoleculeStyle, Surface};
use crate::error::Error;
use crate::formats::molecules::read_molecule;
use crate::polygon::face::{Face, FaceColors, Faces};
use crate::shared::Shared;
use shapes::{Colored, balls, sticks, tube};

/// The most bytes that an atom's faces take.
const BYTES: u64 = 40_000;

/// Reads every molecule.
pub(super) fn read(loading: &mut Loading) -> Result<(), Error> {
    loading.nouns(&["molecule"]).into_iter().try_for_each(|entry| read_one(loading, entry))
}

fn read_one(loading: &mut Loading, entry: usize) -> Result<(), Error> {
    let Some(molecule) = loading.get::<Molecule>(entry) else { return Ok(()) };
    let KeptMolecule { faces, colors, .. } = kept_or_made(loading, entry, molecule)?;
    // A color that the scene states is that of all atoms.
    let stated = loading.get::<Surface>(entry).map(|surface| surface.color);
    if stated.is_none_or(|color| color == Color::WHITE) {
        loading.add(entry, (colors,));
    }
    loading.add(entry, (faces,));
    Ok(())
}

/// The faces that an earlier loading made; else the molecule is read, and its faces are kept for the next.
fn kept_or_made(
    loading: &mut Loading,
    entry: usize,
    molecule: Molecule,
) -> Result<KeptMolecule, Error> {
    let name = loading.entries[entry].name.clone();
    if let Some(kept) = loading.kept.molecules.get(&name).filter(|kept| kept.stated == molecule) {
        loading.files.extend(kept.files.iter().cloned());
        return Ok(kept.clone());
    }
    let kept = made(loading, entry, molecule)?;
    loading.kept.molecules.insert(name, kept.clone());
    Ok(kept)
}

fn made(loading: &mut Loading, entry: usize, molecule: Molecule) -> Result<KeptMolecule, Error> {
    let Some(path) = loading.folders.find(&molecule.file) else {
        let missing = loading.folders.missing(&molecule.file);
        let problem = format!("{missing}; name its folder as a data folder");
        return Err(loading.nowhere(entry, ("molecule", "file"), &molecule.file, problem));
    };
    loading.files.push(path.clone());
    let mut structure = read_molecule(&path)?;
    loading.afford(structure.atoms.len() as u64 * BYTES)?;
    let shift = DVec3::from(molecule.shift.unwrap_or_default());
    structure.atoms.iter_mut().for_each(|atom| atom.place += shift);
    let Molecule { radius, water, carbon, .. } = molecule;
    let shapes = match molecule.style {
        MoleculeStyle::Sticks => sticks(&structure, radius.unwrap_or(0.2), water, carbon),
        MoleculeStyle::Balls => balls(&structure, radius.unwrap_or(1.0), water, carbon),
        MoleculeStyle::Tube => tube(&structure, radius.unwrap_or(0.5), carbon),
    };
    let (faces, colors) = faces(shapes);
    if faces.is_empty() {
        let problem = match molecule.style {
            MoleculeStyle::Tube => "has no backbone for a tube to follow; choose another `style`",
            _ => "shows no atom; state `water = true` or name another file",
        };
        return Err(loading.error(entry, "molecule", "style", problem));
    }
    let (faces, colors) = (Faces(Arc::new(faces)), FaceColors(Shared::new(colors)));
    Ok(KeptMolecule { stated: molecule, faces, colors, files: vec![path] })
}

/// The faces of some shapes, and the color of each.
fn faces(shapes: Vec<Colored>) -> (Vec<Face>, Vec<Color>) {
    let made = shapes.into_iter().flat_map(|(outlines, color)| {
        outlines
            .into_iter()
            .filter_map(move |outline| Some((Face::new(vec![outline]).ok()?, color)))
    });
    made.unzip()
}
