//! What a verb is to draw: a scene by its file or name, or a volume that comes without one.

use std::ffi::OsStr;
use std::path::Path;

use gelray::formats::is_volume;
use gelray::formats::meshes::mesh_format;
use gelray::scene::{EMBEDDED, Scene, Source, Wish, first_contact};

use super::failure::{Failure, tell};
use super::flags::Flags;

/// The scene of an argument; without one, the first that is part of the program; for a volume, one that is made for it.
pub fn open(argument: Option<&OsStr>, flags: &Flags) -> Result<Source, Failure> {
    let argument = argument.unwrap_or(OsStr::new(EMBEDDED[0].0));
    let path = Path::new(argument);
    if !is_without_scene(path) {
        refuse(flags)?;
        return Ok(Source::open(argument)?);
    }
    if let Some(flag) = flags.for_volumes().filter(|_| mesh_format(path).is_some()) {
        return Err(Failure::Misused(format!(
            "{flag} is for volumes, and a mesh has its surface already; leave it away"
        )));
    }
    let wish = Wish {
        iso: flags.iso,
        preset: flags.preset,
        size: flags.size,
        channel: flags.channel,
        time: flags.time,
        most_bytes: flags.max_memory,
    };
    let (source, said) = first_contact(path, &wish)?;
    if !flags.quiet {
        let guessed = mesh_format(path).is_none() && flags.iso.is_none() && flags.preset.is_none();
        let more = if guessed { "; another look is --preset NAME or --iso VALUE" } else { "" };
        tell(format_args!("{said}{more}"));
    }
    Ok(source)
}

/// Whether the argument is a volume, a folder of one, or a mesh; a bare word may be an embedded scene's name first.
fn is_without_scene(path: &Path) -> bool {
    let embedded = EMBEDDED.iter().any(|(name, _)| path.as_os_str() == *name);
    let mesh = mesh_format(path).is_some() && path.is_file();
    is_volume(path) || mesh || (path.is_dir() && !embedded)
}

/// Refuses flags that make a scene where there is one.
fn refuse(flags: &Flags) -> Result<(), Failure> {
    let saved = flags.save_scene.as_ref().map(|_| "--save-scene");
    let Some(flag) = flags.for_volumes().or(saved) else { return Ok(()) };
    let key = match flag {
        "--channel" => "volume.channel=1",
        "--time" => "volume.time=1",
        _ => "classify.KEY=VALUE",
    };
    Err(Failure::Misused(format!(
        "{flag} is for a volume that is named in place of a scene; change a scene with --set ENTITY.{key}"
    )))
}

/// The scene that was made, with the paths in it as they lead there from the folder of the file that is to hold it.
pub fn saved(path: &Path, scene: &Scene) -> String {
    let text = scene.resolved.clone();
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    // A volume is named by one of its files, or by a folder that they are in.
    let mut named = scene.files.iter().flat_map(|file| file.ancestors());
    folder.and_then(|_| named.find_map(|path| absolute(&text, path))).unwrap_or(text)
}

/// The scene with the volume's path from the root; `None` where it is not written as it was made.
fn absolute(text: &str, path: &Path) -> Option<String> {
    let line = |path: &Path| format!("file = {}", toml::Value::from(path.display().to_string()));
    let given = line(path.strip_prefix("./").unwrap_or(path));
    let made = text.contains(&given);
    made.then(|| path.canonicalize().ok()).flatten().map(|full| text.replace(&given, &line(&full)))
}
