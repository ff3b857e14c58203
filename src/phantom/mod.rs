//! Volumes made by formula: the same bits on every machine.

mod choice;
mod head;
mod molecule;
mod shapes;
mod signal;
mod simple;
mod solid;
mod textures;

use crate::formats::Loaded;
use choice::choose;
pub use signal::marschner_lobb_at;
pub use simple::ball;
pub use textures::{TEXTURE_BYTES, is_texture, texture};

/// Makes a volume.
type Maker = fn() -> Loaded;

/// Every phantom: its name, its maker and how many voxels it has.
const PHANTOMS: [(&str, (Maker, u64)); 6] = [
    ("head", (head::head, 256 * 256 * 113)),
    ("molecule", (molecule::molecule, 96 * 96 * 96)),
    ("ball", (|| simple::ball([64; 3], 24.0), 64 * 64 * 64)),
    ("slab", (simple::slab, 64 * 64 * 64)),
    ("ramp", (simple::ramp, 64 * 64 * 64)),
    ("marschner_lobb", (signal::marschner_lobb, 40 * 40 * 40)),
];

/// The names of all phantoms, as `phantom:NAME` takes them.
pub fn names() -> impl Iterator<Item = &'static str> {
    PHANTOMS.iter().map(|(name, _)| *name)
}

/// The phantom called `name`; world units are millimetres (ångström for the molecule), centred on the world's origin.
///
/// The error for an unknown name is a sentence that lists the names.
pub fn phantom(name: &str) -> Result<Loaded, String> {
    choose(&PHANTOMS, name, "phantom").map(|(make, _)| make())
}

/// The most bytes that making a phantom takes; 0 for an unknown name.
#[must_use]
pub fn most_bytes(name: &str) -> u64 {
    // Some are made in floats and rounded to 16 bits.
    let voxel = size_of::<f32>() + size_of::<u16>();
    choose(&PHANTOMS, name, "phantom").map_or(0, |(_, voxels)| voxels * voxel as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::Voxels;
    use crate::volume::grid::Scalars;

    /// FNV-1a over the little-endian bits of the values.
    fn fingerprint(name: &str) -> u64 {
        let Voxels::Scalars(scalars) = phantom(name).unwrap().voxels else { unreachable!() };
        let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let start = 0xcbf2_9ce4_8422_2325;
        match scalars {
            Scalars::U16(values) => values.iter().flat_map(|v| v.to_le_bytes()).fold(start, fold),
            Scalars::F32(values) => values.iter().flat_map(|v| v.to_le_bytes()).fold(start, fold),
            _ => unreachable!(),
        }
    }

    #[test]
    fn every_phantom_has_the_same_bits_on_every_machine_and_any_number_of_threads() {
        let known = [
            ("head", 0xedb6_9522_2d24_0cda),
            ("molecule", 0x8a39_06e4_ffb9_fb18),
            ("ball", 0xcfee_2086_fc0a_cc25),
            ("slab", 0x1386_7599_6a12_2325),
            ("ramp", 0x5d03_9334_d672_e325),
            ("marschner_lobb", 0xe167_ad7c_4229_9db5),
        ];
        assert!(names().eq(known.iter().map(|(name, _)| *name)));
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let made = pool.install(|| known.map(|(name, _)| (name, fingerprint(name))));
            assert_eq!(made, known, "{threads} threads");
        }
    }

    #[test]
    fn every_phantom_is_centred_on_the_origin_and_has_a_value_for_each_voxel() {
        for name in names() {
            let loaded = phantom(name).unwrap();
            let Voxels::Scalars(scalars) = &loaded.voxels else { unreachable!() };
            assert_eq!(scalars.len(), loaded.grid.voxels(), "{name}");
            assert_eq!(most_bytes(name), 6 * scalars.len() as u64, "{name}");
            let middle = loaded.grid.corners().into_iter().sum::<glam::DVec3>() / 8.0;
            assert!(middle.length() < 1e-9, "{name}: {middle}");
            assert!(loaded.warnings.is_empty());
        }
    }

    #[test]
    fn an_unknown_phantom_is_answered_with_the_names() {
        let sentence = phantom("haed").unwrap_err();
        assert!(names().all(|name| sentence.contains(&format!("`{name}`"))), "{sentence}");
    }
}
