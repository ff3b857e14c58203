//! Volumes made by formula: the same bits on every machine.

mod head;
mod molecule;
mod shapes;
mod simple;
mod textures;

use crate::formats::Loaded;
pub use simple::ball;
pub use textures::texture;

/// Every phantom: its name and its maker.
const PHANTOMS: [(&str, fn() -> Loaded); 5] = [
    ("head", head::head),
    ("molecule", molecule::molecule),
    ("ball", || simple::ball([64; 3], 24.0)),
    ("slab", simple::slab),
    ("ramp", simple::ramp),
];

/// The names of all phantoms, as `phantom:NAME` takes them.
pub fn names() -> impl Iterator<Item = &'static str> {
    PHANTOMS.iter().map(|(name, _)| *name)
}

/// The phantom called `name`; world units are millimetres (ångström for the molecule), centred on the world's origin.
///
/// The error for an unknown name is a sentence that lists the names.
pub fn phantom(name: &str) -> Result<Loaded, String> {
    choose(&PHANTOMS, name, "phantom").map(|make| make())
}

/// The entry of a table called `name`, or a sentence that lists the names of its `kind`.
fn choose<T: Copy>(table: &[(&str, T)], name: &str, kind: &str) -> Result<T, String> {
    let found = table.iter().find(|(known, _)| *known == name);
    found.map(|(_, made)| *made).ok_or_else(|| {
        let known: Vec<_> = table.iter().map(|(known, _)| format!("`{known}`")).collect();
        format!("there is no {kind} `{name}`; choose one of {}", known.join(", "))
    })
}
