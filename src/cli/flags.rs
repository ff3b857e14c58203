//! The flags: they mean the same for every verb, and one that a verb has no use for is refused rather than ignored.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser};
use gelray::components::Preset;
use gelray::formats::Stated;

use super::bytes;
use super::failure::Failure;
use super::limit::Limit;
use super::memory;
use super::raw_header::RawHeader;

/// All flags of all verbs.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Flags")]
pub struct Flags {
    /// The file to write; its extension says the format (.png .exr .tiff .npy .jpg .webp); - is standard output (a PNG)
    #[arg(short, long, value_name = "OUT", global = true)]
    pub output: Option<PathBuf>,
    /// Pixels across and down, in place of the scene's
    #[arg(long, value_name = "WxH", global = true, value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// Changes the scene: head.classify.iso.0.value=1200 (repeatable)
    #[arg(long, value_name = "ENTITY.COMPONENT.KEY=VALUE", global = true)]
    pub set: Vec<String>,
    /// Of a volume without a scene: draws the surface of this value
    #[arg(long, value_name = "VALUE", global = true, allow_hyphen_values = true, value_parser = value)]
    pub iso: Option<f32>,
    /// Of a volume without a scene: draws it by a classification of that name
    #[arg(long, value_name = "NAME", global = true, conflicts_with = "iso", value_parser = Preset::named)]
    pub preset: Option<Preset>,
    /// Of a volume without a scene: writes the scene that was made for it
    #[arg(long, value_name = "FILE.toml", global = true)]
    pub save_scene: Option<PathBuf>,
    /// A folder to look for data in, before those of GELRAY_DATA (repeatable)
    #[arg(long, value_name = "DIR", global = true, value_parser = OsStringValueParser::new().try_map(folder))]
    pub data: Vec<PathBuf>,
    /// How many threads compute [default: one a core]
    #[arg(short, long, value_name = "N", global = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// No skipping, no stopping, a ray at every position, 32-bit texels
    #[arg(long, global = true)]
    pub exact: bool,
    /// Writes counts, bytes and seconds
    #[arg(long, value_name = "FILE.json", global = true)]
    pub stats: Option<PathBuf>,
    /// Writes spans for chrome://tracing or ui.perfetto.dev
    #[arg(long, value_name = "FILE.json", global = true)]
    pub trace: Option<PathBuf>,
    /// Writes where rays were cast, 4 × 4 positions a pixel
    #[arg(long, value_name = "FILE.png", global = true, value_parser = OsStringValueParser::new().try_map(png))]
    pub rays: Option<PathBuf>,
    /// Writes what each pixel shows first: depth, normal and entity (.exr or .npy)
    #[arg(long, value_name = "FILE", global = true, value_parser = OsStringValueParser::new().try_map(layers))]
    pub maps: Option<PathBuf>,
    /// Refuses to begin if the plan needs more bytes (8G, 512M)
    #[arg(long, value_name = "BYTES", global = true, value_parser = bytes::parse)]
    pub max_memory: Option<u64>,
    /// Fails where the images are less alike, in linear light: psnr=40 or ssim=0.99 (repeatable)
    #[arg(long, value_name = "MEASURE=NUMBER", global = true, value_parser = Limit::parse)]
    pub fail_below: Vec<Limit>,
    /// The header that a raw file lacks: 256x256x113,uint16,little[,1x1x2]: voxels, type, byte order, spacing in mm
    #[arg(long, value_name = "HEADER", global = true, value_parser = RawHeader::parse)]
    pub raw: Option<RawHeader>,
    /// Of a volume of several channels without a scene (Zarr): which is read, 0 the first
    #[arg(long, value_name = "N", global = true)]
    pub channel: Option<usize>,
    /// Of a volume of several times without a scene (Zarr, NIfTI): which is read, 0 the first
    #[arg(long, value_name = "N", global = true)]
    pub time: Option<usize>,
    /// Says nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Says more
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

/// The flags that not every verb has a use for.
pub const FOR_SOME: [&str; 16] = [
    "--output",
    "--size",
    "--set",
    "--iso",
    "--preset",
    "--save-scene",
    "--exact",
    "--stats",
    "--trace",
    "--rays",
    "--maps",
    "--max-memory",
    "--fail-below",
    "--raw",
    "--channel",
    "--time",
];

impl Flags {
    /// Refuses the first flag that was given and that the verb does not take; `--data`, `-t`, `-q` and `-v` are for all.
    pub fn refuse_others(&self, verb: &str, takes: &[&str]) -> Result<(), Failure> {
        let given = [
            self.output.is_some(),
            self.size.is_some(),
            !self.set.is_empty(),
            self.iso.is_some(),
            self.preset.is_some(),
            self.save_scene.is_some(),
            self.exact,
            self.stats.is_some(),
            self.trace.is_some(),
            self.rays.is_some(),
            self.maps.is_some(),
            self.max_memory.is_some(),
            !self.fail_below.is_empty(),
            self.raw.is_some(),
            self.channel.is_some(),
            self.time.is_some(),
        ];
        let mut flags = FOR_SOME.iter().zip(given);
        match flags.find(|(flag, given)| *given && !takes.contains(flag)) {
            Some((flag, _)) => Err(Failure::Misused(format!(
                "`gelray {verb}` has no use for {flag}; leave it away"
            ))),
            None => Ok(()),
        }
    }

