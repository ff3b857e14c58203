//! What polygons are matted with: a volume, brick by brick.

use std::sync::Arc;

use glam::Vec4;
use hecs::{Entity, World};

use crate::components::Clip;
use crate::light::lit_bricks::LitBricks;
use crate::light::unlit::Unlit;
use crate::volume::bricks::{BrickPlace, EDGE, VOXELS};
use crate::volume::grid::{Grid, Painted};
use crate::volume::layer::LitColors;
use crate::volume::painting::Painting;
use crate::volume::voxel_colors::{BrickColors, VoxelColors};

/// What a polygon is matted with.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Backdrop {
    /// Classified here, and lit where it is asked for.
    Classified(Arc<Unlit>),
    /// Came classified and shaded: no light of the scene changes its colours.
    Painted(Painted, Option<Clip>),
    /// Neither: the polygons are alone.
    Clear,
}

/// One of the colours of a layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Channel {
    Base,
    Shadowed(usize),
    Ambient,
}

impl Backdrop {
    /// That of a volume, of which `unlit` is what is classified, if it is.
    pub fn of(world: &World, entity: Entity, unlit: Option<Arc<Unlit>>) -> Self {
        if let Some(unlit) = unlit {
            return Self::Classified(unlit);
        }
        let clip = world.get::<&Clip>(entity).ok().map(|clip| (*clip).clone());
        let painted = world.get::<&Painted>(entity);
        painted.map_or(Self::Clear, |painted| Self::Painted((*painted).clone(), clip))
    }

    /// c_1 … c_L of what is classified, each as if no shadow fell on it.
    pub fn colors(&self) -> Option<LitColors> {
        let Self::Classified(unlit) = self else { return None };
        let colors = |lit: LitBricks| VoxelColors::new(unlit.grid.size, lit);
        Some(LitColors {
            base: colors(LitBricks::base(unlit)),
            shadowed: LitBricks::unshadowed(unlit).into_iter().map(colors).collect(),
            ambient: LitBricks::ambient(unlit).map(colors),
        })
    }

    /// Whether a voxel of a brick may have an opacity.
    pub fn may_hold(&self, place: BrickPlace) -> bool {
        match self {
            Self::Classified(unlit) => unlit.opacity.voxels.brick(place.brick).is_some(),
            Self::Painted(..) => true,
            Self::Clear => false,
        }
    }

    /// Fills in α_V of a brick, which comes zeroed.
    pub fn opacity(&self, grid: &Grid, place: BrickPlace, made: &mut [f32; VOXELS]) {
        match self {
            Self::Classified(unlit) => {
                let opacity = unlit.opacity.voxels.brick(place.brick);
                made.clone_from_slice(opacity.unwrap_or(&[0.0; VOXELS]));
            }
            Self::Painted(painted, clip) => {
                paint(painted, clip.as_ref(), grid, place, |at, [_, _, _, alpha]| made[at] = alpha);
            }
            Self::Clear => {}
        }
    }

    /// Fills in the colours of a brick that came with them, black where it is clear; it comes zeroed.
    pub fn paint(&self, grid: &Grid, place: BrickPlace, made: &mut BrickColors) {
        if let Self::Painted(painted, clip) = self {
            paint(painted, clip.as_ref(), grid, place, |at, [r, g, b, alpha]| {
                made[at] = if alpha > 0.0 { [r, g, b] } else { [0.0; 3] };
            });
        }
    }
}

/// Tells the straight colour and opacity of every voxel of a brick of a painted volume.
fn paint(
    painted: &Painted,
    clip: Option<&Clip>,
    grid: &Grid,
    place: BrickPlace,
    mut tell: impl FnMut(usize, [f32; 4]),
) {
    let painting = Painting::new(painted, grid, clip);
    let mut row = [Vec4::ZERO; EDGE];
    for z in 0..place.extent[2] {
        for y in 0..place.extent[1] {
            let row = &mut row[..place.extent[0]];
            row.fill(Vec4::ZERO);
            painting.row([place.first[0], place.first[1] + y, place.first[2] + z], row);
            for (x, voxel) in row.iter().enumerate() {
                tell((z * EDGE + y) * EDGE + x, voxel.to_array());
            }
        }
    }
}

impl Channel {
    /// That colour of a layer.
    pub fn of(self, colors: &LitColors) -> Option<&VoxelColors> {
        match self {
            Self::Base => Some(&colors.base),
            Self::Shadowed(light) => colors.shadowed.get(light),
            Self::Ambient => colors.ambient.as_ref(),
        }
    }
}
