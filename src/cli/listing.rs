//! The list of a sequence's frames, with the digests that tell whether one that is there is the one that is wanted.

use gelray::formats::moving::Rate;
use gelray::sequence::digest::{Digest, of_files};
use gelray::sequence::film::Film;
use gelray::sequence::manifest::{Listed, Manifest};
use gelray::sequence::numbered::{Numbered, key};

use super::failure::Failure;
use super::flags::Flags;
use super::noted::VERSION;
use super::noted::telling_notes;

/// The manifest of all frames, whichever of them are rendered here.
pub fn of(
    film: &Film,
    numbered: &Numbered,
    rate: Rate,
    flags: &Flags,
) -> Result<Manifest, Failure> {
    let data_digest = of_files(&film.scene.files)?;
    let listed = |number: usize| -> Result<Listed, Failure> {
        let text = film.text(number)?;
        let notes = telling_notes(&film.scene.name, &text, flags, data_digest.as_deref());
        Ok(Listed { file: numbered.name(number), changes: film.changes(number), key: key(&notes) })
    };
    let frames: Result<Vec<_>, _> = (0..film.range().count()).map(listed).collect();
    let mut scene = Digest::default();
    scene.add(film.stated()?.as_bytes());
    Ok(Manifest {
        version: VERSION.to_owned(),
        scene: film.scene.name.clone(),
        scene_digest: scene.digits(),
        data_digest,
        frames_per_second: rate.to_string(),
        frames: frames?,
    })
}
