//! Runs killed at moments of their own: what they leave is whole, and the next run clears away what is not.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use gelray::formats::read_picture;
use gelray::view::samples::POSITIONS;

use super::random::Random;
use super::scenes::MIXED;

const PROGRAM: &str = env!("CARGO_BIN_EXE_gelray");

/// Half of the runs are killed, half are told to end; prints what was left.
pub fn run(kills: u64) {
    let folder = tempfile::tempdir().expect("a folder for the pictures");
    let folder = folder.path();
    std::fs::write(folder.join("v.raw"), [7; 64]).expect("the voxels are written");
    std::fs::write(folder.join("s.toml"), MIXED).expect("the scene is written");
    let first = start(folder).wait().expect("the first run ends");
    assert!(first.success(), "the scene that is to be killed over does not render by itself");
    let mut left = Left::default();
    for kill in 0..kills {
        let mut child = start(folder);
        std::thread::sleep(Duration::from_micros(Random::new(kill).bits() % 60_000));
        let signal = if kill % 2 == 0 { "-KILL" } else { "-TERM" };
        let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
        left.early += u64::from(!sent.is_ok_and(|sent| sent.success()));
        let _ = child.wait();
        left.look(folder);
    }
    let ended = start(folder).wait().expect("the last run ends").success();
    let Left { early, lost, half, mixed, alone, parts: left } = left;
    println!("{kills} runs killed, {early} of which had ended by themselves");
    println!("{lost} pictures lost, {half} files half-written, {mixed} times files of two runs");
    println!("{alone} times a picture without its rays or stats");
    println!(
        "{left} times a part was left, {} after the next run (ended well: {ended})",
        parts(folder)
    );
    std::process::exit(i32::from(lost + half + mixed + parts(folder) > 0 || !ended));
}

/// What was left of runs, each counted once a kill.
#[derive(Default)]
struct Left {
    early: u64,
    lost: u64,
    half: u64,
    mixed: u64,
    alone: u64,
    parts: u64,
}

impl Left {
    /// Looks at what is there. The pictures of two runs in a row differ in size, so that a file tells its run.
    fn look(&mut self, folder: &Path) {
        self.parts += parts(folder);
        let picture = |name: &str| read_picture(&folder.join(name)).ok().map(|p| p.size);
        let there = |name: &str| folder.join(name).exists();
        let sizes = [
            picture("a.png"),
            picture("r.png").map(|rays| rays.map(|n| n / POSITIONS)),
            json(folder, "a.json"),
        ];
        let broken = ["a.png", "r.png", "a.json"].iter().zip(&sizes);
        self.half += broken.filter(|(name, size)| size.is_none() && there(name)).count() as u64;
        self.lost += u64::from(!there("a.png"));
        let mut known = sizes.iter().flatten();
        let first = known.next();
        self.mixed += u64::from(known.any(|size| Some(size) != first));
        self.alone += u64::from(sizes[0].is_some() && sizes.iter().any(Option::is_none));
    }
}

/// A run whose picture is of another size than the last one's.
fn start(folder: &Path) -> Child {
    let last = read_picture(&folder.join("a.png")).map_or(0, |picture| picture.size[0]);
    let width = last % 7 + 200;
    let words = format!("render s.toml -q --size {width}x200 -o a.png --rays r.png --stats a.json");
    Command::new(PROGRAM)
        .args(words.split(' '))
        .current_dir(folder)
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts")
}

/// Files that were being written.
fn parts(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter(|entry| entry.path().extension().is_some_and(|end| end == "part")).count() as u64
}

/// The size that the stats tell.
fn json(folder: &Path, name: &str) -> Option<[usize; 2]> {
    let text = std::fs::read(folder.join(name)).ok()?;
    let stats: serde_json::Value = serde_json::from_slice(&text).ok()?;
    serde_json::from_value(stats["size"].clone()).ok()
}
