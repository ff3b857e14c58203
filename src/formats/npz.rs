//! NumPy archives (`.npz`): a zip of arrays, stored or deflated; the first that is a volume is read.

mod directory;
#[cfg(test)]
mod tests;

use std::path::Path;

use flate2::Crc;

use super::stream::Stream;
use super::survey::Promise;
use super::{Loaded, Stated, numpy};
use directory::{Member, members};

/// Bytes of a member that hold the header of its array, packed or not.
const HEAD: usize = 1 << 17;

/// The header of a gzip file, which a deflated member lacks.
const GZIP: [u8; 10] = [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255];

/// Whether a file starts as a zip whose first member is an array.
pub(super) fn recognizes(head: &[u8]) -> bool {
    let name = head.get(26).map(|&length| 30..30 + usize::from(length));
    head.starts_with(b"PK\x03\x04")
        && name.and_then(|name| head.get(name)).is_some_and(|name| name.ends_with(b".npy"))
}

/// Reads the first array of three axes, or of four of which the last is RGBA, and names the others.
pub(super) fn read(mut stream: Stream, path: &Path, stated: &Stated) -> Result<Loaded, String> {
    let mut bytes = stream.rest()?;
    let members = members(&bytes)?;
    let member = first_volume(&bytes, &members)?;
    let mut loaded = numpy::read(take(&mut bytes, member)?, path, stated)?;
    let others = members.iter().filter(|other| other.name != member.name);
    let others: Vec<_> = others.map(|other| format!("`{}`", other.name)).collect();
    if !others.is_empty() {
        let name = &member.name;
        loaded.warnings.push(format!(
            "of its arrays `{name}` is read, the first that is a volume, and not {}; save one alone to read another",
            others.join(", ")
        ));
    }
    Ok(loaded)
}

/// Bytes of the numbers that the array's header promises, and of the file.
pub(super) fn promised(
    stream: &mut Stream,
    path: &Path,
    stated: &Stated,
) -> Result<Promise, String> {
    let bytes = stream.rest()?;
    let member = first_volume(&bytes, &members(&bytes)?)?.clone();
    let (voxels, beside) = numpy::promised(&mut head(&bytes, &member), path, stated)?;
    Ok((voxels.saturating_add(bytes.len() as u64), beside))
}

fn first_volume<'m>(bytes: &[u8], members: &'m [Member]) -> Result<&'m Member, String> {
    let is_volume = |member: &&Member| numpy::holds_volume(&mut head(bytes, member));
    members.iter().find(is_volume).ok_or_else(|| {
        let names: Vec<_> = members.iter().map(|member| member.name.as_str()).collect();
        format!(
            "holds no array of numbers of three axes (z, y, x), only {}; save one with numpy.save",
            if names.is_empty() { "other files".to_owned() } else { names.join(", ") }
        )
    })
}

/// The start of a member, unpacked.
fn head(bytes: &[u8], member: &Member) -> Stream {
    let own = &bytes[member.bytes.clone()];
    let own = &own[..own.len().min(HEAD)];
    if member.deflated {
        Stream::of([&GZIP[..], own].concat()).inflated()
    } else {
        Stream::of(own.to_vec())
    }
}

/// A member, unpacked and held to its checksum, in the place of the file that it is of.
fn take(bytes: &mut Vec<u8>, member: &Member) -> Result<Stream, String> {
    bytes.truncate(member.bytes.end);
    if member.deflated {
        // As a gzip file, which is checked as it inflates: its header fits where that of the member was.
        bytes.drain(..member.bytes.start - GZIP.len());
        bytes[..GZIP.len()].copy_from_slice(&GZIP);
        bytes.extend(member.checksum.to_le_bytes());
        bytes.extend((member.size as u32).to_le_bytes());
        return Ok(Stream::of(std::mem::take(bytes)).inflated());
    }
    bytes.drain(..member.bytes.start);
    let mut crc = Crc::new();
    crc.update(bytes);
    if crc.sum() == member.checksum {
        Ok(Stream::of(std::mem::take(bytes)))
    } else {
        Err(format!("its array `{}` is damaged; fetch the file again", member.name))
    }
}
