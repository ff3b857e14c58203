//! `gelray assemble`: finished frames into one animation.

use std::path::{Path, PathBuf};

use gelray::Error;
use gelray::formats::moving::{Movie, Rate};
use gelray::formats::pictures::read_picture;
use gelray::sequence::manifest::Manifest;
use gelray::sequence::pipeline::{self, Feed, RenderFault, Shot, Stopped};

use super::failure::{Failure, tell};
use super::flags::Flags;
use super::interrupt::Interrupt;
use super::same_file::same_file;
use super::target::Target;

pub const EXAMPLES: &str = "\
Examples:
  gelray assemble DIR -o turn.gif                    frames that `gelray animate -o DIR` made, by one machine or by many
  gelray assemble DIR/turn.manifest.json -o turn.mp4 --fps 12";

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--output"];

/// Makes an animation of the frames that a manifest lists, if all of them are finished.
pub fn run(frames: &Path, rate: Option<Rate>, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("assemble", TAKES)?;
    let target = Target::single(flags)?;
    let (folder, manifest) = listed(frames)?;
    let own = |frame: &&gelray::sequence::manifest::Listed| match target {
        Target::Clip(path) => same_file(&folder.join(&frame.file), path),
        _ => false,
    };
    if let Some(frame) = manifest.frames.iter().find(own) {
        let file = &frame.file;
        return Err(Failure::Misused(format!("--output names the frame {file}; choose another")));
    }
    finished(&folder, &manifest)?;
    let rate = match rate {
        Some(rate) => rate,
        None => Rate::parse(&manifest.frames_per_second)
            .map_err(|problem| Error::file(frames, format!("its rate {problem}; state --fps")))?,
    };
    let interrupt = Interrupt::listen();
    interrupt.work_begins();
    let size = match manifest.frames.first() {
        Some(first) => read_picture(&folder.join(&first.file))?.size,
        None => return Err(Error::file(frames, "lists no frame; render them again").into()),
    };
    let clip = Movie { size, count: manifest.frames.len(), rate };
    let sent = pipeline::run(
        |feed| send(&folder, &manifest, &interrupt, feed),
        |shots| target.encode(&clip, shots),
    );
    sent.map_err(|Stopped { error, done }| match error {
        Error::Interrupted => Failure::from(Error::Interrupted),
        error => Failure::Said(format!("{error}; {done} of {} frames were taken", clip.count)),
    })?;
    if !flags.quiet {
        tell(format_args!("{target}: {} frames at {rate} a second", clip.count));
    }
    Ok(())
}

fn send(
    folder: &Path,
    manifest: &Manifest,
    interrupt: &Interrupt,
    feed: &mut Feed,
) -> Result<(), RenderFault> {
    for (number, frame) in manifest.frames.iter().enumerate() {
        interrupt.watch.check()?;
        let picture = read_picture(&folder.join(&frame.file))?;
        feed.send(Shot { number, picture, notes: Vec::new() })?;
    }
    Ok(())
}

/// The folder of some frames, and their manifest: the one that is named, or the only one in the folder that is.
fn listed(frames: &Path) -> Result<(PathBuf, Manifest), Error> {
    if !frames.is_dir() {
        let folder = frames.parent().filter(|folder| *folder != Path::new(""));
        return Ok((folder.unwrap_or(Path::new(".")).to_owned(), Manifest::read(frames)?));
    }
    let entries = std::fs::read_dir(frames)
        .map_err(|error| Error::file(frames, format!("cannot be read ({error})")))?;
    let mut names: Vec<_> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".manifest.json"))
        .collect();
    names.sort();
    match &names[..] {
        [one] => Ok((frames.to_owned(), Manifest::read(&frames.join(one))?)),
        [] => Err(Error::file(
            frames,
            "holds no manifest of frames; name a folder that `gelray animate -o DIR` wrote to",
        )),
        several => Err(Error::file(
            frames,
            format!("holds several sequences; name the manifest of one: {}", several.join(", ")),
        )),
    }
}

/// Passes if every frame is there, whole, and shows what the manifest says.
fn finished(folder: &Path, manifest: &Manifest) -> Result<(), Error> {
    let count = manifest.frames.len();
    let missing: Vec<_> = (0..count).filter(|n| !manifest.is_done(folder, *n)).collect();
    match missing.first().and_then(|first| manifest.frames.get(*first)) {
        None => Ok(()),
        Some(first) => Err(Error::file(
            folder,
            format!(
                "lacks {} of {count} frames, {} before all; render them with `gelray animate` and --resume",
                missing.len(),
                first.file
            ),
        )),
    }
}
