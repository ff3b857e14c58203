//! MetaImage (`.mha`, and `.mhd` with its voxels in a file beside it): what ITK, SimpleITK and elastix write.

use std::path::Path;
use std::str::FromStr;

use glam::{DAffine3, DMat3, DVec3};

use super::data_file;
use super::number::{self, Binary, NumberType, Order};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};

/// Bytes that a header may take.
const LONGEST: u64 = 1 << 16;

/// The words of MetaIO for number types, and ours.
const TYPES: [(&str, NumberType); 14] = [
    ("MET_UCHAR", NumberType::U8),
    ("MET_CHAR", NumberType::I8),
    ("MET_USHORT", NumberType::U16),
    ("MET_SHORT", NumberType::I16),
    ("MET_UINT", NumberType::U32),
    ("MET_INT", NumberType::I32),
    ("MET_ULONG", NumberType::U32),
    ("MET_LONG", NumberType::I32),
    ("MET_ULONG_LONG", NumberType::U64),
    ("MET_LONG_LONG", NumberType::I64),
    ("MET_FLOAT", NumberType::F32),
    ("MET_DOUBLE", NumberType::F64),
    ("MET_UCHAR_ARRAY", NumberType::U8),
    ("MET_USHORT_ARRAY", NumberType::U16),
];

/// What a header says.
struct Header {
    size: [usize; 3],
    kind: NumberType,
    painted: bool,
    order: Order,
    compressed: bool,
    /// Bytes before the voxels in a data file; `None`: all but the voxels.
    skip: Option<u64>,
    placed: DAffine3,
    /// The file that holds the voxels; `None`: this one, after the header.
    data_file: Option<String>,
}

/// Whether a file starts as MetaImage.
pub(super) fn recognizes(head: &[u8]) -> bool {
    let key = |key: &[u8]| {
        head.strip_prefix(key)
            .is_some_and(|rest| rest.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'='))
    };
    key(b"ObjectType") || key(b"NDims")
}

/// Reads the header, and the voxels after it or in the file that it names; its world is ITK's, which is ours.
pub(super) fn read(mut stream: Stream, path: &Path, stated: &Stated) -> Result<Loaded, String> {
    let header = Header::read(&mut stream)?;
    let grid = stated.grid(header.size, header.placed)?;
    let numbers = grid.voxels() * if header.painted { 4 } else { 1 };
    let (voxels, excess) =
        data_file::read(stream, (path, header.data_file.as_deref()), |stream| {
            voxels(stream, &header, numbers)
        })?;
    Ok(Loaded { grid, voxels, warnings: excess.into_iter().collect() })
}

/// Bytes of the voxels that a header promises, and the data file that it names.
pub(super) fn promised(stream: &mut Stream, path: &Path, _: &Stated) -> Result<Promise, String> {
    let header = Header::read(stream)?;
    let each = header.kind.bytes() * if header.painted { 4 } else { 1 };
    let beside = header.data_file.as_deref().map(|name| data_file::beside(path, name));
    Ok((of_size(header.size, each), beside.into_iter().collect()))
}

fn voxels(
    mut stream: Stream,
    header: &Header,
    numbers: usize,
) -> Result<(Voxels, Option<String>), String> {
    match header.skip {
        Some(bytes) => stream.skip_bytes(bytes)?,
        None => stream.skip_to_last((numbers * header.kind.bytes()) as u64)?,
    }
    if header.compressed {
        stream = stream.inflated_zlib();
    }
    let mut source = Binary { stream: &mut stream, order: header.order };
    let voxels = if header.painted {
        number::painted(&mut source, header.kind, numbers / 4)?
    } else {
        Voxels::Scalars(number::scalars(&mut source, header.kind, numbers)?)
    };
    Ok((voxels, stream.finish()?))
}

impl Header {
    /// Reads up to the line that says where the voxels are, which is the last.
    fn read(stream: &mut Stream) -> Result<Self, String> {
        let mut most = LONGEST;
        let mut fields: Vec<(String, String)> = Vec::new();
        while let Some(line) = stream.line(&mut most)? {
            let Some((key, value)) = line.split_once('=') else {
                return Err(format!(
                    "line {} of its header has no `=`; expected `Key = value`",
                    fields.len() + 1
                ));
            };
            fields.push((key.trim().to_owned(), value.trim().to_owned()));
            if key.trim() == "ElementDataFile" {
                return Self::of(&Fields(fields));
            }
        }
        Err("its header lacks `ElementDataFile`, which ends it; fetch the file again".to_owned())
    }

