//! The table at the end of a zip: the members of an archive, and where their bytes are.

use std::ops::Range;

/// Bytes of a header of a member, of a row of the table, and of its end, without the texts in them.
const LOCAL: usize = 30;
const ROW: usize = 46;
const END: usize = 22;

/// An array in an archive.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Member {
    /// Its name, without `.npy`.
    pub name: String,
    /// Where its bytes are in the file.
    pub bytes: Range<usize>,
    /// Whether they are deflated, and not stored.
    pub deflated: bool,
    /// Bytes of it unpacked.
    pub size: u64,
    /// CRC-32 of what it is unpacked.
    pub checksum: u32,
}

/// The arrays of an archive, in the order of its table.
pub(super) fn members(file: &[u8]) -> Result<Vec<Member>, String> {
    let mut row = start(file)?;
    let mut found = Vec::new();
    while row.starts_with(b"PK\x01\x02") {
        let [name, extra, comment] = [28, 30, 32].map(|at| number(row, at, 2));
        let [name, extra, comment] = [name?, extra?, comment?].map(|length| length as usize);
        let text = String::from_utf8_lossy(row.get(ROW..ROW + name).ok_or_else(truncated)?);
        if let Some(name) = text.strip_suffix(".npy") {
            let more = row.get(ROW + text.len()..).unwrap_or_default();
            found.push(member(file, name, row, &more[..extra.min(more.len())])?);
        }
        row = row.get(ROW + name + extra + comment..).ok_or_else(truncated)?;
    }
    Ok(found)
}

/// The table: the end of the file says where it begins, before a comment that it may have.
fn start(file: &[u8]) -> Result<&[u8], String> {
    let last = file.len().checked_sub(END).ok_or_else(truncated)?;
    let places = (last.saturating_sub(1 << 16)..=last).rev();
    let mut ends = places.filter(|&at| file[at..].starts_with(b"PK\x05\x06"));
    let end = ends.next().ok_or_else(truncated)?;
    let at = match number(file, end + 16, 4)? {
        // Archives of more than 4 GiB say it in an end of their own, 20 bytes before this one is what leads there.
        0xffff_ffff => {
            let far = end.checked_sub(20).ok_or_else(truncated)?;
            let far = usize::try_from(number(file, far + 8, 8)?).map_err(|_| truncated())?;
            number(file, far.checked_add(48).ok_or_else(truncated)?, 8)?
        }
        near => near,
    };
    usize::try_from(at).ok().and_then(|at| file.get(at..)).ok_or_else(truncated)
}

fn member(file: &[u8], name: &str, row: &[u8], extra: &[u8]) -> Result<Member, String> {
    let deflated = match number(row, 10, 2)? {
        0 => false,
        8 => true,
        other => {
            return Err(format!(
                "its array `{name}` is packed by method {other} of zip, and deflate is read; save it with numpy.savez_compressed"
            ));
        }
    };
    if number(row, 8, 2)? & 1 != 0 {
        return Err(format!("its array `{name}` is encrypted; save it without a password"));
    }
    // What does not fit in 32 bits stands in a field of its own, in this order.
    let mut wide = wide(extra);
    let mut whole = |at: usize| match number(row, at, 4)? {
        0xffff_ffff => wide.next().ok_or_else(truncated),
        near => Ok(near),
    };
    let (size, packed, at) = (whole(24)?, whole(20)?, whole(42)?);
    let at = usize::try_from(at).map_err(|_| truncated())?;
    let local = file.get(at..).filter(|local| local.starts_with(b"PK\x03\x04"));
    let local = local.ok_or_else(truncated)?;
    let texts = number(local, 26, 2)? + number(local, 28, 2)?;
    let start = at + LOCAL + texts as usize;
    let end = usize::try_from(packed).ok().and_then(|packed| start.checked_add(packed));
    let end = end.filter(|&end| end <= file.len()).ok_or_else(truncated)?;
    let checksum = number(row, 16, 4)? as u32;
    Ok(Member { name: name.to_owned(), bytes: start..end, deflated, size, checksum })
}

/// The numbers of 64 bits in the field that zip has for them.
fn wide(mut extra: &[u8]) -> impl Iterator<Item = u64> {
    let mut own: &[u8] = &[];
    while let (Ok(kind), Ok(length)) = (number(extra, 0, 2), number(extra, 2, 2)) {
        let end = (4 + length as usize).min(extra.len());
        if kind == 1 {
            own = &extra[4..end];
        }
        extra = &extra[end..];
    }
    own.chunks_exact(8).map(|eight| eight.iter().rev().fold(0, |sum, &b| sum << 8 | u64::from(b)))
}

/// The number of so many bytes at a place, the lowest first.
fn number(bytes: &[u8], at: usize, width: usize) -> Result<u64, String> {
    let own = at.checked_add(width).and_then(|end| bytes.get(at..end)).ok_or_else(truncated)?;
    Ok(own.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte)))
}

fn truncated() -> String {
    "is truncated or no zip: the table at its end does not lead to its arrays; fetch the file again"
        .to_owned()
}
