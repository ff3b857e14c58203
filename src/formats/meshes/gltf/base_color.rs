//! Which picture is on a primitive: that of its material's base color, in a file beside, in the JSON or in a buffer.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::super::pictures::{MeshPicture, PictureAlpha, PicturePlace, add_picture, say_once};
use super::accessor::viewed;
use super::buffers::{Buffers, file_of};
use super::document::{Document, Primitive};
use super::looks::{SampledImage, SurfaceLooks};
use crate::components::Wrap;
use crate::formats::base64::all_decoded;

/// What tells pictures apart: the image, what its alpha does, and how it goes on outside itself.
type Look = (usize, [u32; 3], [Wrap; 2]);

/// The pictures of a file that primitives use, each once.
pub(super) struct BaseColors<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    path: &'a Path,
    /// Bytes that may still be copied of buffers: pictures that share them are not to outgrow the file.
    left: usize,
    pub pictures: Vec<MeshPicture>,
    pub warnings: Vec<String>,
    known: HashMap<Look, Option<u32>>,
}

impl<'a> BaseColors<'a> {
    /// Of a file of `held` bytes, with its buffers.
    pub fn new(
        document: &'a Document,
        buffers: &'a Buffers<'a>,
        (path, held): (&'a Path, usize),
    ) -> Self {
        let (pictures, warnings, known) = (Vec::new(), Vec::new(), HashMap::new());
        Self { document, buffers, path, left: held, pictures, warnings, known }
    }

    /// The number of the picture that is on a primitive, and what alpha does to it; what cannot be had of a picture is said once.
    pub fn of(&mut self, primitive: &Primitive) -> (Option<u32>, PictureAlpha) {
        let Some(looks) = self.document.looks(primitive) else {
            return (None, PictureAlpha::Ignored);
        };
        let alpha = alpha(looks);
        (self.picture(looks, alpha), alpha)
    }

    fn picture(&mut self, looks: &SurfaceLooks, alpha: PictureAlpha) -> Option<u32> {
        let document = self.document;
        let used = looks.pbr.as_ref()?.picture.as_ref()?;
        let texture = document.textures.get(used.index);
        let Some(image) = texture.and_then(SampledImage::image) else {
            let sentence = "some of its pictures are in no file or of no format that is read, and left out; export them as PNG or JPEG";
            say_once(&mut self.warnings, sentence);
            return None;
        };
        let wrap = self.wrap(texture.and_then(|texture| texture.sampler));
        let look = (image, alpha.key(), wrap);
        if let Some(known) = self.known.get(&look) {
            return *known;
        }
        let added = self.stored(image).and_then(|(name, place)| {
            add_picture(&mut self.pictures, MeshPicture { name, place, alpha, wrap, veil: None })
        });
        let number = added.map_err(|sentence| say_once(&mut self.warnings, sentence)).ok();
        self.known.insert(look, number);
        number
    }

    /// How a picture goes on outside itself: to its sides, and above and below.
    fn wrap(&self, sampler: Option<usize>) -> [Wrap; 2] {
        let outside = sampler.and_then(|at| self.document.samplers.get(at));
        let ways = outside.map_or([None; 2], |outside| [outside.wrap_s, outside.wrap_t]);
        ways.map(|way| match way {
            Some(33071) => Wrap::Clamp,
            Some(33648) => Wrap::Mirror,
            _ => Wrap::Repeat,
        })
    }

    /// What an image is called, and where its bytes are; the error is a sentence about the file.
    fn stored(&mut self, at: usize) -> Result<(String, PicturePlace), String> {
        let image = self.document.images.get(at);
        let image = image.ok_or_else(|| {
            format!("it names picture {at}, which it does not have; export it again")
        })?;
        let name = image.name.clone().filter(|name| !name.trim().is_empty());
        let name = name.unwrap_or_else(|| format!("number {at}"));
        let wrong = |what: &str| format!("its picture {name} {what}, and is left out");
        let uri = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => uri,
            (None, Some(view)) => {
                let (_, bytes) = viewed(self.document, self.buffers, view)
                    .map_err(|_| wrong("lies outside its buffers; export it again"))?;
                let left = self.left.checked_sub(bytes.len());
                self.left = left.ok_or_else(|| {
                    wrong("shares its bytes with others, more than the file holds; export it again")
                })?;
                return Ok((name, PicturePlace::Within(bytes.to_vec())));
            }
            (None, None) => return Err(wrong("is nowhere; export it again")),
        };
        if uri.starts_with("data:") {
            let text = uri.split_once(";base64,").map(|(_, text)| text.as_bytes());
            let text = text.ok_or_else(|| wrong("is no base64; export it as .glb"))?;
            return Ok((name, PicturePlace::Within(all_decoded(text))));
        }
        let file = file_of(uri, self.path).ok_or_else(|| {
            wrong(&format!("is at {uri}, from where nothing is fetched; export it as .glb"))
        })?;
        let name = file.file_name().map_or(name, |name| name.to_string_lossy().into_owned());
        Ok((name, PicturePlace::Beside(file)))
    }

    /// Keeps a sentence about images that no material has as its base color.
    pub fn say_unread(&mut self) {
        let used = self.document.materials.iter().filter_map(|looks| {
            let picture = looks.pbr.as_ref()?.picture.as_ref()?;
            self.document.textures.get(picture.index)?.image()
        });
        let used: HashSet<usize> = used.collect();
        let unread = (0..self.document.images.len()).filter(|at| !used.contains(at)).count();
        if unread > 0 {
            self.warnings.push(format!("{unread} of its pictures are not of its base color, but of such as normals and roughness, and are not read"));
        }
    }
}

/// What alpha does to a surface that looks so.
fn alpha(looks: &SurfaceLooks) -> PictureAlpha {
    let factor = looks.pbr.as_ref().and_then(|pbr| pbr.base_color).map_or(1.0, |color| color[3]);
    let factor = factor.clamp(0.0, 1.0);
    let least = looks.alpha_cutoff.unwrap_or(0.5);
    match looks.alpha_mode.as_deref() {
        Some("BLEND") => PictureAlpha::Opacity(factor),
        Some("MASK") if least > 0.0 => PictureAlpha::Cut { factor, least },
        _ => PictureAlpha::Ignored,
    }
}
