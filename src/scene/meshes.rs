//! The meshes of a scene that stand in files: their triangles as faces in the world.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::kept::KeptMesh;
use super::loading::Loading;
use super::mesh_pictures;
use crate::components::{Color, Mesh, Smooth, Space, Textured};
use crate::error::Error;
use crate::formats::meshes::{AtCorners, Triangles, read_mesh};
use crate::polygon::face::{Face, FaceColors, FaceOpacities, Faces};
use crate::polygon::smooth::StatedNormals;
use crate::polygon::texture::{MappedTexture, OwnTextures, TexturePlaces};
use crate::shared::Shared;

/// The triangles of a file in the world: their faces, and of each a color, an opacity, normals and places in a texture, if any has them;
/// and the textures that its own pictures are, and of each face which.
#[derive(Default)]
struct Read {
    faces: Vec<Face>,
    colors: Vec<Color>,
    opacities: Vec<f32>,
    normals: Vec<[DVec3; 3]>,
    places: Vec<[DVec2; 3]>,
    textures: Vec<MappedTexture>,
    of: Vec<u32>,
}

/// Reads every mesh that names a file.
pub(super) fn read(loading: &mut Loading) -> Result<(), Error> {
    for entry in loading.nouns(&["mesh"]) {
        let Some(mesh) = loading.get::<Mesh>(entry) else { continue };
        let Some(file) = mesh.file.clone() else { continue };
        let KeptMesh { faces, colors, opacities, normals, places, own, .. } =
            kept_or_read(loading, entry, mesh, &file)?;
        loading.add(entry, (faces, own));
        if let Some(colors) = colors {
            loading.add(entry, (colors,));
        }
        if let Some(opacities) = opacities {
            loading.add(entry, (opacities,));
        }
        if let Some(normals) = normals {
            loading.add(entry, (normals,));
        }
        if let Some(places) = places {
            loading.add(entry, (places,));
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
    let [smooth, textured] =
        [loading.get::<Smooth>(entry).is_some(), loading.get::<Textured>(entry).is_some()];
    let asked = [smooth, textured, mesh_pictures::are_wanted(loading, entry)];
    let is_same = |kept: &&KeptMesh| kept.stated == mesh && kept.asked == asked;
    if let Some(kept) = loading.kept.meshes.get(&name).filter(is_same) {
        loading.files.extend(kept.files.iter().cloned());
        return Ok(kept.clone());
    }
    let before = loading.files.len();
    let Read { faces, colors, opacities, normals, places, textures, of } =
        of_file(loading, entry, file, (&mesh, asked))?;
    let is_laid = asked[1] || !textures.is_empty();
    let kept = KeptMesh {
        stated: mesh,
        asked,
        faces: Faces(Arc::new(faces)),
        colors: (!colors.is_empty()).then(|| FaceColors(Shared::new(colors))),
        opacities: (!opacities.is_empty()).then(|| FaceOpacities(Shared::new(opacities))),
        // Where they are asked for and there are none, none take the place of those of another file.
        normals: asked[0].then(|| StatedNormals(Shared::new(normals))),
        places: is_laid.then(|| TexturePlaces(Shared::new(places))),
        own: OwnTextures::new(textures, of),
        files: loading.files[before..].to_vec(),
    };
    loading.kept.meshes.insert(name, kept.clone());
    Ok(kept)
}

/// The triangles of a file, in the world; those without an area are left out and said.
fn of_file(
    loading: &mut Loading,
    entry: usize,
    file: &str,
    (mesh, [smooth, textured, own]): (&Mesh, [bool; 3]),
) -> Result<Read, Error> {
    let Some(path) = loading.folders.find(file) else {
        let missing = loading.folders.missing(file);
        let problem = format!("{missing}; name its folder as a data folder");
        return Err(loading.nowhere(entry, ("mesh", "file"), file, problem));
    };
    let bytes = std::fs::metadata(&path).map_or(0, |found| found.len());
    loading.files.push(path.clone());
    // A triangle takes 50 bytes at the least in a file, and a face of the world four times that.
    loading.afford(bytes.saturating_mul(4))?;
    let mut triangles = read_mesh(&path)?;
    loading.files.extend(triangles.beside.iter().cloned());
    for warning in &triangles.warnings {
        loading.warn(entry, warning.clone());
    }
    let pictured =
        if own { mesh_pictures::read(loading, entry, &triangles)? } else { Default::default() };
    triangles = as_asked(triangles, [smooth, textured || !pictured.0.is_empty(), own]);
    loading.afford(bytes_at_corners(&triangles))?;
    let read = in_the_world(&triangles, mesh, pictured);
    for warning in gaps(&read, textured) {
        loading.warn(entry, warning);
    }
    match triangles.faces.len() - read.faces.len() {
        0 => {}
        all if read.faces.is_empty() => {
            let problem = format!("none of its {all} triangles has an area; check its `unit_mm`");
            return Err(loading.error(entry, "mesh", "file", problem));
        }
        some => loading.warn(
            entry,
            format!("{some} of its triangles have no area or vertices that are no numbers, and are left out"),
        ),
    }
    Ok(read)
}

/// Triangles without normals that are not asked for, without places in a texture, and without what is of materials.
fn as_asked(mut triangles: Triangles, [smooth, textured, own]: [bool; 3]) -> Triangles {
    if !smooth {
        triangles.normals = AtCorners::default();
    }
    if !textured {
        triangles.places = AtCorners::default();
    }
    // They are there for the pictures of the file, and are not to tint one that the scene lays there.
    if !own {
        triangles.face_colors = Vec::new();
        triangles.opacities = Vec::new();
    }
    triangles
}

/// Bytes of what is kept of corners, in the world.
fn bytes_at_corners(triangles: &Triangles) -> u64 {
    let none = [triangles.normals.values.is_empty(), triangles.places.values.is_empty()];
    let sizes = [size_of::<[DVec3; 3]>(), size_of::<[DVec2; 3]>()];
    let kept = none.into_iter().zip(sizes).filter(|(none, _)| !none).map(|(_, size)| size);
    (triangles.faces.len() * kept.sum::<usize>()) as u64
}

/// Sentences about triangles that lack what others of the file have; where no texture is stated on all, those without a picture lack none.
fn gaps(read: &Read, textured: bool) -> Vec<String> {
    let bent = |normals: &&[DVec3; 3]| normals.iter().all(|normal| normal.is_finite());
    let has_picture =
        |at: usize| read.of.get(at).is_some_and(|&number| (number as usize) < read.textures.len());
    let laid = |(at, places): &(usize, &[DVec2; 3])| {
        places.iter().all(|place| place.is_finite()) || !(textured || has_picture(*at))
    };
    let without = [
        (
            read.normals.len() - read.normals.iter().filter(bent).count(),
            "have no normals of their own, or some without a direction, and are lit by computed ones",
        ),
        (
            read.places.len() - read.places.iter().enumerate().filter(laid).count(),
            "lie nowhere in a texture, and show none of it",
        ),
    ];
    let without = without.into_iter().filter(|(count, _)| *count > 0);
    without.map(|(count, what)| format!("{count} of its triangles {what}")).collect()
}

/// The triangles that have an area, in their colors; where pictures are on some and no color is stated, they are white.
fn in_the_world(
    triangles: &Triangles,
    &Mesh { space, unit_mm, .. }: &Mesh,
    (textures, of): (Vec<MappedTexture>, Vec<u32>),
) -> Read {
    let unit = unit_mm.or(triangles.unit_mm).unwrap_or(1.0);
    let space = space.or(triangles.space).unwrap_or(Space::Lps);
    let turned = |v: DVec3| match space {
        Space::Lps => v,
        Space::Ras => DVec3::new(-v.x, -v.y, v.z),
        Space::YUp => DVec3::new(v.x, -v.z, v.y),
    };
    let [bent, laid] = [!triangles.normals.values.is_empty(), !triangles.places.values.is_empty()];
    let unit_normal = |normal: DVec3| turned(normal).try_normalize().unwrap_or(DVec3::NAN);
    let plain = (!textures.is_empty()).then_some(Color::WHITE);
    let mut read = Read { textures, ..Read::default() };
    for (at, face) in triangles.faces.iter().enumerate() {
        let corners = face.map(|at| unit * turned(triangles.vertices[at as usize]));
        let Ok(made) = Face::new(vec![corners.to_vec()]) else { continue };
        read.faces.push(made);
        read.colors.extend(triangles.color(at).or(plain));
        read.opacities.extend(triangles.opacities.get(at));
        read.of.extend(of.get(at));
        if bent {
            let own = triangles.normals.of(at, *face);
            read.normals.push(own.map_or([DVec3::NAN; 3], |own| own.map(unit_normal)));
        }
        if laid {
            let own = triangles.places.of(at, *face);
            read.places.push(own.unwrap_or([DVec2::NAN; 3]));
        }
    }
    read
}
