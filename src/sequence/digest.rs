//! A number that stands for bytes: equal bytes have equal digests, and different ones, but by a rare chance, do not.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::Error;

/// Multiplies with the fractional digits of the golden ratio and folds the high half of the product onto the low one.
fn mixed(state: u64, word: u64) -> u64 {
    let product = u128::from(state ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835);
    (product as u64) ^ ((product >> 64) as u64).rotate_left(23)
}

/// A digest that grows word by word; no secret, only a means to tell what changed.
#[derive(Debug, Clone, Copy)]
pub struct Digest {
    state: u64,
    length: u64,
}

impl Default for Digest {
    fn default() -> Self {
        Self { state: 0x2545_f491_4f6c_dd1d, length: 0 }
    }
}

impl Digest {
    /// Takes some bytes; where they are cut into pieces makes a difference.
    pub fn add(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks::<8>();
        for word in words {
            self.state = mixed(self.state, u64::from_le_bytes(*word));
        }
        let mut last = [0; 8];
        last[..rest.len()].copy_from_slice(rest);
        self.state = mixed(self.state, u64::from_le_bytes(last));
        self.length += bytes.len() as u64;
        self.state = mixed(self.state, self.length);
    }

    /// Sixteen hexadecimal digits.
    #[must_use]
    pub fn digits(self) -> String {
        format!("{:016x}", mixed(self.state, self.length))
    }
}

/// The digest of what is in some files, in order; of a folder, of the files in it. `None` for no files.
pub fn of_files<P: AsRef<Path>>(paths: &[P]) -> Result<Option<String>, Error> {
    let mut digest = Digest::default();
    for path in paths {
        add_file(&mut digest, path.as_ref())?;
    }
    Ok((!paths.is_empty()).then(|| digest.digits()))
}

fn add_file(digest: &mut Digest, path: &Path) -> Result<(), Error> {
    let unreadable = |error| Error::file(path, format!("cannot be read ({error}); check the path"));
    if path.is_dir() {
        let entries = std::fs::read_dir(path).map_err(unreadable)?;
        let mut inner: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        inner.sort();
        return inner
            .iter()
            .filter(|path| path.is_file())
            .try_for_each(|path| add_file(digest, path));
    }
    let mut file = File::open(path).map_err(unreadable)?;
    let mut piece = Vec::new();
    loop {
        piece.clear();
        file.by_ref().take(1 << 20).read_to_end(&mut piece).map_err(unreadable)?;
        digest.add(&piece);
        if piece.is_empty() {
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_byte_more_less_or_other_makes_another_digest() {
        let of = |bytes: &[u8]| {
            let mut digest = Digest::default();
            digest.add(bytes);
            digest.digits()
        };
        let mut seen = std::collections::HashSet::new();
        for length in 0..40 {
            assert!(seen.insert(of(&vec![0; length])), "{length} zeros");
            for at in 0..length {
                let mut bytes = vec![0; length];
                bytes[at] = 1;
                assert!(seen.insert(of(&bytes)), "a one at {at} of {length}");
            }
        }
        assert_eq!(of(b"gel"), of(b"gel"));
    }

    #[test]
    fn files_are_told_apart_by_what_is_in_them_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for (name, bytes) in [("a", "one"), ("b", "one"), ("c", "two")] {
            std::fs::write(path(name), bytes).unwrap();
        }
        let of = |name| of_files(&[path(name)]).unwrap();
        assert!(of("a") == of("b") && of("a") != of("c") && of("a").is_some());
        assert_eq!(of_files::<&Path>(&[]).unwrap(), None);
        assert!(of_files(&[path("d")]).is_err());
    }
}
