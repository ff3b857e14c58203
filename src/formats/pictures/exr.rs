//! OpenEXR: 32-bit floats, linear, with associated alpha, as the format itself defines them.

use std::io::Cursor;

use exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock};
use exr::block::writer::ChunksWriter;
use exr::image::{Encoding, Image, Layer, SpecificChannels};
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, IntegerBounds, LineOrder, Text};
use exr::meta::header::{Header, LayerAttributes};
use exr::prelude::{
    Blocks, Compression, MetaData, ReadChannels, ReadLayers, ReadSpecificChannel, WritableImage,
    read as reader,
};

use super::{Notes, Opened, PictureFormat, checked_size, whole, wrong};
use crate::formats::whole::{Failure, Sink};
use crate::view::picture::Picture;

/// Read and written.
pub(crate) const FORMAT: PictureFormat = PictureFormat {
    name: "EXR",
    extensions: &["exr"],
    read: Some(read),
    size: Some(size),
    write: Some(write),
};

/// Writes scan lines of float RGBA, compressed without loss (ZIP) by all threads; a note is a text attribute `gelray.` and
/// its name.
pub fn write(sink: &mut dyn Sink, picture: &Picture, notes: &Notes) -> Result<(), Failure> {
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let pixel = |at: Vec2<usize>| <(f32, f32, f32, f32)>::from(picture.pixel(at.x(), at.y()));
    let layer = Layer::new(
        (picture.size[0], picture.size[1]),
        LayerAttributes::default(),
        encoding,
        SpecificChannels::rgba(pixel),
    );
    let mut image = Image::from_layer(layer);
    for (name, text) in notes {
        let name = Text::from_slice_unchecked(format!("gelray.{name}").as_bytes());
        let text = AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes()));
        image.attributes.other.insert(name, text);
    }
    let mut file = Cursor::new(Vec::new());
    let headers = image.write().infer_meta_data();
    let blocks = super::exr_blocks::deflated(picture)?;
    exr::block::write(&mut file, headers, true, |_, chunks| {
        for (index, compressed_pixels_le) in blocks.into_iter().enumerate() {
            let y_coordinate = (index * super::exr_blocks::LINES) as i32;
            let lines = CompressedScanLineBlock { y_coordinate, compressed_pixels_le };
            let compressed_block = CompressedBlock::ScanLine(lines);
            chunks.write_chunk(index, Chunk { layer_index: 0, compressed_block })?;
        }
        Ok(())
    })?;
    let mut bytes = file.into_inner();
    sort_attributes(&mut bytes).ok_or("its header has no end")?;
    Ok(sink.write_all(&bytes)?)
}

/// Puts the attributes of a header in the order of their names: the encoder takes them from a map of random order.
///
/// Their order means nothing to readers and no byte after them moves. `None` if the header does not end.
fn sort_attributes(bytes: &mut [u8]) -> Option<()> {
    let header = bytes.get_mut(8..)?; // after the magic number and the version
    let (mut attributes, mut rest) = (Vec::new(), &*header);
    while *rest.first()? != 0 {
        let name = rest.iter().position(|&byte| byte == 0)? + 1;
        let kind = rest[name..].iter().position(|&byte| byte == 0)? + 1;
        let length = u32::from_le_bytes(*rest.get(name + kind..)?.first_chunk()?) as usize;
        let (attribute, after) = rest.split_at_checked(name + kind + 4 + length)?;
        attributes.push(attribute.to_vec());
        rest = after;
    }
    attributes.sort();
    let sorted = attributes.concat();
    header[..sorted.len()].copy_from_slice(&sorted);
    Some(())
}

/// Reads RGB(A), or grey from a luminance channel, of the first layer that has it, placed in the display window.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(|error| wrong("EXR", error))?;
    meta.headers.iter().try_for_each(check)?;
    let channels = |h: &Header, names: &[&str]| {
        names.iter().all(|n| h.channels.list.iter().any(|c| c.name.eq(n)))
    };
    let found = |names: &[&str]| meta.headers.iter().any(|header| channels(header, names));
    let layer = if found(&["R", "G", "B"]) {
        read_rgba(bytes)
    } else if found(&["Y"]) {
        read_grey(bytes)
    } else {
        return Err("has no channels R, G and B, nor Y; write it with those names".to_owned());
    };
    place(layer.map_err(|error| wrong("EXR", error))?)
}

