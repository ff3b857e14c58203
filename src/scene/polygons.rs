//! The polygons and meshes of a scene as checked faces.

use std::sync::Arc;

use glam::DVec3;

use super::loading::Loading;
use super::shape;
use crate::components::{Mesh, Polygon, Surface, Voxelize};
use crate::error::Error;
use crate::polygon::face::{Face, Faces};

/// Gives every polygon and mesh its faces and its surface.
pub(super) fn bring_in(loading: &mut Loading) -> Result<(), Error> {
    let any_volume = !loading.nouns(&["volume"]).is_empty();
    for entry in loading.nouns(&["polygon", "mesh"]) {
        if !any_volume && loading.get::<Voxelize>(entry).is_some() {
            let problem = "there is no volume to scan-convert it into; take `voxelize` away or add a `volume`";
            return Err(loading.error(entry, "voxelize", "", problem));
        }
        let faces = match (loading.get::<Polygon>(entry), loading.get::<Mesh>(entry)) {
            (Some(polygon), _) => vec![face(loading, entry, &polygon)?],
            (_, Some(mesh)) => mesh_faces(loading, entry, &mesh)?,
            _ => continue,
        };
        let surface = loading.get::<Surface>(entry).unwrap_or_default();
        loading.add(entry, (Faces(Arc::new(faces)), surface));
    }
    Ok(())
}

fn face(loading: &Loading, entry: usize, polygon: &Polygon) -> Result<Face, Error> {
    let outlines = std::iter::once(&polygon.vertices).chain(&polygon.holes);
    let outlines = outlines.map(|o| o.iter().copied().map(DVec3::from).collect()).collect();
    Face::new(outlines).map_err(|problem| loading.error(entry, "polygon", "", problem))
}

fn mesh_faces(loading: &Loading, entry: usize, mesh: &Mesh) -> Result<Vec<Face>, Error> {
    let (key, outlines) = if let Some(shape) = &mesh.ellipsoid {
        ("ellipsoid", shape::ellipsoid(shape))
    } else if let Some(shape) = &mesh.prism {
        ("prism", shape::prism(shape))
    } else {
        let vertex = |&i: &u32| DVec3::from(mesh.vertices[i as usize]);
        ("faces", mesh.faces.iter().map(|face| face.iter().map(vertex).collect()).collect())
    };
    let checked = |(i, outline)| {
        Face::new(vec![outline]).map_err(|problem| {
            let path = if key == "faces" { format!("faces.{i}") } else { key.to_owned() };
            loading.error(entry, "mesh", &path, format!("face {i} of its mesh: {problem}"))
        })
    };
    outlines.into_iter().enumerate().map(checked).collect()
}
