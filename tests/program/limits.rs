//! What would never end, or take more than there is, is refused by a sentence; what nothing reads costs nothing.

use std::fmt::Write;
use std::time::Instant;

use super::{CROSS, Place};

#[cfg(target_os = "linux")]
#[test]
fn a_process_that_the_system_lets_have_little_memory_says_so() {
    let place = Place::new();
    let tried = |kilobytes: u32, words: &str| {
        let program = env!("CARGO_BIN_EXE_gelray");
        let script = format!("ulimit -v {kilobytes}; exec {program} {words}");
        let mut shell = assert_cmd::Command::new("sh");
        let output = shell.current_dir(place.path("")).args(["-c", &script]).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    for kilobytes in [60_000, 95_000, 125_000] {
        let (code, said) = tried(kilobytes, "render head -t 2 -q -o a.png");
        assert_eq!(code, Some(1), "{kilobytes}: {said}");
        assert!(said.contains("ulimit") && said.lines().count() == 1, "{kilobytes}: {said}");
    }
    // Enough, or a sentence: whatever the limit, nothing else. Threads that each took a heap of their own, whenever they
    // came to it, ended one run of hundreds without a word.
    place.write("v.npy", npy_of_bytes(100));
    place.write("many.toml", repeated(6000, |i| format!("light = {{ toward = [1, 0, {i}] }}")));
    place.done("render cross.toml -q -o b.png --size 700x700");
    for (step, words) in [
        (40_000, "render cross.toml -t 3 -q -o a.png --size 99x99"),
        (9_000, "render minimal_6 -t 1 -q -o a.png --size 48x48"),
        (9_001, "render minimal_6 -t 3 -q -o a.png --size 48x48"),
        (23_000, "animate minimal_3 -t 2 -q -o a.gif --size 48x48 --frames 3"),
        (30_000, "compare b.png b.png -t 2 -q -o a.png"),
        (23_001, "info b.png -t 2"),
        (23_002, "info v.npy -t 2"),
        (23_003, "info phantom:head -t 1"),
        (23_004, "render many.toml -t 2 -q -o a.png --size 48x48"),
    ] {
        for kilobytes in (40_000..230_000).step_by(step) {
            let (code, said) = tried(kilobytes, words);
            assert!(matches!(code, Some(0 | 1)), "{words}, {kilobytes}: {code:?} {said}");
            assert!(code == Some(0) || said.lines().count() == 1, "{words}, {kilobytes}: {said}");
        }
        let _ = std::fs::remove_file(place.path("a.png"));
        let _ = std::fs::remove_file(place.path("a.gif"));
    }
    for name in ["v.npy", "b.png", "many.toml"] {
        std::fs::remove_file(place.path(name)).unwrap();
    }
    let (code, said) = tried(60_000, "render cross.toml -t 512 -q -o a.png");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("--threads") && said.lines().count() == 1, "{said}");
    assert_eq!(place.names(), ["cross.toml"]);
}

/// A volume of bytes, `n` voxels a side, as NumPy writes it.
#[cfg(target_os = "linux")]
fn npy_of_bytes(n: usize) -> Vec<u8> {
    let header = format!("{{'descr': '|u1', 'fortran_order': False, 'shape': ({n}, {n}, {n}), }}");
    let header = format!("{header:<117}\n");
    let voxels = (0..n * n * n).map(|i| (i * 7919 % 251) as u8);
    [b"\x93NUMPY\x01\x00\x76\x00", header.as_bytes()].concat().into_iter().chain(voxels).collect()
}

/// A scene of a polygon with a black picture on it, `n` pixels a side and a bit each, in `scene.toml` and `black.png`.
pub fn write_textured(place: &Place, scene: &str, n: u32) {
    let mut encoder =
        png::Encoder::new(std::fs::File::create(place.path("black.png")).unwrap(), n, n);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    let rows = vec![0; n.div_ceil(8) as usize * n as usize];
    encoder.write_header().unwrap().write_image_data(&rows).unwrap();
    let textured = "textured = { texture = \"black\" }\n[[entity]]\nname = \"black\"\ntexture = { file = \"black.png\" }\n[[entity]]\nname = \"blue\"\n";
    place.write(scene, CROSS.replace("[[entity]]\nname = \"blue\"\n", textured));
}

#[test]
fn a_texture_is_weighed_by_its_header_before_it_is_decoded() {
    let place = Place::new();
    // A quarter of a gibibyte of pixels, 16 bytes each, of a file of some kilobytes.
    write_textured(&place, "s.toml", 4096);
    let start = Instant::now();
    let most = (64 << 20).to_string();
    for verb in ["plan s.toml", "render s.toml -o a.png"] {
        place.refused(&format!("{verb} --max-memory 64M"), 1, &[&most, "268435456", "texture"]);
    }
    assert!(start.elapsed().as_secs_f64() < 0.5);
    assert!(!place.path("a.png").exists());
    // One that cannot be decoded is refused as before, whatever it would take.
    place.write("black.png", "no picture");
    place.refused("render s.toml -o a.png --max-memory 64M", 1, &["black.png", "PNG"]);
}

#[test]
fn a_volume_is_weighed_before_it_is_read() {
    let place = Place::new();
    // A gibibyte of zeros that no disc holds: were it read, the test would take its time and its memory.
    std::fs::File::create(place.path("v.raw")).unwrap().set_len(1 << 30).unwrap();
    let volume = "[[entity]]\nvolume = { file = \"v.raw\", size = [1024, 1024, 1024], voxel_type = \"uint8\" }\nclassify = { iso = [{ value = 9 }] }\n";
    place.write("s.toml", volume);
    let start = Instant::now();
    place.refused("render s.toml -o a.png --max-memory 256M", 1, &["1073741824", "268435456"]);
    place.refused("plan s.toml --max-memory 256M", 1, &["1073741824"]);
    place.refused("render head -o a.png --max-memory 20M", 1, &["20971520"]);
    assert!(start.elapsed().as_secs_f64() < 1.0);
}

