//! A volume and polygons, matted a brick at a time: α_C is kept, and c_C made where it is asked for.

use std::sync::Arc;

use glam::Vec3;

use super::backdrop::{Backdrop, Channel};
use super::matting::{footprint, weights};
use crate::components::Matte;
use crate::volume::bricks::{BrickPlace, Bricks, VOXELS};
use crate::volume::grid::Grid;
use crate::volume::layer::{Layer, LitColors};
use crate::volume::voxel_colors::{BrickColors, ColorSource, VoxelColors, brightest};

/// A polygon, where it is and how much of a voxel it takes up there.
#[derive(Debug)]
pub(super) struct Covering {
    pub coverage: Layer,
    pub operator: Matte,
    /// α_G where it is wholly there and as opaque as its surface: the least over the faces' directions in the grid.
    pub peak: f32,
    /// The same for each voxel, of the faces that are there, where some are less opaque and an operator asks.
    pub own: Option<Bricks<[f32; 3]>>,
}

/// A volume and the polygons that are matted with it, in the order of the scene.
#[derive(Debug)]
pub(super) struct Mattes {
    pub grid: Grid,
    pub backdrop: Backdrop,
    /// Colours of the volume, if it is classified.
    pub colors: Option<LitColors>,
    pub polygons: Vec<Covering>,
}

/// One of the colours of what is matted.
#[derive(Debug)]
struct Matted {
    mattes: Arc<Mattes>,
    opacity: Bricks<f32>,
    channel: Channel,
}

impl Covering {
    /// Whether it is in a brick.
    fn is_in(&self, place: BrickPlace) -> bool {
        self.coverage.opacity.brick(place.brick).is_some()
    }

    /// Mattes it with what there is of a brick, whose opacities become those of both; tells of every voxel that changes, and
    /// what its opacity consists of.
    fn matte(
        &self,
        place: BrickPlace,
        alpha: &mut [f32; VOXELS],
        mut tell: impl FnMut(usize, [f32; 2]),
    ) {
        let Some(covered) = self.coverage.opacity.brick(place.brick) else { return };
        let own = self.own.as_ref().and_then(|own| own.brick(place.brick));
        for (at, &covered) in covered.iter().enumerate().filter(|(_, covered)| **covered > 0.0) {
            let part = footprint(covered, own.map_or(self.peak, |own| own[at][0]));
            let parts = weights(self.operator, covered, alpha[at], part);
            alpha[at] = (parts[0] + parts[1]).min(1.0);
            tell(at, parts);
        }
    }
}

impl Mattes {
    /// α_C, and c_C for each light that casts a shadow and for all others.
    pub fn layer(self) -> Layer {
        let opacity = self.opacity();
        let layers = || self.polygons.iter().map(|polygon| &polygon.coverage.colors);
        let apart = layers().any(|colors| colors.ambient.is_some());
        let lights = layers().map(|colors| colors.shadowed.len()).max().unwrap_or(0);
        let (size, mattes) = (self.grid.size, Arc::new(self));
        let colors = |channel| {
            let (mattes, opacity) = (Arc::clone(&mattes), opacity.clone());
            VoxelColors::new(size, Matted { mattes, opacity, channel })
        };
        let base = colors(Channel::Base);
        let shadowed = (0..lights).map(|light| colors(Channel::Shadowed(light))).collect();
        let ambient = apart.then(|| colors(Channel::Ambient));
        Layer { opacity: opacity.clone(), colors: LitColors { base, shadowed, ambient } }
    }

    fn opacity(&self) -> Bricks<f32> {
        let may_hold = |place: BrickPlace| {
            self.backdrop.may_hold(place) || self.polygons.iter().any(|p| p.is_in(place))
        };
        Bricks::make_where(self.grid.size, may_hold, |place, alpha| {
            self.backdrop.opacity(&self.grid, place, alpha);
            self.polygons.iter().for_each(|polygon| polygon.matte(place, alpha, |_, _| {}));
            alpha.iter().any(|&alpha| alpha > 0.0)
        })
    }
}

impl Matted {
    fn of_volume(&self) -> Option<&VoxelColors> {
        self.channel.of(self.mattes.colors.as_ref()?)
    }

    /// The colours of the volume alone.
    fn backdrop(&self, place: BrickPlace, colors: &mut BrickColors) {
        if self.of_volume().is_some_and(|own| own.fill(place, colors)) {
            return;
        }
        colors.fill([0.0; 3]);
        if self.channel == Channel::Base {
            self.mattes.backdrop.paint(&self.mattes.grid, place, colors);
        }
    }
}

impl ColorSource for Matted {
    fn fill(&self, place: BrickPlace, colors: &mut BrickColors) -> bool {
        if self.opacity.brick(place.brick).is_none() {
            return false;
        }
        let (mut alpha, mut own) = ([0.0; VOXELS], [[0.0; 3]; VOXELS]);
        self.mattes.backdrop.opacity(&self.mattes.grid, place, &mut alpha);
        self.backdrop(place, colors);
        for polygon in self.mattes.polygons.iter().filter(|polygon| polygon.is_in(place)) {
            let of_polygon = self.channel.of(&polygon.coverage.colors);
            let has_color = of_polygon.is_some_and(|colors| colors.fill(place, &mut own));
            polygon.matte(place, &mut alpha, |at, [of_polygon, of_volume]| {
                let whole = of_polygon + of_volume;
                let own = if has_color { Vec3::from(own[at]) } else { Vec3::ZERO };
                let part = if whole > 0.0 { of_polygon / whole } else { 0.0 };
                let mixed = Vec3::from(colors[at]).lerp(own, part);
                colors[at] = if whole > 0.0 { mixed.to_array() } else { [0.0; 3] };
            });
        }
        true
    }

    fn brightest(&self, place: BrickPlace) -> f32 {
        let of_volume = if let Some(colors) = self.of_volume() {
            colors.brightest(place)
        } else {
            let mut colors = [[0.0; 3]; VOXELS];
            self.backdrop(place, &mut colors);
            brightest(&colors)
        };
        let of_polygon = |polygon: &Covering| {
            self.channel.of(&polygon.coverage.colors).map_or(0.0, |color| color.brightest(place))
        };
        let polygons = self.mattes.polygons.iter().filter(|polygon| polygon.is_in(place));
        polygons.map(of_polygon).fold(of_volume, f32::max)
    }

    fn bytes(&self) -> u64 {
        0
    }
}
