//! Numbers of pixels that are no color: layers of 32-bit floats, as channels of an OpenEXR or as the last axis of a NumPy array.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec,
    WritableImage,
};

use crate::error::Error;
use crate::formats::whole::{Failure, Whole, written_beside};

/// A layer: its name as a channel, and a value a pixel, row by row from the top.
pub type PixelLayer<'a> = (&'a str, Vec<f32>);

/// Keeps layers of `size` pixels across and down in a file whose name ends in `.exr` or `.npy` (float32, C order, height ×
/// width × layers). Each has a value for every pixel.
pub fn layers_beside(
    path: &Path,
    size: [usize; 2],
    layers: &[PixelLayer<'_>],
) -> Result<Whole, Error> {
    let extension = path.extension().and_then(|end| end.to_str()).unwrap_or_default();
    let is_exr = match extension.to_ascii_lowercase().as_str() {
        "exr" => true,
        "npy" => false,
        _ => {
            let problem = "is no name for layers of floats; one that ends in .exr or .npy is";
            return Err(Error::file(path, problem.to_owned()));
        }
    };
    let bytes = if is_exr { exr_of(size, layers) } else { Ok(npy_of(size, layers)) };
    written_beside(path, |out| Ok(out.write_all(&bytes?)?))
}

fn exr_of(size: [usize; 2], layers: &[PixelLayer<'_>]) -> Result<Vec<u8>, Failure> {
    let channel =
        |(name, values): &PixelLayer<'_>| AnyChannel::new(*name, FlatSamples::F32(values.clone()));
    let channels: SmallVec<[_; 4]> = layers.iter().map(channel).collect();
    let channels = AnyChannels::sort(channels);
    let encoding = Encoding::FAST_LOSSLESS;
    let layer = Layer::new((size[0], size[1]), LayerAttributes::default(), encoding, channels);
    let mut file = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut file)?;
    Ok(file.into_inner())
}

fn npy_of([width, height]: [usize; 2], layers: &[PixelLayer<'_>]) -> Vec<u8> {
    let shape = format!("({height}, {width}, {})", layers.len());
    let mut bytes = super::npy::header(&shape);
    for at in 0..width * height {
        let values = layers.iter().map(|(_, values)| values.get(at).copied().unwrap_or(f32::NAN));
        bytes.extend(values.flat_map(f32::to_le_bytes));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels, ReadLayers};

    use super::*;

    #[test]
    fn layers_are_channels_of_an_exr_and_the_last_axis_of_an_array() {
        let layers: [PixelLayer; 2] =
            [("Z", (0..6).map(|n| n as f32).collect()), ("N.X", vec![0.5; 6])];
        let exr = exr_of([3, 2], &layers).unwrap();
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(Cursor::new(exr))
            .unwrap();
        let channels = image.layer_data.channel_data.list;
        let names: Vec<String> = channels.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["N.X", "Z"]);
        let values: Vec<f32> = channels[1].sample_data.values_as_f32().collect();
        assert_eq!(values, layers[0].1);
        let npy = npy_of([3, 2], &layers);
        assert!(String::from_utf8_lossy(&npy[..128]).contains("'shape': (2, 3, 2)"));
        assert_eq!((npy.len() - 128, &npy[132..136]), (48, &0.5_f32.to_le_bytes()[..]));
    }
}