    /// What is said of a volume that comes without a scene, as a scene's `volume` would.
    pub fn stated(&self) -> Stated {
        let header = self.raw.as_ref().map(|RawHeader(stated)| stated.clone());
        Stated { channel: self.channel, time: self.time, ..header.unwrap_or_default() }
    }

    /// The first flag that was given of those for a volume without a scene.
    pub fn for_volumes(&self) -> Option<&'static str> {
        let given = [
            ("--iso", self.iso.is_some()),
            ("--preset", self.preset.is_some()),
            ("--channel", self.channel.is_some()),
            ("--time", self.time.is_some()),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(flag, _)| flag)
    }

    /// Every file that is to be written, with the flag that names it.
    pub fn outputs(&self) -> Vec<(&'static str, &Path)> {
        let named = [
            ("--output", &self.output),
            ("--save-scene", &self.save_scene),
            ("--stats", &self.stats),
            ("--trace", &self.trace),
            ("--rays", &self.rays),
            ("--maps", &self.maps),
        ];
        named.into_iter().filter_map(|(flag, path)| Some((flag, path.as_deref()?))).collect()
    }

    /// The folders of data, in the order in which they are looked through.
    pub fn data_folders(&self) -> Vec<PathBuf> {
        let variable = std::env::var_os("GELRAY_DATA").unwrap_or_default();
        let folders = std::env::split_paths(&variable).filter(|path| !path.as_os_str().is_empty());
        self.data.iter().cloned().chain(folders).collect()
    }

    /// Makes the threads that compute: here, where a failure is a sentence, and not where they are first used.
    pub fn set_threads(&self) -> Result<(), Failure> {
        let stated = self.threads.map_or(0, usize::from);
        let available = || std::thread::available_parallelism().map_or(1, usize::from);
        let number = if stated == 0 { available() } else { stated };
        let mut pool = rayon::ThreadPoolBuilder::new().num_threads(stated);
        if let Some(bytes) = memory::stack(number)? {
            pool = pool.stack_size(bytes);
        }
        pool.thread_name(|number| format!("thread {number}")).build_global().map_err(|error| {
            Failure::Said(format!(
                "the threads that compute cannot be made ({error}); ask for fewer with --threads, or raise the limits of the system (`ulimit -u`, `ulimit -v`)"
            ))
        })?;
        Ok(())
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |side: &str| side.parse().ok().filter(|side| (1..=16384).contains(side));
    let sides = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([side(w)?, side(h)?]));
    sides.ok_or_else(|| {
        "pixels across and down are expected, each 1 to 16384, such as 380x380".to_owned()
    })
}

fn value(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|number: &f32| number.is_finite());
    number.ok_or_else(|| "a value of the volume is expected, such as 300".to_owned())
}

fn folder(text: OsString) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if path.is_dir() {
        Ok(path)
    } else {
        Err("there is no such folder; name one that is there".to_owned())
    }
}

fn layers(text: OsString) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(end) if end.eq_ignore_ascii_case("exr") || end.eq_ignore_ascii_case("npy") => Ok(path),
        _ => Err("the maps are floats; give them a name that ends in .exr or .npy".to_owned()),
    }
}

fn png(text: OsString) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(end) if end.eq_ignore_ascii_case("png") => Ok(path),
        _ => Err("the map of rays is a PNG; give it a name that ends in .png".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_has_two_sides_of_1_to_16384_pixels() {
        assert_eq!(size("380x240"), Ok([380, 240]));
        assert_eq!(size("1×16384"), Ok([1, 16384]));
        for text in
            ["", "380", "0x10", "10x0", "10x16385", "-1x5", "3.5x2", "1x2x3", "99999999999x1"]
        {
            assert!(size(text).is_err(), "{text}");
        }
    }
}
