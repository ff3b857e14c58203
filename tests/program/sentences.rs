//! What is said, and what is not: escaped text, empty pictures, home folders, pipes, names of any bytes.

use gelray::formats::read_picture;

use super::{CROSS, Place, small_nrrd};

#[test]
fn text_from_files_cannot_command_a_terminal() {
    let place = Place::new();
    let nrrd = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: \u{1b}]0;owned\u{7}\u{1b}[31m\n\n12345678";
    place.write("v.nrrd", nrrd);
    place.refused("info v.nrrd", 1, &["\\x1b]0;owned\\x07\\x1b[31m"]);
    place.write(
        "s.toml",
        CROSS.replace("\"red\"", "\"\\u001b[2Jred\"").replace("0, 10], [-10", "0, 11], [-10"),
    );
    let ran = place.run("plan s.toml");
    assert!(!ran.out.contains('\u{1b}') && !ran.err.contains('\u{1b}'), "{}{}", ran.out, ran.err);
}

#[test]
fn a_missing_file_says_where_it_was_looked_for_and_that_a_shell_knows_the_home_folder() {
    let place = Place::new();
    let scene = |file: &str| format!("[[entity]]\nvolume = {{ file = \"{file}\" }}\n");
    place.write("s.toml", scene("x.nrrd"));
    place.refused(
        "plan s.toml",
        1,
        &["`x.nrrd` is not in the working folder", "no data folder is given"],
    );
    std::fs::create_dir(place.path("scans")).unwrap();
    place.refused(
        "plan s.toml --data scans",
        1,
        &["nor in the data folder `scans` or a folder in it"],
    );
    place.write("s.toml", scene("~/x.nrrd"));
    place.refused("plan s.toml", 1, &["only a shell takes for the home folder"]);
}

#[test]
fn an_entity_that_goes_by_another_name_is_named() {
    let place = Place::new();
    let said = ["no entity", "`view`", "`observer`"];
    place.refused("render cross.toml -o a.png --set view.azimuth=3", 2, &said);
}

#[test]
fn a_volume_in_place_of_a_scene_is_told_apart_from_text() {
    let place = Place::new();
    place.write("v.nrrd", small_nrrd());
    let ran = place.run("render v.nrrd -o a.png");
    assert!(ran.code == 0 || ran.err.contains("is a volume"), "{}", ran.err);
}

#[test]
fn a_picture_that_shows_nothing_is_warned_of_with_the_reason() {
    let place = Place::new();
    place.write("v.nrrd", small_nrrd());
    let scene = |more: &str| {
        format!(
            "[[entity]]\nname = \"v\"\nvolume = {{ file = \"v.nrrd\" }}\nclassify = {{ iso = [{{ value = 5000 }}] }}\n{more}"
        )
    };
    place.write("s.toml", scene(""));
    let ran = place.done("render s.toml -o a.png --size 9x9");
    assert!(
        ran.err.contains(
            "warning: the picture is empty: no voxel of `v` reaches 5000: the greatest is 200"
        ),
        "{}",
        ran.err
    );
    let ran = place.done("render cross.toml -o b.png --set observer.view.focal_point=[999,0,0] --set observer.view.height_mm=40");
    assert!(
        ran.err.contains("the picture is empty: nothing that is stated lies in the view"),
        "{}",
        ran.err
    );
    assert_eq!(place.done("render s.toml -o a.png --size 9x9 -q").err, "");
    assert!(!place.done("render cross.toml -o a.png").err.contains("empty"));
}

#[test]
fn colors_have_the_names_of_css() {
    let place = Place::new();
    place.done("render cross.toml -q -o a.npy --set red.surface.color=rebeccapurple");
    place.done("render cross.toml -q -o b.npy --set red.surface.color=#663399");
    assert_eq!(place.read("a.npy"), place.read("b.npy"));
    let wrong = "render cross.toml -o c.png --set red.surface.color=reddish";
    place.refused(wrong, 2, &["\"reddish\" is no colour", "a name of CSS"]);
}

#[test]
fn pictures_that_are_alike_enough_let_a_script_go_on() {
    let place = Place::new();
    place.done("render cross.toml -q -o a.png");
    place.done("render cross.toml -q -o b.png --set red.surface.opacity=0.6");
    let quiet = place.done("compare a.png b.png -q");
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
    place.done("compare a.png b.png -q --fail-below psnr=10 --fail-below ssim=0.1");
    place.done("compare a.png a.png -q --fail-below psnr=400");
    place.refused("compare a.png b.png -q --fail-below psnr=99", 1, &["psnr", "below the 99 dB"]);
    place.refused("compare a.png b.png --fail-below max=1", 2, &["psnr=DECIBELS"]);
    place.refused(
        "render cross.toml -o c.png --fail-below psnr=9",
        2,
        &["has no use for --fail-below"],
    );
}

