//! Files of volumes and of pictures, a few bytes beside sound ones.

use std::path::{Path, PathBuf};

use gelray::formats::pictures::{Notes, write_picture};
use gelray::formats::{Stated, Voxels, read_picture, read_volume, survey};
use gelray::view::picture::Picture;

use super::made::{gzip, map, nifti, put, zarr};
use super::random::Random;

/// A volume of some format, read; whether it was taken, or what does not hold together.
pub fn volume(random: &mut Random, folder: &Path) -> Result<bool, String> {
    let (path, name) = written(random, folder).map_err(|error| error.to_string())?;
    let stated = Stated {
        size: (random.below(2) == 0).then(|| [random.below(5), random.below(5), 2]),
        voxel_type: (random.below(2) == 0).then(|| "int16".to_owned()),
        endian: (random.below(2) == 0).then(|| "big".to_owned()),
        spacing_mm: (random.below(4) == 0).then(|| [1.0, f64::from_bits(random.bits()), -2.0]),
        ..Stated::default()
    };
    let surveyed = survey(&path, &stated);
    let Ok(loaded) = read_volume(&path, &stated) else { return Ok(false) };
    let count = match &loaded.voxels {
        Voxels::Scalars(scalars) => scalars.len(),
        Voxels::Painted(painted) => painted.len(),
    };
    if count != loaded.grid.voxels() || !loaded.grid.corners().iter().all(|c| c.is_finite()) {
        return Err(format!("{name} was taken with {count} voxels of {:?}", loaded.grid));
    }
    surveyed.map(|_| true).map_err(|error| format!("{name} was read and not surveyed: {error}"))
}

/// A file or a folder of some format, damaged, and its name.
fn written(random: &mut Random, folder: &Path) -> std::io::Result<(PathBuf, &'static str)> {
    if random.below(4) > 0 {
        let (name, bytes) = sound(random);
        let path = folder.join(name);
        std::fs::write(&path, random.mutated(bytes))?;
        return Ok((path, name));
    }
    let mut arrays = zarr();
    let (name, mut files) = arrays.swap_remove(random.below(arrays.len()));
    let damaged = random.below(2);
    files[damaged].1 = random.mutated(std::mem::take(&mut files[damaged].1));
    let path = folder.join(name);
    put(&path, &files)?;
    Ok((path, name))
}

/// A picture of some format, read.
pub fn picture(random: &mut Random, folder: &Path) -> Result<bool, String> {
    let name = *random.of(&["a.png", "a.exr", "a.tiff", "a.npy", "a.jpg"]);
    let path = folder.join(name);
    let notes: &Notes = &[("note".to_owned(), "text".to_owned())];
    let pixels = (0..35).map(|i| [0.1, 0.02 * i as f32, 0.5, 1.0]).collect();
    let picture = Picture::new([7, 5], pixels).ok_or("no picture")?;
    let mut bytes = vec![0xff, 0xd8, 0xff, 0xe0, 0, 16, b'J', b'F', b'I', b'F', 0];
    if name != "a.jpg" {
        write_picture(&path, &picture, notes).map_err(|error| error.to_string())?;
        bytes = std::fs::read(&path).map_err(|error| error.to_string())?;
    }
    std::fs::write(&path, random.mutated(bytes)).map_err(|error| error.to_string())?;
    let Ok(read) = read_picture(&path) else { return Ok(false) };
    let [width, height] = read.size;
    if read.pixels.len() == width * height {
        Ok(true)
    } else {
        Err(format!("{name}: {width} × {height}"))
    }
}

/// A sound file of some format.
fn sound(random: &mut Random) -> (&'static str, Vec<u8>) {
    let short = "type: short\ndimension: 3\nsizes: 2 3 2\nspace: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,2)\nspace origin: (0,0,0)\nendian: big\n";
    let start = format!("NRRD0005\n{short}");
    match random.below(7) {
        0 => ("a.nrrd", [start.as_bytes(), b"encoding: raw\n\n", &[1; 24]].concat()),
        1 => ("b.nrrd", [start.as_bytes(), b"encoding: gzip\n\n", &gzip(&[1; 24])].concat()),
        2 => ("c.nrrd", format!("{start}encoding: ascii\n\n{}", "-12 ".repeat(12)).into_bytes()),
        3 => ("d.nii", nifti()),
        4 => ("e.nii.gz", gzip(&nifti())),
        5 => ("f.map", map()),
        _ => ("g.raw", vec![1; 24]),
    }
}
