//! What polygons are matted with: a volume, brick by brick.

use glam::Vec4;
use hecs::{Entity, World};

use crate::components::Clip;
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::grid::{Grid, Painted};
use crate::volume::layer::{LitColors, Opacity};
use crate::volume::painting::Painting;
use crate::volume::voxel_colors::{BrickColors, VoxelColors, brightest};

/// What a polygon is matted with.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Backdrop {
    /// Classified and shaded here.
    Made(Bricks<f32>, LitColors),
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
    /// That of a volume, as far as it is made.
    pub fn of(world: &World, entity: Entity) -> Self {
        let opacity = world.get::<&Opacity>(entity).ok();
        let colors = world.get::<&LitColors>(entity).ok();
        if let (Some(opacity), Some(colors)) = (opacity, colors) {
            return Self::Made(opacity.voxels.clone(), (*colors).clone());
        }
        let clip = world.get::<&Clip>(entity).ok().map(|clip| (*clip).clone());
        let painted = world.get::<&Painted>(entity);
        painted.map_or(Self::Clear, |painted| Self::Painted((*painted).clone(), clip))
    }

    /// Whether a voxel of a brick may have an opacity.
    pub fn may_hold(&self, place: BrickPlace) -> bool {
        match self {
            Self::Made(opacity, _) => opacity.brick(place.brick).is_some(),
            Self::Painted(..) => true,
            Self::Clear => false,
        }
    }

    /// Fills in α_V of a brick, which comes zeroed.
    pub fn opacity(&self, grid: &Grid, place: BrickPlace, made: &mut [f32; VOXELS]) {
        match self {
            Self::Made(opacity, _) => {
                made.clone_from_slice(opacity.brick(place.brick).unwrap_or(&[0.0; VOXELS]));
            }
            Self::Painted(painted, clip) => {
                paint(painted, clip.as_ref(), grid, place, |at, [_, _, _, alpha]| made[at] = alpha);
            }
            Self::Clear => {}
        }
    }

    /// Fills in one of the colours of a brick, which comes zeroed.
    pub fn color(&self, grid: &Grid, place: BrickPlace, channel: Channel, made: &mut BrickColors) {
        match self {
            Self::Made(_, colors) => {
                if !channel.of(colors).is_some_and(|colors| colors.fill(place, made)) {
                    made.fill([0.0; 3]);
                }
            }
            Self::Painted(painted, clip) if channel == Channel::Base => {
                paint(painted, clip.as_ref(), grid, place, |at, [r, g, b, _]| made[at] = [r, g, b]);
            }
            Self::Painted(..) | Self::Clear => {}
        }
    }

    /// What none of such colours in a brick is above.
    pub fn brightest(&self, grid: &Grid, place: BrickPlace, channel: Channel) -> f32 {
        if let Self::Made(_, colors) = self {
            return channel.of(colors).map_or(0.0, |colors| colors.brightest(place));
        }
        let mut made = [[0.0; 3]; VOXELS];
        self.color(grid, place, channel, &mut made);
        brightest(&made)
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
