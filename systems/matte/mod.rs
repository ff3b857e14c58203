//! Volume matting: polygons' colours and opacities combined with the volume's to c_C and α_C, in the order of the scene
//! (paper §3, figure 4).

mod backdrop;
mod matted;
mod matting;

use std::sync::Arc;

use glam::Vec3;
use hecs::{Entity, World};
use rayon::prelude::*;

use crate::components::{Matte, Order, Surface, Voxelize};
use crate::error::Error;
use crate::light::unlit::Unlit;
use crate::polygon::coverage::{Ball, Covered, Flat};
use crate::polygon::face::{FaceOpacities, Faces};
use crate::polygon::matted::matted;
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::volume::grid::Grid;
use crate::volume::layer::{Composite, Coverage, Layer, Opacity};
use crate::volume::scene_volumes::{SceneVolume, around, volumes};
use backdrop::Backdrop;
use matted::{Covering, Mattes};

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

#[derive(Clone, PartialEq)]
struct Polygon {
    coverage: Layer,
    voxelize: Voxelize,
    surface: Surface,
    faces: Faces,
    /// Parts of its surface's opacity that its faces have, where they are less opaque.
    opacities: Option<FaceOpacities>,
}

impl System for MattePolygons {
    type Product = Composite;
    const NAME: &'static str = "matte";
    const READS: &'static [ProductKey] =
        &[ProductKey::of::<Opacity>(), ProductKey::of::<Coverage>()];

    fn run(world: &World, out: &mut Outbox<'_, Composite>) -> Result<(), Error> {
        let (polygons, volumes) = (Polygon::all(world), volumes(world));
        if polygons.is_empty() {
            return Ok(());
        }
        let unlit = Unlit::all(world);
        for SceneVolume { entity, grid, unit, .. } in &volumes {
            let here = |polygon: &&Polygon| polygon.is_in(*entity, &volumes);
            let polygons: Vec<_> = polygons.iter().filter(here).cloned().collect();
            if !polygons.is_empty() {
                let unlit = unlit.iter().find(|(classified, _)| classified == entity);
                let unlit = unlit.map(|(_, unlit)| Arc::clone(unlit));
                let backdrop = Backdrop::of(world, *entity, unlit);
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
        let held: Vec<_> = volumes
            .iter()
            .map(|v| (v.entity, MayHold::of(world, v).with_polygons(world, v)))
            .collect();
        Plan::of(&held, MayHold::bytes::<f32>, MayHold::seen, "a polygon carries `voxelize`")
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

    /// What it covers, and what tells how much of a voxel it takes up.
    fn covering(&self, grid: &Grid, unit: f64) -> Covering {
        let (coverage, operator) = (self.coverage.clone(), self.voxelize.matte);
        let flats: Vec<Flat> =
            self.faces.0.par_iter().filter_map(|face| Flat::new(face, grid)).collect();
        let ball = Ball::stated(&self.surface, &self.voxelize, unit, grid, &flats);
        let least = |a: &f64, b: &f64| ball.peak(*a).total_cmp(&ball.peak(*b));
        let Some(layer) = flats.iter().map(|flat| flat.layer).min_by(least) else {
            return Covering { coverage, operator, peak: 1.0, own: None };
        };
        let peak = |part: f32| ball.opacity(f64::from(part), 0.5, layer).min(1.0) as f32;
        // What is half as opaque is not half there; the other operators do not ask.
        let asks = matches!(operator, Matte::In | Matte::Out);
        let own = self.opacities.as_ref().filter(|_| asks).map(|own| {
            let of_face = |at| Vec3::splat(peak(FaceOpacities::of(Some(own), at)));
            let covered = Covered::new(&self.faces.0, &flats, &ball, grid.size);
            covered.colors(&(0..flats.len()).map(of_face).collect::<Vec<_>>())
        });
        Covering { coverage, operator, peak: peak(1.0), own }
    }
}

impl Inputs {
    fn composite(&self) -> Layer {
        let covering = |polygon: &Polygon| polygon.covering(&self.grid, self.unit);
        let polygons = self.polygons.iter().map(covering).collect();
        let (backdrop, colors) = (self.backdrop.clone(), self.backdrop.colors());
        Mattes { grid: self.grid, backdrop, colors, polygons }.layer()
    }
}
