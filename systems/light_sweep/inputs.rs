//! What a light's strengths are made from, found in the world.

use glam::DVec3;
use hecs::{Entity, World};

use crate::components::{CastsShadow, Clip, Order, Shaft, Voxelize};
use crate::error::Error;
use crate::light::strength::ProjectedBy;
use crate::polygon::face::Faces;
use crate::volume::bricks::Bricks;
use crate::volume::grid::{Grid, Painted, Scalars};
use crate::volume::layer::{Composite, Coverage, Opacity};
use crate::volume::scene_volumes::{Content, SceneVolume, around, volumes, with_content};

/// What one light's strengths are made from. Nothing of a view, but for a light that stands at the observer.
#[derive(PartialEq)]
pub(super) struct Inputs {
    /// What it shines through, in the order of the scene.
    pub volumes: Vec<LitVolume>,
    /// Unit vector towards the light.
    pub toward: DVec3,
    pub shadow: CastsShadow,
    pub projected: Option<ProjectedBy>,
    /// Whether something reads strengths outside the voxels.
    pub buffer: bool,
}

/// A volume that lights shine through.
#[derive(PartialEq, Clone)]
pub(super) struct LitVolume {
    pub entity: Entity,
    pub grid: Grid,
    /// u, world units.
    pub unit: f64,
    pub opacity: LitOpacity,
    /// The opacities of hybrid polygons, which cast shadows without being in the volume.
    pub polygons: Vec<Bricks<f32>>,
}

/// The opacity that is lit: matted, or the volume's own.
#[derive(PartialEq, Clone)]
pub(super) enum LitOpacity {
    Made(Bricks<f32>),
    Painted(Painted, Option<Clip>),
}

/// The volumes of the scene with an opacity: of their matted voxels, of their own, of their painted ones.
pub(super) fn lit_volumes(world: &World) -> Result<Vec<LitVolume>, Error> {
    let all = volumes(world);
    let mut lit = Vec::new();
    for SceneVolume { entity, grid, unit, .. } in &all {
        let composite = world.get::<&Composite>(*entity).ok();
        let made = composite.map(|composite| composite.0.opacity.clone());
        let own = || Some(world.get::<&Opacity>(*entity).ok()?.voxels.clone());
        let painted = || {
            let painted = (*world.get::<&Painted>(*entity).ok()?).clone();
            let clip = world.get::<&Clip>(*entity).ok().map(|clip| (*clip).clone());
            Some(LitOpacity::Painted(painted, clip))
        };
        let opacity = made.or_else(own).map(LitOpacity::Made).or_else(painted);
        if let Some(opacity) = opacity {
            let polygons = hybrid_coverage(world, &all, (*entity, grid))?;
            lit.push(LitVolume { entity: *entity, grid: *grid, unit: *unit, opacity, polygons });
        }
    }
    Ok(lit)
}

/// What casts shadows in a volume though it is drawn by the hybrid ray tracer, in the order of the scene.
fn hybrid_coverage(
    world: &World,
    all: &[SceneVolume],
    (volume, grid): (Entity, &Grid),
) -> Result<Vec<Bricks<f32>>, Error> {
    let mut query =
        world.query::<(Entity, &Coverage, &Faces, Option<&Order>)>().without::<&Voxelize>();
    let mut found: Vec<_> = query.iter().collect();
    found.retain(|(_, _, faces, _)| {
        around(all, || faces.middle()).is_some_and(|around| around.entity == volume)
    });
    found.sort_by_key(|(entity, .., order)| (order.copied(), *entity));
    let opacity = |(_, coverage, ..): (Entity, &Coverage, &Faces, Option<&Order>)| {
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

/// The volumes that will be lit: what a plan knows before anything is made.
pub(super) fn stated_volumes(world: &World) -> Vec<SceneVolume> {
    let mut all = volumes(world);
    let voxelized = world.query::<&Voxelize>().iter().next().is_some();
    let is_scanned = |entity| world.get::<&Scalars>(entity).is_ok();
    all.retain(|volume| match volume.content {
        Content::Projected => voxelized,
        Content::Clear => voxelized || is_scanned(volume.entity),
        Content::Classified | Content::Values | Content::Painted => true,
    });
    all
}

/// Whether hybrid polygons or values at samples receive this light, or a shaft of it is seen.
pub(super) fn reads_buffer(world: &World, light: Entity) -> bool {
    !with_content(world, Content::Values).is_empty()
        || world.query::<&Faces>().without::<&Voxelize>().iter().next().is_some()
        || world.get::<&Shaft>(light).is_ok_and(|shaft| shaft.attenuated)
}
