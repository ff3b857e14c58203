//! Volume matting: polygons' colours and opacities combined with the volume's to c_C and α_C, in the order of the scene
//! (paper §3, figure 4).

mod matting;

use glam::{Vec3, Vec4};
use hecs::{Entity, World};
use rayon::prelude::*;

use crate::components::{CastsShadow, Clip, Light, Matte, Order, Surface, Voxelize};
use crate::error::Error;
use crate::polygon::coverage::{Ball, Covered, Flat};
use crate::polygon::face::{FaceOpacities, Faces};
use crate::polygon::matted::matted;
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::observer;
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::grid::{Grid, Painted};
use crate::volume::layer::{Composite, Coverage, Layer, LitColors, Opacity};
use crate::volume::painting::Painting;
use crate::volume::scene_volumes::{SceneVolume, around, volumes};
use matting::{footprint, weights};

/// Makes the [`Composite`] of every volume that some polygon is scan-converted into.
pub struct MattePolygons;

/// What a composite is made from: the volume, and the polygons in the order of the scene.
#[derive(Clone, PartialEq)]
struct Inputs {
    grid: Grid,
    unit: f64,
    backdrop: Backdrop,
    polygons: Vec<Polygon>,
}

/// What a polygon is matted with.
#[derive(Clone, PartialEq)]
enum Backdrop {
    /// Classified and shaded here.
    Made(Bricks<f32>, LitColors),
    /// Came classified and shaded: no light of the scene changes its colours.
    Painted(Painted, Option<Clip>),
    /// Neither: the polygons are alone.
    Clear,
}

#[derive(Clone, PartialEq)]
struct Polygon {
    coverage: Layer,
    voxelize: Voxelize,
    surface: Surface,
    faces: Faces,
    /// Parts of its surface's opacity that its faces have, where they are less opaque.
    opacities: Option<FaceOpacities>,
}

/// What tells where a polygon is, and how much of a voxel it takes up there.
struct There {
    /// α_G where it is wholly there and as opaque as its surface: the least over the faces' directions in the grid.
    peak: f32,
    /// The same for each voxel, of the faces that are there, where some are less opaque and an operator asks.
    own: Option<Bricks<[f32; 3]>>,
}

/// One of the colours that a layer keeps.
#[derive(Clone, Copy, PartialEq)]
enum Channel {
    Base,
    Shadowed(usize),
    Ambient,
}

impl System for MattePolygons {
    type Product = Composite;
    const NAME: &'static str = "matte";
    const READS: &'static [ProductKey] =
        &[ProductKey::of::<Opacity>(), ProductKey::of::<LitColors>(), ProductKey::of::<Coverage>()];