#[test]
fn a_sample_distance_that_takes_hours_is_refused_with_the_number_of_samples() {
    let place = Place::new();
    let words = "minimal_4 --set observer.sampling.distance_mm=5e-9";
    let said = ["distance_mm", "samples", "1048576 are the most"];
    let words = words.replace("observer", "view");
    let stated = "[[entity]]\nvolume = { file = \"phantom:ball\" }\nclassify = { iso = [{ value = 0.5 }] }\n[[entity]]\nname = \"view\"\nview = {}\nsampling = { distance_mm = 1 }\n";
    place.write("s.toml", stated);
    let words = words.replace("minimal_4", "s.toml");
    place.refused(&format!("plan {words}"), 2, &said);
    place.refused(&format!("render {words} -o a.png"), 2, &said);
    let plan = place.done("plan s.toml --size 10x10").out;
    assert!(
        plan.contains("A ray has up to 110 samples, 1 apart; at a ray a pixel up to 1.100e4"),
        "{plan}"
    );
}

#[cfg(unix)]
#[test]
fn a_scene_that_never_ends_is_refused() {
    let place = Place::new();
    place.refused("render /dev/zero -o a.png", 1, &["/dev/zero", "may never end"]);
    let made = std::process::Command::new("mkfifo").arg(place.path("pipe.toml")).status();
    assert!(made.unwrap().success());
    place.refused("plan pipe.toml", 1, &["pipe.toml", "may never end"]);
}

/// Seconds that `plan` takes, the best of three runs.
fn seconds(place: &Place, scene: &str) -> f64 {
    place.write("many.toml", scene);
    let run = || {
        let start = Instant::now();
        place.done("plan many.toml -q");
        start.elapsed().as_secs_f64()
    };
    (0..3).map(|_| run()).fold(f64::INFINITY, f64::min)
}

/// Eight times as many must not take more than 8^1.1 times as long, starting and a fair allowance for noise left out.
fn is_linear(of: impl Fn(usize) -> String, few: usize) {
    let place = Place::new();
    let [few, many] =
        [few, 8 * few].map(|number| seconds(&place, &format!("{CROSS}{}", of(number))));
    assert!(many < 0.1 + 1.5 * few * 8_f64.powf(1.1), "{few} s and then {many} s");
}

fn repeated(number: usize, entity: impl Fn(usize) -> String) -> String {
    (0..number).fold(String::new(), |mut scene, i| {
        let _ = writeln!(scene, "[[entity]]\n{}", entity(i));
        scene
    })
}

#[test]
fn scenes_of_many_polygons_load_in_linear_time() {
    let polygon = |i| format!("polygon = {{ vertices = [[{i}, 0, 0], [{i}, 1, 0], [{i}, 0, 1]] }}");
    is_linear(|number| repeated(number, polygon), 500);
    is_linear(|number| repeated(number, |i| format!("name = \"p{i}\"\n{}", polygon(i))), 500);
}

#[test]
fn scenes_of_many_lights_load_in_linear_time() {
    is_linear(|number| repeated(number, |i| format!("light = {{ toward = [1, 0, {i}] }}")), 500);
}

#[test]
fn textures_that_nothing_names_are_neither_read_nor_made() {
    let textures = |number| {
        repeated(number, |i| {
            let how = if i % 2 == 0 { "formula = \"grid\"" } else { "file = \"nowhere.png\"" };
            format!("name = \"t{i}\"\ntexture = {{ {how} }}")
        })
    };
    is_linear(textures, 500);
    let place = Place::new();
    place.write("s.toml", format!("{CROSS}{}", textures(3000)));
    let ran = place.done("render s.toml -o a.png --stats a.json");
    assert!(ran.err.contains("2999 more textures are not read"), "{}", ran.err);
    // Three thousand of them would be 3 GB.
    let peak = &place.json("a.json")["bytes"]["peak_rss"];
    assert!(peak.as_u64().is_none_or(|bytes| bytes < 300 << 20), "{peak}");
}

#[test]
fn an_exact_picture_keeps_the_shortcuts_that_lose_nothing() {
    let place = Place::new();
    let counted = |words: &str| {
        place.done(&format!(
            "render minimal_1 --size 24x24 --exact -q -o a.npy --stats a.json {words}"
        ));
        let counts = place.json("a.json")["counts"].clone();
        (
            place.read("a.npy"),
            counts["samples"].as_u64().unwrap(),
            counts["cells_skipped"].as_u64().unwrap(),
        )
    };
    place.write("view.toml", "[[entity]]\nvolume = { file = \"phantom:ball\" }\nclassify = { iso = [{ value = 0.5 }] }\n[[entity]]\nname = \"o\"\nview = { size = [24, 24] }\nsampling = { skip = \"none\" }\n");
    let (_, samples, skipped) = counted("");
    assert!(skipped > 0, "{samples} samples, {skipped} cells skipped");
    place.done("render view.toml --exact -q -o none.npy --stats none.json");
    place.done(
        "render view.toml --exact -q -o skip.npy --stats skip.json --set o.sampling.skip=pyramid",
    );
    let [none, skip] = ["none", "skip"]
        .map(|name| place.json(&format!("{name}.json"))["counts"]["samples"].as_u64().unwrap());
    assert!(2 * skip < none, "{skip} of {none} samples");
    assert_eq!(place.read("none.npy"), place.read("skip.npy"));
}
