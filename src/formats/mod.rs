//! Files in and out, one format a file; the tables here are where a new format is added.

mod base64;
mod data_file;
mod loaded;
mod number;
mod part;
mod stated;
mod stream;
mod survey;
mod vtk_file;
mod zarr;

#[cfg(test)]
mod hostile_files;
pub mod label_table;
#[cfg(test)]
mod made;
pub mod meshes;
pub mod molecules;
pub mod moving;
pub mod pictures;
#[cfg(test)]
mod real_files;
pub mod whole;

use std::iter;
use std::path::{Path, PathBuf};

pub use loaded::{Loaded, Voxels};
pub use stated::Stated;
pub use survey::Survey;

use crate::error::Error;
use crate::view::picture::Picture;
use stream::Stream;
use survey::Promise;

/// A format of volume files: a row of [`FORMATS`].
pub(crate) struct Format {
    /// What people call it.
    pub name: &'static str,
    /// How its file names end, in lower case and without the first dot.
    pub extensions: &'static [&'static str],
    /// Whether a file that starts (once inflated) with these bytes, up to [`HEAD`] of them, is of this format;
    /// `None` for a headerless format, which only its name tells.
    recognizes: Option<fn(&[u8]) -> bool>,
    /// Reads what the stream holds; the path is that of the file, for a format that names another file beside it.
    ///
    /// The error is a sentence without a subject, for the path to be put before it.
    read: fn(Stream, &Path, &Stated) -> Result<Loaded, String>,
    /// What its header promises, before a voxel is read; errors as those of `read`.
    promised: fn(&mut Stream, &Path, &Stated) -> Result<Promise, String>,
    /// Which keys choose among the volumes of a file of this format: of `channel` and `time`.
    takes: &'static [&'static str],
}

/// Bytes at the start of a file that tell its format: MRC has its word at 208, NIfTI at 344.
const HEAD: usize = 352;

/// Declares the formats of volumes: a row is a file, what people call the format, how its names end, whether the first
/// bytes of a file tell it, and which of `channel` and `time` it has several of.
macro_rules! formats {
    ($($file:ident $name:literal $extensions:tt $recognizes:expr $(, takes $key:literal)?;)*) => {
        $(mod $file;)*

        /// The formats of volumes; one more is a file and a row.
        pub(crate) static FORMATS: &[Format] = &[$(Format {
            name: $name,
            extensions: &$extensions,
            recognizes: $recognizes,
            takes: &[$($key)?],
            read: $file::read,
            promised: $file::promised,
        }),*];
    };
}

formats! {
    nrrd "NRRD" ["nrrd", "nhdr"] Some(nrrd::recognizes);
    nifti "NIfTI" ["nii", "nii.gz"] Some(nifti::recognizes), takes "time";
    mrc "MRC or CCP4" ["mrc", "mrc.gz", "map", "map.gz", "ccp4", "ccp4.gz"] Some(mrc::recognizes);
    dicom "DICOM" ["dcm"] Some(dicom::recognizes);
    metaimage "MetaImage" ["mha", "mhd"] Some(metaimage::recognizes);
    numpy "NumPy" ["npy"] Some(numpy::recognizes);
    npz "NumPy archive" ["npz"] Some(npz::recognizes);
    tiff_stack "TIFF" ["tif", "tiff"] Some(tiff_stack::recognizes);
    vti "VTK ImageData" ["vti"] Some(vti::recognizes);
    raw "raw" ["raw", "raw.gz"] None;
}

/// A format of folders that hold a volume in files: a row of [`FOLDERS`].
struct FolderFormat {
    /// What people call it.
    name: &'static str,
    /// Whether a folder is of this format.
    recognizes: fn(&Path) -> bool,
    /// Reads what the folder holds; errors as those of [`Format::read`].
    read: fn(&Path, &Stated) -> Result<Loaded, String>,
    /// What the files in it promise, before a voxel is read.
    promised: fn(&Path, &Stated) -> Result<Promise, String>,
}

