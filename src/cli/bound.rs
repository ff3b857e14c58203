//! The most bytes that a scene takes, before any is taken.

use gelray::schedule::{Job, Schedule};
use hecs::World;

use super::failure::Failure;
use super::flags::Flags;
use super::{memory, stats};

/// Refuses a scene whose voxels and products could take more memory than `--max-memory` allows.
pub fn check_memory(schedule: &Schedule, world: &World, flags: &Flags) -> Result<(), Failure> {
    let taken = stats::voxels(world);
    let needed = most_bytes(schedule, world) - taken;
    memory::allowed(flags, taken).map_or(Ok(()), |allowed| allowed.check(needed, taken))
}

/// The jobs of a schedule, in the order in which they run.
pub fn jobs(schedule: &Schedule) -> impl Iterator<Item = &Job> {
    schedule.waves().iter().flatten()
}

/// The voxels that were read, and the most that systems can make of them.
pub fn most_bytes(schedule: &Schedule, world: &World) -> u64 {
    let plans = jobs(schedule).map(|job| (job.plan)(world).bytes());
    plans.fold(stats::voxels(world), u64::saturating_add)
}
