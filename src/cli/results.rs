//! What a run writes, made whole one by one and seen all at once: picture, rays, stats and trace of one run, or of none.

use std::path::Path;

use gelray::Error;
use gelray::formats::pictures::{Notes, format_of, picture_beside, png_bytes};
use gelray::formats::whole::{Whole, appear_together, written_beside};
use gelray::view::picture::Picture;

use super::failure::{Failure, print_bytes};
use super::interrupt::Interrupt;
use super::outputs::is_standard;

/// Files that are written and not yet seen.
#[derive(Default)]
pub struct Results {
    files: Vec<Whole>,
    printed: Vec<u8>,
}

impl Results {
    /// Keeps a picture under each name: in the format that it says, or as a PNG for standard output. Those that are PNGs are
    /// encoded once.
    pub fn pictures(
        &mut self,
        paths: &[&Path],
        picture: &Picture,
        notes: &Notes,
    ) -> Result<(), Failure> {
        let is_png = |path: &Path| {
            is_standard(path) || format_of(path).is_some_and(|format| format.name == "PNG")
        };
        let mut encoded = None;
        for path in paths {
            if !is_png(path) {
                self.keep(picture_beside(path, picture, notes)?);
                continue;
            }
            let bytes = match encoded.take() {
                Some(bytes) => bytes,
                None => png_bytes(picture, notes)
                    .map_err(|problem| Failure::Said(format!("the picture {problem}")))?,
            };
            if is_standard(path) {
                self.printed.clone_from(&bytes);
            } else {
                self.keep(written_beside(path, |out| Ok(out.write_all(&bytes)?))?);
            }
            encoded = Some(bytes);
        }
        Ok(())
    }

    /// Keeps a file of JSON.
    pub fn json(&mut self, path: &Path, value: &impl serde::Serialize) -> Result<(), Error> {
        self.keep(written_beside(path, |out| {
            serde_json::to_writer_pretty(&mut *out, value)?;
            Ok(out.write_all(b"\n")?)
        })?);
        Ok(())
    }

    /// Keeps a file of text.
    pub fn text(&mut self, path: &Path, text: &str) -> Result<(), Error> {
        self.keep(written_beside(path, |out| Ok(out.write_all(text.as_bytes())?))?);
        Ok(())
    }

    /// Keeps a file that is written already.
    pub fn keep(&mut self, file: Whole) {
        self.files.push(file);
    }

    /// Lets all be seen, the picture first, if nobody asked to stop until now; from here on nothing stops it.
    pub fn appear(self, interrupt: &Interrupt) -> Result<(), Failure> {
        let _whole = interrupt.hold()?;
        if !self.printed.is_empty() {
            print_bytes(&self.printed)?;
        }
        Ok(appear_together(self.files)?)
    }
}
