//! The real program: exit codes, sentences, files that appear whole or not at all, equal bytes.

#[path = "program/animate.rs"]
mod animate;
#[path = "program/bad_input.rs"]
mod bad_input;
#[path = "program/contact.rs"]
mod contact;
#[path = "program/estimated.rs"]
mod estimated;
#[path = "program/fuzzed.rs"]
mod fuzzed;
#[path = "program/inquiries.rs"]
mod inquiries;
#[path = "program/interrupted.rs"]
mod interrupted;
#[path = "program/limits.rs"]
mod limits;
#[path = "program/maps.rs"]
mod maps;
#[path = "program/misuse.rs"]
mod misuse;
#[path = "program/planned.rs"]
mod planned;
#[path = "program/profile.rs"]
mod profile;
#[path = "program/progressive.rs"]
mod progressive;
#[path = "../benches/fuzz/random.rs"]
mod random;
#[path = "program/render.rs"]
mod render;
#[path = "program/report.rs"]
mod report;
#[path = "../benches/fuzz/scenes.rs"]
mod scenes;
#[path = "program/sentences.rs"]
mod sentences;
#[path = "program/spared.rs"]
mod spared;
#[path = "program/surfaces.rs"]
mod surfaces;
#[path = "program/targeted.rs"]
mod targeted;
#[path = "program/trade.rs"]
mod trade;

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// Two polygons that cross, one of them translucent: whatever becomes of volumes, this is seen.
const CROSS: &str = r##"# Two polygons that cross.
[[entity]]
name = "red"
polygon = { vertices = [[-10, 0, -10], [10, 0, -10], [10, 0, 10], [-10, 0, 10]] }
surface = { color = "#d03030", opacity = 0.5 }

[[entity]]
name = "blue"
polygon = { vertices = [[0, -10, -10], [0, 10, -10], [0, 10, 10], [0, -10, 10]] }
surface = { color = "#3060d0" }

[[entity]]
name = "observer"
view = { azimuth = 30, elevation = 20, size = [48, 40] }
"##;

/// What a run of the program left: its exit code, standard output and standard error.
struct Ran {
    code: i32,
    out: String,
    err: String,
}

/// A folder of its own, and the program run in it.
struct Place(TempDir);

impl Place {
    /// A folder with the scene of two polygons in `cross.toml`.
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        place.write("cross.toml", CROSS);
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).unwrap();
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.read(name)).unwrap()
    }

    /// Names of all files, hidden ones too, in order.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs the program with words separated by blanks, in this folder.
    fn run(&self, words: &str) -> Ran {
        self.run_with_data(words, None)
    }

    fn run_with_data(&self, words: &str, data: Option<&Path>) -> Ran {
        let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_gelray"));
        command.current_dir(self.0.path()).args(words.split_whitespace()).env_remove("GELRAY_DATA");
        if let Some(data) = data {
            command.env("GELRAY_DATA", data);
        }
        let output = command.output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let code = output.status.code().unwrap();
        Ran { code, out: text(output.stdout), err: text(output.stderr) }
    }

    /// Runs the program, which must succeed.
    fn done(&self, words: &str) -> Ran {
        let ran = self.run(words);
        assert_eq!(ran.code, 0, "{words}: {}", ran.err);
        ran
    }

    /// Runs the program, which must fail with that code, say all of those words in one sentence, and leave no file.
    fn refused(&self, words: &str, code: i32, said: &[&str]) {
        let before = self.names();
        let ran = self.run(words);
        assert_eq!(ran.code, code, "{words}: {}", ran.err);
        assert!(said.iter().all(|part| ran.err.contains(part)), "{words}: {}", ran.err);
        assert_eq!((ran.out.as_str(), self.names()), ("", before), "{words}");
    }
}

/// A NRRD of 6 × 5 × 4 bytes: a brighter block within zeros.
fn small_nrrd() -> Vec<u8> {
    let header =
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 5 4\nspacings: 2 2 3\nencoding: raw\n\n";
    let inside = |i: usize| (1..5).contains(&(i % 6)) && (1..4).contains(&(i / 6 % 5));
    let voxels = (0..120).map(|i| if inside(i) { 200 } else { 0 });
    header.bytes().chain(voxels).collect()
}
