//! Triangles that stand for a curved surface: their normal runs from corner to corner, and light with it.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use crate::components::Surface;
use crate::light::shading::{Lamps, Reflectance};

/// How a face whose normal is not the same all over it answers the lights.
pub(crate) struct Bent {
    /// World points of the face to vectors along its normal.
    normal: DAffine3,
    color: Vec3,
    how: Reflectance,
    lamps: Arc<Lamps>,
}

impl Bent {
    /// A face of that surface; `normal` is as of [`over`](crate::polygon::smooth::CornerNormals::over).
    pub fn new(normal: DAffine3, surface: &Surface, lamps: &Arc<Lamps>) -> Self {
        Self { normal, color: surface.color.0, how: surface.into(), lamps: Arc::clone(lamps) }
    }

    fn normal(&self, world: DVec3) -> Vec3 {
        self.normal.transform_point3(world).normalize_or_zero().as_vec3()
    }

    /// What it reflects at a world point of the lights that cast no shadow.
    pub fn reflected(&self, world: DVec3) -> DVec3 {
        let normal = self.normal(world);
        let lamps = self.lamps.plain.iter();
        lamps.map(|lamp| lamp.reflected(self.color, normal, &self.how)).sum::<Vec3>().as_dvec3()
    }

    /// What it reflects there of the light of that number that does, unshadowed.
    pub fn shadowed(&self, light: usize, world: DVec3) -> DVec3 {
        self.lamps.shadowed.get(light).map_or(DVec3::ZERO, |(_, lamp)| {
            lamp.reflected(self.color, self.normal(world), &self.how).as_dvec3()
        })
    }
}
