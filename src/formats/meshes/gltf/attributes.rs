//! What the vertices of a primitive have beside their positions: colors, normals, and places in a texture.

use glam::{DMat3, DMat4, DVec2, DVec3};

use super::super::triangles::reserve;
use super::accessor::{Numbers, floats};
use super::buffers::Buffers;
use super::document::{Document, Primitive};
use super::looks::{Moved, PictureUse};
use crate::components::Color;

/// The vertices of a primitive, placed by a matrix, of which `first` in the file were there before.
pub(super) struct Vertices<'a> {
    pub document: &'a Document,
    pub buffers: &'a Buffers<'a>,
    pub primitive: &'a Primitive,
    pub matrix: DMat4,
    pub first: usize,
    pub count: usize,
}

impl Vertices<'_> {
    /// The numbers of an attribute, of one of these widths a vertex; `what` it is for a sentence.
    fn numbers(&self, name: &str, widths: &[usize], what: &str) -> Result<Option<Numbers>, String> {
        let Some(&accessor) = self.primitive.attributes.get(name) else { return Ok(None) };
        let own = floats(self.document, self.buffers, accessor)?;
        if !widths.contains(&own.width) || own.values.len() != own.width * self.count {
            return Err(format!("has {what} that are not those of its vertices; export it again"));
        }
        Ok(Some(own))
    }

    /// Adds their colors, linear: their own times their material's factor; white where neither is stated.
    pub fn color(&self, colors: &mut Vec<Color>) -> Result<Colored, String> {
        let looks = self.document.looks(self.primitive);
        let factor = looks.and_then(|looks| looks.pbr.as_ref()?.base_color);
        let tint = factor.unwrap_or([1.0; 4]);
        let of = |channels: &[f64]| {
            let channel = |at: usize| (channels[at] as f32 * tint[at]).clamp(0.0, 1.0);
            Color([0, 1, 2].map(channel).into())
        };
        reserve(colors, self.count)?;
        let own = self.numbers("COLOR_0", &[3, 4], "colors")?;
        match &own {
            Some(own) => colors.extend(own.values.chunks_exact(own.width).map(of)),
            None => colors.extend(std::iter::repeat_n(of(&[1.0; 3]), self.count)),
        }
        let with_alpha = own.as_ref().filter(|own| own.width == 4);
        let alphas = with_alpha.map_or_else(Vec::new, |own| {
            own.values.chunks_exact(4).map(|channels| sound_alpha(channels[3])).collect()
        });
        Ok(Colored { is_stated: own.is_some() || factor.is_some(), alphas })
    }

    /// Adds their normals, if they have any; those of vertices before them that have none are no numbers.
    pub fn bend(&self, normals: &mut Vec<DVec3>) -> Result<(), String> {
        let Some(own) = self.numbers("NORMAL", &[3], "normals")? else { return Ok(()) };
        // Normals stand on what is stretched as they do on planes.
        let turned = DMat3::from_mat4(self.matrix).inverse().transpose();
        reserve(normals, self.first + self.count - normals.len())?;
        normals.resize(self.first, DVec3::NAN);
        let normal = |n: &[f64]| turned * DVec3::new(n[0], n[1], n[2]);
        normals.extend(own.values.chunks_exact(3).map(normal));
        Ok(())
    }

    /// Adds where they lie in a texture, moved as their material says, as [`bend`](Self::bend) adds normals.
    pub fn lay(&self, places: &mut Vec<DVec2>) -> Result<(), String> {
        let looks = self.document.looks(self.primitive);
        let picture = looks.and_then(|looks| looks.pbr.as_ref()?.picture.as_ref());
        let set = format!("TEXCOORD_{}", picture.map_or(0, PictureUse::set));
        let Some(own) = self.numbers(&set, &[2], "places in a texture")? else {
            return Ok(());
        };
        let moved = picture.and_then(PictureUse::moved).unwrap_or_default();
        reserve(places, self.first + self.count - places.len())?;
        places.resize(self.first, DVec2::NAN);
        places.extend(own.values.chunks_exact(2).map(|uv| place(uv, moved)));
        Ok(())
    }
}

/// What is known of the colors of a primitive's vertices.
#[derive(Default)]
pub(super) struct Colored {
    /// Whether the file states any.
    pub is_stated: bool,
    /// The alpha of each vertex, 0..=1; empty where they have none.
    alphas: Vec<f32>,
}

impl Colored {
    /// Whether some vertex is less than opaque.
    pub fn has_alpha(&self) -> bool {
        self.alphas.iter().any(|&alpha| alpha < 1.0)
    }

    /// The mean alpha of a triangle's corners, which are numbers of vertices of the primitive; 1 where they have none.
    pub fn alpha(&self, corners: [u32; 3]) -> f32 {
        let of = |corner: u32| self.alphas.get(corner as usize).copied().unwrap_or(1.0);
        let [a, b, c] = corners.map(of);
        (a + b + c) / 3.0
    }
}

/// An alpha within 0..=1; one that is no number is opaque.
fn sound_alpha(alpha: f64) -> f32 {
    if alpha.is_nan() { 1.0 } else { alpha.clamp(0.0, 1.0) as f32 }
}

/// A place in a picture: scaled, turned and moved as `KHR_texture_transform` has it, counter-clockwise where v runs down.
fn place(uv: &[f64], Moved { offset, rotation, scale, .. }: Moved) -> DVec2 {
    let scaled = DVec2::new(uv[0], uv[1]) * DVec2::from(scale.unwrap_or([1.0; 2]));
    let (sin, cos) = rotation.unwrap_or(0.0).sin_cos();
    let turned = DVec2::new(cos * scaled.x + sin * scaled.y, cos * scaled.y - sin * scaled.x);
    turned + DVec2::from(offset.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadrant_is_turned_as_the_extension_shows_it() {
        // Its own example: "the lower left quadrant of the source image, rotated clockwise 90°".
        let half = Some([0.5; 2]);
        let rotation = Some(std::f64::consts::FRAC_PI_2);
        let moved = Moved { offset: Some([0.0, 1.0]), rotation, scale: half, ..Moved::default() };
        for (uv, there) in
            [([0.0, 0.0], [0.0, 1.0]), ([1.0, 0.0], [0.0, 0.5]), ([0.0, 1.0], [0.5, 1.0])]
        {
            assert!(place(&uv, moved).abs_diff_eq(DVec2::from(there), 1e-12), "{uv:?}");
        }
        assert_eq!(place(&[0.25, 0.75], Moved::default()), DVec2::new(0.25, 0.75));
    }
}
