//! A row of voxels under the lights, side by side: to the last bit what [`Lamp::reflected`] gives of each alone.
//!
//! Everything here is in plain arrays, and compiled anew within each instruction set of whoever calls it.
#![allow(clippy::inline_always, reason = "compiled anew within each instruction set")]

use glam::Vec3;

use crate::light::shading::{Lamp, Reflectance};
use crate::volume::bricks::EDGE;

/// A vector at every voxel of a row, axis by axis or channel by channel.
pub(crate) type Row = [[f32; EDGE]; 3];

/// A row of the same vector.
#[inline(always)]
pub(crate) fn all(vector: Vec3) -> Row {
    vector.to_array().map(|part| [part; EDGE])
}

/// The vector of one voxel.
#[inline(always)]
pub(crate) fn one(row: &Row, at: usize) -> Vec3 {
    Vec3::new(row[0][at], row[1][at], row[2][at])
}

/// Sets the vector of one voxel.
#[inline(always)]
pub(crate) fn set(row: &mut Row, at: usize, vector: Vec3) {
    row.iter_mut().zip(vector.to_array()).for_each(|(row, part)| row[at] = part);
}

/// N of every gradient: [`normal`](crate::volume::gradients::normal), side by side.
#[inline(always)]
pub(crate) fn normals(gradients: &Row) -> Row {
    let mut made = [[0.0; EDGE]; 3];
    for at in 0..EDGE {
        let [x, y, z] =
            [gradients[0][at], gradients[1][at], gradients[2][at]].map(|part| -f64::from(part));
        let per = 1.0 / (x * x + y * y + z * z).sqrt();
        // The gradient zero has no direction: it is infinitely short.
        let per = if per < f64::INFINITY { per } else { 0.0 };
        made[0][at] = (x * per) as f32;
        made[1][at] = (y * per) as f32;
        made[2][at] = (z * per) as f32;
    }
    made
}

/// The lights that are summed in one array of colors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lighting<'a> {
    /// Of its color, what a voxel sends whatever falls on it.
    pub ambient: f32,
    pub lamps: &'a [&'a Lamp],
    pub how: Reflectance,
}

impl Lighting<'_> {
    /// What voxels of these colors and normals send towards the observer.
    #[inline(always)]
    pub fn row(&self, colors: &Row, normals: &Row) -> Row {
        let mut sent = [[0.0; EDGE]; 3];
        for lamp in self.lamps {
            let amounts = amounts(lamp, normals, &self.how);
            for (channel, light) in lamp.light.to_array().into_iter().enumerate() {
                for at in 0..EDGE {
                    sent[channel][at] += colors[channel][at] * light * amounts[at];
                }
            }
        }
        for channel in 0..3 {
            for at in 0..EDGE {
                sent[channel][at] += colors[channel][at] * self.ambient;
            }
        }
        sent
    }
}

/// `k_d max(N·L, 0) + k_s max(N·H, 0)^n` of every normal.
#[inline(always)]
fn amounts(lamp: &Lamp, normals: &Row, how: &Reflectance) -> [f32; EDGE] {
    let (mut diffuse, mut glints) = ([0.0; EDGE], [0.0; EDGE]);
    for at in 0..EDGE {
        let facing = along(normals, at, lamp.toward);
        let side = if how.two_sided && facing < 0.0 { -1.0 } else { 1.0 };
        diffuse[at] = how.diffuse * (side * facing).max(0.0);
        glints[at] = side * along(normals, at, lamp.half);
    }
    if how.specular > 0.0 {
        let powers = powers(&glints, how);
        for at in 0..EDGE {
            diffuse[at] += if glints[at] > 0.0 { how.specular * powers[at] } else { 0.0 };
        }
    }
    diffuse
}

#[inline(always)]
fn along(normals: &Row, at: usize, direction: Vec3) -> f32 {
    normals[0][at] * direction.x + normals[1][at] * direction.y + normals[2][at] * direction.z
}

/// The n-th powers of glints; of those that are not above 0, anything.
#[inline(always)]
fn powers(glints: &[f32; EDGE], how: &Reflectance) -> [f32; EDGE] {
    let Some(mut left) = how.whole_shininess() else {
        return glints.map(|glint| if glint > 0.0 { how.glint(glint) } else { 0.0 });
    };
    let (mut squares, mut products) = (glints.map(f64::from), [1.0; EDGE]);
    while left > 0 {
        for at in 0..EDGE {
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
    use crate::volume::gradients::normal;

    fn vector() -> impl Strategy<Value = [f32; 3]> {
        let part = prop_oneof![4 => -1.0_f32..1.0, 1 => Just(0.0), 1 => -1e30_f32..1e30];
        [part.clone(), part.clone(), part]
    }

    proptest! {
        #[test]
        fn a_row_is_lit_as_each_of_its_voxels(
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
            let lamps: Vec<&Lamp> = lamps.iter().collect();
            let color = Vec3::new(1.0, tint, 0.3);
            let (mut row, colors) = ([[0.0; EDGE]; 3], all(color));
            gradients.iter().enumerate().for_each(|(at, gradient)| set(&mut row, at, Vec3::from(*gradient)));
            let lighting = Lighting { ambient, lamps: &lamps, how };
            let made = dispatch!(Level::new(), _simd => lighting.row(&colors, &normals(&row)));
            for (at, gradient) in gradients.iter().enumerate() {
                let reflected = lamps.iter().map(|lamp| lamp.reflected(color, normal(*gradient), &how));
                let expected = color * ambient + reflected.sum::<Vec3>();
                prop_assert_eq!(one(&made, at), expected);
            }
        }
    }
}