    fn run(world: &World, out: &mut Outbox<'_, Composite>) -> Result<(), Error> {
        let (polygons, volumes) = (Polygon::all(world), volumes(world));
        for SceneVolume { entity, grid, unit, .. } in &volumes {
            let here = |polygon: &&Polygon| polygon.is_in(*entity, &volumes);
            let polygons: Vec<_> = polygons.iter().filter(here).cloned().collect();
            if !polygons.is_empty() {
                let backdrop = Backdrop::of(world, *entity);
                let inputs = Inputs { grid: *grid, unit: *unit, backdrop, polygons };
                out.derive(*entity, inputs, |inputs| Ok(Composite(inputs.composite())))?;
            }
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let volumes = matted(world);
        if volumes.is_empty() {
            return Plan::absent("no polygon is scan-converted into a volume");
        }
        let cued = observer::is_cued(world);
        let shadowed = world.query::<&Light>().with::<&CastsShadow>().iter().count();
        let held: Vec<_> = volumes
            .iter()
            .map(|v| (v.entity, MayHold::of(world, v).with_polygons(world, v)))
            .collect();
        let colors = 1 + u64::from(cued) + shadowed as u64;
        let most = |held: &MayHold| {
            colors.saturating_mul(held.bytes::<[f32; 3]>()).saturating_add(held.bytes::<f32>())
        };
        Plan::of(&held, most, MayHold::seen, "a polygon carries `voxelize`")
    }
}

impl Backdrop {
    fn of(world: &World, entity: Entity) -> Self {
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
    fn may_hold(&self, place: BrickPlace) -> bool {
        match self {
            Self::Made(opacity, _) => opacity.brick(place.brick).is_some(),
            Self::Painted(..) => true,
            Self::Clear => false,
        }
    }

    /// Fills in α_V of a brick, which comes zeroed.
    fn opacity(&self, grid: &Grid, place: BrickPlace, made: &mut [f32; VOXELS]) {
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
    fn color(
        &self,
        grid: &Grid,
        place: BrickPlace,
        channel: Channel,
        made: &mut [[f32; 3]; VOXELS],
    ) {
        match self {
            Self::Made(_, colors) => {
                if let Some(brick) = channel.of(colors).and_then(|bricks| bricks.brick(place.brick))
                {
                    *made = *brick;
                }
            }
            Self::Painted(painted, clip) if channel == Channel::Base => {
                paint(painted, clip.as_ref(), grid, place, |at, [r, g, b, _]| made[at] = [r, g, b]);
            }
            Self::Painted(..) | Self::Clear => {}
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

impl Polygon {
    /// Every scan-converted polygon, in the order of the scene.
    fn all(world: &World) -> Vec<Self> {
        type Stated<'a> = (
            (&'a Coverage, &'a Voxelize, &'a Surface),
            (&'a Faces, Option<&'a FaceOpacities>),
            Option<&'a Order>,
        );
        let mut query = world.query::<Stated<'_>>();
        let mut all: Vec<_> = query.iter().collect();
        all.sort_by_key(|(.., order)| order.copied());
        let polygon = |((coverage, voxelize, surface), (faces, opacities), _): Stated<'_>| Self {
            coverage: coverage.0.clone(),
            voxelize: voxelize.clone(),
            surface: surface.clone(),
            faces: faces.clone(),
            opacities: opacities.cloned(),
        };
        all.into_iter().map(polygon).collect()
    }

    /// Whether it is scan-converted into this of some volumes.
    fn is_in(&self, entity: Entity, volumes: &[SceneVolume]) -> bool {
        around(volumes, || self.faces.middle()).is_some_and(|volume| volume.entity == entity)
    }

    /// What tells how much of a voxel it takes up.
    fn there(&self, grid: &Grid, unit: f64) -> There {
        let flats: Vec<Flat> =
            self.faces.0.par_iter().filter_map(|face| Flat::new(face, grid)).collect();
        let ball = Ball::stated(&self.surface, &self.voxelize, unit, grid, &flats);
        let least = |a: &f64, b: &f64| ball.peak(*a).total_cmp(&ball.peak(*b));
        let Some(layer) = flats.iter().map(|flat| flat.layer).min_by(least) else {
            return There { peak: 1.0, own: None };
        };
        let peak = |part: f32| ball.opacity(f64::from(part), 0.5, layer).min(1.0) as f32;
        // What is half as opaque is not half there; the other operators do not ask.
        let asks = matches!(self.voxelize.matte, Matte::In | Matte::Out);
        let own = self.opacities.as_ref().filter(|_| asks).map(|own| {
            let of_face = |at| Vec3::splat(peak(FaceOpacities::of(Some(own), at)));
            let covered = Covered::new(&self.faces.0, &flats, &ball, grid.size);
            covered.colors(&(0..flats.len()).map(of_face).collect::<Vec<_>>())
        });
        There { peak: peak(1.0), own }
    }
}

impl Channel {
    fn of(self, colors: &LitColors) -> Option<&Bricks<[f32; 3]>> {
        match self {
            Self::Base => Some(&colors.base),
            Self::Shadowed(light) => colors.shadowed.get(light),
            Self::Ambient => colors.ambient.as_ref(),
        }
    }
}

impl Inputs {
    fn composite(&self) -> Layer {
        let there: Vec<There> =
            self.polygons.iter().map(|p| p.there(&self.grid, self.unit)).collect();
        let opacity = Bricks::make_where(self.grid.size, |place| self.may_hold(place), |place, alpha| {
            self.backdrop.opacity(&self.grid, place, alpha);
            self.matte(&there, place, alpha, |_, _, _, _| {});
            alpha.iter().any(|&alpha| alpha > 0.0)
        });
        let layers = || self.polygons.iter().map(|polygon| &polygon.coverage.colors);
        let apart = layers().any(|colors| colors.ambient.is_some());
        let bricks = |channel| self.color(&there, &opacity, channel);
        let lights = layers().map(|colors| colors.shadowed.len()).max().unwrap_or(0);
        let base = bricks(Channel::Base);
        let shadowed = (0..lights).map(|light| bricks(Channel::Shadowed(light))).collect();
        let ambient = apart.then(|| bricks(Channel::Ambient));
        Layer { opacity, colors: LitColors { base, shadowed, ambient } }
    }

    /// Whether anything may be in a brick.
    fn may_hold(&self, place: BrickPlace) -> bool {
        let of_polygon = |polygon: &Polygon| polygon.coverage.opacity.brick(place.brick).is_some();
        self.backdrop.may_hold(place) || self.polygons.iter().any(of_polygon)
    }

    /// One of the composite's colours. Bricks in which it is black are kept of `base` alone.
    fn color(&self, there: &[There], opacity: &Bricks<f32>, channel: Channel) -> Bricks<[f32; 3]> {
        let is_stored = |place: BrickPlace| opacity.brick(place.brick).is_some();
        Bricks::make_where(self.grid.size, is_stored, |place, made| {
            let mut alpha = [0.0; VOXELS];
            self.backdrop.opacity(&self.grid, place, &mut alpha);
            self.backdrop.color(&self.grid, place, channel, made);
            self.matte(there, place, &mut alpha, |colors, at, parts, whole| {
                let of_polygon = channel.of(colors).and_then(|bricks| bricks.brick(place.brick));
                let of_polygon = of_polygon.map_or(Vec3::ZERO, |brick| Vec3::from(brick[at]));
                let part = if whole > 0.0 { parts[0] / whole } else { 0.0 };
                let mixed = Vec3::from(made[at]).lerp(of_polygon, part);
                made[at] = if whole > 0.0 { mixed.to_array() } else { [0.0; 3] };
            });
            channel == Channel::Base || made.iter().any(|color| *color != [0.0; 3])
        })
    }

    /// Mattes every polygon in turn with what there is of a brick, from α_V to α_C; tells of every voxel that changes.
    fn matte(
        &self,
        there: &[There],
        place: BrickPlace,
        alpha: &mut [f32; VOXELS],
        mut tell: impl FnMut(&LitColors, usize, [f32; 2], f32),
    ) {
        for (polygon, there) in self.polygons.iter().zip(there) {
            let Some(covered) = polygon.coverage.opacity.brick(place.brick) else { continue };
            let own = there.own.as_ref().and_then(|own| own.brick(place.brick));
            for (at, &covered) in covered.iter().enumerate().filter(|(_, covered)| **covered > 0.0)
            {
                let part = footprint(covered, own.map_or(there.peak, |own| own[at][0]));
                let parts = weights(polygon.voxelize.matte, covered, alpha[at], part);
                alpha[at] = (parts[0] + parts[1]).min(1.0);
                tell(&polygon.coverage.colors, at, parts, parts[0] + parts[1]);
            }
        }
    }
}
