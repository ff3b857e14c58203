//! MP4 and WebM: made by the program `ffmpeg`, where it is on the PATH, out of a pipe of YUV4MPEG2.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use super::format::{By, Frames, Movie, MovingFormat};
use super::y4m;
use crate::error::Error;
use crate::formats::whole::{Failure, write_by_name};

/// H.264 with a color sample for each 2 × 2 pixels: what every player shows.
pub const MP4: MovingFormat = MovingFormat {
    name: "MP4",
    extensions: &["mp4"],
    made: By::Ffmpeg(&["-c:v", "libx264", "-crf", "17", "-movflags", "+faststart", "-f", "mp4"]),
};

/// VP9: what browsers show.
pub(crate) const WEBM: MovingFormat = MovingFormat {
    name: "WebM",
    extensions: &["webm"],
    made: By::Ffmpeg(&["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-f", "webm"]),
};

/// What is said to `ffmpeg` about its input.
const INPUT: &[&str] =
    &["-nostdin", "-hide_banner", "-loglevel", "error", "-y", "-f", "yuv4mpegpipe", "-i", "-"];

/// What is said about its output: an even number of pixels each way, colors named, and no clock time in it.
#[rustfmt::skip]
const OUTPUT: &[&str] = &[
    "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,format=yuv420p", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1",
    "-colorspace", "bt709", "-color_range", "tv", "-fflags", "+bitexact", "-flags:v", "+bitexact",
];

/// An error, with the remedy, where there is no `ffmpeg` on the PATH, or none that has the encoder of these arguments.
pub fn check(path: &Path, arguments: &[&str]) -> Result<(), Error> {
    const REMEDY: &str = "install it (apt-get install ffmpeg, brew install ffmpeg), or write an animation that needs none: .png, .gif or .y4m";
    let listed =
        Command::new("ffmpeg").args(["-hide_banner", "-encoders"]).stdin(Stdio::null()).output();
    let refuse = |problem: String| Err(Error::file(path, format!("{problem}; {REMEDY}")));
    match (listed, arguments) {
        (Err(error), _) => refuse(format!("is made by `ffmpeg`, which cannot be run ({error})")),
        (Ok(listed), [_, encoder, ..]) => {
            let known = String::from_utf8_lossy(&listed.stdout);
            if known.split_whitespace().any(|word| word == *encoder) {
                return Ok(());
            }
            refuse(format!("is made by `ffmpeg`, and the one on the PATH lacks {encoder}"))
        }
        _ => Ok(()),
    }
}

/// Pipes the frames through `ffmpeg`, and puts its file in place when it is whole.
pub fn write(path: &Path, arguments: &[&str], clip: &Movie, frames: Frames) -> Result<(), Error> {
    write_by_name(path, |temporary| {
        let mut child = Command::new("ffmpeg")
            .args(INPUT)
            .args(OUTPUT)
            .args(arguments)
            .arg(temporary)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()?;
        let piped = pipe(&mut child, clip, frames);
        let ended = ended(child);
        match piped {
            // A pipe that nobody reads: why is what the program said last.
            Err(failure) if is_broken_pipe(&failure) => Err(ended.err().unwrap_or(failure)),
            Err(failure) => Err(failure),
            Ok(()) => ended,
        }
    })
}

/// Writes the frames to the program's input, which is closed at the end; where a frame fails, the program is ended.
fn pipe(child: &mut Child, clip: &Movie, frames: Frames) -> Result<(), Failure> {
    let mut input = std::io::BufWriter::new(child.stdin.take().ok_or("`ffmpeg` takes no input")?);
    let written = y4m::write(&mut input, clip, frames);
    if written.is_err() {
        let _ = child.kill();
    }
    written.and_then(|()| Ok(input.flush()?))
}

/// Waits for the program; an error with what it said where it failed.
fn ended(mut child: Child) -> Result<(), Failure> {
    let mut said = String::new();
    if let Some(mut errors) = child.stderr.take() {
        // It says little (`-loglevel error`), far less than its pipe holds, so it never waits for this.
        let _ = errors.read_to_string(&mut said);
    }
    let status = child.wait()?;
    if status.success() {
        return Ok(());
    }
    let last =
        said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("and said nothing");
    Err(format!("`ffmpeg` ended with {status}: {last}").into())
}

fn is_broken_pipe(failure: &Failure) -> bool {
    let error = failure.downcast_ref::<std::io::Error>();
    error.is_some_and(|error| error.kind() == std::io::ErrorKind::BrokenPipe)
}
