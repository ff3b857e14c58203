//! Whether a polygon is simple: no edge crosses another, every hole lies in the outline and in no other hole.
//!
//! Tracing counts crossings and scan-conversion adds up areas; they mean the same of simple polygons alone.

use glam::{DVec2, DVec3};

use super::outline;

/// An edge of an outline, with the number of the outline and its own.
struct Edge {
    ends: [DVec2; 2],
    name: [usize; 2],
}

/// Finds that outlines in the plane of `normal` make a simple polygon; the error is a sentence without a subject.
///
/// Edges may touch: a path into the inside and back, or corners that meet, are no crossing.
pub(super) fn check(outlines: &[Vec<DVec3>], normal: DVec3) -> Result<(), String> {
    if let [triangle] = outlines
        && triangle.len() == 3
    {
        return Ok(());
    }
    let (right, up) = normal.any_orthonormal_pair();
    let flat = |outline: &Vec<DVec3>| {
        outline.iter().map(|v| DVec2::new(right.dot(*v), up.dot(*v))).collect::<Vec<_>>()
    };
    let outlines: Vec<_> = outlines.iter().map(flat).collect();
    crossing(&outlines)?;
    let called = |number: usize| {
        if number == 0 { "the outline".to_owned() } else { format!("hole {number}") }
    };
    for (number, hole) in outlines.iter().enumerate().skip(1) {
        if !hole.iter().any(|vertex| holds(&outlines[0], *vertex)) {
            return Err(format!(
                "{} lies outside the outline; move it in or take it away",
                called(number)
            ));
        }
        let others = outlines.iter().enumerate().skip(1).filter(|(other, _)| *other != number);
        let within =
            |(_, other): &(usize, &Vec<DVec2>)| hole.iter().all(|vertex| holds(other, *vertex));
        if let Some((other, _)) = others.into_iter().find(within) {
            return Err(format!(
                "{} lies in {}; take it away, or state what fills it as a polygon",
                called(number),
                called(other)
            ));
        }
    }
    Ok(())
}

/// Looks for two edges that cross, from left to right.
fn crossing(outlines: &[Vec<DVec2>]) -> Result<(), String> {
    let mut edges: Vec<Edge> = Vec::new();
    for (outline, vertices) in outlines.iter().enumerate() {
        let ends = outline::edges(vertices).map(|(a, b)| [a, b]).enumerate();
        edges.extend(ends.map(|(edge, ends)| Edge { ends, name: [outline, edge] }));
    }
    let size = edges
        .iter()
        .flat_map(|edge| edge.ends)
        .fold(0.0, |size: f64, end| size.max(end.abs().max_element()));
    edges.sort_by(|a, b| a.left().total_cmp(&b.left()));
    let mut open: Vec<&Edge> = Vec::new();
    for edge in &edges {
        open.retain(|other| other.right() >= edge.left());
        if let Some(other) = open.iter().find(|other| edge.crosses(other, size)) {
            let [[o, e], [p, f]] = [other.name.min(edge.name), other.name.max(edge.name)];
            let of = |outline: usize| {
                if outline == 0 { String::new() } else { format!(" of hole {outline}") }
            };
            return Err(format!(
                "edges {e}{} and {f}{} cross; split it where they do",
                of(o),
                of(p)
            ));
        }
        open.push(edge);
    }
    Ok(())
}

impl Edge {
    fn left(&self) -> f64 {
        self.ends[0].x.min(self.ends[1].x)
    }

    fn right(&self) -> f64 {
        self.ends[0].x.max(self.ends[1].x)
    }

    /// Whether each of two edges has an end on either side of the other, by more than is lost in rounding.
    fn crosses(&self, other: &Self, size: f64) -> bool {
        let apart = |line: &[DVec2; 2], ends: &[DVec2; 2]| {
            let along = line[1] - line[0];
            let [a, b] = ends.map(|end| along.perp_dot(end - line[0]));
            let lost = 1e-12 * size * along.length();
            a.abs() > lost && b.abs() > lost && (a > 0.0) != (b > 0.0)
        };
        apart(&self.ends, &other.ends) && apart(&other.ends, &self.ends)
    }
}

/// Whether a point lies in an outline, by the crossings of a ray to the right.
fn holds(outline: &[DVec2], point: DVec2) -> bool {
    let crossed = outline::edges(outline).filter(|(a, b)| {
        (a.y > point.y) != (b.y > point.y)
            && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Vec<DVec3> {
        [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
            .map(|(a, b)| DVec3::new(x + a, y + b, 7.0))
            .to_vec()
    }

    fn problem(outlines: &[Vec<DVec3>]) -> String {
        check(outlines, DVec3::Z).err().unwrap_or_default()
    }

    #[test]
    fn outlines_that_cross_themselves_or_each_other_are_told_by_their_edges() {
        let mut bow = square(0.0, 0.0, 4.0);
        bow.swap(1, 2);
        assert!(problem(&[bow]).contains("cross"));
        let across = [square(0.0, 0.0, 4.0), square(3.0, 1.0, 2.0)];
        assert!(problem(&across).contains("of hole 1 cross"));
        let overlapping = [square(0.0, 0.0, 9.0), square(1.0, 1.0, 3.0), square(2.0, 2.0, 3.0)];
        assert!(problem(&overlapping).contains("of hole 2 cross"));
    }

    #[test]
    fn holes_outside_and_holes_in_holes_are_told() {
        assert!(
            problem(&[square(0.0, 0.0, 4.0), square(8.0, 0.0, 1.0)])
                .contains("hole 1 lies outside")
        );
        let nested = [square(0.0, 0.0, 9.0), square(1.0, 1.0, 5.0), square(2.0, 2.0, 1.0)];
        assert!(problem(&nested).contains("hole 2 lies in hole 1"));
    }

    #[test]
    fn what_only_touches_is_simple() {
        // A way in along an edge and back, corners that meet, and a hole that shares a corner with the outline.
        let keyhole =
            [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 4.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0)];
        let keyhole = keyhole.map(|(x, y)| DVec3::new(x, y, 7.0)).to_vec();
        assert_eq!(problem(&[keyhole]), "");
        assert_eq!(
            problem(&[square(0.0, 0.0, 9.0), square(1.0, 1.0, 2.0), square(3.0, 3.0, 2.0)]),
            ""
        );
        assert_eq!(problem(&[square(0.0, 0.0, 9.0), square(0.0, 0.0, 2.0)]), "");
    }
}
