//! Exit codes 1 and 2: whose fault it is, what was found, what was expected and what to do.

use super::{CROSS, Place};

#[test]
fn a_wrong_command_line_is_a_misuse() {
    let place = Place::new();
    place.refused("rendr -o a.png", 2, &["rendr", "render"]);
    place.refused("", 2, &["Usage"]);
    place.refused("render --nonsense", 2, &["--nonsense"]);
    place.refused("render cross.toml", 2, &["-o OUT", ".png, .exr"]);
    place.refused("render cross.toml -o a.xyz", 2, &["`.xyz`", ".png"]);
    place.refused("render cross.toml -o a.bmp", 2, &["`.bmp`", ".png"]);
    place.refused("render cross.toml -o a", 2, &["has no extension"]);
    place.refused("render cross.toml -o a.png -o b.png", 2, &["--output", "multiple times"]);
    place.refused("render cross.toml -o a.png --rays a.jpg", 2, &["ends in .png"]);
    place.refused("render cross.toml -o a.png -q -v", 2, &["cannot be used with"]);
    place.refused("compare a.png", 2, &["<B>"]);
}

#[test]
fn numbers_out_of_their_range_are_a_misuse() {
    let place = Place::new();
    for size in ["0x10", "10x0", "10", "axb", "10x-1", "99999x10"] {
        place.refused(
            &format!("render cross.toml -o a.png --size {size}"),
            2,
            &["each 1 to 16384"],
        );
    }
    for threads in ["0", "1025", "-3", "x", "99999999999999999999"] {
        place.refused(
            &format!("render cross.toml -o a.png --threads={threads}"),
            2,
            &["--threads"],
        );
    }
    for bytes in ["0", "8X", "G", "999999999T"] {
        place.refused(&format!("render cross.toml -o a.png --max-memory {bytes}"), 2, &["8G"]);
    }
    place.refused("render cross.toml -o a.png --data nowhere", 2, &["no such folder"]);
}

#[test]
fn a_wrong_override_is_a_misuse_that_lists_the_right_ones() {
    let place = Place::new();
    let wrong = |change: &str, said: &[&str]| {
        place.refused(&format!("render cross.toml -o a.png --set {change}"), 2, said);
    };
    wrong("redd.surface.opacity=1", &["did you mean `red`?", "`blue`, `observer`"]);
    wrong("red.surfce.opacity=1", &["did you mean `surface`?"]);
    wrong("red.surface.opacty=1", &["did you mean `opacity`?"]);
    wrong("red.surface.opacity", &["no `=`"]);
    wrong("red.surface.opacity=2", &["cross.toml with --set:", "opacity"]);
    wrong("observer.view.size=[0,5]", &["cross.toml with --set:", "size"]);
}

#[test]
fn a_wrong_scene_is_a_failure_at_its_line_and_column_even_with_overrides() {
    let place = Place::new();
    place.write("wrong.toml", CROSS.replace("opacity = 0.5", "opacty = 0.5"));
    place.refused(
        "render wrong.toml -o a.png",
        1,
        &["wrong.toml:5:32: ", "did you mean `opacity`?"],
    );
    place.refused("render wrong.toml -o a.png --set blue.surface.opacity=1", 1, &["opacty"]);
    place.write("size.toml", CROSS.replace("[48, 40]", "[0, 40]"));
    place.refused("render size.toml -o a.png", 1, &["size.toml:14:", "16384"]);
    place.write("text.toml", "this is no scene");
    place.refused("render text.toml -o a.png --size 9x9", 1, &["text.toml", "not TOML"]);
    place.write("empty.toml", "");
    place.refused("plan empty.toml", 1, &["the scene is empty", "[[entity]]"]);
    place.write("binary.toml", b"\xff\xfe");
    place.refused("render binary.toml -o a.png", 1, &["UTF-8"]);
}

#[test]
fn what_is_not_there_is_a_failure_with_a_remedy() {
    let place = Place::new();
    place.refused("render nowhere.toml -o a.png", 1, &["nowhere.toml", "check the path"]);
    place.refused("render hed -o a.png", 1, &["did you mean `head`?"]);
    place.refused("scenes hed", 1, &["did you mean `head`?"]);
    place.refused("info nowhere.nrrd", 1, &["nowhere.nrrd", "no such file"]);
    place.refused("info phantom:hed", 1, &["`head`"]);
    place.refused("compare cross.png nowhere.png", 1, &["cross.png", "check the path"]);
}

#[test]
fn files_that_cannot_be_written_are_known_before_any_work() {
    let place = Place::new();
    for flag in ["-o", "--rays", "--stats", "--trace"] {
        let rest = if flag == "-o" { "" } else { "-o a.png" };
        let words = format!("render cross.toml {rest} {flag} nowhere/a.png");
        place.refused(&words, 1, &["nowhere", "make it first"]);
    }
    std::fs::create_dir(place.path("folder.png")).unwrap();
    place.refused("render cross.toml -o folder.png", 1, &["is a folder"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_no_file_can_be_made_in_is_a_failure() {
    Place::new().refused("render cross.toml -o /proc/a.png", 1, &["/proc"]);
    Place::new().refused(
        "render cross.toml -o a.png --stats /sys/a.json",
        1,
        &["/sys", "choose another"],
    );
}

#[test]
fn a_file_is_never_written_twice_nor_over_what_is_read() {
    let place = Place::new();
    place.refused(
        "render cross.toml -o a.png --rays ./a.png",
        2,
        &["--output and --rays both name"],
    );
    place.refused("render cross.toml -o a.png --stats cross.toml", 2, &["which is read"]);
    place.done("render cross.toml -o a.png");
    place.refused("compare a.png a.png -o a.png", 2, &["which is read"]);
    assert_eq!(place.read("cross.toml"), CROSS.as_bytes());
}

#[test]
fn a_flag_that_a_verb_has_no_use_for_is_refused() {
    let place = Place::new();
    for words in [
        "schema --exact",
        "scenes --size 9x9",
        "info phantom:ball --set a.b=1",
        "plan --stats a.json",
    ] {
        place.refused(words, 2, &["has no use for", "leave it away"]);
    }
}

#[test]
fn memory_is_refused_before_it_is_taken() {
    let place = Place::new();
    let words = "render cross.toml -o a.png --size 16384x16384";
    place.refused(
        &format!("{words} --max-memory 1G"),
        1,
        &["up to", "--max-memory allows 1073741824", "smaller"],
    );
    let ran = place.run("plan cross.toml --size 16384x16384 --max-memory 1G");
    assert!(ran.code == 1 && ran.out.contains("total") && ran.err.contains("up to"), "{}", ran.err);
    place.done("render cross.toml -o a.png --max-memory 1G");
}
