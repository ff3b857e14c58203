//! `gelray profile`: spans that make up the run, the paper's numbers beside ours, and differences that are there or not.

use super::Place;

/// A ball of scalars, a polygon through it with a texture, and a light that casts shadows: all that the paper has numbers of.
const ALL: &str = r##"
[[entity]]
name = "ball"
volume = { file = "phantom:ball" }
classify = { iso = [{ value = 0.5 }] }

[[entity]]
name = "grid"
texture = { formula = "grid" }

[[entity]]
name = "plane"
polygon = { vertices = [[-20, 0, -20], [20, 0, -20], [20, 0, 20], [-20, 0, 20]] }
surface = { color = "#d03030" }
textured = { texture = "grid" }

[[entity]]
name = "key"
light = { toward = [-0.4, -0.8, 0.5] }
casts_shadow = {}

[[entity]]
name = "eye"
view = { azimuth = 30, elevation = 20, size = [40, 36] }
"##;

fn place() -> Place {
    let place = Place::new();
    place.write("all.toml", ALL);
    place
}

#[test]
fn the_stages_make_up_the_run_and_stand_beside_the_paper() {
    let place = place();
    place.done("profile all.toml --no-ratios --repeat 5 --size 120x100 --json -o p.json");
    let profile = place.json("p.json");
    let stages = profile["stages"].as_array().unwrap();
    let seconds = |stage: &serde_json::Value, run: usize| stage["seconds"][run].as_f64().unwrap();
    let whole = |run: usize| seconds(&profile["run"], run);
    let part =
        |run: usize| stages.iter().map(|stage| seconds(stage, run)).sum::<f64>() / whole(run);
    let mut parts: Vec<f64> = (0..5).map(part).collect();
    parts.sort_by(f64::total_cmp);
    assert!(parts[2] > 0.97 && parts[4] <= 1.0, "{parts:?}");
    let stage = |name: &str| stages.iter().find(|stage| stage["name"] == name).unwrap();
    for name in ["load", "classify", "light_sweep", "relight", "pyramid", "cast", "encode"] {
        assert!(stage(name)["median"].as_f64() > Some(0.0), "{name}");
    }
    assert_eq!(stage("classify")["paper_seconds"], 60.0);
    assert_eq!(stage("relight")["paper_seconds"], 60.0);
    assert_eq!(profile["frame"]["paper_what"], "polygons traced");
    assert!(stage("cast")["counts"]["rays"].as_u64() > Some(0));
    assert!(stage("relight")["bytes"].as_u64() > Some(0));
    let csv = place.done("profile all.toml --no-ratios --repeat 1 --csv").out;
    assert_eq!(csv.lines().count(), stages.len() + 3, "{csv}");
    let cells = |line: &str| line.matches(',').count();
    assert!(csv.lines().all(|line| cells(line) >= cells(csv.lines().next().unwrap())), "{csv}");
}

#[test]
fn the_numbers_of_the_paper_are_measured_where_the_scene_has_what_they_are_of() {
    let place = place();
    let table = place.done("profile all.toml --repeat 1").out;
    for line in table.lines().skip_while(|line| !line.contains("in 19 of 20")).skip(1) {
        assert!(!line.contains("needs"), "{table}");
    }
    assert!(table.contains("about 1.6") && table.contains("60 s classifying"), "{table}");
    let csv = place.done("profile all.toml --repeat 1 --csv").out;
    for (key, paper) in [("hybrid", "about 1.6"), ("brute_force", "more than 100")] {
        let line = csv.lines().find(|line| line.starts_with(&format!("{key},"))).unwrap();
        let cells: Vec<&str> = line.split(',').collect();
        assert!(cells[10].parse::<f64>().unwrap() > 0.0 && cells[13] == paper, "{line}");
        assert_eq!(cells.len(), csv.lines().next().unwrap().split(',').count());
    }
    place.done("profile cross.toml --repeat 1 --json -o cross.json");
    let numbers = place.json("cross.json")["numbers"].clone();
    let hybrid = numbers.as_array().unwrap().iter().find(|n| n["key"] == "hybrid").unwrap();
    assert!(hybrid["ours"].is_null() && hybrid["note"] == "needs a volume and polygons");
}

