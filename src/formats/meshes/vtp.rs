//! VTK PolyData (`.vtp`): points, polygons and strips of one or several pieces, and of points their normals, their
//! places in a texture, and colors if these are their scalars.

use std::ops::RangeInclusive;
use std::path::Path;

use glam::{DVec2, DVec3};

use super::triangles::{Triangles, add_fan, add_strip, fans, place_upward, reserve};
use crate::components::Color;
use crate::formats::number::{self, NumberType};
use crate::formats::vtk_file::{Tag, VtkFile, before, tag};

/// Reads every piece; what is a line or a point alone is left out.
pub(super) fn read(bytes: &[u8], _: &Path) -> Result<Triangles, String> {
    let file = VtkFile::of(bytes)?;
    let mut rest = tag(bytes, "PolyData").ok_or("has no `PolyData`; save the surface alone")?.rest;
    let mut triangles = Triangles::default();
    let mut polygons = 0;
    while let Some(piece) = tag(rest, "Piece") {
        let end = before(piece.rest, b"</Piece").unwrap_or(piece.rest);
        polygons += add_piece(&mut triangles, &Piece { file, tag: piece, bytes: end })?;
        rest = &piece.rest[end.len()..];
    }
    triangles.warnings.extend(fans(polygons));
    Ok(triangles)
}

/// A part of a file with points of its own.
struct Piece<'b> {
    file: VtkFile<'b>,
    tag: Tag<'b>,
    bytes: &'b [u8],
}

/// Adds the triangles of a piece, and how many polygons were split for them.
fn add_piece(triangles: &mut Triangles, piece: &Piece) -> Result<usize, String> {
    let count = piece.count("NumberOfPoints")?;
    let place = piece.inside("Points").and_then(|inside| tag(inside, "DataArray"));
    if count == 0 {
        return Ok(0);
    }
    let points = piece.numbers(place, count.checked_mul(3))?;
    let first = triangles.vertices.len();
    if u32::try_from(first + count).is_err() {
        return Err("has more than 2³² points; split it".to_owned());
    }
    reserve(&mut triangles.vertices, count)?;
    triangles.vertices.extend(points.chunks_exact(3).map(|p| DVec3::new(p[0], p[1], p[2])));
    add_attributes(triangles, piece, (first, count))?;
    let mut split = 0;
    for corners in piece.cells("Polys", "NumberOfPolys")? {
        let corners = corners_of(&corners, first, count)?;
        split += usize::from(corners.len() > 3);
        add_fan(&mut triangles.faces, &corners);
    }
    for corners in piece.cells("Strips", "NumberOfStrips")? {
        add_strip(&mut triangles.faces, &corners_of(&corners, first, count)?);
    }
    Ok(split)
}

/// Points of a piece as those of the file.
fn corners_of(corners: &[f64], first: usize, count: usize) -> Result<Vec<u32>, String> {
    let corner = |&at: &f64| {
        let is_one = (0.0..count as f64).contains(&at) && at.fract() == 0.0;
        is_one.then_some((first + at as usize) as u32)
    };
    corners.iter().map(corner).collect::<Option<_>>().ok_or_else(|| {
        "has a polygon that names a point it does not have; save it again".to_owned()
    })
}

