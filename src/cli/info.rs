//! `gelray info`: what a volume holds, where it lies, how its values are spread, and isovalues worth a contour.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use gelray::formats::meshes::mesh_format;
use gelray::formats::pictures::format_of;
use gelray::formats::{Loaded, Stated, Voxels, is_headerless, is_volume, read_volume, survey};
use gelray::measure::histogram::{Histogram, histogram, suggested_isovalues};
use gelray::measure::sigma::sigma;
use gelray::phantom::{most_bytes, phantom};
use gelray::volume::grid::{Grid, Painted, Scalars};
use glam::DVec3;

use super::bytes::human;
use super::failure::{Failure, tell};
use super::flags::Flags;
use super::number::number;
use super::sentence::DATA;
use super::table::table;
use super::{info_mesh, info_picture, memory, outputs};

/// Bins of the histogram that is printed.
const BINS: usize = 24;

/// Letters of the longest bar.
const BAR: f64 = 40.0;

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--output", "--raw", "--channel", "--time"];

/// Prints what a file (or `phantom:NAME`) holds.
pub fn run(file: &OsStr, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("info", TAKES)?;
    let path = find(file, flags);
    outputs::check(flags, &[&path])?;
    if format_of(&path).is_some_and(|format| format.read.is_some()) && !is_volume(&path) {
        refuse_choices("a picture", flags)?;
        return outputs::print_or_write(&info_picture::words(&path, flags)?, flags);
    }
    if mesh_format(&path).is_some() && path.is_file() {
        refuse_choices("a mesh", flags)?;
        return outputs::print_or_write(&info_mesh::words(&path, flags.quiet)?, flags);
    }
    let name = file.to_string_lossy();
    let phantom_name = name.strip_prefix("phantom:");
    if phantom_name.is_none() && !path.exists() {
        let path = path.display();
        return Err(Failure::Said(format!("{path}: no such file; correct the path ({DATA})")));
    }
    let loaded = match phantom_name {
        Some(name) => {
            refuse_choices("a phantom", flags)?;
            memory::check(most_bytes(name.trim()), flags.max_memory)?;
            phantom(name.trim()).map_err(Failure::Said)?
        }
        None => read(&path, flags)?,
    };
    for warning in loaded.warnings.iter().filter(|_| !flags.quiet) {
        tell(format_args!("warning: {warning}"));
    }
    outputs::print_or_write(&words(&name, &loaded), flags)
}

/// Refuses what only a volume of a file has a use for.
fn refuse_choices(what: &str, flags: &Flags) -> Result<(), Failure> {
    match flags.for_volumes() {
        Some(flag) => Err(Failure::Misused(format!(
            "{flag} is for volumes of several channels or times, and {what} is none; leave it away"
        ))),
        None => Ok(()),
    }
}

/// The volume of a file; that of one without a header with the header that `--raw` states.
fn read(path: &Path, flags: &Flags) -> Result<Loaded, Failure> {
    let asked = || {
        let remedy = "state its header, such as --raw 256x256x113,uint16,little";
        Failure::Said(format!("{}: has no header; {remedy}", path.display()))
    };
    if flags.raw.is_none() && is_headerless(path) && path.is_file() {
        return Err(asked());
    }
    within(path, &flags.stated(), flags)
}

/// The volume of a file, if it is not more than memory may hold.
pub fn within(path: &Path, stated: &Stated, flags: &Flags) -> Result<Loaded, Failure> {
    let found = survey(path, stated)?;
    memory::check(found.bytes, flags.max_memory)?;
    outputs::spare(flags, &found.files)?;
    Ok(read_volume(path, stated)?)
}

/// The file as given, or the first of that name in the folders of data.
pub fn find(file: &OsStr, flags: &Flags) -> PathBuf {
    let given = PathBuf::from(file);
    let elsewhere = || {
        flags.data_folders().into_iter().map(|folder| folder.join(file)).find(|path| path.exists())
    };
    if given.exists() { given } else { elsewhere().unwrap_or(given) }
}

fn words(file: &str, loaded: &Loaded) -> String {
    let mut rows = vec![["file".to_owned(), file.to_owned()]];
    rows.extend(header(&loaded.grid, &loaded.voxels).map(|(name, text)| [name.to_owned(), text]));
    let mut bars = String::new();
    match &loaded.voxels {
        Voxels::Scalars(scalars) => {
            let counted = histogram(scalars, BINS);
            rows.extend(values(scalars, &counted).map(|(name, text)| [name.to_owned(), text]));
            bars = self::bars(&counted);
        }
        Voxels::Painted(painted) => {
            let opaque = opaque(painted);
            let text = format!("{opaque} of {} voxels have an opacity above 0", painted.len());
            rows.push(["opacity".to_owned(), text]);
        }
    }
    table(&rows, &[]) + &bars
}