/// The largest of its layers and of what is meant to be seen; a crop is laid into that.
fn size(file: &mut dyn Opened) -> Result<([usize; 2], u64), String> {
    let meta = MetaData::read_from_buffered(file, false).map_err(|error| wrong("EXR", error))?;
    meta.headers.iter().try_for_each(check)?;
    let sizes = meta.headers.iter().flat_map(|header| {
        let window = header.shared_attributes.display_window.size;
        [header.layer_size, window].map(|size| [size.width(), size.height()])
    });
    let largest = sizes.max_by_key(|size| size[0] * size[1]);
    Ok((largest.ok_or_else(|| wrong("EXR", "it holds no layer"))?, 16))
}

/// The pixels of a layer, and where they lie in what is meant to be seen.
struct Placed {
    window: IntegerBounds,
    position: Vec2<i32>,
    pixels: Pixels,
}

struct Pixels {
    width: usize,
    pixels: Vec<[f32; 4]>,
}

impl Pixels {
    fn new(size: Vec2<usize>) -> Self {
        Self { width: size.width(), pixels: vec![[0.0; 4]; size.area()] }
    }

    fn set(&mut self, at: Vec2<usize>, pixel: [f32; 4]) {
        if let Some(place) = self.pixels.get_mut(at.y() * self.width + at.x()) {
            *place = pixel;
        }
    }
}

fn read_rgba(bytes: &[u8]) -> exr::error::Result<Placed> {
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| Pixels::new(size),
            |pixels: &mut Pixels, at, (r, g, b, a): (f32, f32, f32, f32)| {
                pixels.set(at, [r, g, b, a]);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))?;
    let Layer { attributes, channel_data, .. } = image.layer_data;
    Ok(Placed {
        window: image.attributes.display_window,
        position: attributes.layer_position,
        pixels: channel_data.pixels,
    })
}

fn read_grey(bytes: &[u8]) -> exr::error::Result<Placed> {
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("Y")
        .optional("A", 1.0_f32)
        .collect_pixels(
            |size, _| Pixels::new(size),
            |pixels: &mut Pixels, at, (y, a): (f32, f32)| pixels.set(at, [y, y, y, a]),
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))?;
    let Layer { attributes, channel_data, .. } = image.layer_data;
    Ok(Placed {
        window: image.attributes.display_window,
        position: attributes.layer_position,
        pixels: channel_data.pixels,
    })
}

/// Refuses a header of a size that is too large to read, or of channels that skip pixels.
fn check(header: &Header) -> Result<(), String> {
    let window = header.shared_attributes.display_window.size;
    checked_size(header.layer_size.width() as u64, header.layer_size.height() as u64)?;
    checked_size(window.width() as u64, window.height() as u64)?;
    if header.channels.list.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
        return Err(
            "has channels of fewer samples than pixels; write it with a sample a pixel".to_owned()
        );
    }
    Ok(())
}

/// The display window of a layer whose own window may be smaller (a crop: the rest is transparent) or larger.
fn place(Placed { window, position, pixels }: Placed) -> Result<Picture, String> {
    let size = [window.size.width(), window.size.height()];
    let Pixels { width, pixels } = pixels;
    if window.position == position && width == size[0] && pixels.len() == size[0] * size[1] {
        return whole(size, pixels);
    }
    let offset = |from: i32, to: i32| i64::from(to) - i64::from(from);
    let left = offset(window.position.x(), position.x());
    let top = offset(window.position.y(), position.y());
    let mut placed = vec![[0.0; 4]; size[0] * size[1]];
    for (pixel, i) in pixels.into_iter().zip(0_i64..) {
        let (x, y) = (left + i % width as i64, top + i / width as i64);
        if (0..size[0] as i64).contains(&x) && (0..size[1] as i64).contains(&y) {
            placed[y as usize * size[0] + x as usize] = pixel;
        }
    }
    whole(size, placed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crop_is_placed_in_its_display_window_and_grey_is_luminance() {
        let position =
            LayerAttributes { layer_position: Vec2(7, -2), ..LayerAttributes::default() };
        let grey = SpecificChannels::build()
            .with_channel("Y")
            .with_pixel_fn(|at: Vec2<usize>| ((at.x() + 2 * at.y()) as f32,));
        let mut image =
            Image::from_layer(Layer::new((2, 2), position, Encoding::UNCOMPRESSED, grey));
        image.attributes.display_window = IntegerBounds::new((6, -2), (2, 4));
        let mut file = Cursor::new(Vec::new());
        image.write().to_buffered(&mut file).unwrap();
        let picture = read(&file.into_inner()).unwrap();
        let [none, first, third] = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [2.0, 2.0, 2.0, 1.0]];
        assert_eq!(picture.size, [2, 4]);
        assert_eq!(picture.pixels[..], [none, first, none, third, none, none, none, none]);
    }
}
