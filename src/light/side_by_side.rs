//! Several places under the lights, side by side: to the last bit what [`Lamp::reflected`] gives of each alone.
//!
//! Everything here is in plain arrays, and compiled anew within each instruction set of whoever calls it.
#![allow(clippy::inline_always, reason = "compiled anew within each instruction set")]

use glam::Vec3;

use super::shading::{Lamp, Reflectance};
use crate::volume::gradients::{MEASURABLE, normal};

/// A vector at each of `N` places, axis by axis or channel by channel.
pub(crate) type Vectors<const N: usize> = [[f32; N]; 3];

/// The same vector everywhere.
#[inline(always)]
pub(crate) fn all<const N: usize>(vector: Vec3) -> Vectors<N> {
    vector.to_array().map(|part| [part; N])
}

/// The vector at one place.
#[inline(always)]
pub(crate) fn one<const N: usize>(vectors: &Vectors<N>, at: usize) -> Vec3 {
    Vec3::new(vectors[0][at], vectors[1][at], vectors[2][at])
}

/// Sets the vector at one place.
#[inline(always)]
pub(crate) fn set<const N: usize>(vectors: &mut Vectors<N>, at: usize, vector: Vec3) {
    vectors.iter_mut().zip(vector.to_array()).for_each(|(parts, part)| parts[at] = part);
}

/// N of every gradient: [`normal`](crate::volume::gradients::normal), side by side.
#[inline(always)]
pub(crate) fn normals<const N: usize>(gradients: &Vectors<N>) -> Vectors<N> {
    let mut made = [[0.0; N]; 3];
    let mut measurable = true;
    for at in 0..N {
        let [x, y, z] = [-gradients[0][at], -gradients[1][at], -gradients[2][at]];
        let square = x * x + y * y + z * z;
        let clear = x.abs() + y.abs() + z.abs() == 0.0;
        measurable &= clear | MEASURABLE.contains(&square);
        let per = if clear { 0.0 } else { 1.0 / square.sqrt() };
        made[0][at] = x * per;
        made[1][at] = y * per;
        made[2][at] = z * per;
    }
    if !measurable {
        (0..N).for_each(|at| set(&mut made, at, normal(one(gradients, at).to_array())));
    }
    made
}

/// The lights that are summed in one array of colors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lighting<'a> {
    /// Of its color, what a voxel sends whatever falls on it.
    pub ambient: f32,
    pub lamps: &'a [Lamp],
    pub how: Reflectance,
}

impl Lighting<'_> {
    /// What voxels of these colors and normals send towards the observer.
    #[inline(always)]
    pub fn sent<const N: usize>(&self, colors: &Vectors<N>, normals: &Vectors<N>) -> Vectors<N> {
        let mut sent = [[0.0; N]; 3];
        for lamp in self.lamps {
            self.add(lamp, (colors, normals), &[1.0; N], &mut sent);
        }
        for channel in 0..3 {
            for at in 0..N {
                sent[channel][at] += colors[channel][at] * self.ambient;
            }
        }
        sent
    }

    /// Adds what they send of one of the lights, of which so much comes `through` to each.
    #[inline(always)]
    pub fn add<const N: usize>(
        &self,
        lamp: &Lamp,
        (colors, normals): (&Vectors<N>, &Vectors<N>),
        through: &[f32; N],
        sent: &mut Vectors<N>,
    ) {
        let amounts = amounts(lamp, normals, &self.how);
        for (channel, light) in lamp.light.to_array().into_iter().enumerate() {
            for at in 0..N {
                sent[channel][at] += colors[channel][at] * light * amounts[at] * through[at];
            }
        }
    }
}

/// `k_d max(N·L, 0) + k_s max(N·H, 0)^n` of every normal.
#[inline(always)]
fn amounts<const N: usize>(lamp: &Lamp, normals: &Vectors<N>, how: &Reflectance) -> [f32; N] {
    let (mut diffuse, mut glints) = ([0.0; N], [0.0; N]);
    for at in 0..N {
        let facing = along(normals, at, lamp.toward);
        let side = if how.two_sided && facing < 0.0 { -1.0 } else { 1.0 };
        diffuse[at] = how.diffuse * (side * facing).max(0.0);
        glints[at] = side * along(normals, at, lamp.half);
    }
    if how.specular > 0.0 {
        let powers = powers(&glints, how);
        for at in 0..N {
            diffuse[at] += if glints[at] > 0.0 { how.specular * powers[at] } else { 0.0 };
        }
    }
    diffuse
}

#[inline(always)]
fn along<const N: usize>(normals: &Vectors<N>, at: usize, direction: Vec3) -> f32 {
    normals[0][at] * direction.x + normals[1][at] * direction.y + normals[2][at] * direction.z
}

/// The n-th powers of glints; of those that are not above 0, anything.
#[inline(always)]
fn powers<const N: usize>(glints: &[f32; N], how: &Reflectance) -> [f32; N] {
    let Some(mut left) = how.whole_shininess() else {
        return glints.map(|glint| if glint > 0.0 { how.glint(glint) } else { 0.0 });
    };
    let (mut squares, mut products) = (glints.map(f64::from), [1.0; N]);
    while left > 0 {
        for at in 0..N {
            products[at] *= if left & 1 == 1 { squares[at] } else { 1.0 };
            squares[at] *= squares[at];
        }
        left >>= 1;
    }
    products.map(|product| product as f32)
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::components::{Color, Light, Toward};

    fn vector() -> impl Strategy<Value = [f32; 3]> {
        let part = prop_oneof![4 => -1.0_f32..1.0, 1 => Just(0.0), 1 => -1e30_f32..1e30];
        [part.clone(), part.clone(), part]
    }

    proptest! {
        #[test]
        fn places_side_by_side_are_lit_as_each_alone(
            gradients in [vector(), vector(), vector(), vector(), vector(), vector(), vector(), vector()],
            lights in proptest::collection::vec(([-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], 0.1_f32..3.0), 0..3),
            (specular, shininess) in (0.0_f32..0.5, prop_oneof![Just(1.0_f32), Just(20.0), 1.0_f32..70.0]),
            (ambient, two_sided, tint) in (0.0_f32..1.0, any::<bool>(), 0.0_f32..1.0),
        ) {
            let how = Reflectance { ambient, diffuse: 0.7, specular, shininess, two_sided };
            let lamps: Vec<Lamp> = lights.iter().map(|(toward, strength)| {
                let toward = Toward::Direction(*toward);
                Lamp::new(&Light { toward, strength: *strength, color: Color::WHITE }, DVec3::NEG_Y)
            }).collect();
            let color = Vec3::new(1.0, tint, 0.3);
            let (mut row, colors): (Vectors<8>, Vectors<8>) = ([[0.0; 8]; 3], all(color));
            gradients.iter().enumerate().for_each(|(at, gradient)| set(&mut row, at, Vec3::from(*gradient)));
            let lighting = Lighting { ambient, lamps: &lamps, how };
            let made = dispatch!(Level::new(), _simd => lighting.sent(&colors, &normals(&row)));
            for (at, gradient) in gradients.iter().enumerate() {
                let reflected = lamps.iter().map(|lamp| lamp.reflected(color, normal(*gradient), &how));
                let expected = color * ambient + reflected.sum::<Vec3>();
                prop_assert_eq!(one(&made, at), expected);
            }
        }
    }
}
