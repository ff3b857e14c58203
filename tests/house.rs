//! The rules of the house that a compiler does not check: who may name whom, how files begin and how long they are.

use std::fs;
use std::path::{Path, PathBuf};

use gelray::measure::cost::{FRAME, PAPER};
use gelray::systems::JOBS;

/// A Rust file: its path from the top of the repository, with `/`, and its text.
struct File {
    path: String,
    text: String,
}

impl File {
    fn is_in(&self, folder: &str) -> bool {
        self.path.starts_with(folder)
    }

    /// The lines that are code, numbered from 1: without those that are comments alone.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let lines = self.text.lines().enumerate().map(|(at, line)| (at + 1, line.trim()));
        lines.filter(|(_, line)| !line.starts_with("//"))
    }

    /// The `use` statements, each on one line.
    fn uses(&self) -> Vec<String> {
        let code: Vec<_> = self.code().map(|(_, line)| line).collect();
        let code = code.join(" ");
        let start = |statement: &str| statement.find("use ").map(|at| statement[at..].to_owned());
        code.split(';').filter_map(start).collect()
    }

    /// Lines of code in which `is_wrong` finds something, as `path:line`.
    fn faults(&self, is_wrong: impl Fn(&str) -> bool) -> Vec<String> {
        let wrong = self.code().filter(|(_, line)| is_wrong(line));
        wrong.map(|(number, line)| format!("{}:{number}: {line}", self.path)).collect()
    }
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
}

/// The Rust files of some folders, in the order of their paths.
fn files(folders: &[&str]) -> Vec<File> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    for folder in folders {
        collect(&top.join(folder), &mut paths);
    }
    paths.sort();
    assert!(!paths.is_empty());
    let file = |path: PathBuf| File {
        path: path.strip_prefix(top).unwrap().to_string_lossy().replace('\\', "/"),
        text: fs::read_to_string(&path).unwrap(),
    };
    paths.into_iter().map(file).collect()
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !c.is_alphanumeric() && c != '_')
}

fn none(faults: &[String], rule: &str) {
    assert!(faults.is_empty(), "{rule}:\n{}", faults.join("\n"));
}

#[test]
fn nouns_do_not_name_verbs() {
    let allowed = |file: &File| {
        ["src/lib.rs", "src/main.rs", "src/renderer.rs"].contains(&file.path.as_str())
            || file.is_in("src/cli/")
    };
    let nouns: Vec<_> = files(&["src"]).into_iter().filter(|file| !allowed(file)).collect();
    let faults: Vec<_> =
        nouns.iter().flat_map(|file| file.faults(|line| line.contains("systems::"))).collect();
    none(&faults, "in src/ only lib.rs, renderer.rs, main.rs and cli/ may name systems");
}

#[test]
fn no_system_names_the_file_of_another() {
    let systems: Vec<_> =
        files(&["systems"]).into_iter().filter(|file| file.path != "systems/mod.rs").collect();
    let stage = |file: &File| {
        let rest = file.path.trim_start_matches("systems/");
        rest.split('/').next().unwrap().trim_end_matches(".rs").to_owned()
    };
    let mut stages: Vec<_> = systems.iter().map(stage).collect();
    stages.dedup();
    let faults: Vec<_> = systems
        .iter()
        .flat_map(|file| {
            let own = stage(file);
            // Inside a stage's folder, `super` is the stage itself.
            let inner = file.path.matches('/').count() > 1 && !file.path.ends_with("/mod.rs");
            let outside = if inner { "super::super::" } else { "super::" };
            let names_another = |code: &str| {
                let leaves = code.contains(outside) || code.contains("systems::");
                leaves && words(code).any(|word| word != own && stages.iter().any(|s| s == word))
            };
            let uses = file.uses().into_iter().filter(|code| names_another(code));
            let uses = uses.map(|code| format!("{}: {code}", file.path));
            file.faults(names_another).into_iter().chain(uses).collect::<Vec<_>>()
        })
        .collect();
    none(&faults, "a system reads products and names no other system");
}

#[test]
fn every_file_says_in_its_first_line_what_it_does() {
    let faults: Vec<_> = files(&["src", "systems", "tests", "benches"])
        .into_iter()
        .filter(|file| !file.text.starts_with("//! "))
        .map(|file| file.path)
        .collect();
    none(&faults, "the first line of a file begins with `//!` and says what the file does");
}

#[test]
fn a_file_is_one_idea() {
    let faults: Vec<_> = files(&["src", "systems", "tests", "benches"])
        .into_iter()
        .map(|file| (file.text.lines().count(), file.path))
        .filter(|(lines, _)| *lines > 320)
        .map(|(lines, path)| format!("{path}: {lines} lines"))
        .collect();
    none(&faults, "a file past 320 lines has two ideas; split it");
}

#[test]
fn nothing_is_put_off() {
    let marks = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("X", "XX")];
    let macros = [concat!("to", "do!("), concat!("unimple", "mented!(")];
    let marked = |line: &str| {
        words(line).any(|word| marks.contains(&word)) || macros.iter().any(|m| line.contains(m))
    };
    let faults: Vec<_> = files(&["src", "systems", "tests", "benches"])
        .into_iter()
        .flat_map(|file| {
            let lines = file.text.lines().enumerate().filter(|(_, line)| marked(line));
            lines.map(|(at, line)| format!("{}:{}: {line}", file.path, at + 1)).collect::<Vec<_>>()
        })
        .collect();
    none(&faults, "nothing is left for later in the code");
}

#[test]
fn only_the_schedule_the_program_and_what_measures_look_at_a_clock() {
    let allowed = |file: &File| {
        file.path == "src/schedule/mod.rs" || file.is_in("src/cli/") || file.is_in("src/measure/")
    };
    let clocks = ["Instant", "SystemTime", "UNIX_EPOCH"];
    let faults: Vec<_> = files(&["src", "systems"])
        .iter()
        .filter(|file| !allowed(file))
        .flat_map(|file| file.faults(|line| words(line).any(|word| clocks.contains(&word))))
        .collect();
    none(&faults, "a result must not depend on a clock");
}

#[test]
fn the_stages_of_the_paper_s_cost_table_are_systems() {
    let names: Vec<_> = JOBS.iter().map(|job| job.name).collect();
    let stages = PAPER.iter().map(|cost| cost.stage).filter(|stage| *stage != "frame");
    for stage in FRAME.into_iter().chain(stages) {
        assert!(names.contains(&stage), "{stage} is not among {names:?}");
    }
}
