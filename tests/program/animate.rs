//! Sequences: frames that are plain renders, taken up where they stopped, shared by several machines, made into animations.

use std::fs;
use std::process::{Command, Stdio};

use super::{CROSS, Place};

/// The names and bytes of all files of a folder that are not hidden.
fn folder(place: &Place, name: &str) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(place.path(name)).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &std::path::Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    let mut files: Vec<_> = entries.map(|path| (name(&path), fs::read(&path).unwrap())).collect();
    files.retain(|(name, _)| !name.starts_with('.'));
    files.sort();
    files
}

fn command(place: &Place, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gelray"));
    command.current_dir(place.path("")).args(words.split_whitespace()).env_remove("GELRAY_DATA");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// What is stated for every picture to be framed alike.
const HEIGHT: &str = "--set observer.view.height_mm=70";

#[test]
fn a_frame_of_a_turn_is_the_plain_render_of_its_view() {
    let place = Place::new();
    place.done(&format!("animate cross.toml -o t.##.png --frames 8 --stats s.json {HEIGHT}"));
    for (frame, azimuth) in [(0, 30), (3, 165), (7, 345)] {
        let view = format!("{HEIGHT} --set observer.view.azimuth={azimuth}");
        place.done(&format!("render cross.toml -o a.png {view}"));
        if frame > 0 {
            assert_eq!(place.read(&format!("t.0{frame}.png")), place.read("a.png"), "{frame}");
        }
    }
    let stats = place.json("s.json");
    let made = |frame: usize| -> Vec<String> {
        let systems = stats["frames"][frame]["systems"].as_array().unwrap().iter();
        let made = systems.filter(|ran| ran["made"].as_u64() > Some(0));
        made.map(|ran| ran["name"].as_str().unwrap().to_owned()).collect()
    };
    assert!((0..8).all(|frame| made(frame) == ["cast", "resample"]));
    assert_eq!(place.json("t.manifest.json")["frames"].as_array().unwrap().len(), 8);
}

#[test]
fn after_the_first_frame_of_a_turn_only_rays_are_cast() {
    let place = Place::new();
    let ran = place.done("animate head -o frames --size 40x40 --frames 0..30x10 --axis view-up -v");
    let lines: Vec<_> = ran.err.lines().filter(|line| line.starts_with("frame ")).collect();
    assert!(lines.len() == 4 && lines[0].contains("ranges"), "{}", ran.err);
    assert!(lines[1..].iter().all(|line| line.ends_with("s, cast, resample ran")), "{}", ran.err);
}

#[test]
fn keyframes_make_anew_only_what_they_touch_and_frames_are_plain_renders() {
    let place = Place::new();
    let scene = r##"[[entity]]
name = "ball"
volume = { file = "phantom:head" }
classify = { iso = [{ value = 1200 }] }
material = { color = "#ffffff" }
animate = { tracks = [{ key = "material.color", to = ["#ffffff", "#ff0000", "#ff0000"] }] }

[[entity]]
name = "key"
light = { toward = [-0.5, -0.7, 0.6] }

[[entity]]
name = "eye"
view = { size = [24, 24], height_mm = 300 }
animate = { tracks = [{ key = "view.azimuth", to = [0, 90], ease = "smooth" }] }
"##;
    place.write("moving.toml", scene);
    let ran = place.done("animate moving.toml -o m.#.png --frames 0..4x1 -v");
    let lines: Vec<_> = ran.err.lines().filter(|line| line.starts_with("frame ")).collect();
    assert!(lines[1].contains("relight, cast") && !lines[1].contains("classify"), "{}", ran.err);
    assert!(lines[4].ends_with("s, cast, resample ran"), "{}", ran.err);
    place.done(
        "render moving.toml -o a.png --set eye.view.azimuth=45 --set ball.material.color=[1,0,0]",
    );
    let pixels =
        |name: &str| gelray::formats::read_picture(&place.path(name)).unwrap().pixels.to_vec();
    assert_eq!(pixels("m.2.png"), pixels("a.png"));
}

#[test]
fn a_killed_sequence_is_taken_up_to_the_very_bytes_of_one_that_was_not() {
    let place = Place::new();
    let words = "animate head --size 64x64 --frames 24 -t 1 -q";
    let mut child = command(&place, &format!("{words} -o killed")).spawn().unwrap();
    while !place.path("killed/frame.0003.png").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it was killed");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let before = fs::metadata(place.path("killed/frame.0001.png")).unwrap().modified().unwrap();
    assert!(!place.path("killed/frame.0023.png").exists());
    place.done(&format!("{words} -o killed --resume"));
    let after = fs::metadata(place.path("killed/frame.0001.png")).unwrap().modified().unwrap();
    assert_eq!(before, after, "what was done is left as it is");
    place.done(&format!("{words} -o whole"));
    assert!(folder(&place, "killed") == folder(&place, "whole"));
}

#[test]
fn two_shards_at_once_make_the_very_bytes_of_one_run() {
    let place = Place::new();
    let words = "animate cross.toml --frames 9 -q";
    fs::create_dir(place.path("shared")).unwrap();
    let shard = |n: usize| command(&place, &format!("{words} -o shared --shard {n}/2")).spawn();
    let mut shards = [1, 2].map(|n| shard(n).unwrap());
    assert!(shards.iter_mut().all(|child| child.wait().unwrap().success()));
    place.done(&format!("{words} -o whole"));
    assert!(folder(&place, "shared") == folder(&place, "whole"));
    place.refused("animate cross.toml -o whole --shard 3/2", 2, &["--shard", "2/8"]);
}

#[test]
fn what_has_changed_or_is_damaged_is_made_again() {
    let place = Place::new();
    place.done("animate cross.toml -o f.#.png --frames 3 -q");
    let whole = place.read("f.1.png");
    place.write("f.1.png", &whole[..whole.len() - 5]);
    let again = place.done("animate cross.toml -o f.#.png --frames 3 --resume");
    assert!(again.err.contains("1 frame (2 more were there)"), "{}", again.err);
    assert_eq!(place.read("f.1.png"), whole);
    place.write("cross.toml", CROSS.replace("#3060d0", "#30d060"));
    let other = place.done("animate cross.toml -o f.#.png --frames 3 --resume");
    assert!(other.err.contains(": 3 frames,"), "{}", other.err);
    assert_ne!(place.read("f.1.png"), whole);
}

#[test]
fn finished_frames_are_assembled_to_the_bytes_of_rendering_straight_to_a_file() {
    let place = Place::new();
    place.done("animate cross.toml -o frames --frames 5 --fps 12");
    for name in ["turn.gif", "turn.png", "turn.y4m"] {
        place.done(&format!("animate cross.toml -o a.{name} --frames 5 --fps 12"));
        place.done(&format!("assemble frames -o b.{name}"));
        assert!(place.read(&format!("a.{name}")) == place.read(&format!("b.{name}")), "{name}");
    }
    place.refused("assemble frames -o frames/frame.0001.png", 2, &["frame.0001.png"]);
    fs::remove_file(place.path("frames/frame.0003.png")).unwrap();
    place.refused("assemble frames -o c.gif", 1, &["1 of 5", "frame.0003.png", "--resume"]);
    place.refused("assemble . -o c.gif", 1, &["no manifest"]);
}

#[test]
fn a_pipe_is_fed_with_video_and_nothing_else() {
    let place = Place::new();
    let mut child = command(&place, "animate cross.toml -o - --frames 3");
    let output = child.stdout(Stdio::piped()).output().unwrap();
    let header = b"YUV4MPEG2 W48 H40 F24:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    assert!(output.status.success() && output.stdout.starts_with(header));
    assert_eq!(output.stdout.len(), header.len() + 3 * (6 + 3 * 48 * 40));
}

#[test]
fn what_cannot_be_made_is_refused_before_any_frame() {
    let place = Place::new();
    let refused = |words: &str, code, said: &[&str]| {
        place.refused(&format!("animate cross.toml {words}"), code, said);
    };
    refused("", 2, &["-o DIR", ".gif"]);
    refused("-o a.avi", 2, &["a.avi", ".mp4"]);
    refused("-o a.##.exr", 2, &["PNG"]);
    refused("-o a.gif --resume", 2, &["--resume", "assemble"]);
    refused("-o a.gif --shard 1/2", 2, &["--shard", "assemble"]);
    refused("-o a.gif --frames 0", 2, &["--frames", "1 to 1000000"]);
    refused("-o a.gif --frames 0..90", 2, &["FROM..TOxSTEP"]);
    refused("-o a.gif --fps 0", 2, &["--fps", "29.97"]);
    refused("-o a.gif --rays b.png", 2, &["--rays"]);
    refused("-o nowhere/a.gif", 1, &["make it first"]);
    refused("-o no/where/a.##.png", 1, &["make it first"]);
    let tracks = |track: &str, said: &[&str]| {
        let animate =
            format!("surface = {{ color = \"#3060d0\" }}\nanimate = {{ tracks = [{track}] }}");
        let text = CROSS.replace("surface = { color = \"#3060d0\" }", &animate);
        place.write("cross.toml", text);
        refused("-o a.gif", 1, said);
        place.write("cross.toml", CROSS);
    };
    tracks("{ key = \"surface.opacty\", to = [0, 1] }", &["frame 0 of 72", "opacity"]);
    tracks("{ key = \"surface.opacity\", to = [0, 2] }", &["frame 37 of 72", "opacity"]);
    tracks("{ key = \"surface.opacity\", to = [0, 1], at = [0] }", &["cross.toml:", "2 values"]);
    tracks("{ key = \"opacity\", to = [0, 1] }", &["cross.toml:", "COMPONENT.KEY"]);
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::PermissionsExt;

    use super::*;

    /// A program called `ffmpeg` that knows its encoders, takes a little, says why and ends.
    const FAILING: &str = "#!/bin/sh\ncase \"$*\" in *-encoders*) echo libx264;; *) head -c 9000 >/dev/null; echo 'out of luck' >&2; exit 7;; esac\n";

    #[test]
    fn a_video_needs_ffmpeg_and_says_how_far_it_got_when_that_dies() {
        let place = Place::new();
        let words = "animate cross.toml -o a.mp4 --frames 200";
        let run = |path: &std::path::Path| {
            let mut command = command(&place, words);
            let output = command.env("PATH", path).stderr(Stdio::piped()).output().unwrap();
            (output.status.code(), String::from_utf8(output.stderr).unwrap())
        };
        let (code, said) = run(&place.path(""));
        assert!(
            code == Some(1) && said.contains("install it") && !said.contains("frame 0"),
            "{said}"
        );
        let program = place.path("ffmpeg");
        fs::write(&program, FAILING).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let path = format!("{}:/usr/bin:/bin", place.path("").display());
        let (code, said) = run(std::path::Path::new(&path));
        assert!(code == Some(1) && said.contains("out of luck"), "{said}");
        assert!(said.contains("of 200 frames were rendered"), "{said}");
        assert_eq!(place.names(), ["cross.toml", "ffmpeg"]);
    }

    #[test]
    fn an_interrupt_leaves_whole_frames_and_no_part_of_an_animation() {
        let place = Place::new();
        let interrupted = |out: &str, seen: &str| {
            let words = format!("animate head --size 64x64 --frames 500 -t 1 -o {out}");
            let mut child = command(&place, &words).stderr(Stdio::piped()).spawn().unwrap();
            let mut lines = std::io::BufReader::new(child.stderr.take().unwrap());
            let mut said = String::new();
            while !said.contains(seen) {
                assert!(std::io::BufRead::read_line(&mut lines, &mut said).unwrap() > 0, "{said}");
            }
            let id = child.id().to_string();
            assert!(Command::new("kill").args(["-TERM", &id]).status().unwrap().success());
            std::io::Read::read_to_string(&mut lines, &mut said).unwrap();
            assert_eq!(child.wait().unwrap().code(), Some(130), "{said}");
            said
        };
        let said = interrupted("frames", "frame 5 of");
        assert!(said.contains("--resume goes on"), "{said}");
        let files = folder(&place, "frames");
        assert!(files.len() > 5 && files.len() < 500);
        let names = fs::read_dir(place.path("frames")).unwrap().count();
        assert_eq!(names, files.len(), "no hidden part of a frame");
        interrupted("a.gif", "frame 5 of");
        assert_eq!(place.names(), ["cross.toml", "frames"]);
    }

    #[test]
    fn a_full_disc_is_an_error_that_says_how_far_it_got() {
        let Ok(full) = fs::OpenOptions::new().write(true).open("/dev/full") else { return };
        let place = Place::new();
        let mut command = command(&place, "animate cross.toml -o - --frames 20");
        let output = command.stdout(full).stderr(Stdio::piped()).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("standard output") && said.contains("of 20 frames"), "{said}");
    }
}
