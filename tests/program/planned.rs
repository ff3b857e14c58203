//! What `plan` promises of a scene of two volumes under a light that casts shadows, against what a render then takes.

use super::{Place, small_nrrd};

/// A ball of scalars, a block of scalars whose classification is stated too, and a light whose shadows both cast.
const TWO: &str = "
[[entity]]
name = \"ball\"
volume = { file = \"phantom:ball\" }
classify = { iso = [{ value = 0.5 }] }
[[entity]]
name = \"block\"
volume = { file = \"small.nrrd\", center = [0, 0, 40] }
classify = { transfer = [{ value = 0, opacity = 0 }, { value = 200, opacity = 0.5 }] }
[[entity]]
name = \"key\"
light = { toward = [0, 0.2, 1] }
casts_shadow = {}
[[entity]]
name = \"eye\"
view = { size = [60, 50] }
";

/// The row of a system: whether it runs, the bytes that it makes at the most, and what it is for.
fn row<'a>(plan: &'a str, system: &str) -> (bool, u64, &'a str) {
    let line =
        plan.lines().find(|line| line.starts_with(system)).unwrap_or_else(|| panic!("{plan}"));
    let words: Vec<&str> = line.split_whitespace().collect();
    let unit = words.iter().position(|word| word.ends_with('B'));
    let bytes = unit.map_or(0, |unit| words[unit + 1].parse().unwrap());
    (!line.contains("does not run"), bytes, line)
}

#[test]
fn a_plan_of_two_volumes_names_what_runs_for_which_and_bounds_what_it_takes() {
    let place = Place::new();
    place.write("small.nrrd", small_nrrd());
    place.write("two.toml", TWO);
    let plan = place.done("plan two.toml").out;
    for system in ["ranges", "classify", "shade", "relight", "pyramid"] {
        let (runs, bytes, line) = row(&plan, system);
        assert!(runs && bytes > 0 && line.contains("ball, block"), "{line}");
    }
    let (runs, _, line) = row(&plan, "light_sweep");
    assert!(runs && line.contains("key"), "{line}");
    let (runs, _, line) = row(&plan, "scan_convert");
    assert!(!runs, "{line}");
    let (.., line) = row(&plan, "cast");
    assert!(line.contains("eye") && !line.contains("ball"), "{line}");

    place.done("render two.toml -o a.png --stats a.json");
    let taken = &place.json("a.json")["bytes"];
    let taken = |key: &str| taken[key].as_u64().unwrap();
    for (system, key) in [("relight", "gel"), ("pyramid", "pyramid"), ("light_sweep", "light")] {
        let (_, most, _) = row(&plan, system);
        assert!(taken(key) > 0 && taken(key) <= most, "{system}: {} of {most}", taken(key));
    }
    let (_, total, _) = row(&plan, "total");
    let known = ["scalars", "gel", "pyramid", "light"].map(taken);
    assert!(known.iter().sum::<u64>() < total, "{known:?} {total}");

    // Without the shadow there is no sweep, and the reason is said.
    place.write("bright.toml", TWO.replace("casts_shadow = {}\n", ""));
    let plan = place.done("plan bright.toml").out;
    let (runs, _, line) = row(&plan, "light_sweep");
    assert!(!runs && line.contains("casts_shadow"), "{line}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_render_takes_no_more_than_its_plan_says_and_not_much_less() {
    let place = Place::new();
    let scenes = ["head", "minimal_3", "minimal_6", "shaft"];
    println!("scene        plan MB  peak MB  ratio");
    for scene in scenes {
        let (_, most, _) = row(&place.done(&format!("plan {scene} -t 2 -q")).out, "total");
        place.done(&format!("render {scene} -t 2 -q -o a.png --stats a.json"));
        let peak = place.json("a.json")["bytes"]["peak_rss"].as_u64().unwrap();
        let ratio = most as f64 / peak as f64;
        println!("{scene:<12} {:7.1}  {:7.1}  {ratio:.2}", most as f64 / 1e6, peak as f64 / 1e6);
        assert!((1.0..1.9).contains(&ratio), "{scene}: {most} planned, {peak} taken");
    }
}

#[test]
fn polygons_that_were_read_are_in_the_plan() {
    let place = Place::new();
    let triangle = "[[entity]]\npolygon = { vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }\n";
    let weighed = |number: usize| {
        place.write("many.toml", triangle.repeat(number));
        row(&place.done("plan many.toml -q --size 9x9").out, "total").1
    };
    assert!(weighed(2000) > weighed(1000) + 1000 * 100);
}