#[test]
fn a_dash_is_standard_output() {
    let place = Place::new();
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_gelray"));
    let output = command
        .current_dir(place.path(""))
        .args(["render", "cross.toml", "-o", "-"])
        .output()
        .unwrap();
    assert!(
        output.status.success()
            && String::from_utf8_lossy(&output.stderr).contains("standard output: 48 × 40")
    );
    place.write("a.png", output.stdout);
    assert_eq!(place.names(), ["a.png", "cross.toml"]);
    place.done("render cross.toml -q -o b.png");
    assert_eq!(place.read("a.png"), place.read("b.png"));
    assert_eq!(place.done("plan cross.toml -o -").out, place.done("plan cross.toml").out);
    place.refused("render cross.toml -o c.png --stats -", 2, &["cannot be standard output"]);
}

#[cfg(target_os = "linux")]
#[test]
fn names_of_files_need_not_be_text() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let place = Place::new();
    let [scene, out, stats] =
        [&b"sc\xffne.toml"[..], b"p\xfe.png", b"s\xfd.json"].map(OsStr::from_bytes);
    std::fs::rename(place.path("cross.toml"), place.0.path().join(scene)).unwrap();
    let run = |words: &[&OsStr]| {
        let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_gelray"));
        command.current_dir(place.path("")).args(words).assert().success();
    };
    let word = OsStr::new;
    run(&[word("render"), scene, word("-o"), out, word("--stats"), stats]);
    assert_eq!(read_picture(&place.0.path().join(out)).unwrap().size, [48, 40]);
    run(&[word("info"), out]);
    run(&[word("compare"), out, out, word("--stats"), word("d.json")]);
}

#[test]
fn help_of_a_verb_lists_the_flags_that_it_has_a_use_for() {
    let place = Place::new();
    for (verb, has, lacks) in [
        ("render", "--rays", "--fail-below"),
        ("plan", "--max-memory", "--stats"),
        ("compare", "--fail-below", "--exact"),
        ("info", "--raw", "--set"),
        ("scenes", "--output", "--size"),
        ("schema", "--output", "--trace"),
    ] {
        let help = place.done(&format!("{verb} --help")).out;
        assert!(
            help.contains(has) && help.contains("--threads") && !help.contains(lacks),
            "{verb}: {help}"
        );
    }
}

#[test]
fn a_file_of_bare_voxels_is_told_with_a_stated_header() {
    let place = Place::new();
    place.write("v.raw", [0_u8, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0, 7, 0, 8]);
    place.refused("info v.raw", 1, &["has no header", "--raw 256x256x113,uint16,little"]);
    let out = place.done("info v.raw --raw 2x2x2,uint16,big,1x1x3").out;
    assert!(
        out.contains("2 × 2 × 2 of uint16") && out.contains("(1, 1, 3)") && out.contains("1 to 8"),
        "{out}"
    );
    place.refused("info v.raw --raw 2x2x3,uint16,big", 1, &["v.raw", "24 bytes"]);
    place.refused("info v.raw --raw 2x2,uint16", 2, &["voxels on each axis"]);
}

#[test]
fn scenes_are_described_in_whole_sentences() {
    let list = Place::new().done("scenes").out;
    assert!(list.lines().all(|line| line.ends_with('.')), "{list}");
}

#[test]
fn what_loses_digits_or_brightness_is_said() {
    let place = Place::new();
    let header =
        "NRRD0004\ntype: int\ndimension: 3\nsizes: 3 3 3\nencoding: raw\nendian: little\n\n";
    let values = (0..27).flat_map(|i: i32| (100_000_000 + i).to_le_bytes());
    place.write("v.nrrd", header.bytes().chain(values).collect::<Vec<_>>());
    let scene = "[[entity]]\nname = \"v\"\nvolume = { file = \"v.nrrd\" }\nclassify = { iso = [{ value = 100000009 }] }\n[[entity]]\nname = \"l\"\nlight = { toward = [0, -1, 0], strength = 4 }\n[[entity]]\nname = \"o\"\nview = { size = [9, 9] }\nsampling = { texel = \"u16\" }\n";
    place.write("s.toml", scene);
    let said = place.done("plan s.toml").err;
    assert!(
        said.contains("`v`: its values from 100000000 to 100000026 are taken as 32-bit floats"),
        "{said}"
    );
    assert!(said.contains("the lights sum to 4: what is brighter is cut"), "{said}");
    let said = place.done("plan s.toml --set o.sampling.texel=auto").err;
    assert!(!said.contains("is cut"), "{said}");
}

#[test]
fn polygons_that_the_two_methods_would_differ_on_are_refused() {
    let place = Place::new();
    let refused = |vertices: &str, more: &str, said: &[&str]| {
        place.write(
            "s.toml",
            format!("[[entity]]\nname = \"p\"\npolygon = {{ vertices = {vertices}{more} }}\n"),
        );
        place.refused("render s.toml -o a.png", 1, said);
    };
    let square = "[[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]";
    refused("[[0, 0, 0], [9, 9, 0], [9, 0, 0], [0, 9, 0]]", "", &["`p`", "crosses itself"]);
    refused("[[0, 0, 0], [9, 9, 0], [9, 0, 0], [0, 8, 0]]", "", &["edges", "cross; split it"]);
    refused(square, ", holes = [[[20, 1, 0], [21, 1, 0], [21, 2, 0]]]", &["hole 1 lies outside"]);
    refused(square, ", holes = [[[8, 1, 0], [12, 1, 0], [8, 5, 0]]]", &["of hole 1", "cross"]);
}
