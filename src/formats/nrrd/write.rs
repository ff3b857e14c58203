//! NRRD written: attached, raw, little-endian, in left-posterior-superior, so that what is read again is the same bits.

use super::super::loaded::{Loaded, Voxels};
use super::super::number::{Order, Stored, to_native};
use super::super::whole::{Failure, Sink};
use crate::volume::grid::{Painted, Scalars};
use crate::with_scalars;

/// Numbers that are turned to their byte order at a time.
const CHUNK: usize = 1 << 16;

/// Writes the header and the voxels.
pub fn write(sink: &mut dyn Sink, loaded: &Loaded) -> Result<(), Failure> {
    let [x, y, z] = loaded.grid.size;
    let placed = loaded.grid.index_to_world;
    let vector = |v: glam::DVec3| format!("({:?},{:?},{:?})", v.x, v.y, v.z);
    let [i, j, k] = [0, 1, 2].map(|axis| vector(placed.matrix3.col(axis)));
    let painted = matches!(loaded.voxels, Voxels::Painted(_));
    let [sizes, none, kind] = if painted { ["4 ", "none ", "RGBA-color "] } else { [""; 3] };
    write!(
        sink,
        "NRRD0004\ntype: {}\ndimension: {}\nspace: left-posterior-superior\nsizes: {sizes}{x} {y} {z}\nspace directions: {none}{i} {j} {k}\nkinds: {kind}domain domain domain\nendian: little\nencoding: raw\nspace origin: {}\n\n",
        type_name(&loaded.voxels),
        if painted { 4 } else { 3 },
        vector(placed.translation),
    )?;
    match &loaded.voxels {
        Voxels::Scalars(scalars) => with_scalars!(scalars, values => numbers(sink, values)),
        Voxels::Painted(Painted::U8(values)) => numbers(sink, values.as_flattened()),
        Voxels::Painted(Painted::U16(values)) => numbers(sink, values.as_flattened()),
        Voxels::Painted(Painted::F32(values)) => numbers(sink, values.as_flattened()),
    }
}

fn numbers<T: Stored>(sink: &mut dyn Sink, values: &[T]) -> Result<(), Failure> {
    for chunk in values.chunks(CHUNK) {
        let mut chunk = chunk.to_vec();
        to_native(&mut chunk, Order::Little);
        sink.write_all(bytemuck::cast_slice(&chunk))?;
    }
    Ok(())
}

fn type_name(voxels: &Voxels) -> &'static str {
    match voxels {
        Voxels::Scalars(Scalars::U8(_)) | Voxels::Painted(Painted::U8(_)) => "uint8",
        Voxels::Scalars(Scalars::U16(_)) | Voxels::Painted(Painted::U16(_)) => "uint16",
        Voxels::Scalars(Scalars::F32(_)) | Voxels::Painted(Painted::F32(_)) => "float",
        Voxels::Scalars(Scalars::I8(_)) => "int8",
        Voxels::Scalars(Scalars::I16(_)) => "int16",
        Voxels::Scalars(Scalars::U32(_)) => "uint32",
        Voxels::Scalars(Scalars::I32(_)) => "int32",
        Voxels::Scalars(Scalars::U64(_)) => "uint64",
        Voxels::Scalars(Scalars::I64(_)) => "int64",
        Voxels::Scalars(Scalars::F64(_)) => "double",
    }
}
