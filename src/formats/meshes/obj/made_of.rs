//! What the triangles of an OBJ are made of: the materials that it names, looked up in the files that it names.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::super::pictures::{MeshPicture, PictureAlpha, PicturePlace, add_picture, say_once};
use super::super::triangles::{AtCorners, Triangles, place_upward};
use super::library::{ObjMaterial, PictureLine, add_materials};
use crate::components::{Color, Wrap};
use crate::formats::stream::Stream;

/// Files of materials that are looked into: no OBJ that is drawn here names more.
const MOST_LIBRARIES: usize = 64;

/// The number of no material.
const NONE: u32 = u32::MAX;

/// The materials of a file, while it is read.
#[derive(Default)]
pub(super) struct MadeOf {
    /// Names of materials, and their numbers in the order of their first use.
    numbers: HashMap<String, u32>,
    /// The number of the one that is taken now, if any.
    now: Option<u32>,
    /// The number of the material of each triangle; empty as long as none is taken.
    of: Vec<u32>,
    /// By name, what files of materials hold.
    materials: HashMap<String, ObjMaterial>,
    /// The folder of the file.
    folder: PathBuf,
    libraries: Vec<PathBuf>,
    read: Vec<PathBuf>,
    warnings: Vec<String>,
}

impl MadeOf {
    /// Reads the files of materials that a line names, from the folder of the mesh's file.
    pub fn look_up(&mut self, names: &str, path: &Path) {
        path.parent().unwrap_or(Path::new("")).clone_into(&mut self.folder);
        // A name may have blanks in it, and there may be several.
        let is_one = beside(&self.folder, names).is_file();
        let several = names.split_whitespace().filter(|_| !is_one);
        let one = Some(names).filter(|_| is_one);
        for name in one.into_iter().chain(several) {
            let file = beside(&self.folder, name);
            if self.libraries.contains(&file) {
                continue;
            }
            if self.libraries.len() == MOST_LIBRARIES {
                let sentence = format!(
                    "it names more than {MOST_LIBRARIES} files of materials, and the rest are not read; join them into one"
                );
                return say_once(&mut self.warnings, sentence);
            }
            match Stream::open(&file).and_then(|mut stream| stream.rest()) {
                Ok(bytes) => {
                    add_materials(&bytes, &mut self.materials);
                    self.read.push(file.clone());
                }
                Err(problem) => say_once(&mut self.warnings, unread(&file, &problem)),
            }
            self.libraries.push(file);
        }
    }

    /// What follows is made of the material of that name.
    pub fn take(&mut self, name: &str) {
        let next = self.numbers.len() as u32;
        self.now = Some(*self.numbers.entry(name.to_owned()).or_insert(next));
    }

    /// The triangles from `before` on, `count` in all, are of the material that is taken.
    pub fn cover(&mut self, before: usize, count: usize) {
        if let Some(now) = self.now {
            self.of.resize(before, NONE);
            self.of.resize(count, now);
        }
    }

    /// Gives the triangles the colors and pictures of their materials: white where others have a color and they have none.
    pub fn color(mut self, triangles: &mut Triangles) {
        let mut names: Vec<_> = std::mem::take(&mut self.numbers).into_iter().collect();
        names.sort_by_key(|(_, number)| *number);
        let used: Vec<_> = names.iter().map(|(name, _)| self.materials.remove(name)).collect();
        let known = || used.iter().flatten();
        let mut pictures =
            Pictures { folder: &self.folder, all: Vec::new(), known: HashMap::new() };
        let numbers: Vec<_> = used
            .iter()
            .map(|material| pictures.number(material.as_ref()?, &mut self.warnings))
            .collect();
        self.of.resize(triangles.faces.len(), NONE);
        if known().any(|material| material.tint().is_some()) {
            let tint = |number: &u32| used.get(*number as usize)?.as_ref()?.tint();
            let colors = self.of.iter().map(|number| tint(number).unwrap_or(Color::WHITE));
            triangles.face_colors = colors.collect();
        }
        if !pictures.all.is_empty() {
            let number = |at: &u32| numbers.get(*at as usize).copied().flatten().unwrap_or(NONE);
            triangles.pictured = self.of.iter().map(number).collect();
        }
        triangles.pictures = pictures.all;
        if known().any(|material| material.opacity() < 1.0) {
            let opacity = |number: &u32| Some(used.get(*number as usize)?.as_ref()?.opacity());
            let opacities = self.of.iter().map(|number| opacity(number).unwrap_or(1.0));
            triangles.opacities = opacities.collect();
        }
        let moves: Vec<_> =
            used.iter().map(|material| material.as_ref()?.laid()?.moves()).collect();
        move_places(triangles, |at| moves.get(self.of[at] as usize).copied().flatten());
        let unseen = || known().filter(|material| material.opacity() <= 0.0);
        let by_tr = unseen().filter(|material| material.is_clear_by_tr()).count();
        let by_d = unseen().count() - by_tr;
        let missing = used.len() - known().count();
        if by_d > 0 {
            self.warnings.push(format!("{by_d} of its materials are wholly clear (`d` is 0), and what is made of them is not seen; write `d 1` where they are meant to be opaque"));
        }
        if by_tr > 0 {
            self.warnings.push(format!("{by_tr} of its materials are wholly clear by `Tr 1` without a `d`, and what is made of them is not seen; some programs mean opaque by that: write `d 1` then"));
        }
        if missing > 0 && !self.read.is_empty() {
            self.warnings.push(format!("{missing} of its materials are in no file that it names, and what is made of them is plain; export it again"));
        }
        triangles.beside.extend(self.read);
        triangles.warnings.extend(self.warnings);
    }
}

