//! Volumes whose values are sampled: what cannot be done to them, and what is stated without effect.

use hecs::World;

use super::carriers::{carriers, get};
use super::fault::{Fault, Notice};
use crate::components::{Classify, Filter, Reconstruct, Sampling, View, Voxelize};
use crate::polygon::face::Faces;
use crate::volume::labels::Tint;
use crate::volume::scene_volumes::{Content, around, volumes};

/// Checks that no polygon is scan-converted into values, and tells of a filter that nothing uses.
pub(super) fn check(world: &World, notices: &mut Vec<Notice>) -> Result<(), Fault> {
    let volumes = volumes(world);
    let mut voxelized = world.query::<&Faces>().with::<&Voxelize>();
    for faces in &mut voxelized {
        let into = around(&volumes, || faces.middle());
        if let Some(volume) = into.filter(|volume| volume.content == Content::Values) {
            let problem = "is reconstructed from values, and a polygon is scan-converted into it, where colors of voxels are matted; state `reconstruct = \"colors\"`, or take `voxelize` off the polygon";
            return Err(Fault::of(volume.entity, "volume", "reconstruct", problem));
        }
    }
    let any = volumes.iter().any(|volume| volume.content == Content::Values);
    for entity in carriers::<View>(world) {
        let stated = get::<Sampling>(world, entity);
        if stated.is_some_and(|sampling| sampling.filter != Filter::Linear) && !any {
            let problem = "`sampling.filter` has no effect: colors are interpolated linearly; state `reconstruct = \"values\"` on the volume".to_owned();
            notices.push(Notice { entity, problem });
        }
    }
    for volume in volumes.iter().filter(|volume| volume.content == Content::Classified) {
        let iso = get::<Classify>(world, volume.entity).map_or_else(Vec::new, |stated| stated.iso);
        if let Some(n) = iso.iter().position(|contour| contour.thickness_voxels == 0.0) {
            let problem = "has a contour of thickness 0, which no voxel holds; state a thickness above 0, or `reconstruct = \"values\"` on the volume";
            let path = format!("iso.{n}.thickness_voxels");
            return Err(Fault::of(volume.entity, "classify", path, problem));
        }
    }
    for volume in volumes.iter().filter(|volume| volume.content == Content::Values) {
        if world.get::<&Tint>(volume.entity).is_ok() {
            let problem = "is reconstructed from values, and its labels color voxels; state `reconstruct = \"colors\"`, or take `labels` away";
            return Err(Fault::of(volume.entity, "volume", "reconstruct", problem));
        }
    }
    for entity in carriers::<Reconstruct>(world) {
        let painted = volumes.iter().any(|v| v.entity == entity && v.content == Content::Painted);
        if painted && get(world, entity) == Some(Reconstruct::Values) {
            let problem = "is RGBA, which has no values to reconstruct; take `reconstruct` away";
            return Err(Fault::of(entity, "volume", "reconstruct", problem));
        }
    }
    Ok(())
}