#[test]
fn a_profile_that_was_stopped_goes_on() {
    let place = place();
    let seconds = |run: &serde_json::Value| run["seconds"].as_array().unwrap().clone();
    let measured = |words: &str, name: &str| {
        place.done(&format!("profile all.toml {words} --json -o {name} --resume"));
        place.json(name)
    };
    let two = measured("--repeat 2 --no-ratios", "p.json");
    let five = measured("--repeat 5 --no-ratios", "p.json");
    let runs = seconds(&five["run"]);
    assert_eq!([seconds(&two["run"]).len(), runs.len()], [2, 5]);
    assert_eq!(runs[..2], seconds(&two["run"])[..]);
    for stage in five["stages"].as_array().unwrap() {
        assert_eq!(seconds(stage).len(), 5, "{}", stage["name"]);
    }
    let least = runs.iter().map(|run| run.as_f64().unwrap()).fold(f64::INFINITY, f64::min);
    assert_eq!(five["run"]["least"].as_f64(), Some(least));
    // Nothing is left but the paper's numbers.
    let whole = measured("--repeat 5", "p.json");
    assert_eq!((seconds(&whole["run"]), whole["numbers"].as_array().unwrap().len()), (runs, 7));
    let pair = |repeat: u32| {
        measured(&format!("cross.toml --repeat {repeat}"), "pair.json")["b"]["run"].clone()
    };
    let before = seconds(&pair(1));
    assert_eq!(seconds(&pair(3))[..1], before[..]);

    let going_on = "--repeat 9 --json --resume -o p.json";
    place.refused(
        &format!("profile all.toml --size 9x9 {going_on}"),
        1,
        &["p.json", "other settings"],
    );
    place.refused(&format!("profile all.toml cross.toml {going_on}"), 1, &["another number"]);
    place.refused("profile all.toml --json --resume", 2, &["-o FILE.json"]);
    place.refused("profile all.toml --resume -o p.json", 2, &["--json"]);
    assert_eq!(place.json("p.json"), whole);
}

#[test]
fn a_difference_is_found_where_there_is_one() {
    let place = place();
    let flags = "--size 200x200 --set eye.sampling.coarsest=4";
    let words = format!("profile all.toml {flags} --repeat 12 --b eye.sampling.distance_mm=0.02");
    let told = place.done(&words).out;
    let cast = told.lines().find(|line| line.starts_with("cast")).unwrap();
    assert!(
        cast.contains("B takes longer") && told.ends_with("a difference was found\n"),
        "{told}"
    );
}

#[test]
fn a_saved_profile_does_not_differ_from_itself() {
    let place = place();
    place.done("profile cross.toml --no-ratios --repeat 12 --json -o p.json");
    place.write("q.json", place.read("p.json"));
    let told = place.done("profile p.json q.json").out;
    assert!(told.contains("not by turns") && told.ends_with("\nno difference found\n"), "{told}");
    assert!(!told.contains("B takes"), "{told}");
    place.done("profile p.json q.json --csv -o pair.csv");
    let csv = String::from_utf8(place.read("pair.csv")).unwrap();
    assert!(csv.lines().last().unwrap().starts_with("run,") && csv.ends_with(",false\n"), "{csv}");
}

#[test]
fn a_profile_is_refused_in_a_sentence() {
    let place = place();
    place.write("p.json", "{}");
    place.refused("profile p.json all.toml", 2, &["another one"]);
    place.refused("profile p.json p.json", 1, &["p.json", "is no profile", "--json"]);
    place.refused("profile p.json p.json --repeat 3", 2, &["leave --repeat"]);
    place.refused("profile all.toml --json --csv", 2, &["--json", "--csv"]);
    place.refused("profile all.toml --trace t.json", 2, &["no use for --trace"]);
    place.refused("profile nowhere.toml", 1, &["nowhere.toml"]);
    place.refused("profile all.toml --b eye.sampling.nothing=1", 2, &["nothing"]);
}
