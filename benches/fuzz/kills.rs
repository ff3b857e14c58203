//! Runs killed at moments of their own: what they leave is whole, and the next run clears away what is not.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use gelray::formats::read_picture;

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
    let (mut lost, mut mixed, mut left, mut early) = (0, [0, 0], 0, 0);
    for kill in 0..kills {
        let mut child = start(folder);
        std::thread::sleep(Duration::from_micros(Random::new(kill).bits() % 60_000));
        let signal = if kill % 2 == 0 { "-KILL" } else { "-TERM" };
        let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
        early += u64::from(!sent.is_ok_and(|sent| sent.success()));
        let _ = child.wait();
        left += parts(folder);
        let picture = read_picture(&folder.join("a.png"));
        lost += u64::from(picture.is_err() || json(folder, "a.json").is_none());
        mixed[(kill % 2) as usize] +=
            u64::from(picture.is_ok_and(|picture| json(folder, "a.json") != Some(picture.size)));
    }
    let ended = start(folder).wait().expect("the last run ends").success();
    println!("{kills} runs killed, {early} of which had ended by themselves");
    println!(
        "{lost} with a file lost or half-written, with files of two runs: {} killed, {} told to end",
        mixed[0], mixed[1]
    );
    println!(
        "{left} times a part was left, {} after the next run (ended well: {ended})",
        parts(folder)
    );
    std::process::exit(i32::from(lost + mixed[1] + parts(folder) > 0 || !ended));
}

/// A run whose picture is of another size than the last one's.
fn start(folder: &Path) -> Child {
    let width = json(folder, "a.json").map_or(0, |size| size[0]) % 7 + 200;
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
