//! Components that a caller of the library puts into a world, held to what scene files are held to.

use hecs::World;

use super::table::COMPONENTS;
use crate::components::Name;
use crate::error::Error;

/// Checks every component of a world that a scene could state: numbers within their ranges, keys that suit each other.
///
/// What was checked is not checked again until it is changed. The error is of the first entity that is at fault.
pub fn check_world(world: &mut World) -> Result<(), Error> {
    for row in &COMPONENTS {
        row.check_world(world).map_err(|(entity, problem)| {
            let name = world.get::<&Name>(entity).map(|name| name.0.clone());
            Error::entity(name.unwrap_or_else(|_| entity.id().to_string()), problem)
        })?;
    }
    Ok(())
}
