//! What the tests of several formats make, and those who damage files.

use std::io::Write;

/// The bytes as a gzip file.
pub(super) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    packer.write_all(bytes).unwrap();
    packer.finish().unwrap()
}

/// The bytes as zlib packs them.
pub(super) fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(bytes).unwrap();
    packer.finish().unwrap()
}

/// A TIFF of so many pages of 3 × 2 pixels, each of the hundredfold of its number, without a description.
pub(super) fn pages(count: u16) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
    for page in 0..count {
        let pixels = [page * 100; 6];
        encoder.write_image::<tiff::encoder::colortype::Gray16>(3, 2, &pixels).unwrap();
    }
    bytes.into_inner()
}

/// A NIfTI of 2 × 3 × 2 zeros of 16 bits.
pub(super) fn nifti() -> Vec<u8> {
    let mut nifti = vec![0; 352 + 24];
    nifti[..4].copy_from_slice(&348_i32.to_le_bytes());
    nifti[40..50].copy_from_slice(&[3, 0, 2, 0, 3, 0, 2, 0, 1, 0]);
    nifti[70] = 4;
    for at in [76, 80, 84, 88, 112] {
        nifti[at..at + 4].copy_from_slice(&1.0_f32.to_le_bytes());
    }
    nifti[344..348].copy_from_slice(b"n+1\0");
    nifti
}

/// An MRC map of 2 × 3 × 2 zeros of 16 bits.
pub(super) fn map() -> Vec<u8> {
    let mut map = vec![0; 1024 + 24];
    for (word, value) in [2, 3, 2, 1, 0, 0, 0, 2, 3, 2].into_iter().enumerate() {
        map[word * 4] = value;
    }
    for (word, value) in [2.0_f32, 3.0, 2.0, 90.0, 80.0, 100.0].iter().enumerate() {
        map[40 + word * 4..44 + word * 4].copy_from_slice(&value.to_le_bytes());
    }
    (map[64], map[68], map[72]) = (1, 2, 3);
    map[208..212].copy_from_slice(b"MAP ");
    map[212] = 0x44;
    map
}

/// The bytes as base64.
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits =
            (0..3).fold(0_u32, |bits, at| bits << 8 | u32::from(*three.get(at).unwrap_or(&0)));
        for at in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * at) & 63) as usize] as char;
            text.push(if at <= three.len() { letter } else { '=' });
        }
    }
    text
}

/// Numbers of 16 bits of a chunk of an array of 2 × 3 × 4 that counts on, in which the chunk begins at `at`; its axes are
/// written in the `order`, the slowest first. Over the end are ones.
fn counted(at: [usize; 3], chunk: [usize; 3], order: [usize; 3], big: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    for number in 0..chunk.iter().product() {
        let (mut rest, mut place) = (number, at);
        for axis in order.into_iter().rev() {
            place[axis] += rest % chunk[axis];
            rest /= chunk[axis];
        }
        let [z, y, x] = place;
        let value = if z < 2 && y < 3 && x < 4 { (z * 12 + y * 4 + x) as i16 } else { -1 };
        bytes.extend(if big { value.to_be_bytes() } else { value.to_le_bytes() });
    }
    bytes
}

/// Files by their names in a folder.
pub(super) type Files = Vec<(&'static str, Vec<u8>)>;

/// Arrays of Zarr of 2 × 3 × 4 numbers of 16 bits that count on from 0: for each a name, and the files in its folder.
pub(super) fn zarr() -> Vec<(&'static str, Files)> {
    const PLACES: [[usize; 3]; 4] = [[0, 0, 0], [0, 0, 3], [0, 2, 0], [0, 2, 3]];
    let chunks = |names: [&'static str; 4], order, big, pack: fn(Vec<u8>) -> Vec<u8>| {
        let chunk = |at| pack(counted(at, [2, 2, 3], order, big));
        names.into_iter().zip(PLACES.map(chunk)).collect::<Vec<_>>()
    };
    let plain = r#"{"zarr_format":2,"shape":[2,3,4],"chunks":[2,2,3],"dtype":"<i2","order":"C","fill_value":-7,"compressor":null,"filters":null}"#;
    let turned = r#"{"zarr_format":2,"shape":[2,3,4],"chunks":[2,2,3],"dtype":">i2","order":"F","fill_value":-7,"compressor":{"id":"zlib","level":1},"filters":[],"dimension_separator":"/"}"#;
    let third = r#"{"zarr_format":3,"node_type":"array","shape":[2,3,4],"data_type":"int16","chunk_grid":{"name":"regular","configuration":{"chunk_shape":[2,2,3]}},"chunk_key_encoding":{"name":"default"},"fill_value":-7,"codecs":[{"name":"transpose","configuration":{"order":[1,0,2]}},{"name":"bytes","configuration":{"endian":"little"}},{"name":"gzip"}],"attributes":{}}"#;
    let shards = r#"{"zarr_format":3,"node_type":"array","shape":[2,3,4],"data_type":"int16","chunk_grid":{"name":"regular","configuration":{"chunk_shape":[2,4,4]}},"chunk_key_encoding":{"name":"v2"},"fill_value":-7,"codecs":[{"name":"sharding_indexed","configuration":{"chunk_shape":[2,2,2],"codecs":[{"name":"bytes","configuration":{"endian":"big"}}],"index_codecs":[{"name":"bytes","configuration":{"endian":"little"}}],"index_location":"end"}}],"dimension_names":["z","y","x"]}"#;
    let inner = [[0, 0, 0], [0, 0, 2], [0, 2, 0], [0, 2, 2]];
    let inner = inner.map(|at| counted(at, [2, 2, 2], [0, 1, 2], true));
    let table = (0..4_u64).flat_map(|row| [row * 16, 16]).flat_map(u64::to_le_bytes);
    let shard = [inner.concat(), table.collect()].concat();
    let metadata = |name: &'static str, text: &str| vec![(name, text.as_bytes().to_vec())];
    let flat = ["0.0.0", "0.0.1", "0.1.0", "0.1.1"];
    let nested = ["0/0/0", "0/0/1", "0/1/0", "0/1/1"];
    let under = ["c/0/0/0", "c/0/0/1", "c/0/1/0", "c/0/1/1"];
    let with = |metadata: Vec<_>, chunks: Vec<_>| [metadata, chunks].concat();
    vec![
        ("plain", with(metadata(".zarray", plain), chunks(flat, [0, 1, 2], false, |b| b))),
        (
            "turned",
            with(metadata(".zarray", turned), chunks(nested, [2, 1, 0], true, |b| zlib(&b))),
        ),
        (
            "third",
            with(metadata("zarr.json", third), chunks(under, [1, 0, 2], false, |b| gzip(&b))),
        ),
        ("shards", with(metadata("zarr.json", shards), vec![("0.0.0", shard)])),
    ]
}

/// Puts files of these names into a folder, and makes the folders that the names need.
pub(super) fn put(folder: &std::path::Path, files: &[(&str, Vec<u8>)]) -> std::io::Result<()> {
    files.iter().try_for_each(|(name, bytes)| {
        let path = folder.join(name);
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        std::fs::write(path, bytes)
    })
}
