//! Where a sequence goes: numbered frames, a clip in one file, or a pipe; known to be possible before any frame is rendered.

use std::fmt;
use std::path::{Path, PathBuf};

use gelray::Error;
use gelray::formats::moving::{
    Frames, MOVING_FORMATS, Movie, check_clip, moving_format_of, write_clip, y4m,
};
use gelray::formats::pictures::encoded::to_bytes;
use gelray::formats::pictures::write_picture;
use gelray::formats::whole::check_writable;
use gelray::sequence::film::Film;
use gelray::sequence::numbered::Numbered;
use gelray::sequence::pipeline::{Shot, Shots};

use super::failure::Failure;
use super::flags::Flags;
use super::motion::Motion;
use super::same_file::same_file;

/// Where a sequence goes.
#[derive(Debug, Clone)]
pub enum Target<'a> {
    /// A file a frame.
    Frames(Numbered),
    /// One file.
    Clip(&'a Path),
    /// Standard output.
    Pipe,
}

impl<'a> Target<'a> {
    /// What `-o` names; what could not be written, or not in parts, is refused.
    pub fn of(flags: &'a Flags, motion: &Motion) -> Result<Self, Failure> {
        let target = Self::named(flags)?;
        let parts = [("--resume", motion.resume), ("--shard", motion.shard.is_some())];
        match (&target, parts.iter().find(|(_, given)| *given)) {
            (Self::Frames(_), _) | (_, None) => Ok(target),
            (_, Some((flag, _))) => Err(Failure::Misused(format!(
                "{flag} is for frames, and {target} is one animation; write frames with -o DIR, then `gelray assemble DIR -o {target}`"
            ))),
        }
    }

    /// What `-o` names, where it is to be one animation.
    pub fn single(flags: &'a Flags) -> Result<Self, Failure> {
        match flags.output.as_deref() {
            Some(path) if path == Path::new("-") => Ok(Self::Pipe),
            Some(path) => clip(path),
            None => Err(Failure::Misused(format!(
                "`gelray assemble` needs a file to write; add -o OUT, a name that ends in one of {}",
                extensions()
            ))),
        }
    }

    /// Writes the pictures that come to where they belong.
    pub fn encode(&self, clip: &Movie, shots: &mut Shots) -> Result<(), Error> {
        match self {
            Self::Frames(numbered) => write_frames(numbered, shots),
            Self::Clip(path) => write_clip(path, clip, &mut Stream(shots)),
            Self::Pipe => pipe(clip, &mut Stream(shots)),
        }
    }

    fn named(flags: &'a Flags) -> Result<Self, Failure> {
        let Some(path) = flags.output.as_deref() else {
            return Err(Failure::Misused(format!(
                "`gelray animate` needs something to write; add -o DIR or -o name.####.png for frames, or -o OUT, a name that ends in one of {}",
                extensions()
            )));
        };
        if path == Path::new("-") {
            return Ok(Self::Pipe);
        }
        match Numbered::of(path) {
            Some(Ok(numbered)) => {
                check_folder(&numbered)?;
                Ok(Self::Frames(numbered))
            }
            Some(Err(problem)) => Err(misused(path, &problem)),
            None => clip(path),
        }
    }

    /// Finds out that no file that is to be written is one that the scene reads.
    pub fn spare(&self, film: &Film) -> Result<(), Failure> {
        let overwritten = |input: &&PathBuf| match self {
            Self::Pipe => false,
            Self::Clip(path) => same_file(input, path),
            Self::Frames(numbered) => {
                let named = |number: &usize| {
                    input.file_name().is_some_and(|name| *name == *numbered.name(*number))
                };
                let all = 0..film.range().count();
                all.into_iter().find(named).is_some_and(|n| same_file(input, &numbered.path(n)))
            }
        };
        match film.scene.files.iter().find(overwritten) {
            Some(input) => {
                Err(misused(input, "is read and would be written over; choose another --output"))
            }
            None => Ok(()),
        }
    }
}

/// A clip in one file, if it could be written; a name that no clip has is a misuse.
fn clip(path: &Path) -> Result<Target<'_>, Failure> {
    match (check_clip(path), moving_format_of(path)) {
        (Ok(()), _) => Ok(Target::Clip(path)),
        (Err(error), Some(_)) => Err(error.into()),
        (Err(error), None) => Err(Failure::Misused(error.to_string())),
    }
}

impl fmt::Display for Target<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frames(numbered) => write!(f, "{}", numbered.folder().display()),
            Self::Clip(path) => write!(f, "{}", path.display()),
            Self::Pipe => write!(f, "standard output"),
        }
    }
}

fn misused(path: &Path, problem: &str) -> Failure {
    Failure::Misused(format!("{} {problem}", path.display()))
}

/// Whether frames could be written: in a folder that is there, or could be made.
fn check_folder(numbered: &Numbered) -> Result<(), Error> {
    let folder = numbered.folder();
    if folder.is_dir() {
        return check_writable(&numbered.manifest());
    }
    check_writable(folder)
}

/// Each frame a file, whole or not at all.
fn write_frames(numbered: &Numbered, shots: &mut Shots) -> Result<(), Error> {
    for shot in shots {
        let Shot { number, picture, notes } = shot?;
        write_picture(&numbered.path(number), &picture, &notes)?;
    }
    Ok(())
}

/// The extensions of clips, for sentences.
fn extensions() -> String {
    let all = MOVING_FORMATS.iter().flat_map(|format| format.extensions);
    all.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
}

/// The pictures of a sequence as the codes that clips are made of.
struct Stream<'a, 's>(&'a mut Shots<'s>);

impl Iterator for Stream<'_, '_> {
    type Item = Result<Vec<u8>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        Some(self.0.next()?.map(|shot| to_bytes(&shot.picture)))
    }
}

/// YUV4MPEG2 to standard output.
fn pipe(clip: &Movie, frames: Frames) -> Result<(), Error> {
    y4m::write(&mut std::io::stdout().lock(), clip, frames).map_err(|failure| {
        match failure.downcast::<Error>() {
            Ok(error) => *error,
            Err(failure) => Error::file(
                "standard output",
                format!("cannot be written ({failure}); look at what reads it"),
            ),
        }
    })
}
