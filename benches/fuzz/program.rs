//! The real program on scenes and command lines that nobody means.

use std::path::Path;
use std::process::{Command, Stdio};

use super::random::Random;
use super::scenes;

const WORDS: [&str; 16] = [
    "--size",
    "9x9",
    "0x0",
    "--exact",
    "-t",
    "2",
    "--stats",
    "a.json",
    "--rays",
    "r.png",
    "-q",
    "-v",
    "--max-memory",
    "1K",
    "--data",
    ".",
];

const OUTPUTS: [&str; 5] = ["a.png", "a.exr", "a.npy", "a.xyz", "s.toml"];

/// One run of the program; whether it did what it was asked, or what is wrong with how it failed.
pub fn run(random: &mut Random, folder: &Path) -> Result<bool, String> {
    let folder = folder.join("program");
    let _ = std::fs::remove_dir_all(&folder);
    let told = |error: std::io::Error| error.to_string();
    std::fs::create_dir(&folder).map_err(told)?;
    std::fs::write(folder.join("v.raw"), [7; 64]).map_err(told)?;
    let (text, changes) = scenes::stated(random);
    std::fs::write(folder.join("s.toml"), text).map_err(told)?;
    let mut words = vec![(*random.of(&["render", "render", "plan", "info", "compare"])).to_owned()];
    words.push("s.toml".to_owned());
    words.push("-o".to_owned());
    words.push((*random.of(&OUTPUTS)).to_owned());
    words.extend(changes.into_iter().map(|change| format!("--set={change}")));
    words.extend((0..random.below(4)).map(|_| (*random.of(&WORDS)).to_owned()));
    let output = Command::new(env!("CARGO_BIN_EXE_gelray"))
        .args(&words)
        .current_dir(&folder)
        .stdin(Stdio::null())
        .output()
        .map_err(told)?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let fault = |what: &str| Err(format!("{what}: {words:?}: {said}"));
    let left = std::fs::read_dir(&folder).map_err(told)?.flatten();
    if left.into_iter().any(|entry| entry.file_name().to_string_lossy().starts_with('.')) {
        return fault("a hidden file is left");
    }
    match output.status.code() {
        Some(0) => Ok(true),
        Some(1 | 2) if said.contains("panicked") => fault("panic"),
        Some(1 | 2) if said.contains("error: ") => Ok(false),
        Some(1 | 2) => fault("no sentence"),
        code => fault(&format!("exit code {code:?}")),
    }
}
