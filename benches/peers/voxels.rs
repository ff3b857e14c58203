//! The voxels that every renderer is given: the head, shaded by one light and classified, once and for all of them.

use std::io::Write;
use std::path::Path;

use gelray::components::color::to_srgb;
use gelray::volume::grid::Scalars;

/// Opacity and grey of every voxel, a byte each, in linear light; x fastest, the first slice the lowest.
pub struct Voxels {
    pub size: [usize; 3],
    /// Between slices, in spacings within a slice.
    pub z_spacing: f32,
    pairs: Vec<[u8; 2]>,
    scalars: Vec<i16>,
}

/// Where the light comes from.
const LIGHT: [f32; 3] = [0.6, -0.7, 0.4];

impl Voxels {
    /// Shades and classifies scalars whose first slice is the highest.
    pub fn new(scalars: &Scalars, size: [usize; 3], z_spacing: f32) -> Self {
        let [nx, ny, nz] = size;
        let slice = nx * ny;
        let upright = (0..nz).rev().flat_map(|z| (0..slice).map(move |at| z * slice + at));
        let values: Vec<f32> = upright.map(|at| scalars.value(at)).collect();
        let value = |[x, y, z]: [usize; 3]| values[(z * ny + y) * nx + x];
        let slope = |voxel: [usize; 3], axis: usize| {
            let (mut low, mut high) = (voxel, voxel);
            low[axis] = low[axis].saturating_sub(1);
            high[axis] = (high[axis] + 1).min(size[axis] - 1);
            let spacing = if axis == 2 { z_spacing } else { 1.0 };
            (value(high) - value(low)) / ((high[axis] - low[axis]) as f32 * spacing)
        };
        let byte = |part: f32| (part.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let pair = |at: usize| {
            let voxel = [at % nx, at / nx % ny, at / slice];
            let gradient: [f32; 3] = std::array::from_fn(|axis| slope(voxel, axis));
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let length = (dot(gradient, gradient) * dot(LIGHT, LIGHT)).sqrt().max(1e-6);
            let facing = (-dot(gradient, LIGHT) / length).max(0.0);
            [byte((values[at] - 1324.0) / 400.0), byte(0.25 + 0.7 * facing)]
        };
        let pairs = (0..values.len()).map(pair).collect();
        let scalars = values.iter().map(|value| *value as i16).collect();
        Self { size, z_spacing, pairs, scalars }
    }

    /// Writes `pairs.raw` and `scalars.raw` for peers and `painted.nrrd` for gelray into a folder.
    pub fn write(&self, folder: &Path) -> std::io::Result<()> {
        std::fs::write(folder.join("pairs.raw"), self.pairs.as_flattened())?;
        let scalars: Vec<u8> = self.scalars.iter().flat_map(|value| value.to_le_bytes()).collect();
        std::fs::write(folder.join("scalars.raw"), scalars)?;
        let [nx, ny, nz] = self.size;
        let mut painted = std::fs::File::create(folder.join("painted.nrrd"))?;
        write!(
            painted,
            "NRRD0004\ntype: uint16\ndimension: 4\nsizes: 4 {nx} {ny} {nz}\nspacings: nan 1 1 {}\nkinds: RGBA-color domain domain domain\nendian: little\nencoding: raw\n\n",
            self.z_spacing
        )?;
        let rgba = self.pairs.iter().flat_map(|[opacity, grey]| {
            let encoded = (to_srgb(f32::from(*grey) / 255.0) * 65535.0 + 0.5) as u16;
            [encoded, encoded, encoded, u16::from(*opacity) * 257].map(u16::to_le_bytes)
        });
        painted.write_all(rgba.collect::<Vec<_>>().as_flattened())
    }
}