fn header(grid: &Grid, voxels: &Voxels) -> [(&'static str, String); 5] {
    let [x, y, z] = grid.size;
    let (kind, bytes) = match voxels {
        Voxels::Scalars(scalars) => (scalar_type(scalars), scalars.bytes()),
        Voxels::Painted(painted) => (painted_type(painted), painted.bytes()),
    };
    let corners = grid.corners();
    let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    [
        ("voxels", format!("{x} × {y} × {z} of {kind}, {}", human(bytes))),
        ("spacing", point(grid.spacing())),
        ("axes", axes(grid)),
        ("first voxel", format!("at {}", point(corners[0]))),
        ("extent", format!("{} to {}", point(low), point(high))),
    ]
}

/// Which way each index runs through the world, and what that is in a patient (world axes are left, posterior, superior).
fn axes(grid: &Grid) -> String {
    let matrix = grid.index_to_world.matrix3;
    let mut letters = String::new();
    let mut ways = Vec::new();
    for (name, column) in
        ["i", "j", "k"].into_iter().zip([matrix.x_axis, matrix.y_axis, matrix.z_axis])
    {
        let way = column.normalize();
        let axis = way.abs().max_position();
        let positive = way[axis] > 0.0;
        letters.push([['R', 'L'], ['A', 'P'], ['I', 'S']][axis][usize::from(positive)]);
        let sign = if positive { '+' } else { '−' };
        let along = format!("{name} {sign}{}", ["x", "y", "z"][axis]);
        // A thousandth of a turn off its axis is a way of its own.
        let oblique = way[axis].abs() < 0.999_98;
        ways.push(if oblique { format!("{along} (along {})", point(way)) } else { along });
    }
    format!("{} ({letters} in a patient)", ways.join(", "))
}

fn values(scalars: &Scalars, counted: &Histogram) -> [(&'static str, String); 4] {
    let spread = sigma(scalars).map_or_else(
        || "there is no finite value".to_owned(),
        |found| format!("{} σ {}", number(found.mean), number(found.deviation)),
    );
    let isovalues: Vec<_> =
        suggested_isovalues(scalars).iter().map(|v| number(f64::from(*v))).collect();
    let isovalues = if isovalues.is_empty() { "none".to_owned() } else { isovalues.join(", ") };
    let range =
        format!("{} to {}", number(f64::from(counted.low)), number(f64::from(counted.high)));
    [
        ("values", range),
        ("not finite", format!("{} NaN, {} infinite", counted.nan, counted.infinite)),
        ("mean", spread),
        ("isovalues", format!("{isovalues} (suggested, the most striking first)")),
    ]
}

/// The histogram, a bin a line: the value in its middle, a bar in proportion to the logarithm, the count.
fn bars(counted: &Histogram) -> String {
    let length = |count: u64| ((count + 1) as f64).log2();
    let longest = counted.counts.iter().map(|&count| length(count)).fold(1.0, f64::max);
    let row = |(bin, &count): (usize, &u64)| {
        let letters = (length(count) / longest * BAR).round() as usize;
        [number(f64::from(counted.center(bin))), "█".repeat(letters), count.to_string()]
    };
    let mut rows = vec![["value", "log₂ of the number of voxels", "voxels"].map(str::to_owned)];
    rows.extend(counted.counts.iter().enumerate().map(row));
    format!("\n{}", table(&rows, &[0, 2]))
}

fn opaque(painted: &Painted) -> usize {
    match painted {
        Painted::U8(values) => values.iter().filter(|rgba| rgba[3] > 0).count(),
        Painted::U16(values) => values.iter().filter(|rgba| rgba[3] > 0).count(),
        Painted::F32(values) => values.iter().filter(|rgba| rgba[3] > 0.0).count(),
    }
}

fn point(p: DVec3) -> String {
    format!("({}, {}, {})", number(p.x), number(p.y), number(p.z))
}

fn scalar_type(scalars: &Scalars) -> &'static str {
    match scalars {
        Scalars::U8(_) => "uint8",
        Scalars::I8(_) => "int8",
        Scalars::U16(_) => "uint16",
        Scalars::I16(_) => "int16",
        Scalars::U32(_) => "uint32",
        Scalars::I32(_) => "int32",
        Scalars::U64(_) => "uint64",
        Scalars::I64(_) => "int64",
        Scalars::F32(_) => "float",
        Scalars::F64(_) => "double",
    }
}

fn painted_type(painted: &Painted) -> &'static str {
    match painted {
        Painted::U8(_) => "RGBA uint8",
        Painted::U16(_) => "RGBA uint16",
        Painted::F32(_) => "RGBA float",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits_and_no_idle_zeros() {
        let read =
            [0.0, -0.0, 1.0, 0.5, -127.5, 3272.0, 113.062_5, 1e-9, 123_456_789.0, 1e12, f64::NAN]
                .map(number);
        let expected = [
            "0",
            "0",
            "1",
            "0.5",
            "-127.5",
            "3272",
            "113.062",
            "1.0000e-9",
            "123456789",
            "1.0000e12",
            "NaN",
        ];
        assert_eq!(read, expected);
    }

    #[test]
    fn axes_are_named_by_the_way_they_run() {
        let grid = Grid::axis_aligned([2; 3], [-1.0, 1.0, 2.0], [0.0; 3]).unwrap();
        assert_eq!(axes(&grid), "i −x, j +y, k +z (RPS in a patient)");
    }
}