impl Piece<'_> {
    fn count(&self, key: &str) -> Result<usize, String> {
        let text = self.tag.attribute(key).unwrap_or_else(|| "0".to_owned());
        text.trim().parse().map_err(|_| format!("its `{key}` is \"{text}\"; save it again"))
    }

    /// What stands between a tag and its end.
    fn inside(&self, name: &str) -> Option<&[u8]> {
        before(tag(self.bytes, name)?.rest, format!("</{name}").as_bytes())
    }

    /// So many numbers of an array; `None` for more than there can be.
    fn numbers(&self, array: Option<Tag>, count: Option<usize>) -> Result<Vec<f64>, String> {
        let array = array.ok_or("lacks an array of its points or polygons; save it again")?;
        let kind = NumberType::named(&array.attribute("type").unwrap_or_default())?;
        let count = count.ok_or("promises more numbers than there can be; save it again")?;
        let needed = count.saturating_mul(kind.bytes());
        number::numbers(&mut self.file.source(&array, needed)?, kind, count)
    }

    /// The points of each cell of a kind.
    fn cells(&self, name: &str, key: &str) -> Result<Vec<Vec<f64>>, String> {
        let count = self.count(key)?;
        if count == 0 {
            return Ok(Vec::new());
        }
        let inside = self.inside(name).unwrap_or_default();
        let ends = self.numbers(named(inside, "offsets"), Some(count))?;
        let last = ends.last().copied().unwrap_or(0.0);
        let rising = ends.windows(2).all(|pair| pair[0] <= pair[1]) && ends[0] >= 0.0;
        if !rising || !(0.0..9e15).contains(&last) {
            return Err("has polygons whose ends do not rise; save it again".to_owned());
        }
        let corners = self.numbers(named(inside, "connectivity"), Some(last as usize))?;
        let starts = std::iter::once(0.0).chain(ends.iter().copied());
        let cell = |(from, to): (f64, &f64)| corners[from as usize..*to as usize].to_vec();
        Ok(starts.zip(&ends).map(cell).collect())
    }

    /// The array that the piece names for a use, such as `Normals`, and how many numbers each point has of it.
    fn named_for(&self, what: &str) -> Option<(Tag<'_>, usize)> {
        let name = tag(self.bytes, "PointData")?.attribute(what)?;
        let array = named(self.inside("PointData").unwrap_or_default(), &name)?;
        let width = array.attribute("NumberOfComponents")?.parse().ok()?;
        Some((array, width))
    }

    /// The numbers of the points' array for a use, and how many each point has, if these are enough.
    fn attribute(
        &self,
        what: &str,
        widths: RangeInclusive<usize>,
        count: usize,
    ) -> Result<Option<(Vec<f64>, usize)>, String> {
        let named = self.named_for(what).filter(|(_, width)| widths.contains(width));
        let Some((array, width)) = named else { return Ok(None) };
        Ok(Some((self.numbers(Some(array), count.checked_mul(width))?, width)))
    }

    /// The colors of the points, where the scalars that the piece names are three or four bytes each.
    fn colors(&self, count: usize) -> Result<Vec<Color>, String> {
        let are_bytes =
            |(array, _): &(Tag, usize)| array.attribute("type").as_deref() == Some("UInt8");
        if !self.named_for("Scalars").is_some_and(|named| are_bytes(&named)) {
            return Ok(Vec::new());
        }
        let Some((bytes, width)) = self.attribute("Scalars", 3..=4, count)? else {
            return Ok(Vec::new());
        };
        let channel = |byte: f64| byte as f32 / 255.0;
        let color = |c: &[f64]| Color::from_srgb([c[0], c[1], c[2]].map(channel));
        Ok(bytes.chunks_exact(width).map(color).collect())
    }
}

/// Adds colors, normals and places in a texture of a piece's points, of which `first` are before them in the file.
fn add_attributes(
    triangles: &mut Triangles,
    piece: &Piece,
    (first, count): (usize, usize),
) -> Result<(), String> {
    triangles.colors.extend(piece.colors(count)?);
    if let Some((normals, _)) = piece.attribute("Normals", 3..=3, count)? {
        triangles.normals.values.resize(first, DVec3::NAN);
        let normal = |n: &[f64]| DVec3::new(n[0], n[1], n[2]);
        triangles.normals.values.extend(normals.chunks_exact(3).map(normal));
    }
    if let Some((places, width)) = piece.attribute("TCoords", 2..=3, count)? {
        triangles.places.values.resize(first, DVec2::NAN);
        let place = |uv: &[f64]| place_upward(uv[0], uv[1]);
        triangles.places.values.extend(places.chunks_exact(width).map(place));
    }
    Ok(())
}

/// The array of that name.
fn named<'b>(mut bytes: &'b [u8], name: &str) -> Option<Tag<'b>> {
    loop {
        let array = tag(bytes, "DataArray")?;
        if array.attribute("Name").as_deref() == Some(name) {
            return Some(array);
        }
        bytes = array.rest;
    }
}
