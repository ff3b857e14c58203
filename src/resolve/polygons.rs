//! Polygons and meshes: their faces, checked, and what their surfaces are.

use std::sync::Arc;

use glam::DVec3;
use hecs::{Entity, World};

use super::carriers::carriers;
use super::fault::Fault;
use super::fill::{fill, fill_from, withdraw};
use crate::components::{Mesh, Polygon, Smooth, SmoothNormals, Surface, Voxelize};
use crate::polygon::face::{Face, Faces};
use crate::polygon::shape;
use crate::polygon::smooth::{CornerNormals, StatedNormals};
use crate::volume::grid::Grid;

/// Gives every polygon and mesh its faces, and all faces a surface.
pub(super) fn fill_in(world: &mut World) -> Result<(), Fault> {
    let any_volume = !carriers::<Grid>(world).is_empty();
    for entity in carriers::<Faces>(world) {
        if world.get::<&Polygon>(entity).is_err() {
            withdraw::<Polygon, Faces>(world, entity);
        }
        if world.get::<&Mesh>(entity).is_err() {
            withdraw::<Mesh, Faces>(world, entity);
        }
    }
    for entity in carriers::<Polygon>(world) {
        fill_from(world, entity, |polygon| faces_of_polygon(entity, polygon))?;
    }
    for entity in carriers::<Mesh>(world) {
        fill_from(world, entity, |mesh| faces_of_mesh(entity, mesh))?;
    }
    for entity in carriers::<Faces>(world) {
        if !any_volume && world.get::<&Voxelize>(entity).is_ok() {
            let problem = "there is no volume to scan-convert it into; take `voxelize` away or add a `volume`";
            return Err(Fault::of(entity, "voxelize", "", problem));
        }
        fill(world, entity, (), |()| Ok(Surface::default()))?;
        bend(world, entity)?;
    }
    Ok(())
}

/// What normals at corners are made of.
type Bending = (Smooth, Faces, Option<StatedNormals>);

/// Gives faces that are to look smooth the normals of their corners, and takes them off others.
fn bend(world: &mut World, entity: Entity) -> Result<(), Fault> {
    let smooth = world.get::<&Smooth>(entity).map(|smooth| *smooth).ok();
    let faces = world.get::<&Faces>(entity).map(|faces| (*faces).clone()).ok();
    let (Some(smooth), Some(faces)) = (smooth, faces) else {
        withdraw::<Bending, CornerNormals>(world, entity);
        return Ok(());
    };
    let stated = world.get::<&StatedNormals>(entity).map(|normals| (*normals).clone()).ok();
    let stated = stated.filter(|_| smooth.normals == SmoothNormals::File);
    let normals = |(smooth, faces, stated): &Bending| {
        let crease = smooth.crease_degrees.to_radians();
        Ok(match stated {
            Some(stated) => CornerNormals::stated(stated, &faces.0, crease),
            None => CornerNormals::of(&faces.0, crease),
        })
    };
    fill(world, entity, (smooth, faces, stated), normals).map(drop)
}

fn faces_of_polygon(entity: Entity, polygon: &Polygon) -> Result<Faces, Fault> {
    let outlines = std::iter::once(&polygon.vertices).chain(&polygon.holes);
    let outlines = outlines.map(|o| o.iter().copied().map(DVec3::from).collect()).collect();
    let face = Face::new(outlines).map_err(|p| Fault::of(entity, "polygon", "", p))?;
    Ok(Faces(Arc::new(vec![face])))
}

fn faces_of_mesh(entity: Entity, mesh: &Mesh) -> Result<Faces, Fault> {
    let (key, outlines) = if let Some(shape) = &mesh.ellipsoid {
        ("ellipsoid", shape::ellipsoid(shape))
    } else if let Some(shape) = &mesh.prism {
        ("prism", shape::prism(shape))
    } else if mesh.file.is_some() {
        let problem = "a mesh of a file is read where a scene is loaded; put `Faces` on the entity, or load a scene that names the file";
        return Err(Fault::of(entity, "mesh", "file", problem));
    } else {
        ("faces", outlines(entity, mesh)?)
    };
    let checked = |(i, outline)| {
        Face::new(vec![outline]).map_err(|problem| {
            let path = if key == "faces" { format!("faces.{i}") } else { key.to_owned() };
            Fault::of(entity, "mesh", path, format!("face {i} of its mesh: {problem}"))
        })
    };
    let faces: Result<_, Fault> = outlines.into_iter().enumerate().map(checked).collect();
    Ok(Faces(Arc::new(faces?)))
}

/// The vertices of each face.
fn outlines(entity: Entity, mesh: &Mesh) -> Result<Vec<Vec<DVec3>>, Fault> {
    let count = mesh.vertices.len();
    let vertex = |(face, index): (usize, u32)| {
        let missing = || {
            let problem = format!(
                "face {face} of its mesh names vertex {index}, and there are {count}, counted from 0"
            );
            Fault::of(entity, "mesh", format!("faces.{face}"), problem)
        };
        mesh.vertices.get(index as usize).copied().map(DVec3::from).ok_or_else(missing)
    };
    let face = |(i, face): (usize, &Vec<u32>)| face.iter().map(|&v| vertex((i, v))).collect();
    mesh.faces.iter().enumerate().map(face).collect()
}
