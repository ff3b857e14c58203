//! `gelray render`: pictures, and what goes with them.

use gelray::formats::read_picture;

use super::{CROSS, Place, small_nrrd};

#[test]
fn every_format_holds_the_picture() {
    let place = Place::new();
    for name in ["a.png", "a.exr", "a.tiff", "a.npy"] {
        let ran = place.done(&format!("render cross.toml -o {name}"));
        assert!(ran.out.is_empty() && ran.err.contains("48 × 40 pixels"), "{}", ran.err);
        let picture = read_picture(&place.path(name)).unwrap();
        assert_eq!(picture.size, [48, 40]);
        assert!(picture.pixel(24, 20)[3] > 0.45, "{:?}", picture.pixel(24, 20));
        assert_eq!(picture.pixel(0, 0), [0.0; 4]);
    }
    assert_eq!(place.names(), ["a.exr", "a.npy", "a.png", "a.tiff", "cross.toml"]);
}

#[test]
fn equal_renders_are_equal_bytes_on_one_thread_and_on_two() {
    let place = Place::new();
    for end in ["png", "exr"] {
        for (name, threads) in [("a", 1), ("b", 2), ("c", 2)] {
            place.done(&format!("render cross.toml -t {threads} -o {name}.{end}"));
        }
        let [a, b, c] = ["a", "b", "c"].map(|name| place.read(&format!("{name}.{end}")));
        assert!(a == b && b == c, "{end}");
    }
}

#[test]
fn a_picture_notes_what_it_takes_to_make_it_again() {
    let place = Place::new();
    place.done("render cross.toml -o a.png --set observer.view.azimuth=77 --size 9x8 --exact");
    let picture = String::from_utf8_lossy(&place.read("a.png")).into_owned();
    for note in ["settings", "azimuth = 77", "size = [9, 8]", "cross", "counts", "exact", "version"]
    {
        assert!(picture.contains(note), "{note}");
    }
}

#[test]
fn flags_mean_the_same_before_and_after_the_verb_and_repeat_in_any_place() {
    let place = Place::new();
    place.done("render cross.toml -o a.png --size 20x10 --set red.surface.opacity=1 --set blue.surface.opacity=0.2");
    place.done("--set red.surface.opacity=1 -qo b.png --size=20x10 render --set blue.surface.opacity=0.2 cross.toml");
    assert_eq!(place.read("a.png"), place.read("b.png"));
    assert_eq!(read_picture(&place.path("a.png")).unwrap().size, [20, 10]);
}

#[test]
fn a_size_is_that_of_the_view_whatever_it_is_called() {
    let place = Place::new();
    let polygons = CROSS.split("[[entity]]\nname = \"observer\"").next().unwrap();
    place.write("unstated.toml", polygons);
    place.write("renamed.toml", format!("{polygons}[[entity]]\nname = \"eye\"\nview = {{}}\n"));
    let taken = polygons.replace("\"blue\"", "\"observer\"");
    place.write("taken.toml", format!("{taken}[[entity]]\nview = {{ azimuth = 5 }}\n"));
    for scene in ["unstated", "renamed", "taken"] {
        place.done(&format!("render {scene}.toml -o {scene}.png --size 7x9"));
        assert_eq!(read_picture(&place.path(&format!("{scene}.png"))).unwrap().size, [7, 9]);
    }
}

#[test]
fn stats_have_every_key_that_scripts_depend_on() {
    let place = Place::new();
    place.write("small.nrrd", small_nrrd());
    let volume = "[[entity]]\nname = \"block\"\nvolume = { file = \"small.nrrd\" }\nclassify = { iso = [{ value = 100 }] }\n";
    place.write("mixed.toml", format!("{CROSS}\n{volume}"));
    place.done("render mixed.toml -o a.png --stats a.json -t 2");
    let stats = place.json("a.json");
    for key in ["version", "scene", "size", "threads", "systems", "counts", "bytes", "seconds"] {
        assert!(!stats[key].is_null(), "{key}");
    }
    let has = |table: &str, keys: &[&str]| {
        for key in keys {
            assert!(stats[table][key].is_number(), "{table}.{key} in {stats}");
        }
    };
    has(
        "counts",
        &[
            "rays",
            "rays_per_pixel",
            "samples",
            "cells_skipped",
            "polygon_hits",
            "slivers",
            "nan_voxels",
        ],
    );
    has("bytes", &["scalars", "gel", "pyramid", "light"]);
    has("seconds", &["load", "prepare", "frame", "encode", "total"]);
    assert!(stats["bytes"].as_object().unwrap().contains_key("peak_rss"));
    assert_eq!(
        (stats["bytes"]["scalars"].as_u64(), stats["threads"].as_u64()),
        (Some(120), Some(2))
    );
    assert_eq!((&stats["scene"], &stats["size"]), (&"mixed".into(), &[48, 40].into()));
    let cast = stats["systems"].as_array().unwrap().iter().find(|s| s["name"] == "cast").unwrap();
    assert_eq!((&cast["made"], &cast["reused"]), (&1.into(), &0.into()));
    assert!(cast["seconds"].as_f64().unwrap() <= stats["seconds"]["frame"].as_f64().unwrap());
}

