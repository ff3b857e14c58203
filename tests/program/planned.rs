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
