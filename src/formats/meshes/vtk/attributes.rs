//! What a legacy VTK file says of its points after them: colors, normals, and places in a texture.

use glam::{DVec2, DVec3};

use super::super::triangles::place_upward;
use super::legacy::{Legacy, truncated};
use crate::components::Color;
use crate::formats::number::NumberType;

/// What was said of points so far.
#[derive(Default)]
pub(super) struct Attributes {
    pub colors: Vec<Color>,
    pub normals: Vec<DVec3>,
    pub places: Vec<DVec2>,
}

impl Attributes {
    /// Reads the parts after the word `first`, which is `POINT_DATA` or `CELL_DATA`; of cells nothing is taken. Ends at a
    /// word that begins no part.
    pub fn add(&mut self, first: &str, file: &mut Legacy) -> Result<(), String> {
        let mut of_cells = Self::default();
        let (mut points, mut count) = (true, 0);
        let mut word = first.to_owned();
        loop {
            if word == "POINT_DATA" || word == "CELL_DATA" {
                points = word == "POINT_DATA";
                count = file.count()?;
            } else {
                let into = if points { &mut *self } else { &mut of_cells };
                if !into.add_part(&word, count, file)? {
                    return Ok(());
                }
            }
            word = file.word();
        }
    }

    /// Reads what follows the first word of a part of `count` points; false where it is none.
    fn add_part(&mut self, word: &str, count: usize, file: &mut Legacy) -> Result<bool, String> {
        match word {
            "SCALARS" => scalars(count, file)?,
            "COLOR_SCALARS" => self.add_colors(count, file)?,
            "NORMALS" => {
                file.word();
                let numbers = numbers(file, count, 3)?;
                let normal = |n: &[f64]| DVec3::new(n[0], n[1], n[2]);
                self.normals = numbers.chunks_exact(3).map(normal).collect();
            }
            "VECTORS" => {
                file.word();
                numbers(file, count, 3)?;
            }
            "TENSORS" => {
                file.word();
                numbers(file, count, 9)?;
            }
            "TEXTURE_COORDINATES" => {
                file.word();
                let width = file.count()?;
                let numbers = numbers(file, count, width)?;
                if (2..=3).contains(&width) {
                    let place = |uv: &[f64]| place_upward(uv[0], uv[1]);
                    self.places = numbers.chunks_exact(width).map(place).collect();
                }
            }
            "LOOKUP_TABLE" => {
                file.word();
                let rows = file.count()?;
                file.numbers(channel(file), product(rows, 4)?)?;
            }
            "FIELD" => fields(file)?,
            "METADATA" => file.skip_paragraph(),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Three or four channels a point: bytes, or as text 0 to 1.
    fn add_colors(&mut self, count: usize, file: &mut Legacy) -> Result<(), String> {
        file.word();
        let width = file.count()?;
        let numbers = file.numbers(channel(file), product(count, width)?)?;
        let white = if file.text { 1.0 } else { 255.0 };
        if (3..=4).contains(&width) {
            let channel = |at: f64| (at / white).clamp(0.0, 1.0) as f32;
            let color = |c: &[f64]| Color::from_srgb([c[0], c[1], c[2]].map(channel));
            self.colors = numbers.chunks_exact(width).map(color).collect();
        }
        Ok(())
    }
}

/// How channels of colors are written.
fn channel(file: &Legacy) -> NumberType {
    if file.text { NumberType::F32 } else { NumberType::U8 }
}

/// The numbers of a part after their type, `width` of them a point.
fn numbers(file: &mut Legacy, count: usize, width: usize) -> Result<Vec<f64>, String> {
    let kind = file.number_type()?;
    file.numbers(kind, product(count, width)?)
}

/// Goes on after scalars: they have a name, a type, perhaps how many each point has, and a table of colors.
fn scalars(count: usize, file: &mut Legacy) -> Result<(), String> {
    file.word();
    let kind = file.number_type()?;
    let width = file.count_if_any().unwrap_or(1);
    if file.word() == "LOOKUP_TABLE" {
        file.word();
    }
    file.numbers(kind, product(count, width)?).map(drop)
}

/// Goes on after arrays that each have a name, how many numbers each of how many rows has, and a type.
fn fields(file: &mut Legacy) -> Result<(), String> {
    file.word();
    let arrays = file.count()?;
    for _ in 0..arrays {
        while file.word() == "METADATA" {
            file.skip_paragraph();
        }
        let (width, rows) = (file.count()?, file.count()?);
        numbers(file, rows, width)?;
    }
    Ok(())
}

fn product(count: usize, width: usize) -> Result<usize, String> {
    count.checked_mul(width).ok_or_else(truncated)
}