    fn of(fields: &Fields) -> Result<Self, String> {
        let axes: Vec<usize> = fields.numbers("NDims")?.unwrap_or_default();
        if axes != [3] {
            return Err(format!(
                "its `NDims` is {axes:?}, and 3 axes are expected; take one volume out of the series and save it alone"
            ));
        }
        let word = fields.needed("ElementType")?;
        let kind = TYPES.iter().find(|row| row.0 == word).map(|row| row.1).ok_or_else(|| {
            format!("its `ElementType` is `{word}`, and MET_UCHAR to MET_DOUBLE are read; convert it to one of these")
        })?;
        let channels: Vec<usize> = fields.numbers("ElementNumberOfChannels")?.unwrap_or(vec![1]);
        if channels != [1] && channels != [4] {
            return Err(format!(
                "its `ElementNumberOfChannels` is {channels:?}, and 1, or 4 for RGBA, is expected; save one channel alone"
            ));
        }
        if fields.is_true("BinaryData") == Some(false) {
            return Err("its voxels are text, and binary ones are read; save it again".to_owned());
        }
        let big =
            fields.is_true("BinaryDataByteOrderMSB").or(fields.is_true("ElementByteOrderMSB"));
        let skip: Vec<i64> = fields.numbers("HeaderSize")?.unwrap_or(vec![0]);
        Ok(Self {
            size: fields.three("DimSize")?.ok_or("its header lacks `DimSize`; add it")?,
            kind,
            painted: channels == [4],
            order: if big == Some(true) { Order::Big } else { Order::Little },
            compressed: fields.is_true("CompressedData") == Some(true),
            skip: match skip[..] {
                [-1] => None,
                [bytes] if bytes >= 0 => Some(bytes as u64),
                _ => return Err(format!("its `HeaderSize` is {skip:?}; expected bytes, or -1")),
            },
            placed: placed(fields)?,
            data_file: data_file(fields.needed("ElementDataFile")?)?,
        })
    }
}

/// Directions of the axes, one after the other, times the spacings; each may be left out.
fn placed(fields: &Fields) -> Result<DAffine3, String> {
    let first = |keys: &[&str]| {
        keys.iter().find_map(|key| fields.get(key).map(|_| fields.three(key))).unwrap_or(Ok(None))
    };
    let spacing: [f64; 3] = first(&["ElementSpacing", "ElementSize"])?.unwrap_or([1.0; 3]);
    let origin: [f64; 3] = first(&["Offset", "Position", "Origin"])?.unwrap_or([0.0; 3]);
    let matrix = ["TransformMatrix", "Rotation", "Orientation"];
    let axes = match matrix.iter().find(|key| fields.get(key).is_some()) {
        None => DMat3::IDENTITY,
        Some(key) => {
            let numbers: Vec<f64> = fields.numbers(key)?.unwrap_or_default();
            let numbers: [f64; 9] = numbers.try_into().map_err(|numbers: Vec<f64>| {
                format!("its `{key}` has {} numbers where 9 are expected", numbers.len())
            })?;
            DMat3::from_cols_array(&numbers)
        }
    };
    let matrix3 = axes * DMat3::from_diagonal(DVec3::from(spacing));
    Ok(DAffine3 { matrix3, translation: DVec3::from(origin) })
}

fn data_file(name: &str) -> Result<Option<String>, String> {
    if name.eq_ignore_ascii_case("local") {
        return Ok(None);
    }
    if name.is_empty() || name.contains('%') || name.starts_with("LIST") {
        return Err(format!(
            "its `ElementDataFile` is `{name}`, and LOCAL or the name of one file is expected, not a list or pattern of slices; join them in one file"
        ));
    }
    Ok(Some(name.to_owned()))
}

/// Keys and what they say, in the file's order.
struct Fields(Vec<(String, String)>);

impl Fields {
    fn get(&self, key: &str) -> Option<&str> {
        self.0.iter().find(|field| field.0 == key).map(|field| field.1.as_str())
    }

