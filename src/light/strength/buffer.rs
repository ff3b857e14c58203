//! The 3D light strength buffer (paper §4, figure 5), sheared so that its columns run along the light.

use glam::DVec3;

use super::{Falloff, Shear, Slide};
use crate::shared::Shared;

/// The strength of a light anywhere in space; made only where something asks for it. Equality is identity.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffer {
    shear: Shear,
    falloff: Falloff,
    slide: Option<Slide>,
    /// β_0 · T at the kept columns of every slice: 65535 stands for `full`.
    slices: Shared<u16>,
    full: f32,
    bias: DVec3,
}

impl Buffer {
    /// The buffer of a light: `slices` holds β_0 · T at the kept columns of every slice of `shear`, 65535 for `full`.
    ///
    /// `bias` is the way from a point to the one nearer to the light whose strength is used at it, in the world.
    #[must_use]
    pub fn new(
        (shear, falloff): (Shear, Falloff),
        slide: Option<Slide>,
        (slices, full): (Vec<u16>, f32),
        bias: DVec3,
    ) -> Self {
        Self { shear, falloff, slide, slices: Shared::new(slices), full, bias }
    }

    /// β at a world point, without a bias: finite and 0 or above.
    ///
    /// Before the volume, and beside it, nothing weakens the light: β_0. Behind the volume it has what its column had
    /// where it left. The falloff with distance stops at the volume's nearest and farthest corner.
    #[must_use]
    pub fn at(&self, world: DVec3) -> f32 {
        let (column, slice) = self.shear.locate(world);
        let [enter, leave] = self.shear.span(column);
        let before = || self.slide.as_ref().map_or(1.0, |s| f64::from(s.at(world, self.cell(s))));
        let strength = if enter > leave || slice.is_nan() || slice <= enter {
            before()
        } else {
            let [width, height] = self.shear.width();
            let plane = |slice: usize| &self.slices[slice * width * height..][..width * height];
            let scale = f64::from(self.full) / 65535.0;
            let place = self.shear.place(column, slice.min(leave));
            scale * self.shear.interpolate(place.as_ref(), plane, || before() / scale)
        };
        (strength / self.falloff.divisor(self.falloff.distance(world))) as f32
    }

    /// The way from a point to the one whose strength is used at it: towards the light, world units.
    #[must_use]
    pub fn bias(&self) -> DVec3 {
        self.bias
    }

    /// Bytes that the buffer takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.slices.bytes() + self.slide.as_ref().map_or(0, Slide::bytes)
    }

    fn cell(&self, slide: &Slide) -> [f64; 2] {
        slide.cell(&self.shear)
    }
}
