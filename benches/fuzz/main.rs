//! Inputs that nobody means, for as long as one likes: files of volumes and pictures, scenes, `--set`, whole command lines.
//!
//! `cargo bench --bench fuzz -- --seconds 3600` (or `--runs N`) makes run after run, each from its own number: `--from N
//! --runs 1` makes run N again. Readers and the loader of scenes are tried in this process, one run in 64 through the real
//! program; half of the scenes at least are sound, and rendered. What counts as a fault: a panic, an exit code that is not stated, an error that is not one line, a file left
//! behind, more memory than a small input explains, and a run of more than ten seconds. `--kills 400` kills as many runs of
//! the program at moments of their own and looks at what they leave, and whether the next run clears it away.

mod files;
mod kills;
#[allow(dead_code, reason = "the tests of formats make more")]
#[path = "../../src/formats/made.rs"]
mod made;
mod program;
mod random;
mod scenes;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use random::Random;
use tempfile::TempDir;

/// The most memory that this process may have had: no input is larger than a few megabytes.
const MOST_BYTES: u64 = 1 << 30;

/// After so many seconds a run hangs.
const PATIENCE: u64 = 10;

/// The run that is being made, for the thread that looks whether it ends.
static RUN: AtomicU64 = AtomicU64::new(0);

/// What was found wrong, by the number of its run.
#[derive(Default)]
struct Found {
    faults: Vec<(u64, String)>,
    refused: u64,
    /// Scenes that were tried, and those of them that were taken.
    scenes: [u64; 2],
}

fn main() {
    if let Some(kills) = number("--kills") {
        kills::run(kills);
        return;
    }
    let (first, runs) = (number("--from").unwrap_or(0), number("--runs").unwrap_or(u64::MAX));
    let seconds = number("--seconds").unwrap_or(if runs == u64::MAX { 20 } else { u64::MAX });
    std::panic::set_hook(Box::new(|_| ()));
    std::thread::spawn(watch);
    let folder = tempfile::tempdir().expect("a folder for the inputs");
    let (start, mut found, mut run) = (Instant::now(), Found::default(), first);
    while run - first < runs && start.elapsed().as_secs() < seconds {
        RUN.store(run, Ordering::Relaxed);
        one(run, &folder, &mut found);
        run += 1;
    }
    report(run - first, start.elapsed(), &found);
    std::process::exit(i32::from(!found.faults.is_empty()));
}

/// One run: the number says what is tried and with what.
fn one(run: u64, folder: &TempDir, found: &mut Found) {
    let mut random = Random::new(run);
    let tried = catch_unwind(AssertUnwindSafe(|| match run % 64 {
        0 => program::run(&mut random, folder.path()),
        n if n % 4 == 0 => files::picture(&mut random, folder.path()),
        n if n % 2 == 0 => files::volume(&mut random, folder.path()),
        _ => scenes::load(&mut random, folder.path()),
    }));
    match tried {
        Ok(Ok(taken)) => {
            found.refused += u64::from(!taken);
            if run.is_multiple_of(64) || run % 2 == 1 {
                found.scenes[0] += 1;
                found.scenes[1] += u64::from(taken);
            }
        }
        Ok(Err(fault)) => found.faults.push((run, fault)),
        Err(panic) => {
            let said = panic.downcast_ref::<String>().cloned();
            let said = said.or_else(|| panic.downcast_ref::<&str>().map(|&s| s.to_owned()));
            found.faults.push((run, format!("panic: {}", said.unwrap_or_default())));
        }
    }
}

/// Ends the process where a run does not end by itself.
fn watch() {
    let (mut last, mut since) = (u64::MAX, Instant::now());
    loop {
        std::thread::sleep(Duration::from_millis(200));
        let run = RUN.load(Ordering::Relaxed);
        if run != last {
            (last, since) = (run, Instant::now());
        } else if since.elapsed().as_secs() > PATIENCE {
            println!("run {run} hangs: more than {PATIENCE} seconds");
            std::process::exit(1);
        }
    }
}

fn report(runs: u64, took: Duration, found: &Found) {
    let seconds = took.as_secs_f64();
    println!("{runs} runs in {seconds:.1} s; {} were refused by a sentence", found.refused);
    let [scenes, taken] = found.scenes;
    println!("{scenes} of scenes and `--set`, of which {taken} were taken");
    for (run, fault) in found.faults.iter().take(20) {
        println!("run {run}: {fault}");
    }
    let peak = peak();
    println!("{} faults, 0 hangs, {} MiB at the most", found.faults.len(), peak >> 20);
    if scenes > 1000 && 2 * taken < scenes {
        println!("that is too few: what is refused early tries nothing else");
        std::process::exit(1);
    }
    if peak > MOST_BYTES {
        println!("that is more memory than the inputs explain");
        std::process::exit(1);
    }
}

/// The most memory that this process ever had; 0 where the system does not tell.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes =
        line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}

/// The number after a flag.
fn number(flag: &str) -> Option<u64> {
    let mut words = std::env::args().skip_while(|word| word != flag);
    words.nth(1)?.parse().ok()
}