/// The sentence about a file of materials that is not read, for that problem.
fn unread(file: &Path, problem: &str) -> String {
    let name = file.display();
    match file.try_exists() {
        Ok(false) => {
            format!("its materials are not read, for {name} is not there; put it beside the mesh")
        }
        Ok(true) if file.is_dir() => {
            format!("its materials are not read, for {name} is a folder; put a file there")
        }
        _ => format!("its materials are not read, for {name} {problem}"),
    }
}

/// Scales and shifts where triangles lie in their pictures, `v` running up, as `of` says of each by its number.
///
/// Triangles of several materials may share places, so that one that is moved is kept once more for each way.
fn move_places(triangles: &mut Triangles, of: impl Fn(usize) -> Option<[[f64; 2]; 2]>) {
    let AtCorners { values, faces } = &mut triangles.places;
    let mut made = HashMap::new();
    for (at, face) in faces.iter_mut().enumerate() {
        let Some(moved) = of(at) else { continue };
        for corner in face.iter_mut() {
            let Some(&place) = values.get(*corner as usize) else { continue };
            let key = (*corner, moved.map(|numbers| numbers.map(f64::to_bits)));
            *corner = *made.entry(key).or_insert_with(|| {
                let [scale, shift] = moved.map(DVec2::from);
                let up = DVec2::new(place.x, 1.0 - place.y) * scale + shift;
                values.push(place_upward(up.x, up.y));
                values.len() as u32 - 1
            });
        }
    }
}

/// What tells pictures apart: their names, whether they are clamped, and what alpha does.
type Look = (String, Option<String>, bool, [u32; 3]);

/// The pictures that materials name, each once.
struct Pictures<'f> {
    folder: &'f Path,
    all: Vec<MeshPicture>,
    known: HashMap<Look, u32>,
}

impl Pictures<'_> {
    /// A picture that a line names, whose alpha does that.
    fn picture(&self, line: &PictureLine, alpha: PictureAlpha) -> MeshPicture {
        let wrap = [if line.is_clamped { Wrap::Clamp } else { Wrap::Repeat }; 2];
        let place = PicturePlace::Beside(beside(self.folder, &line.name));
        MeshPicture { name: line.name.clone(), place, alpha, wrap, veil: None }
    }

    /// The number of a material's picture, if it names one.
    fn number(&mut self, material: &ObjMaterial, warnings: &mut Vec<String>) -> Option<u32> {
        let line = material.laid()?;
        if line.is_rough {
            say_once(
                warnings,
                "it makes pictures rough by turbulence (`-t`), which is not read; they lie where its `vt`, `-s` and `-o` say",
            );
        }
        let veil = material.veil_apart();
        if veil.is_some_and(|veil| !veil.lies_as(line)) {
            say_once(
                warnings,
                "it lays pictures of opacity (`map_d`) otherwise than those of color beside them, which is not read; they lie as those of `map_Kd`",
            );
        }
        let alpha = match (&material.picture, &material.veil) {
            (None, _) => PictureAlpha::Veil,
            (Some(_), Some(_)) if veil.is_none() => PictureAlpha::Opacity(1.0),
            (Some(_), _) => PictureAlpha::Ignored,
        };
        let name_of = |line: &PictureLine| line.name.clone();
        let key = (name_of(line), veil.map(name_of), line.is_clamped, alpha.key());
        if let Some(&number) = self.known.get(&key) {
            return Some(number);
        }
        let veil = veil.map(|veil| Box::new(self.picture(veil, PictureAlpha::Veil)));
        let added = MeshPicture { veil, ..self.picture(line, alpha) };
        let number = add_picture(&mut self.all, added).map_err(|said| say_once(warnings, said));
        self.known.insert(key, number.ok()?);
        number.ok()
    }
}

/// The file of that name, from a folder; one that is not there, but beside, is meant where a path of another machine is written.
fn beside(folder: &Path, name: &str) -> PathBuf {
    let name = name.replace('\\', "/");
    let stated = folder.join(&name);
    let bare = Path::new(&name).file_name().map(|bare| folder.join(bare));
    bare.filter(|bare| !stated.is_file() && bare.is_file()).unwrap_or(stated)
}