#[test]
fn a_trace_has_the_spans_of_systems_and_of_bands() {
    let place = Place::new();
    place.done("render cross.toml -o a.png --trace spans.json");
    let spans = place.json("spans.json");
    let named =
        |name: &str| spans.as_array().unwrap().iter().filter(|span| span["name"] == name).count();
    for stage in ["cast", "resample", "relight", "pyramid", "load", "encode"] {
        assert!(named(stage) >= 2, "{stage} begins and ends: {spans}");
    }
    assert!(named("system") == 0 && named("band") >= 2, "{spans}");
}

#[test]
fn the_map_of_rays_has_four_positions_along_a_pixel() {
    let place = Place::new();
    place.done("render cross.toml -o a.png --rays rays.png --stats a.json");
    let map = read_picture(&place.path("rays.png")).unwrap();
    let rays = map.pixels.iter().filter(|pixel| pixel[0] == 1.0).count() as u64;
    assert_eq!(map.size, [192, 160]);
    // Rays on the far edges belong to the regions beyond the last pixels.
    assert!(rays > 0 && rays <= place.json("a.json")["counts"]["rays"].as_u64().unwrap());
    place.done("render cross.toml -o a.png --rays rays.png --exact");
    let map = read_picture(&place.path("rays.png")).unwrap();
    assert!(
        map.pixels.iter().all(|pixel| pixel[0] == 1.0),
        "--exact casts a ray at every position"
    );
}

#[test]
fn quiet_is_silent_and_verbose_names_the_systems() {
    let place = Place::new();
    let ran = place.done("render cross.toml -o a.png -q");
    assert_eq!((ran.out, ran.err), (String::new(), String::new()));
    assert!(place.done("render cross.toml -o a.png -v").err.contains("resample: 1 made, 0 kept"));
}

#[test]
fn data_is_found_where_a_flag_or_the_variable_says_and_a_stand_in_is_warned_of() {
    let place = Place::new();
    std::fs::create_dir(place.path("scans")).unwrap();
    place.write("scans/small.nrrd", small_nrrd());
    let volume = |more: &str| {
        format!(
            "[[entity]]\nvolume = {{ file = \"small.nrrd\"{more} }}\nclassify = {{ iso = [{{ value = 100 }}] }}\n"
        )
    };
    place.write("scene.toml", volume(""));
    place.write("stand_in.toml", volume(", stand_in = \"phantom:ball\""));
    place.refused(
        "render scene.toml -o a.png",
        1,
        &["scene.toml:2:", "`small.nrrd` is not in", "--data DIR"],
    );
    place.done("render scene.toml -o a.png --size 8x8 --data scans");
    let ran =
        place.run_with_data("render scene.toml -o b.png --size 8x8", Some(&place.path("scans")));
    assert_eq!((ran.code, place.read("a.png")), (0, place.read("b.png")));
    let ran = place.done("render stand_in.toml -o a.png --size 8x8");
    assert!(ran.err.contains("warning: ") && ran.err.contains("stands in"), "{}", ran.err);
}

#[test]
fn an_older_picture_stays_as_it_was_when_a_render_fails() {
    let place = Place::new();
    place.write("a.png", "older");
    place.refused("render cross.toml -o a.png --max-memory 1K", 1, &["--max-memory allows 1024"]);
    place.refused("render nowhere.toml -o a.png", 1, &["nowhere.toml", "check the path"]);
    assert_eq!(place.read("a.png"), b"older");
}
