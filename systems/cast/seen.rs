//! The faces that rays of a view may meet, and the beams that each is near to: found part by part, side by side.

use rayon::prelude::*;

use super::beams::{Beams, Patch};
use super::binned::{Binned, Near, near};
use super::inputs::TracedPolygons;
use super::projected::ProjectedFace;
use crate::polygon::face::Face;
use crate::view::camera::Camera;

/// Faces of a part, at the most, as a power of two.
const BITS: u32 = 12;

/// The faces that rays may meet, in the order of the scene: their numbers grow with it.
pub(crate) struct SeenFaces {
    parts: Vec<Vec<ProjectedFace>>,
    binned: Binned,
}

impl SeenFaces {
    /// Of the polygons of a scene, those that the rays of a view may meet.
    pub fn new(polygons: &[TracedPolygons], camera: &Camera, beams: &Beams) -> Self {
        let parts = polygons.iter().enumerate().flat_map(|(entity, traced)| {
            let parts = traced.faces.0.chunks(1 << BITS).enumerate();
            parts.map(move |(part, faces)| ([entity, part << BITS], faces))
        });
        let parts: Vec<_> = parts.collect();
        let parts = parts.into_par_iter().enumerate().map(|(part, (of, faces))| {
            let (patches, faces): (Vec<_>, Vec<_>) = seen(faces, of, camera, beams).unzip();
            let near = near(&faces, &patches, (part as u32) << BITS, beams);
            (faces, near)
        });
        let (parts, near): (Vec<_>, Vec<Vec<(u32, Near)>>) = parts.unzip();
        Self { parts, binned: Binned::new(&near, beams.counts[0] * beams.counts[1]) }
    }

    /// The face of that number.
    #[inline]
    pub fn get(&self, number: u32) -> &ProjectedFace {
        let (part, at) = self.part(number);
        &part[at]
    }

    /// Those of the part that a face is in, and its number there.
    #[inline]
    pub fn part(&self, number: u32) -> (&[ProjectedFace], usize) {
        (&self.parts[(number >> BITS) as usize], (number & ((1 << BITS) - 1)) as usize)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &ProjectedFace> {
        self.parts.iter().flatten()
    }

    /// Whether there are none that any ray is near to.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.binned.is_empty()
    }

    /// Those near a beam.
    pub fn near(&self, beam: usize) -> &[Near] {
        self.binned.near(beam)
    }
}

/// Those of some faces of an entity that rays may meet, each with the positions of the rays; `of` is the number of the entity,
/// and that of the first face there.
fn seen<'a>(
    faces: &'a [Face],
    [entity, first]: [usize; 2],
    camera: &'a Camera,
    beams: &'a Beams,
) -> impl Iterator<Item = (Patch, ProjectedFace)> + 'a {
    faces.iter().enumerate().filter_map(move |(at, face)| {
        let of = [entity, first + at].map(|n| n as u32);
        ProjectedFace::new(face, of, camera, |bounds| beams.patch(bounds))
    })
}
