//! Colors of voxels, a brick at a time: kept, or made where they are asked for.

use std::fmt::Debug;
use std::sync::Arc;

use glam::Vec3;

use super::bricks::{BrickPlace, Bricks, EDGE, VOXELS};

/// The colors of a brick's voxels, linear light, at (z · 8 + y) · 8 + x.
pub type BrickColors = [[f32; 3]; VOXELS];

/// What colors of voxels come from.
pub trait ColorSource: Debug + Send + Sync {
    /// Fills in the colors of a brick, whatever it held before; `false` where there are none, and then it may hold anything.
    fn fill(&self, place: BrickPlace, colors: &mut BrickColors) -> bool;

    /// What no channel in a brick is above; at least 0.
    fn brightest(&self, place: BrickPlace) -> f32;

    /// Bytes that it takes, beside what others keep too.
    fn bytes(&self) -> u64;
}

/// Colors of the voxels of a grid. Shared by pointer, equality is identity.
#[derive(Debug, Clone)]
pub struct VoxelColors {
    size: [usize; 3],
    source: Arc<dyn ColorSource>,
}

impl PartialEq for VoxelColors {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.source, &other.source)
    }
}

impl From<Bricks<[f32; 3]>> for VoxelColors {
    /// Those that are kept.
    fn from(bricks: Bricks<[f32; 3]>) -> Self {
        Self::new(bricks.size(), bricks)
    }
}

impl VoxelColors {
    /// Those of a grid of `size` voxels.
    #[must_use]
    pub fn new(size: [usize; 3], source: impl ColorSource + 'static) -> Self {
        Self { size, source: Arc::new(source) }
    }

    /// The same color wherever an opacity is above 0.
    #[must_use]
    pub fn alike(color: Vec3, opacity: Bricks<f32>) -> Self {
        Self::new(opacity.size(), Alike { color: color.to_array(), opacity })
    }

    /// Fills in the colors of a brick, whatever it held before; `false` where there are none, and then it may hold anything.
    pub fn fill(&self, place: BrickPlace, colors: &mut BrickColors) -> bool {
        self.source.fill(place, colors)
    }

    /// What no channel in a brick is above; at least 0.
    #[must_use]
    pub fn brightest(&self, place: BrickPlace) -> f32 {
        self.source.brightest(place)
    }

    /// The color of a voxel; black where there is none. Panics outside the grid.
    #[must_use]
    pub fn value(&self, [x, y, z]: [usize; 3]) -> [f32; 3] {
        let mut colors = [[0.0; 3]; VOXELS];
        let place = BrickPlace::new([x, y, z].map(|at| at / EDGE), self.size);
        let within = ((z % EDGE) * EDGE + y % EDGE) * EDGE + x % EDGE;
        if self.fill(place, &mut colors) { colors[within] } else { [0.0; 3] }
    }

    /// All of them, kept.
    #[must_use]
    pub fn bricks(&self) -> Bricks<[f32; 3]> {
        Bricks::make(self.size, |place, colors| self.fill(place, colors))
    }

    /// Bytes that they take, beside what others keep too.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.source.bytes()
    }
}

impl ColorSource for Bricks<[f32; 3]> {
    fn fill(&self, place: BrickPlace, colors: &mut BrickColors) -> bool {
        self.brick(place.brick).is_some_and(|brick| {
            *colors = *brick;
            true
        })
    }

    fn brightest(&self, place: BrickPlace) -> f32 {
        self.brick(place.brick).map_or(0.0, brightest)
    }

    fn bytes(&self) -> u64 {
        Self::bytes(self)
    }
}

/// One color, where there is anything.
#[derive(Debug)]
struct Alike {
    color: [f32; 3],
    opacity: Bricks<f32>,
}

impl ColorSource for Alike {
    fn fill(&self, place: BrickPlace, colors: &mut BrickColors) -> bool {
        self.opacity.brick(place.brick).is_some_and(|opacity| {
            fill_alike(self.color, opacity, colors);
            true
        })
    }

    fn brightest(&self, place: BrickPlace) -> f32 {
        let most = self.color.into_iter().fold(0.0, f32::max);
        self.opacity.brick(place.brick).map_or(0.0, |_| most)
    }

    fn bytes(&self) -> u64 {
        0
    }
}

/// Fills in the colors of a brick: the same wherever an opacity is above 0, and black elsewhere.
pub fn fill_alike(color: [f32; 3], opacity: &[f32; VOXELS], colors: &mut BrickColors) {
    for (made, opacity) in colors.iter_mut().zip(opacity) {
        *made = if *opacity > 0.0 { color } else { [0.0; 3] };
    }
}

/// The greatest channel of a brick's colors, at least 0.
#[must_use]
pub fn brightest(colors: &BrickColors) -> f32 {
    // Eight at a time, so that they are compared in lanes.
    let eights = colors.as_flattened().chunks_exact(8);
    let most = eights.fold([0.0; 8], |most: [f32; 8], eight| {
        std::array::from_fn(|i| if eight[i] > most[i] { eight[i] } else { most[i] })
    });
    most.into_iter().fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 3] = [20, 9, 8];

    fn opacity() -> Bricks<f32> {
        Bricks::make(SIZE, |place, alpha| {
            place.voxels().for_each(|(at, [x, y, _])| alpha[at] = if x > y { 0.5 } else { 0.0 });
            place.brick[0] > 0
        })
    }

    #[test]
    fn one_color_where_there_is_anything_is_that_color_in_every_voxel_of_it() {
        let color = [0.25, 0.0, 3.0];
        let (alike, opacity) = (VoxelColors::alike(Vec3::from(color), opacity()), opacity());
        let kept = opacity.map(|_, alpha, made| {
            made.iter_mut()
                .zip(alpha)
                .filter(|(_, a)| **a > 0.0)
                .for_each(|(made, _)| *made = color);
        });
        let kept = VoxelColors::from(kept);
        for (x, y) in (0..20).flat_map(|x| (0..9).map(move |y| (x, y))) {
            assert_eq!(alike.value([x, y, 5]), kept.value([x, y, 5]), "{x} {y}");
            assert_eq!(alike.value([x, y, 5]), alike.bricks().value([x, y, 5]));
            let place = BrickPlace::new([x / EDGE, y / EDGE, 0], SIZE);
            assert!(alike.brightest(place) >= kept.brightest(place));
        }
        assert!(alike.value([19, 3, 0]) == color && alike.bytes() == 0 && kept.bytes() > 0);
    }

    #[test]
    fn a_clone_is_the_same_and_what_is_made_again_is_not() {
        let colors = VoxelColors::alike(Vec3::ONE, opacity());
        assert_eq!(colors, colors.clone());
        assert_ne!(colors, VoxelColors::alike(Vec3::ONE, opacity()));
    }
}
