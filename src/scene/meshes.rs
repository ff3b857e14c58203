//! The meshes of a scene that stand in files: their triangles as faces in the world.

use std::sync::Arc;

use glam::DVec3;

use super::kept::KeptMesh;
use super::loading::Loading;
use crate::components::{Color, Mesh, Space};
use crate::error::Error;
use crate::formats::meshes::read_mesh;
use crate::polygon::face::{Face, FaceColors, Faces};
use crate::shared::Shared;

/// Reads every mesh that names a file.
pub(super) fn read(loading: &mut Loading) -> Result<(), Error> {
    for entry in loading.nouns(&["mesh"]) {
        let Some(mesh) = loading.get::<Mesh>(entry) else { continue };
        let Some(file) = mesh.file.clone() else { continue };
        let KeptMesh { faces, colors, .. } = kept_or_read(loading, entry, mesh, &file)?;
        loading.add(entry, (faces,));
        if let Some(colors) = colors {
            loading.add(entry, (colors,));
        }
    }
    Ok(())
}

/// The faces that an earlier loading read; else the file is read, and its faces are kept for the next.
fn kept_or_read(
    loading: &mut Loading,
    entry: usize,
    mesh: Mesh,
    file: &str,
) -> Result<KeptMesh, Error> {
    let name = loading.entries[entry].name.clone();
    if let Some(kept) = loading.kept.meshes.get(&name).filter(|kept| kept.stated == mesh) {
        loading.files.extend(kept.files.iter().cloned());
        return Ok(kept.clone());
    }
    let before = loading.files.len();
    let (faces, colors) = of_file(loading, entry, file, &mesh)?;
    let kept = KeptMesh {
        stated: mesh,
        faces: Faces(Arc::new(faces)),
        colors: (!colors.is_empty()).then(|| FaceColors(Shared::new(colors))),
        files: loading.files[before..].to_vec(),
    };
    loading.kept.meshes.insert(name, kept.clone());
    Ok(kept)
}

/// The triangles of a file, in the world, and their colors if it has any; those without an area are left out and said.
fn of_file(
    loading: &mut Loading,
    entry: usize,
    file: &str,
    &Mesh { space, unit_mm, .. }: &Mesh,
) -> Result<(Vec<Face>, Vec<Color>), Error> {
    let Some(path) = loading.folders.find(file) else {
        let missing = loading.folders.missing(file);
        let problem = format!("{missing}; name its folder as a data folder");
        return Err(loading.nowhere(entry, ("mesh", "file"), file, problem));
    };
    let bytes = std::fs::metadata(&path).map_or(0, |found| found.len());
    loading.files.push(path.clone());
    // A triangle takes 50 bytes at the least in a file, and a face of the world four times that.
    loading.afford(bytes.saturating_mul(4))?;
    let read = read_mesh(&path)?;
    loading.files.extend(read.beside.iter().cloned());
    for warning in &read.warnings {
        loading.warn(entry, warning.clone());
    }
    let unit = unit_mm.or(read.unit_mm).unwrap_or(1.0);
    let world = |v: DVec3| {
        unit * match space.or(read.space).unwrap_or(Space::Lps) {
            Space::Lps => v,
            Space::Ras => DVec3::new(-v.x, -v.y, v.z),
            Space::YUp => DVec3::new(v.x, -v.z, v.y),
        }
    };
    let corner = |at: u32| world(read.vertices[at as usize]);
    let (mut faces, mut colors) = (Vec::new(), Vec::new());
    for face in &read.faces {
        if let Ok(made) = Face::new(vec![face.map(corner).to_vec()]) {
            faces.push(made);
            colors.extend(read.color(*face));
        }
    }
    match read.faces.len() - faces.len() {
        0 => {}
        all if faces.is_empty() => {
            let problem = format!("none of its {all} triangles has an area; check its `unit_mm`");
            return Err(loading.error(entry, "mesh", "file", problem));
        }
        some => loading.warn(
            entry,
            format!("{some} of its triangles have no area or vertices that are no numbers, and are left out"),
        ),
    }
    Ok((faces, colors))
}
