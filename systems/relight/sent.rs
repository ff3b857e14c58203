//! What the voxels of a layer send, all lights together: `c_T = Σ c_i β_i` (equation 4).

use rayon::prelude::*;

use crate::light::lit_bricks::{LitBricks, Rows, add};
use crate::light::strength::VoxelStrength;
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::voxel_colors::{BrickColors, VoxelColors};

/// Colors of the interesting voxels of a layer, and what weakens them.
#[derive(Debug)]
pub(crate) enum Sent<'a> {
    /// Light by light, as of a composite.
    Made {
        /// What no shadow weakens.
        base: &'a VoxelColors,
        /// c_i and β_i of each light that casts a shadow; `None` is β = 1.
        shadowed: Vec<(&'a VoxelColors, Option<&'a VoxelStrength>)>,
    },
    /// All lights at once.
    Lit(Box<LitBricks>),
}

impl Sent<'_> {
    /// Fills in `c_T` of a brick, of the rows in which an opacity `alpha` is above 0.
    pub fn fill(&self, place: BrickPlace, alpha: &[f32; VOXELS], sent: &mut Rows) {
        match self {
            Self::Lit(lights) => lights.light(place, alpha, sent),
            Self::Made { base, shadowed } => {
                let mut colors = [[0.0; 3]; VOXELS];
                if base.fill(place, &mut colors) {
                    for (row, sent) in sent.iter_mut().enumerate() {
                        *sent = channels(&colors, row);
                    }
                }
                for (light, strength) in shadowed {
                    if !light.fill(place, &mut colors) {
                        continue;
                    }
                    for (row, sent) in sent.iter_mut().enumerate() {
                        let betas = VoxelStrength::row(*strength, place.brick, row);
                        add(sent, &channels(&colors, row), betas);
                    }
                }
            }
        }
    }

    /// What no channel of `c_T` is above, of a layer in which `opacity` is stored.
    #[must_use]
    pub fn brightest(&self, opacity: &Bricks<f32>) -> f32 {
        let (base, shadowed) = match self {
            Self::Lit(lights) => return lights.brightest(),
            Self::Made { base, shadowed } => (base, shadowed),
        };
        let bricks: Vec<_> = opacity.stored().map(|(place, _)| place).collect();
        let most = |place: &BrickPlace| {
            let channel = |colors: &VoxelColors| colors.brightest(*place);
            let full = |strength: Option<&VoxelStrength>| strength.map_or(1.0, VoxelStrength::most);
            let shadowed = shadowed.iter();
            let shadowed: f32 = shadowed.map(|(light, beta)| channel(light) * full(*beta)).sum();
            channel(base) + shadowed
        };
        bricks.par_iter().map(most).reduce(|| 0.0, f32::max)
    }
}

/// A row of colors, channel by channel.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn channels(colors: &BrickColors, row: usize) -> [[f32; EDGE]; 3] {
    let colors = &colors.as_chunks::<EDGE>().0[row];
    std::array::from_fn(|channel| std::array::from_fn(|at| colors[at][channel]))
}
