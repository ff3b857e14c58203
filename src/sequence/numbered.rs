//! Files of single pictures: `name.####.png`, and whether one that is there already is the one that is wanted.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::digest::Digest;
use crate::formats::pictures::Notes;

/// How the files of a sequence are called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Numbered {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

/// The notes that say which picture a file holds; counts follow from them, and the scene's name makes no difference.
const TELLING: [&str; 4] = ["version", "settings", "exact", "data"];

impl Numbered {
    /// The pattern that a path is: the last row of `#` in its name stands for the number, in so many digits at least. A
    /// path of neither `#` nor extension, or of a folder that is there, is a folder: its pictures are `frame.####.png`.
    ///
    /// `None` for a single file; the error is a sentence without a subject.
    #[must_use]
    pub fn of(path: &Path) -> Option<Result<Self, String>> {
        if path.is_dir() || (path.extension().is_none() && !path.to_string_lossy().contains('#')) {
            return Some(Ok(Self::new(path, "frame.", 4, ".png")));
        }
        let name = path.file_name()?.to_str()?;
        let last = name.rfind('#')?;
        let first = name[..last]
            .rfind(|letter| letter != '#')
            .map_or(0, |at| at + name[at..].chars().next().map_or(1, char::len_utf8));
        let after = &name[last + 1..];
        if !after.to_ascii_lowercase().ends_with(".png") {
            return Some(Err(
                "is no name of frames: they are PNGs; end it in .png, as name.####.png".to_owned(),
            ));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        Some(Ok(Self::new(folder, &name[..first], last + 1 - first, after)))
    }

    fn new(folder: &Path, before: &str, digits: usize, after: &str) -> Self {
        let folder = if folder == Path::new("") { Path::new(".") } else { folder }.to_owned();
        Self { folder, before: before.to_owned(), digits, after: after.to_owned() }
    }

    /// The folder that they are in.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The name of a picture's file.
    #[must_use]
    pub fn name(&self, number: usize) -> String {
        let Self { before, digits, after, .. } = self;
        format!("{before}{number:0digits$}{after}")
    }

    /// The path of a picture's file.
    #[must_use]
    pub fn path(&self, number: usize) -> PathBuf {
        self.folder.join(self.name(number))
    }

    /// The path of the list of all files.
    #[must_use]
    pub fn manifest(&self) -> PathBuf {
        let stem = self.before.trim_end_matches(['.', '-', '_', ' ']);
        self.folder.join(format!("{}.manifest.json", if stem.is_empty() { "frames" } else { stem }))
    }
}

/// A digest of the notes of a picture that tell it from others.
#[must_use]
pub fn key(notes: &Notes) -> String {
    let mut digest = Digest::default();
    for telling in TELLING {
        let note = notes.iter().find(|(name, _)| name == telling);
        digest.add(note.map_or("", |(_, text)| text).as_bytes());
    }
    digest.digits()
}

/// The key of the picture that a PNG holds; `None` where there is none that is whole.
///
/// Files that gelray writes appear whole; one that was cut short in copying lacks its end.
#[must_use]
pub fn key_of_file(path: &Path) -> Option<String> {
    const END: [u8; 12] = [0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82];
    let mut file = BufReader::new(File::open(path).ok()?);
    let mut end = [0; 12];
    file.seek(SeekFrom::End(-12)).ok()?;
    file.read_exact(&mut end).ok()?;
    file.rewind().ok()?;
    let reader = png::Decoder::new(file).read_info().ok().filter(|_| end == END)?;
    let texts = reader.info().utf8_text.iter();
    let notes: Option<Vec<_>> =
        texts.map(|text| Some((text.keyword.clone(), text.get_text().ok()?))).collect();
    Some(key(&notes?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::pictures::write_picture;
    use crate::view::picture::Picture;

    fn name(path: &str, number: usize) -> String {
        Numbered::of(Path::new(path)).unwrap().unwrap().path(number).display().to_string()
    }

    #[test]
    fn the_last_row_of_marks_is_the_number_and_a_folder_has_names_of_its_own() {
        assert_eq!(name("out/turn.####.png", 7), "out/turn.0007.png");
        assert_eq!(name("a#b-##.PNG", 123), "./a#b-123.PNG");
        assert_eq!(name("tür###.png", 5), "./tür005.png");
        assert_eq!(name("frames", 5), "frames/frame.0005.png");
        assert_eq!(Numbered::of(Path::new("turn.png")), None);
        assert!(Numbered::of(Path::new("turn.##.exr")).unwrap().is_err());
    }

    #[test]
    fn the_manifest_is_called_after_the_frames() {
        let of = |path| Numbered::of(Path::new(path)).unwrap().unwrap().manifest();
        assert_eq!(of("out/turn.####.png"), Path::new("out/turn.manifest.json"));
        assert_eq!(of("####.png"), Path::new("./frames.manifest.json"));
    }

    #[test]
    fn a_file_is_recognized_by_its_notes_if_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let notes = [("version", "1"), ("settings", "größe"), ("counts", "{}")];
        let notes = notes.map(|(name, text)| (name.to_owned(), text.to_owned()));
        write_picture(&path, &Picture::new([1, 1], vec![[0.5; 4]]).unwrap(), &notes).unwrap();
        assert_eq!(key_of_file(&path), Some(key(&notes)));
        let mut other = notes.clone();
        other[1].1.push('x');
        assert_ne!(key(&other), key(&notes));
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
        assert_eq!((key_of_file(&path), key_of_file(folder.path())), (None, None));
    }
}
