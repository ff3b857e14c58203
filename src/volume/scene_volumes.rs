//! Which volumes a scene has: the one place that says so, to every stage and every plan.

use glam::DVec3;
use hecs::{Entity, World};

use crate::components::{CastsShadow, Classify, OpacityUnit, Order, Projection, Reconstruct};
use crate::volume::grid::{Grid, Painted, Scalars};

/// A volume of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneVolume {
    /// Its entity.
    pub entity: Entity,
    /// Where its voxels are.
    pub grid: Grid,
    /// u: the thickness that its opacities are stated for, world units; the smallest spacing where none is stated.
    pub unit: f64,
    /// What its voxels hold.
    pub content: Content,
}

/// What the voxels of a volume hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// Scalars, with a classification that says what is seen of them.
    Classified,
    /// Scalars of which a ray shows one: no gel is made of them.
    Projected,
    /// Scalars with a classification, which is asked where rays sample them and not at voxels.
    Values,
    /// RGBA: nothing is to be classified and shaded.
    Painted,
    /// Nothing that is seen by itself: a place for polygons to be scan-converted into.
    Clear,
}

impl SceneVolume {
    /// Voxels on each axis.
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        self.grid.size
    }

    /// Whether a world point lies in its domain.
    fn holds(&self, point: DVec3) -> bool {
        let index = self.grid.world_to_index().transform_point3(point);
        let last = DVec3::from(self.grid.size.map(|n| (n - 1) as f64));
        index.cmpge(DVec3::ZERO).all() && index.cmple(last).all()
    }
}

/// The volumes of a scene, in its order.
#[must_use]
pub fn volumes(world: &World) -> Vec<SceneVolume> {
    type How<'a> = (Option<&'a Projection>, Option<&'a Reconstruct>);
    type Voxels<'a> = (Option<&'a Scalars>, Option<&'a Classify>, Option<&'a Painted>, How<'a>);
    type Volume<'a> = (Entity, &'a Grid, Option<&'a OpacityUnit>, Option<&'a Order>, Voxels<'a>);
    let mut query = world.query::<Volume<'_>>();
    let mut found: Vec<_> = query.iter().collect();
    found.sort_by_key(|(entity, _, _, order, _)| (order.copied(), *entity));
    let volume = |(entity, grid, unit, _, voxels): <Volume<'_> as hecs::Query>::Item<'_>| {
        let content = match voxels {
            (Some(_), Some(_), _, (Some(_), _)) => Content::Projected,
            (Some(_), Some(_), _, (_, Some(Reconstruct::Values))) => Content::Values,
            (Some(_), Some(_), ..) => Content::Classified,
            (_, _, Some(_), _) => Content::Painted,
            _ => Content::Clear,
        };
        let unit = unit.map_or_else(|| grid.spacing().min_element(), |unit| unit.0);
        SceneVolume { entity, grid: *grid, unit, content }
    };
    found.into_iter().map(volume).collect()
}

/// Those whose voxels hold this, in the order of the scene.
#[must_use]
pub(crate) fn with_content(world: &World, content: Content) -> Vec<SceneVolume> {
    volumes(world).into_iter().filter(|volume| volume.content == content).collect()
}

/// Those of scalars that state how they are classified, wherever that is asked, in the order of the scene.
#[must_use]
pub fn scanned(world: &World) -> Vec<SceneVolume> {
    use Content::{Classified, Projected, Values};
    let is_scanned = |v: &SceneVolume| matches!(v.content, Classified | Projected | Values);
    volumes(world).into_iter().filter(is_scanned).collect()
}

/// Those whose opacities at voxels something asks for: all that are classified there, and all others of scalars where a
/// light casts shadows.
#[must_use]
pub(crate) fn with_opacities(world: &World) -> Vec<SceneVolume> {
    let shadows = world.query::<&CastsShadow>().iter().next().is_some();
    let asked = |v: &SceneVolume| match v.content {
        Content::Classified => true,
        Content::Values => shadows,
        _ => false,
    };
    scanned(world).into_iter().filter(asked).collect()
}

/// Those that are seen by themselves, in the order of the scene.
#[must_use]
pub fn visible(world: &World) -> Vec<SceneVolume> {
    volumes(world).into_iter().filter(|volume| volume.content != Content::Clear).collect()
}

/// Those that are made gel of, in the order of the scene.
#[must_use]
pub fn gels(world: &World) -> Vec<SceneVolume> {
    let mut gels = stepped(world);
    gels.retain(|volume| volume.content != Content::Values);
    gels
}

/// Those that rays go through sample by sample, in the order of the scene.
#[must_use]
pub fn stepped(world: &World) -> Vec<SceneVolume> {
    let mut stepped = visible(world);
    stepped.retain(|volume| volume.content != Content::Projected);
    stepped
}

/// Which of some volumes something around `middle` (a world point) is scan-converted into: the first that holds it, else
/// the first. The middle is not asked for where it makes no difference.
#[must_use]
pub fn around(
    volumes: &[SceneVolume],
    middle: impl FnOnce() -> Option<DVec3>,
) -> Option<SceneVolume> {
    let middle = if volumes.len() > 1 { middle() } else { None };
    let holding = middle.and_then(|middle| volumes.iter().find(|volume| volume.holds(middle)));
    holding.or(volumes.first()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::Shared;

    fn grid(at: f64) -> Grid {
        Grid::axis_aligned([2; 3], [1.0; 3], [at; 3]).unwrap()
    }

    #[test]
    fn volumes_come_in_the_order_of_the_scene_with_what_their_voxels_hold() {
        let mut world = World::new();
        let scalars = Scalars::U8(Shared::new(vec![0; 8]));
        let paint = Painted::U8(Shared::new(vec![[0; 4]; 8]));
        let clear = world.spawn((Order(2), grid(0.0), scalars.clone()));
        let tissue = world.spawn((Order(1), grid(0.0), scalars, Classify::<f32>::default()));
        let paint = world.spawn((Order(0), grid(0.0), paint, OpacityUnit(3.0)));
        let found: Vec<_> = volumes(&world).iter().map(|v| (v.entity, v.content, v.unit)).collect();
        let expected = [
            (paint, Content::Painted, 3.0),
            (tissue, Content::Classified, 1.0),
            (clear, Content::Clear, 1.0),
        ];
        assert_eq!(found, expected);
        assert_eq!(visible(&world).len(), 2);
        assert_eq!(with_content(&world, Content::Classified)[0].entity, tissue);
    }

    #[test]
    fn what_lies_in_the_second_volume_is_scan_converted_into_it_and_what_lies_in_none_into_the_first()
     {
        let mut world = World::new();
        world.spawn((Order(0), grid(0.0)));
        world.spawn((Order(1), grid(5.0)));
        let volumes = volumes(&world);
        let place =
            |at: f64| around(&volumes, || Some(DVec3::splat(at))).map(|volume| volume.entity);
        let [first, second] = [Some(volumes[0].entity), Some(volumes[1].entity)];
        assert_eq!([place(0.5), place(5.5), place(20.0)], [first, second, first]);
        assert_eq!(around(&[], || None), None);
    }
}
