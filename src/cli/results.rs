//! What a run writes, made whole one by one and seen all at once: picture, rays, stats and trace of one run, or of none.

use std::path::Path;

use gelray::Error;
use gelray::formats::pictures::{Notes, picture_beside, png_bytes};
use gelray::formats::whole::{Whole, written_beside};
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
    /// Keeps a picture: in the format that the path says, or as a PNG for standard output.
    pub fn picture(
        &mut self,
        path: &Path,
        picture: &Picture,
        notes: &Notes,
    ) -> Result<(), Failure> {
        if is_standard(path) {
            self.printed = png_bytes(picture, notes)
                .map_err(|problem| Failure::Said(format!("the picture {problem}")))?;
        } else {
            self.keep(picture_beside(path, picture, notes)?);
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

    /// Lets all be seen, if nobody asked to stop until now; from here on nothing stops it.
    pub fn appear(self, interrupt: &Interrupt) -> Result<(), Failure> {
        let _whole = interrupt.hold()?;
        if !self.printed.is_empty() {
            print_bytes(&self.printed)?;
        }
        Ok(self.files.into_iter().try_for_each(Whole::appear)?)
    }
}
