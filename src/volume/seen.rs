//! Which volumes of a scene will be seen, from what is stated alone: for plans.

use hecs::{Entity, World};

use crate::components::{Classify, OpacityUnit, Order};
use crate::volume::grid::{Grid, Painted, Scalars};

/// A volume that will be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Its entity.
    pub entity: Entity,
    /// Its voxels on each axis.
    pub size: [usize; 3],
    /// Whether it comes painted, with nothing to classify and shade.
    pub painted: bool,
}

/// The scene's first volume: its entity, its grid, and its opacity unit (the smallest spacing where none is stated).
#[must_use]
pub fn first(world: &World) -> Option<(Entity, Grid, f64)> {
    let mut query = world.query::<(Entity, &Grid, Option<&OpacityUnit>, Option<&Order>)>();
    let (entity, grid, unit, _) = query.iter().min_by_key(|(.., order)| order.copied())?;
    Some((entity, *grid, unit.map_or_else(|| grid.spacing().min_element(), |unit| unit.0)))
}

/// Volumes of scalars that state how they are classified.
#[must_use]
pub fn classified(world: &World) -> Vec<Seen> {
    let mut volumes =
        world.query::<(Entity, &Grid)>().with::<(&Scalars, &Classify, &OpacityUnit)>();
    let seen = |(entity, grid): (Entity, &Grid)| Seen { entity, size: grid.size, painted: false };
    volumes.iter().map(seen).collect()
}

/// Volumes that will be gel: classified or painted, an entity once.
#[must_use]
pub fn all(world: &World) -> Vec<Seen> {
    let mut seen = classified(world);
    for (entity, grid) in &mut world.query::<(Entity, &Grid)>().with::<&Painted>() {
        if seen.iter().all(|other| other.entity != entity) {
            seen.push(Seen { entity, size: grid.size, painted: true });
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::Shared;

    #[test]
    fn scalars_are_seen_if_classified_and_paint_always() {
        let mut world = World::new();
        let grid = Grid::axis_aligned([2; 3], [1.0; 3], [0.0; 3]).unwrap();
        let scalars = Scalars::U8(Shared::new(vec![0; 8]));
        world.spawn((grid, scalars.clone()));
        let tissue = world.spawn((grid, scalars, Classify::<f32>::default(), OpacityUnit(1.0)));
        let paint = world.spawn((grid, Painted::U8(Shared::new(vec![[0; 4]; 8]))));
        let entities = |seen: Vec<Seen>| seen.iter().map(|seen| seen.entity).collect::<Vec<_>>();
        assert_eq!(entities(classified(&world)), [tissue]);
        assert_eq!(entities(all(&world)), [tissue, paint]);
    }
}
