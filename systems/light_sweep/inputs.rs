//! What a light's strengths are made from, found in the world.

use glam::DVec3;
use hecs::{Entity, World};

use crate::components::{CastsShadow, Order, Shaft, Voxelize};
use crate::error::Error;
use crate::light::strength::ProjectedBy;
use crate::polygon::face::Faces;
use crate::volume::bricks::Bricks;
use crate::volume::grid::{Grid, Painted, Scalars};
use crate::volume::layer::{Composite, Coverage, Opacity};

/// What one light's strengths are made from. Nothing of a view, but for a light that stands at the observer.
#[derive(PartialEq)]
pub(super) struct Inputs {
    pub grid: Grid,
    /// u, world units.
    pub unit: f64,
    pub opacity: Source,
    /// The opacities of hybrid polygons, which cast shadows without being in the volume.
    pub polygons: Vec<Bricks<f32>>,
    /// Unit vector towards the light.
    pub toward: DVec3,
    pub shadow: CastsShadow,
    pub projected: Option<ProjectedBy>,
    /// Whether something reads strengths outside the voxels.
    pub buffer: bool,
}

/// The opacity that is lit: matted, or the volume's own.
#[derive(PartialEq, Clone)]
pub(super) enum Source {
    Made(Bricks<f32>),
    Painted(Painted),
}

/// The first volume of the scene with an opacity: of the matted voxels, of the volume's own, of its painted ones.
pub(super) fn lit_volume(world: &World) -> Option<(Entity, Grid, Source)> {
    type Opacities<'a> = (Option<&'a Composite>, Option<&'a Opacity>, Option<&'a Painted>);
    let mut query = world.query::<(Entity, &Grid, Option<&Order>, Opacities<'_>)>();
    let volumes =
        query.iter().filter_map(|(entity, grid, order, (composite, opacity, painted))| {
            let source = composite
                .map(|composite| Source::Made(composite.0.opacity.clone()))
                .or_else(|| opacity.map(|opacity| Source::Made(opacity.voxels.clone())))
                .or_else(|| painted.map(|painted| Source::Painted(painted.clone())))?;
            Some((order.copied(), (entity, *grid, source)))
        });
    volumes.min_by_key(|(order, (entity, ..))| (*order, *entity)).map(|(_, volume)| volume)
}

/// What casts shadows though it is drawn by the hybrid ray tracer, in the order of the scene.
pub(super) fn hybrid_coverage(world: &World, grid: &Grid) -> Result<Vec<Bricks<f32>>, Error> {
    let mut query = world
        .query::<(Entity, &Coverage, Option<&Order>)>()
        .with::<&Faces>()
        .without::<&Voxelize>();
    let mut found: Vec<_> = query.iter().collect();
    found.sort_by_key(|(entity, _, order)| (order.copied(), *entity));
    let opacity = |(_, coverage, _): (Entity, &Coverage, Option<&Order>)| {
        let opacity = &coverage.0.opacity;
        if opacity.size() == grid.size {
            return Ok(opacity.clone());
        }
        let problem = format!(
            "a coverage of {:?} voxels was made for a volume of {:?}",
            opacity.size(),
            grid.size
        );
        Err(Error::Schedule(problem))
    };
    found.into_iter().map(opacity).collect()
}

/// The grid of the first volume that states voxels: what a plan knows before anything is made.
pub(super) fn stated_grid(world: &World) -> Option<Grid> {
    let mut query =
        world.query::<(Entity, &Grid, Option<&Order>, Option<&Scalars>, Option<&Painted>)>();
    let stated =
        query.iter().filter(|(.., scalars, painted)| scalars.is_some() || painted.is_some());
    stated.min_by_key(|(entity, _, order, ..)| (order.copied(), *entity)).map(|found| *found.1)
}

/// Whether hybrid polygons receive this light, or a shaft of it is seen.
pub(super) fn reads_buffer(world: &World, light: Entity) -> bool {
    world.query::<&Faces>().without::<&Voxelize>().iter().next().is_some()
        || world.get::<&Shaft>(light).is_ok_and(|shaft| shaft.attenuated)
}
