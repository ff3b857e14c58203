//! Files of meshes: triangles as STL, PLY, OBJ, glTF and VTK have them; the table here is where a new format is added.

mod gltf;
mod obj;
mod pictures;
mod ply;
mod stl;
mod triangles;
mod veiled;
mod vtk;
mod vtp;

#[cfg(test)]
mod tests;

use std::path::Path;

use super::stream::Stream;
use crate::error::Error;
pub use pictures::{MeshPicture, PictureAlpha, PicturePlace};
pub use triangles::{AtCorners, Triangles};
pub(crate) use veiled::veiled;

/// A format of meshes: a row of `MESH_FORMATS`.
pub struct MeshFormat {
    /// What people call it.
    pub name: &'static str,
    /// How its file names end, in lower case and without the dot.
    pub extension: &'static str,
    /// Reads the bytes of a file; the path is that of the file, for a format that names others beside it. The error is a sentence without a subject.
    read: fn(&[u8], &Path) -> Result<Triangles, String>,
}

/// The formats of meshes; one more is a file and a row.
pub(crate) static MESH_FORMATS: &[MeshFormat] = &[
    MeshFormat { name: "STL", extension: "stl", read: stl::read },
    MeshFormat { name: "PLY", extension: "ply", read: ply::read },
    MeshFormat { name: "OBJ", extension: "obj", read: obj::read },
    MeshFormat { name: "glTF", extension: "gltf", read: gltf::read },
    MeshFormat { name: "GLB", extension: "glb", read: gltf::read },
    MeshFormat { name: "VTK PolyData", extension: "vtp", read: vtp::read },
    MeshFormat { name: "VTK's older PolyData", extension: "vtk", read: vtk::read },
];

/// The format of a file by how its name ends.
#[must_use]
pub fn mesh_format(path: &Path) -> Option<&'static MeshFormat> {
    let end = path.extension()?.to_string_lossy().to_ascii_lowercase();
    MESH_FORMATS.iter().find(|format| format.extension == end)
}

/// Reads a mesh of a format in the table here, which its name tells.
///
/// Every index is one of a vertex, and every vertex is finite. Fails where the file is missing, of no known format, damaged
/// or without a face; memory is taken in proportion to what the file holds.
pub fn read_mesh(path: &Path) -> Result<Triangles, Error> {
    let known = || {
        let row = |format: &MeshFormat| format!("{} (.{})", format.name, format.extension);
        MESH_FORMATS.iter().map(row).collect::<Vec<_>>().join(", ")
    };
    let read = || {
        let format = mesh_format(path).ok_or_else(|| {
            format!("its name is of no known format of meshes; expected one of {}", known())
        })?;
        let bytes = Stream::open(path)?.rest()?;
        checked((format.read)(&bytes, path)?)
    };
    read().map_err(|problem| Error::file(path, problem))
}

/// Passes on triangles whose indices are those of vertices that are finite.
fn checked(triangles: Triangles) -> Result<Triangles, String> {
    let Triangles { vertices, faces, .. } = &triangles;
    if faces.is_empty() {
        return Err("holds no face; name a mesh and not a cloud of points".to_owned());
    }
    if let Some(at) = vertices.iter().position(|vertex| !vertex.is_finite()) {
        return Err(format!("its vertex {at} (from 0) is not finite; fetch the file again"));
    }
    let count = vertices.len();
    let beyond = |face: &[u32; 3]| face.iter().any(|&index| index as usize >= count);
    match faces.iter().position(beyond) {
        Some(at) => Err(format!(
            "its triangle {at} (from 0) names a vertex beyond its {count}; fetch the file again"
        )),
        None => Ok(with_all_colors(triangles)),
    }
}

/// Leaves colors out that not every vertex has, and says so.
fn with_all_colors(mut triangles: Triangles) -> Triangles {
    if !triangles.colors.is_empty() && triangles.colors.len() != triangles.vertices.len() {
        triangles.colors.clear();
        let warning =
            "some of its vertices have no color, and so the colors of the others are left out";
        triangles.warnings.push(warning.to_owned());
    }
    for color in triangles.colors.iter_mut().filter(|color| !color.0.is_finite()) {
        color.0 = glam::Vec3::ZERO;
    }
    triangles
}
