//! The rules of the house that a compiler does not check: who may name whom, how files begin and how long they are.

mod files;
mod imports;

use gelray::measure::cost::{COLORS, FRAME, PAPER};
use gelray::measure::held::held;
use gelray::systems::JOBS;
use hecs::World;

use files::{File, files};
use imports::Imports;

fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !c.is_alphanumeric() && c != '_')
}

fn none(faults: &[String], rule: &str) {
    assert!(faults.is_empty(), "{rule}:\n{}", faults.join("\n"));
}

#[test]
fn no_stage_names_a_file_of_another() {
    none(
        &Imports::of_the_library().between_stages(),
        "a stage reads products and names no other stage",
    );
}

#[test]
fn no_files_name_each_other_in_a_circle() {
    let mut circles = Imports::of_the_library().circles();
    circles.extend(Imports::of_the_program().circles());
    none(&circles, "what two files share lies in a third");
}

/// The rooms in the order of the picture in the crate documentation.
fn rooms() -> Vec<String> {
    let text = files(&["src"]).into_iter().find(|file| file.path == "src/lib.rs").unwrap().text;
    let rows = text.lines().skip_while(|line| *line != "//! # The rooms").skip(1);
    let rows = rows.take_while(|line| !line.starts_with("//! # "));
    let names = |row: &str| {
        let cell = row.strip_prefix("//! | `")?.split('|').next()?.to_owned();
        Some(words(&cell).filter(|word| !word.is_empty()).map(str::to_owned).collect::<Vec<_>>())
    };
    rows.filter_map(names).flatten().collect()
}

#[test]
fn a_room_names_only_rooms_before_it_in_the_picture_of_the_house() {
    let rooms = rooms();
    let place = |room: &String| rooms.iter().position(|other| other == room);
    let upwards = |([from, to], arrow): ([String; 2], String)| {
        let both = place(&from).zip(place(&to));
        both.is_none_or(|(from, to)| from <= to).then_some(arrow)
    };
    let arrows = Imports::of_the_library().between_rooms();
    assert!(arrows.len() > 300, "the walk finds imports: {}", arrows.len());
    let faults: Vec<_> = arrows.into_iter().filter_map(upwards).collect();
    none(&faults, "a room names rooms before it in the table of the crate documentation");
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
        file.is_in("src/schedule/") || file.is_in("src/cli/") || file.is_in("src/measure/")
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
    for stage in FRAME.into_iter().chain(COLORS).chain(stages) {
        assert!(names.contains(&stage), "{stage} is not among {names:?}");
    }
    for name in names {
        assert!(held(&World::new(), name).is_some(), "what {name} makes is not counted");
    }
}

#[test]
fn the_readme_states_no_number_that_a_machine_would_have_to_measure() {
    let text = include_str!("../../README.md");
    let prose = text.split("```").step_by(2).flat_map(str::lines);
    let units = ["ms", "dB", "MB", "MiB", "GB", "GiB", "s", "seconds", "times", "%", "percent"];
    let measured = |line: &&str| {
        let words: Vec<_> = line.split_whitespace().collect();
        let is_number = |word: &str| word.parse::<f64>().is_ok();
        words.windows(2).any(|two| {
            is_number(two[0]) && units.contains(&two[1].trim_matches(|c: char| ",.;:)".contains(c)))
        })
    };
    let faults: Vec<_> = prose.filter(measured).map(str::to_owned).collect();
    none(&faults, "what is measured is measured by `gelray report`, and not typed");
}