    fn needed(&self, key: &str) -> Result<&str, String> {
        self.get(key).ok_or_else(|| format!("its header lacks `{key}`; add it"))
    }

    fn is_true(&self, key: &str) -> Option<bool> {
        self.get(key).map(|value| value.starts_with(['T', 't', '1', 'Y', 'y']))
    }

    fn numbers<T: FromStr>(&self, key: &str) -> Result<Option<Vec<T>>, String> {
        let Some(text) = self.get(key) else { return Ok(None) };
        let number = |word: &str| word.parse().ok();
        let numbers: Option<Vec<T>> = text.split_whitespace().map(number).collect();
        numbers.map(Some).ok_or_else(|| {
            format!("its `{key}` is `{text}`, and numbers are expected; correct the header")
        })
    }

    fn three<T: FromStr>(&self, key: &str) -> Result<Option<[T; 3]>, String> {
        let Some(numbers) = self.numbers::<T>(key)? else { return Ok(None) };
        numbers.try_into().map(Some).map_err(|numbers: Vec<T>| {
            format!("its `{key}` has {} numbers where 3 are expected", numbers.len())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::grid::Scalars;

    const HEADER: &str = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 2 3 4\nDimSize = 2 3 2\nElementType = MET_SHORT\n";

    fn of(header: &str, voxels: &[u8]) -> Result<Loaded, String> {
        let bytes = [header.as_bytes(), voxels].concat();
        read(Stream::of(bytes), Path::new("a.mha"), &Stated::default())
    }

    #[test]
    fn each_axis_has_its_direction_and_spacing() {
        let voxels: Vec<u8> = (0..12_i16).flat_map(i16::to_le_bytes).collect();
        let loaded = of(&format!("{HEADER}ElementDataFile = LOCAL\n"), &voxels).unwrap();
        let at = |x, y, z| loaded.grid.index_to_world.transform_point3(DVec3::new(x, y, z));
        assert_eq!(at(0.0, 0.0, 0.0), DVec3::new(10.0, 20.0, 30.0));
        assert_eq!(at(1.0, 0.0, 0.0), DVec3::new(10.0, 22.0, 30.0));
        assert_eq!(at(0.0, 1.0, 1.0), DVec3::new(7.0, 20.0, 34.0));
        let Voxels::Scalars(Scalars::I16(values)) = loaded.voxels else { panic!("not i16") };
        assert_eq!(values[..3], [0, 1, 2]);
    }

    #[test]
    fn voxels_beside_the_header_may_be_packed() {
        use std::io::Write;
        let folder = tempfile::tempdir().unwrap();
        let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        packer.write_all(&[1; 24]).unwrap();
        std::fs::write(folder.path().join("a.zraw"), packer.finish().unwrap()).unwrap();
        let path = folder.path().join("a.mhd");
        let header = format!("{HEADER}CompressedData = True\nElementDataFile = a.zraw\n");
        let loaded = read(Stream::of(header.into()), &path, &Stated::default()).unwrap();
        assert!(matches!(loaded.voxels, Voxels::Scalars(Scalars::I16(v)) if v[..] == [257; 12]));
    }

    #[test]
    fn what_is_not_read_is_said() {
        for (change, to, said) in [
            ("NDims = 3", "NDims = 2", "3 axes"),
            ("MET_SHORT", "MET_STRING", "MET_UCHAR to MET_DOUBLE"),
            ("DimSize = 2 3 2", "DimSize = 2 3", "2 numbers where 3"),
            ("BinaryData = True", "BinaryData = False", "text"),
            ("ElementSpacing = 2 3 4", "ElementSpacing = 2 0 4", "spacing"),
            ("NDims = 3", "NDims 3", "no `=`"),
        ] {
            let header = format!("{HEADER}ElementDataFile = LOCAL\n").replace(change, to);
            let problem = of(&header, &[0; 24]).unwrap_err();
            assert!(problem.contains(said), "{problem}");
        }
        assert!(of(HEADER, &[]).unwrap_err().contains("ElementDataFile"));
        let list = format!("{HEADER}ElementDataFile = LIST\n");
        assert!(of(&list, &[]).unwrap_err().contains("join them"));
    }
}