/// The formats of folders, the first that recognizes one reads it; the last takes what no other does.
static FOLDERS: [FolderFormat; 2] = [
    FolderFormat {
        name: "Zarr",
        recognizes: zarr::recognizes,
        read: zarr::read_folder,
        promised: zarr::promised_of_folder,
    },
    FolderFormat {
        name: "DICOM",
        recognizes: |_| true,
        read: dicom::read_folder,
        promised: dicom::promised_of_folder,
    },
];

/// The folder that a path stands for, itself or by a file of metadata in it, and its format.
fn of_folder(path: &Path) -> Option<(PathBuf, &'static FolderFormat)> {
    let folder = if path.is_dir() { path.to_owned() } else { zarr::folder_of(path)? };
    let format = FOLDERS.iter().find(|format| (format.recognizes)(&folder))?;
    Some((folder, format))
}

/// Reads a volume of any format in `FORMATS`: by what it starts with, else by how its name ends; of a folder, the
/// array of Zarr or the series of slices in it.
///
/// A name that ends as a headerless file is believed, whatever its voxels look like. `stated` is what the scene says of
/// the file: needed by headerless files, and its spacing replaces that of any file. Fails where the file is missing,
/// of no known format, damaged, or promises more than it holds; nothing is allocated that the file does not back.
pub fn read_volume(path: &Path, stated: &Stated) -> Result<Loaded, Error> {
    let wrong = |problem| Error::format(path, problem);
    stated.check().map_err(wrong)?;
    if let Some((folder, format)) = of_folder(path) {
        let mut loaded = (format.read)(&folder, stated).map_err(wrong)?;
        loaded.warnings.extend(stated.unused());
        return Ok(loaded);
    }
    let stream = Stream::open(path).map_err(|problem| Error::file(path, problem))?;
    read_stream(stream, path, stated).map_err(wrong)
}

/// Surveys a volume of any format in `FORMATS`: fails as [`read_volume`] does where the header cannot be read.
pub fn survey(path: &Path, stated: &Stated) -> Result<Survey, Error> {
    let wrong = |problem| Error::format(path, problem);
    stated.check().map_err(wrong)?;
    if let Some((folder, format)) = of_folder(path) {
        let (bytes, files) = (format.promised)(&folder, stated).map_err(wrong)?;
        return Ok(Survey { format: format.name, files, bytes });
    }
    let stream = Stream::open(path).map_err(|problem| Error::file(path, problem))?;
    let (mut stream, format) = recognized(stream, path).map_err(wrong)?;
    let (bytes, beside) = (format.promised)(&mut stream, path, stated).map_err(wrong)?;
    let files = iter::once(path.into()).chain(beside).collect();
    Ok(Survey { format: format.name, files, bytes })
}

/// Writes a volume as NRRD, whole or not at all: what is read again is the same voxels at the same places, bit for bit.
pub fn write_volume(path: &Path, loaded: &Loaded) -> Result<(), Error> {
    whole::write_whole(path, |sink| nrrd::write(sink, loaded))
}

/// Whether a file is a volume of a known format: by what it starts with, or by the name of a headerless one or of metadata of Zarr.
///
/// A TIFF or an array that is a picture is none.
#[must_use]
pub fn is_volume(path: &Path) -> bool {
    let head = || Stream::open(path).ok()?.inflated_if_gzip().ok()?.peek(HEAD).ok();
    let recognized = |head: Vec<u8>| {
        by_head(&head).is_some() && (!tiff_stack::recognizes(&head) || tiff_stack::is_stack(path))
    };
    (is_headerless(path) && path.is_file())
        || zarr::folder_of(path).is_some()
        || head().is_some_and(recognized)
}

/// Whether a file's name is that of a format without a header, which the scene has to state.
#[must_use]
pub fn is_headerless(path: &Path) -> bool {
    by_name(path).is_some_and(|format| format.recognizes.is_none())
}

