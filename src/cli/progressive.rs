//! `--progressive`: pictures of what is known so far, written at equal intervals while rays are cast (paper §6).

use std::path::{Path, PathBuf};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser};
use crossbeam::channel::Receiver;
use gelray::Error;
use gelray::formats::pictures::{Notes, picture_beside};
use gelray::scene::Scene;
use gelray::view::observer::first_view;
use gelray::view::picture::Picture;
use gelray::view::viewer::Viewer;
use hecs::World;

use super::failure::Failure;

/// What `render` takes beside the flags of all verbs.
#[derive(Debug, Args)]
pub struct Progressive {
    /// Writes pictures into a folder while rays are cast, each better than the last; the last is the whole one
    #[arg(long = "progressive", value_name = "DIR", value_parser = OsStringValueParser::new().map(PathBuf::from))]
    folder: Option<PathBuf>,
    /// Time from each of these pictures to the next: 100ms, 2s
    #[arg(long, value_name = "TIME", default_value = "100ms", value_parser = time, requires = "folder")]
    every: Duration,
}

/// Who writes the pictures.
pub struct Looking {
    folder: PathBuf,
    writer: JoinHandle<Result<usize, Error>>,
}

impl Progressive {
    /// Makes the folder, where pictures are asked for; those of another run in it are a misuse, for they would be taken for
    /// this one's.
    pub fn check(&self) -> Result<(), Failure> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let said = |problem: std::io::Error| {
            let folder = folder.display();
            Failure::Said(format!("the folder {folder} cannot be made ({problem})"))
        };
        std::fs::create_dir_all(folder).map_err(said)?;
        if name(folder, 0).exists() {
            return Err(Failure::Misused(format!(
                "{} is there already; name an empty folder with --progressive, or remove the pictures of the last run",
                name(folder, 0).display()
            )));
        }
        Ok(())
    }

    /// Looks on from now, if that was asked for; `notes` are what each picture says of itself.
    pub fn look(
        &self,
        scene: &mut Scene,
        notes: Vec<(String, String)>,
    ) -> Result<Option<Looking>, Failure> {
        let Some(folder) = self.folder.clone() else { return Ok(None) };
        let (viewer, pictures) = Viewer::new(self.every);
        if let Some(view) = first_view(&scene.world) {
            let _ = scene.world.insert_one(view, viewer);
        }
        let into = folder.clone();
        let writer = Builder::new().name("pictures".to_owned());
        let writer = writer.spawn(move || write(&into, &pictures, &notes)).map_err(|problem| {
            Failure::Said(format!("a thread that writes pictures cannot be made ({problem})"))
        })?;
        Ok(Some(Looking { folder, writer }))
    }
}

impl Looking {
    /// Looks no longer; where the last picture goes, once those before it are written.
    pub fn end(self, world: &mut World) -> Result<PathBuf, Failure> {
        if let Some(view) = first_view(world) {
            let _ = world.remove_one::<Viewer>(view);
        }
        match self.writer.join() {
            Ok(written) => Ok(name(&self.folder, written?)),
            Err(_) => Err(Failure::Said("the pictures cannot be written".to_owned())),
        }
    }
}

/// Writes pictures as they come; how many there were.
fn write(folder: &Path, pictures: &Receiver<Picture>, notes: &Notes) -> Result<usize, Error> {
    let mut written = 0;
    for picture in pictures {
        picture_beside(&name(folder, written), &picture, notes)?.appear()?;
        written += 1;
    }
    Ok(written)
}

fn name(folder: &Path, number: usize) -> PathBuf {
    folder.join(format!("progress.{number:04}.png"))
}

fn time(text: &str) -> Result<Duration, String> {
    let units = [("ms", 1e-3), ("min", 60.0), ("s", 1.0)];
    let stated = units.iter().find_map(|(unit, seconds)| {
        let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
        Some(number * seconds)
    });
    let expected = "a time above 0 and under a day is expected, such as 100ms or 2s";
    let held = stated.filter(|seconds| (1e-6..86_400.0).contains(seconds));
    held.map(Duration::from_secs_f64).ok_or_else(|| expected.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_has_a_unit() {
        assert_eq!(time("100ms"), Ok(Duration::from_millis(100)));
        assert_eq!(time("1.5 s"), Ok(Duration::from_millis(1500)));
        assert_eq!(time("2min"), Ok(Duration::from_mins(2)));
        for text in ["", "100", "ms", "-1s", "0s", "nans", "infs", "1e9s", "2h"] {
            assert!(time(text).is_err(), "{text}");
        }
    }
}
