//! The pictures that a mesh's file lays on its triangles, read where the scene lays no texture on them itself.

use super::loading::Loading;
use crate::components::{TextureFilter, Textured, Wrap};
use crate::error::Error;
use crate::formats::meshes::{MeshPicture, PicturePlace, Triangles, veiled};
use crate::polygon::texture::MappedTexture;
use crate::view::picture::Picture;

/// Whether the pictures of a mesh's own file are wanted: where no `textured` is stated, or one that names the mesh itself.
pub(super) fn are_wanted(loading: &Loading, entry: usize) -> bool {
    let stated = loading.get::<Textured>(entry);
    stated.is_none_or(|textured| textured.texture == loading.entries[entry].name)
}

/// Reads the pictures on the triangles of an entry's mesh: its textures, and of each triangle which, beyond them for none.
///
/// One that cannot be read is left out and said; the error is that there is no memory for it.
pub(super) fn read(
    loading: &mut Loading,
    entry: usize,
    triangles: &Triangles,
) -> Result<(Vec<MappedTexture>, Vec<u32>), Error> {
    if triangles.pictures.is_empty() {
        return Ok(Default::default());
    }
    if triangles.places.values.is_empty() && !lies_as_stated(loading, entry) {
        loading.warn(entry, "its file has pictures and does not say where its triangles lie in them, and they are left out; state `textured` with its own name and `corners`");
        return Ok(Default::default());
    }
    let (mut textures, mut numbers, mut failures) = (Vec::new(), Vec::new(), Vec::new());
    for picture in &triangles.pictures {
        let texture = texture(loading, picture, &mut failures)?;
        numbers.push(texture.as_ref().map_or(u32::MAX, |_| textures.len() as u32));
        textures.extend(texture);
    }
    if let Some((first, rest)) = failures.split_first() {
        let more =
            if rest.is_empty() { String::new() } else { format!(" (and {} more)", rest.len()) };
        loading.warn(entry, format!("{first}{more}"));
    }
    let number = |at| triangles.picture(at).map_or(u32::MAX, |number| numbers[number as usize]);
    let of = (0..triangles.faces.len()).map(number).collect();
    Ok((textures, of))
}

/// Whether the scene says where a texture lies on the mesh.
fn lies_as_stated(loading: &Loading, entry: usize) -> bool {
    loading.get::<Textured>(entry).is_some_and(|textured| textured.corners.is_some())
}

/// A picture ready for lookups, seen through by its veil if it has one; `None` where it cannot be read, which is kept as a failure,
/// as that of a veil is.
fn texture(
    loading: &mut Loading,
    picture: &MeshPicture,
    failures: &mut Vec<String>,
) -> Result<Option<MappedTexture>, Error> {
    let Some(mut own) = decoded(loading, picture, failures)? else { return Ok(None) };
    if let Some(veil) = &picture.veil
        && let Some(veil) = decoded(loading, veil, failures)?
    {
        // One of the two is made as large as the other, and then a third of both.
        loading.afford_passing(3 * (own.pixels.bytes() + veil.pixels.bytes()))?;
        own = veiled(&own, &veil).unwrap_or(own);
    }
    let texture = MappedTexture::new(&own, Wrap::default(), TextureFilter::default());
    Ok(Some(texture.wrapping(picture.wrap)))
}

/// The pixels of a picture; `None` where it cannot be read, which is kept as a failure.
fn decoded(
    loading: &mut Loading,
    picture: &MeshPicture,
    failures: &mut Vec<String>,
) -> Result<Option<Picture>, Error> {
    let mut kept = |problem: String| {
        failures.push(format!("is shown without its picture `{}`, which {problem}", picture.name));
    };
    let weight = match picture.weighed() {
        Ok((_, weight)) => weight,
        Err(problem) => {
            kept(problem);
            return Ok(None);
        }
    };
    if let PicturePlace::Beside(path) = &picture.place {
        loading.files.push(path.clone());
    }
    // Levels of the texture are kept: its texels, and a third more; of two that make one, those of the larger. Pictures pass.
    loading.afford((weight.kept * 4).div_ceil(3))?;
    loading.afford_passing(weight.most())?;
    Ok(picture.decoded().map_err(kept).ok())
}
