//! The few tags of a VTK file that are wanted: found by name, in bytes that need not be text throughout.

/// A tag: what stands in it, and what follows it.
#[derive(Debug, Clone, Copy)]
pub struct Tag<'b> {
    inside: &'b [u8],
    /// What follows it.
    pub rest: &'b [u8],
}

/// The first tag of that name.
pub fn tag<'b>(bytes: &'b [u8], name: &str) -> Option<Tag<'b>> {
    let start = format!("<{name}");
    let mut from = 0;
    loop {
        let at = from + find(&bytes[from..], start.as_bytes())? + start.len();
        // A longer name is another tag.
        if bytes.get(at).is_some_and(|&byte| byte == b'>' || byte.is_ascii_whitespace()) {
            let end = bytes[at..].iter().position(|&byte| byte == b'>')?;
            return Some(Tag { inside: &bytes[at..at + end], rest: &bytes[at + end + 1..] });
        }
        from = at;
    }
}

/// What stands before a word; `None` where it does not stand there.
pub fn before<'b>(bytes: &'b [u8], word: &[u8]) -> Option<&'b [u8]> {
    find(bytes, word).map(|at| &bytes[..at])
}

fn find(bytes: &[u8], word: &[u8]) -> Option<usize> {
    bytes.windows(word.len()).position(|here| here == word)
}

impl Tag<'_> {
    /// What stands between the quotes after `key=`.
    pub fn attribute(&self, key: &str) -> Option<String> {
        let text = String::from_utf8_lossy(self.inside);
        let mut rest: &str = &text;
        loop {
            let (name, after) = rest.split_once('=')?;
            let after = after.trim_start();
            let quote = after.chars().next().filter(|letter| ['"', '\''].contains(letter))?;
            let (value, next) = after[1..].split_once(quote)?;
            if name.trim() == key {
                return Some(value.to_owned());
            }
            rest = next;
        }
    }
}
