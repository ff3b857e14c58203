//! Headerless volumes (`.raw`): nothing but voxels, x fastest; the scene states their sizes and type.

use std::path::Path;

use glam::DAffine3;

use super::number::{self, Binary, NumberType, Order};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};

/// Reads the voxels that `stated` describes; the file must hold just these. Without a stated spacing it is 1.
pub(super) fn read(mut stream: Stream, _: &Path, stated: &Stated) -> Result<Loaded, String> {
    let (Some(size), Some(name)) = (stated.size, &stated.voxel_type) else {
        return Err("has no header; state its `size` (voxels on each axis) and `voxel_type` (such as uint8) in the scene's `volume`".to_owned());
    };
    let kind = NumberType::named(name)?;
    let order = match &stated.endian {
        Some(word) => Order::named(word)?,
        None if kind.bytes() == 1 => Order::Little,
        None => {
            return Err(format!(
                "has no header, and `{name}` has {} bytes; state its byte order as `endian`, little or big",
                kind.bytes()
            ));
        }
    };
    let grid = stated.grid(size, DAffine3::IDENTITY)?;
    let scalars = number::scalars(&mut Binary { stream: &mut stream, order }, kind, grid.voxels())?;
    if let Some(excess) = stream.finish()? {
        return Err(format!(
            "{excess}: the stated `size` {size:?} of `{name}` is {} bytes; correct `size` or `voxel_type`",
            scalars.bytes()
        ));
    }
    Ok(Loaded { grid, voxels: Voxels::Scalars(scalars), warnings: Vec::new() })
}

/// Bytes of the voxels that are stated; where too little is, whoever reads them says so.
pub(super) fn promised(_: &mut Stream, _: &Path, stated: &Stated) -> Result<Promise, String> {
    let (Some(size), Some(name)) = (stated.size, &stated.voxel_type) else {
        return Ok((0, Vec::new()));
    };
    Ok((of_size(size, NumberType::named(name)?.bytes()), Vec::new()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::grid::Scalars;

    fn stated() -> Stated {
        Stated {
            size: Some([2, 2, 3]),
            voxel_type: Some("uint16".to_owned()),
            endian: Some("big".to_owned()),
            spacing_mm: Some([1.0, 1.0, 2.0]),
            ..Stated::default()
        }
    }

    fn bytes(length: u8) -> Stream {
        Stream::of((0..length).collect())
    }

    #[test]
    fn a_headerless_file_is_what_the_scene_states() {
        let loaded = read(bytes(24), Path::new(""), &stated()).unwrap();
        assert_eq!(loaded.grid.spacing(), glam::DVec3::new(1.0, 1.0, 2.0));
        let Voxels::Scalars(Scalars::U16(values)) = loaded.voxels else { panic!("not u16") };
        assert_eq!(values[..3], [0x0001, 0x0203, 0x0405]);
    }

    #[test]
    fn a_headerless_file_must_hold_just_what_is_stated() {
        for length in [23, 25] {
            let said = read(bytes(length), Path::new(""), &stated()).unwrap_err();
            assert!(said.contains("24 bytes"), "{said}");
        }
    }

    #[test]
    fn what_is_not_stated_is_asked_for() {
        for (stated, asked) in [
            (Stated { size: None, ..stated() }, "`size`"),
            (Stated { voxel_type: None, ..stated() }, "`voxel_type`"),
            (Stated { endian: None, ..stated() }, "`endian`"),
            (Stated { endian: Some("pdp".to_owned()), ..stated() }, "`pdp`"),
            (Stated { voxel_type: Some("bit".to_owned()), ..stated() }, "`bit`"),
            (Stated { size: Some([2, 1, 6]), ..stated() }, "at least 2"),
            (Stated { size: Some([1 << 40; 3]), ..stated() }, "multiply"),
        ] {
            let said = read(bytes(24), Path::new(""), &stated).unwrap_err();
            assert!(said.contains(asked), "{said}");
        }
    }
}
