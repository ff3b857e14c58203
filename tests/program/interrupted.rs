//! Ctrl-C: exit code 130, and no file that is not whole.
#![cfg(unix)]

use std::fmt::Write;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};

use super::Place;

/// A scene of so many faint planes that its exact picture takes longer than anybody waits.
fn many_planes() -> String {
    let mut scene = String::new();
    for y in 0..600 {
        let _ = writeln!(
            scene,
            "[[entity]]\npolygon = {{ vertices = [[-9, {y}, -9], [9, {y}, -9], [9, {y}, 9], [-9, {y}, 9]] }}\nsurface = {{ opacity = 0.001 }}"
        );
    }
    scene.push_str("[[entity]]\nview = { height_mm = 15, size = [500, 500] }\n");
    scene
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

#[test]
fn the_first_interrupt_stops_the_work_and_leaves_nothing_half_written() {
    let place = Place::new();
    place.write("planes.toml", many_planes());
    // What an earlier run left: a set, and a part that it was killed over.
    place.write("a.png", "older");
    place.write("a.json", "{}");
    place.write(".gelray-killed.part", "half");
    let mut child = Command::new(env!("CARGO_BIN_EXE_gelray"))
        .current_dir(place.path(""))
        .args("render planes.toml -o a.png --stats a.json --exact -v -t 1".split(' '))
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.starts_with("cast") {
        line.clear();
        assert!(lines.read_line(&mut line).unwrap() > 0, "it ended before it was interrupted");
    }
    signal(&child, "-INT");
    let mut said = String::new();
    lines.read_to_string(&mut said).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{said}");
    assert!(said.contains("stopping") && said.contains("interrupted"), "{said}");
    assert_eq!(place.names(), ["a.json", "a.png", "cross.toml", "planes.toml"]);
    assert_eq!((place.read("a.png"), place.read("a.json")), (b"older".to_vec(), b"{}".to_vec()));
}
