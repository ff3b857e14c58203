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
    for system in ["ranges", "classify", "relight", "pyramid"] {
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

/// What the plan bounds the render of a scene by, and what it expects, as parts of what the render took.
#[cfg(target_os = "linux")]
fn against_peak(place: &Place, scene: &str) -> [f64; 2] {
    let plan = place.done(&format!("plan {scene} -t 2 -q")).out;
    let (_, most, line) = row(&plan, "total");
    let expected: Vec<&str> = line.split_whitespace().rev().take(2).collect();
    let unit = if expected[0] == "GiB" { 1 << 30 } else { 1 << 20 };
    let expected = expected[1].parse::<f64>().unwrap() * f64::from(unit);
    let stats = scene.replace('.', "_");
    place.done(&format!("render {scene} -t 2 -q -o {stats}.png --stats {stats}.json"));
    let peak = place.json(&format!("{stats}.json"))["bytes"]["peak_rss"].as_u64().unwrap() as f64;
    let ratios = [most as f64 / peak, expected / peak];
    println!(
        "{scene:<12} {:7.1}  {:7.1}  {:.2}  {:.2}",
        most as f64 / 1e6,
        peak / 1e6,
        ratios[0],
        ratios[1]
    );
    ratios
}

#[cfg(target_os = "linux")]
fn assert_near(scene: &str, [bound, expected]: [f64; 2]) {
    assert!((1.0..1.5).contains(&bound), "{scene}: the bound is {bound} of what was taken");
    assert!((0.7..1.35).contains(&expected), "{scene}: {expected} of what was taken is expected");
}

#[cfg(target_os = "linux")]
#[test]
fn a_render_takes_no_more_than_its_plan_says_and_not_much_less() {
    let place = Place::new();
    let listed = place.done("scenes").out;
    let scenes: Vec<&str> =
        listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(scenes.len() >= 19, "{listed}");
    let (even, odd): (Vec<_>, Vec<_>) = scenes.iter().enumerate().partition(|(at, _)| at % 2 == 0);
    println!("scene        plan MB  peak MB  bound  expected");
    std::thread::scope(|scope| {
        for half in [even, odd] {
            let place = &place;
            scope.spawn(move || {
                for (_, scene) in half {
                    assert_near(scene, against_peak(place, scene));
                }
            });
        }
    });
}

/// A ball of bytes in a cube of `n` voxels a side, densest in its middle.
#[cfg(target_os = "linux")]
fn assert_near_for_a_cube_of(n: usize) {
    let place = Place::new();
    let axis: Vec<f32> =
        (0..n).map(|i| (2 * i + 1) as f32 / n as f32 - 1.0).map(|x| x * x).collect();
    let plane = |z: &f32| {
        let line = |y: &f32| {
            let yz = y + z;
            axis.iter().map(move |x| (255.0 * (1.0 - (x + yz).sqrt() / 1.8)) as u8)
        };
        axis.iter().flat_map(line).collect::<Vec<u8>>()
    };
    let voxels: Vec<u8> = axis.iter().flat_map(plane).collect();
    place.write("cube.raw", voxels);
    place.write("cube.toml", format!("[[entity]]\nvolume = {{ file = \"cube.raw\", size = [{n}, {n}, {n}], voxel_type = \"uint8\" }}\nclassify = {{ transfer = [{{ value = 100, opacity = 0 }}, {{ value = 160, opacity = 0.3 }}, {{ value = 230, opacity = 0 }}] }}\n"));
    assert_near(&format!("{n}³"), against_peak(&place, "cube.toml"));
}

#[cfg(target_os = "linux")]
#[test]
fn the_plan_of_a_large_volume_is_as_near() {
    assert_near_for_a_cube_of(128);
    assert_near_for_a_cube_of(256);
}

#[cfg(target_os = "linux")]
#[test]
fn the_plan_of_a_volume_of_512_voxels_a_side_is_as_near() {
    assert_near_for_a_cube_of(512);
}

#[test]
fn the_plan_of_a_shadow_bounds_that_of_polygons_away_from_the_gel_too() {
    let place = Place::new();
    // A speck of gel, and a traced polygon across all the rest of the volume.
    place.write(
        "s.toml",
        "
[[entity]]
name = \"speck\"
volume = { file = \"phantom:ball\" }
classify = { iso = [{ value = 0.5 }] }
clip = { box = [[-4, -4, -4], [4, 4, 4]] }
[[entity]]
name = \"sheet\"
polygon = { vertices = [[-31, -31, -10], [31, -31, -10], [31, 31, 10], [-31, 31, 10]] }
[[entity]]
name = \"key\"
light = { toward = [0, 0.3, 1] }
casts_shadow = {}
",
    );
    let (_, most, _) = row(&place.done("plan s.toml -q").out, "light_sweep");
    place.done("render s.toml -q --size 9x9 -o a.png --stats a.json");
    let taken = place.json("a.json")["bytes"]["light"].as_u64().unwrap();
    assert!(taken > 0 && taken <= most, "{taken} of {most}");
}

#[cfg(target_os = "linux")]
#[test]
fn textures_that_were_read_are_in_the_plan() {
    let place = Place::new();
    super::limits::write_textured(&place, "textured.toml", 1500);
    let plan = place.done("plan textured.toml").out;
    let line = plan.lines().find(|line| line.contains("textures, as they were read")).unwrap();
    // 16 bytes a texel, and again with a third more for the coarser levels.
    let texels = 1500_u64 * 1500 * 16;
    let stated: u64 = line
        .split_whitespace()
        .find_map(|word| word.parse().ok().filter(|n| *n > 1_000_000))
        .unwrap();
    assert!((texels * 23 / 10..texels * 12 / 5).contains(&stated), "{line}");
    assert_near("textured.toml", against_peak(&place, "textured.toml"));
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

#[cfg(target_os = "linux")]
#[test]
fn the_text_of_a_scene_is_in_the_plan_for_as_long_as_it_is_read() {
    let place = Place::new();
    let triangles: Vec<String> = (0..6000)
        .map(|i| {
            format!(
                "[[entity]]\npolygon = {{ vertices = [[{i}, 0, 0], [{i}, 1, 0], [{i}, 0, 1]] }}\n"
            )
        })
        .collect();
    place.write("many.toml", triangles.concat());
    let [bound, _] = against_peak(&place, "many.toml");
    assert!((1.0..1.5).contains(&bound), "{bound}");
    place.refused("plan many.toml --max-memory 20M", 1, &["20971520"]);
}

#[cfg(target_os = "linux")]
#[test]
fn rays_through_voxels_are_in_the_plan() {
    let place = Place::new();
    let scene = gelray::scene::Source::embedded("figure_06b").unwrap().text;
    place.write("voxels.toml", scene.replace("sampling = {", "sampling = { per_voxel = 4,"));
    assert!(scene.contains("sampling = {"), "{scene}");
    let [bound, _] = against_peak(&place, "voxels.toml");
    assert!((1.0..1.5).contains(&bound), "{bound}");
}