fn read_stream(stream: Stream, path: &Path, stated: &Stated) -> Result<Loaded, String> {
    let (stream, format) = recognized(stream, path)?;
    let mut loaded = (format.read)(stream, path, stated)?;
    if format.recognizes.is_some() {
        loaded.warnings.extend(stated.unused());
    }
    loaded.warnings.extend(stated.unused_choices(format.takes));
    Ok(loaded)
}

/// The format of a file, and its stream, inflated if need be and at its start.
fn recognized(mut stream: Stream, path: &Path) -> Result<(Stream, &'static Format), String> {
    let named = by_name(path);
    let headerless = named.filter(|format| format.recognizes.is_none());
    if headerless.is_none() || path.extension().is_some_and(|end| end.eq_ignore_ascii_case("gz")) {
        stream = stream.inflated_if_gzip()?;
    }
    let head = stream.peek(HEAD)?;
    let format = headerless.or_else(|| by_head(&head)).or(named).ok_or_else(unknown)?;
    Ok((stream, format))
}

fn by_head(head: &[u8]) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.recognizes.is_some_and(|of| of(head)))
}

fn by_name(path: &Path) -> Option<&'static Format> {
    let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
    let ends = |end: &&str| name.strip_suffix(*end).is_some_and(|stem| stem.ends_with('.'));
    FORMATS.iter().find(|format| format.extensions.iter().any(ends))
}

fn unknown() -> String {
    let known: Vec<String> = FORMATS
        .iter()
        .map(|format| format!("{} (.{})", format.name, format.extensions.join(", .")))
        .collect();
    format!(
        "neither its first bytes nor its name are of a known format; expected one of {}; name the folder of a series of DICOM or of a Zarr array, convert it, or name a headerless file .raw and state `size` and `voxel_type`",
        known.join(", ")
    )
}

/// Reads a picture of any known format, as linear associated RGBA.
pub fn read_picture(path: &Path) -> Result<Picture, Error> {
    pictures::read_picture(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(path: &Path) -> String {
        read_volume(path, &Stated::default()).unwrap_err().to_string()
    }

    #[test]
    fn a_missing_file_is_a_sentence_with_a_remedy() {
        let said = problem(Path::new("nowhere/head.nrrd"));
        assert!(said.contains("no such file") && said.contains("correct the path"), "{said}");
    }

    #[test]
    fn a_folder_without_a_series_says_what_to_name() {
        let folder = tempfile::tempdir().unwrap();
        assert!(problem(folder.path()).contains("the folder that holds the series"));
    }

    #[test]
    fn an_unknown_file_names_the_formats_that_are_known() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.xyz");
        std::fs::write(&path, b"hello").unwrap();
        let said = problem(&path);
        assert!(said.contains(".nhdr") && said.contains(".mrc"), "{said}");
    }

    #[test]
    fn content_outweighs_the_name_except_for_headerless_files() {
        let folder = tempfile::tempdir().unwrap();
        let bytes = b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 8\n";
        let misnamed = folder.path().join("head.MRC");
        std::fs::write(&misnamed, bytes).unwrap();
        assert_eq!(read_volume(&misnamed, &Stated::default()).unwrap().grid.size, [2; 3]);
        let raw = folder.path().join("head.raw");
        std::fs::write(&raw, &bytes[..27]).unwrap();
        let stated = Stated {
            size: Some([3; 3]),
            voxel_type: Some("uint8".to_owned()),
            ..Stated::default()
        };
        assert_eq!(read_volume(&raw, &stated).unwrap().grid.size, [3; 3]);
    }

    #[test]
    fn sizes_that_a_header_states_itself_are_warned_of() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.nrrd");
        std::fs::write(&path, b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 8\n").unwrap();
        let stated = Stated { size: Some([9; 3]), ..Stated::default() };
        let loaded = read_volume(&path, &stated).unwrap();
        assert_eq!(loaded.grid.size, [2; 3]);
        assert!(loaded.warnings[0].contains("`size`"), "{:?}", loaded.warnings);
    }
}
