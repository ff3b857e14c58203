//! `plan`, `info`, `compare`, `scenes`, `schema`, `--version`, `--help`: results on standard output.

use std::io::Read;
use std::process::{Command, Stdio};

use gelray::formats::read_picture;
use gelray::scene::EMBEDDED;

use super::{Place, small_nrrd};

#[test]
fn a_plan_tells_systems_bytes_and_reasons_and_writes_nothing() {
    let place = Place::new();
    let ran = place.done("plan cross.toml --size 100x50");
    let line = |name: &str| ran.out.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(line("resample").contains("runs") && line("resample").contains("80000"), "{}", ran.out);
    assert!(line("cast").contains("observer") && line("cast").contains("a view is stated"));
    let bytes = |line: &str| -> Option<u64> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let unit = words.iter().position(|word| *word == "B" || word.ends_with("iB"))?;
        words.get(unit + 1)?.parse().ok()
    };
    // Every row has a part in the total: systems, what was read, the program and the file of the picture.
    let rows = ran.out.lines().filter(|line| !line.starts_with("total"));
    let parts: Vec<u64> = rows.filter_map(bytes).collect();
    assert_eq!(bytes(line("total")), Some(parts.iter().sum()), "{}", ran.out);
    assert!(bytes(line("cast")) > Some(0) && parts.len() >= 5, "{}", ran.out);
    assert_eq!(place.names(), ["cross.toml"]);
    place.done("plan cross.toml --size 100x50 -o plan.txt");
    assert_eq!(place.read("plan.txt"), ran.out.as_bytes());
}

#[test]
fn a_volume_is_told_by_header_values_and_histogram() {
    let place = Place::new();
    place.write("small.nrrd", small_nrrd());
    let out = place.done("info small.nrrd").out;
    for fact in [
        "6 × 5 × 4 of uint8, 120 B",
        "(2, 2, 3)",
        "i +x, j +y, k +z (LPS in a patient)",
        "(0, 0, 0) to (10, 8, 9)",
        "0 to 200",
        "0 NaN",
        "mean",
        "isovalues",
    ] {
        assert!(out.contains(fact), "{fact} in {out}");
    }
    let counted: Vec<&str> = out.lines().filter(|line| line.contains('█')).collect();
    assert!(
        counted.len() == 2 && counted[0].ends_with("72") && counted[1].ends_with("48"),
        "{out}"
    );
    assert!(place.done("info phantom:ball").out.contains("64 × 64 × 64"));
}

#[test]
fn a_mesh_is_told_by_extent_area_and_whether_it_is_closed() {
    let place = Place::new();
    let points = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n";
    place.write("whole.obj", format!("{points}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
    let out = place.done("info whole.obj").out;
    for fact in ["4 of 4 points, OBJ", "(0, 0, 0) to (1, 2, 3)", "9", "yes, around a volume of 1"] {
        assert!(out.contains(fact), "{fact} in {out}");
    }
    assert!(!out.contains("inward"), "{out}");
    place.write("open.obj", format!("{points}f 1 2 3\nf 1 2 4\nf 1 4 3\n"));
    let out = place.done("info open.obj").out;
    assert!(
        out.contains("no: 3 edges of one triangle alone") && out.contains("different sides"),
        "{out}"
    );
    place.write("inward.obj", format!("{points}f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n"));
    assert!(place.done("info inward.obj").out.contains("face inward"));
    place.done("render cross.toml -o bark.png --size 12x8");
    place.write(
        "tree.mtl",
        "newmtl bark\nKd 1 1 1\nmap_Kd bark.png\nnewmtl leaf\nd 0.5\nmap_Kd no.png\n",
    );
    let faces = "mtllib tree.mtl\nusemtl bark\nf 1 3 2\nusemtl leaf\nf 1 2 4\n";
    place.write("tree.obj", format!("{points}{faces}"));
    let out = place.done("info tree.obj").out;
    for fact in [
        "in the colors of its materials, 1 of them seen through",
        "bark.png, 12 × 8 pixels",
        "no.png, which is not found",
    ] {
        assert!(out.contains(fact), "{fact} in {out}");
    }
}

#[test]
fn a_picture_is_told_by_size_and_range() {
    let place = Place::new();
    place.done("render cross.toml -o a.exr");
    let out = place.done("info a.exr").out;
    assert!(out.contains("48 × 40, EXR"), "{out}");
    assert!(out.contains("alpha") && out.contains("empty"), "{out}");
}

#[test]
fn pictures_that_differ_are_compared_and_that_is_no_failure() {
    let place = Place::new();
    place.done("render cross.toml -o a.png");
    place.done("render cross.toml -o b.png --set red.surface.opacity=0.6");
    let equal = place.done("compare a.png a.png").out;
    assert!(equal.contains("∞ dB") && equal.contains("The pictures are equal."), "{equal}");
    let out = place.done("compare a.png b.png -o map.png --stats d.json").out;
    assert!(out.contains("linear") && out.contains("sRGB") && out.contains("in column"), "{out}");
    assert_eq!(read_picture(&place.path("map.png")).unwrap().size, [48, 40]);
    let stats = place.json("d.json");
    for key in ["max", "rmse", "psnr_db", "ssim"] {
        assert!(stats["linear"][key].is_number() && stats["srgb"][key].is_number(), "{key}");
    }
    assert!(stats["linear"]["max"].as_f64().unwrap() > 0.05);
}

#[test]
fn pictures_of_two_sizes_are_a_failure_in_one_sentence() {
    let place = Place::new();
    place.done("render cross.toml -o a.png");
    place.done("render cross.toml -o b.png --size 9x9");
    place.refused("compare a.png b.png -o map.png", 1, &["48 × 40", "9 × 9", "render both"]);
}

#[test]
fn embedded_scenes_are_listed_and_printed_as_they_are() {
    let place = Place::new();
    let list = place.done("scenes").out;
    for (name, text) in EMBEDDED {
        let comment = text.lines().next().unwrap().trim_start_matches("# ");
        assert!(
            list.lines().any(|line| line.starts_with(name) && line.contains(comment)),
            "{name}"
        );
        assert_eq!(place.done(&format!("scenes {name}")).out, text);
    }
}

#[test]
fn the_schema_is_that_of_the_library() {
    let out = Place::new().done("schema").out;
    let schema: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(schema, gelray::scene::schema());
}

#[test]
fn version_and_help_go_to_standard_output() {
    let place = Place::new();
    assert_eq!(place.done("--version").out, format!("gelray {}\n", env!("CARGO_PKG_VERSION")));
    let help = place.done("--help").out;
    for word in [
        "render",
        "plan",
        "info",
        "compare",
        "scenes",
        "schema",
        "Examples:",
        "Exit codes:",
        "--set",
    ] {
        assert!(help.contains(word), "{word}");
    }
    assert!(place.done("render --help").out.contains("Examples:"));
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_gelray"))
        .arg("schema")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert_eq!((child.wait().unwrap().code(), said.as_str()), (Some(0), ""));
}
