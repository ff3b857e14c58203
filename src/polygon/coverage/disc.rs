//! The area of a disc that a polygon covers, exactly (algorithm §8): no tables, concave polygons and holes included.
//!
//! The area is a sum over edges of the signed area of disc ∩ triangle(centre, edge). An edge shared by two polygons
//! runs once each way and cancels, so that areas of neighbours add up to that of the undivided polygon.

use std::f64::consts::PI;

use glam::DVec2;

use crate::polygon::outline::edges;

/// The area of disc ∩ polygon; units of the coordinates squared, in 0..=π r², exact at both ends.
///
/// `outlines` is an outline and then its holes, each simple, of at least three vertices, and either way round. A hole
/// takes away what lies in it. A radius that is not above 0 has no area. All numbers must be finite.
#[must_use]
pub fn disc_area(center: DVec2, radius: f64, outlines: &[Vec<DVec2>]) -> f64 {
    let mut parts = outlines.iter().map(|outline| part_in_outline(center, radius, outline));
    let whole = parts.next().unwrap_or(0.0);
    if whole == 0.0 { 0.0 } else { (whole - parts.sum::<f64>()).max(0.0) }
}

/// The distance from a point to the nearest edge of a polygon, and whether the point is inside it (holes are outside).
#[must_use]
pub(crate) fn clearance(point: DVec2, outlines: &[Vec<DVec2>]) -> (f64, bool) {
    let (squared, inside) =
        outlines.iter().fold((f64::INFINITY, false), |(nearest, odd), outline| {
            let (squared, inside) = clearance_of_outline(point, outline);
            (nearest.min(squared), odd != inside)
        });
    (squared.sqrt(), inside)
}

fn part_in_outline(center: DVec2, radius: f64, outline: &[DVec2]) -> f64 {
    let disc = PI * radius * radius;
    let (squared, inside) = clearance_of_outline(center, outline);
    if radius.is_nan() || radius <= 0.0 {
        0.0
    } else if squared >= radius * radius {
        if inside { disc } else { 0.0 }
    } else {
        let area: f64 =
            edges(outline).map(|(a, b)| part_of_triangle(a - center, b - center, radius)).sum();
        area.abs().min(disc)
    }
}

/// Squared distance to the nearest edge, and whether a ray towards +x crosses the outline an odd number of times.
fn clearance_of_outline(point: DVec2, outline: &[DVec2]) -> (f64, bool) {
    edges(outline).fold((f64::INFINITY, false), |(nearest, odd), (a, b)| {
        let (a, b) = (a - point, b - point);
        let along = b - a;
        let length = along.length_squared();
        let at = if length > 0.0 { (-a.dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        // A crossing at the left or right of the point: the sign of the triangle tells.
        let crossed = (a.y > 0.0) != (b.y > 0.0) && (a.perp_dot(b) > 0.0) == (b.y > a.y);
        (nearest.min((a + along * at).length_squared()), odd != crossed)
    })
}

/// Signed area of the triangle (0, a, b) within the circle of radius `r` about 0; positive counter-clockwise.
///
/// Worked out in one direction of the edge only: the same edge run the other way cancels to the last bit.
fn part_of_triangle(a: DVec2, b: DVec2, r: f64) -> f64 {
    if (a.x, a.y) > (b.x, b.y) {
        return -part_of_triangle(b, a, r);
    }
    let along = b - a;
    let length = along.length();
    if length == 0.0 {
        return 0.0;
    }
    // By the distance of the line rather than by the quadratic: that would cancel for edges far longer than the disc.
    let away = a.perp_dot(along) / length;
    let half = r * r - away * away;
    let (foot, half) = (-a.dot(along) / length, half.max(0.0).sqrt());
    let (enters, leaves) = ((foot - half).max(0.0), (foot + half).min(length));
    if half == 0.0 || enters >= leaves {
        return sector(a, b, r);
    }
    let p = if enters > 0.0 { a + along * (enters / length) } else { a };
    let q = if leaves < length { a + along * (leaves / length) } else { b };
    let before = if enters > 0.0 { sector(a, p, r) } else { 0.0 };
    let after = if leaves < length { sector(q, b, r) } else { 0.0 };
    before + away * (leaves - enters) / 2.0 + after
}

fn sector(a: DVec2, b: DVec2, r: f64) -> f64 {
    libm::atan2(a.perp_dot(b), a.dot(b)) * r * r / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator of our own: the tests are the same everywhere.
    struct Dice(u64);

    impl Dice {
        fn roll(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        /// A star-shaped, mostly concave polygon about a random middle.
        fn star(&mut self, middle: DVec2, size: f64) -> Vec<DVec2> {
            let corners = 3 + (self.roll() * 7.0) as usize;
            let corner = |k: usize| {
                let angle = (k as f64 + 0.8 * self.roll()) / corners as f64 * 2.0 * PI;
                middle + DVec2::from_angle(angle) * size * (0.2 + self.roll())
            };
            (0..corners).map(corner).collect()
        }
    }

    /// ∫ of the widths of disc ∩ polygon over `lines` horizontal lines, each split exactly at the crossings.
    fn quadrature(center: DVec2, radius: f64, outlines: &[Vec<DVec2>], lines: u32) -> f64 {
        let step = PI / f64::from(lines);
        let strip = |k: u32| {
            // y = −r cos φ: the widths' square roots at top and bottom become smooth.
            let phi = (f64::from(k) + 0.5) * step;
            let (y, half) = (center.y - radius * phi.cos(), radius * phi.sin());
            let mut crossings: Vec<f64> = outlines
                .iter()
                .flat_map(|outline| edges(outline))
                .filter(|(a, b)| (a.y > y) != (b.y > y))
                .map(|(a, b)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
                .map(|x| x.clamp(center.x - half, center.x + half))
                .collect();
            crossings.sort_by(f64::total_cmp);
            crossings.chunks_exact(2).map(|pair| pair[1] - pair[0]).sum::<f64>() * half * step
        };
        (0..lines).map(strip).sum()
    }

    #[test]
    fn areas_of_random_polygons_with_holes_agree_with_quadrature_to_1e_5_of_the_disc() {
        let mut dice = Dice(7);
        for _ in 0..300 {
            let middle = DVec2::new(dice.roll(), dice.roll()) * 3.0 - 1.5;
            let mut outlines = vec![dice.star(middle, 1.5)];
            let hole = [DVec2::new(-0.05, -0.05), DVec2::new(0.0, 0.06), DVec2::new(0.05, -0.02)];
            if outlines[0].len() > 4 {
                outlines.push(hole.map(|v| middle + v).to_vec());
            }
            if dice.roll() < 0.5 {
                outlines[0].reverse();
            }
            let radius = 0.1 + dice.roll();
            let exact = disc_area(DVec2::ZERO, radius, &outlines);
            let sum = quadrature(DVec2::ZERO, radius, &outlines, 20_000);
            assert!(
                (exact - sum).abs() <= 1e-5 * PI * radius * radius,
                "{exact} {sum} {outlines:?}"
            );
        }
    }

    #[test]
    fn a_disc_wholly_inside_is_pi_r_squared_and_one_outside_or_in_a_hole_is_nothing_exactly() {
        let square = |half: f64| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| DVec2::new(x, y) * half)
                .to_vec()
        };
        let ring = [square(10.0), square(2.0)];
        for (place, radius, part) in
            [(5.0, 1.0, 1.0), (12.0, 1.0, 0.0), (0.0, 1.9, 0.0), (5.0, 3.0, 1.0)]
        {
            let area = disc_area(DVec2::new(place, 0.1), radius, &ring);
            assert_eq!(area, part * PI * radius * radius, "{place} {radius}");
        }
        assert_eq!(disc_area(DVec2::ZERO, 0.0, &ring), 0.0);
        assert!((disc_area(DVec2::ZERO, 5.0, &ring) - (PI * 25.0 - 16.0)).abs() < 1e-12);
        assert!((disc_area(DVec2::ZERO, 50.0, &ring) - 384.0).abs() < 1e-9);
    }

    #[test]
    fn two_polygons_that_share_an_edge_cover_what_the_undivided_one_covers() {
        let mut dice = Dice(3);
        for size in [0.01, 1.0, 1e3, 1e6] {
            for _ in 0..200 {
                let corners = [(0.0, 0.0), (1.0, 0.1), (1.1, 0.9), (-0.1, 1.0)]
                    .map(|(x, y)| DVec2::new(x, y) * size);
                let halves =
                    [[0, 1, 2], [2, 3, 0]].map(|f| vec![f.map(|k: usize| corners[k]).to_vec()]);
                let middle = corners[0].lerp(corners[2], dice.roll());
                let center = middle + DVec2::new(dice.roll() - 0.5, dice.roll() - 0.5);
                let radius = dice.roll();
                let whole = disc_area(center, radius, &[corners.to_vec()]);
                let sum: f64 = halves.iter().map(|half| disc_area(center, radius, half)).sum();
                assert!((whole - sum).abs() <= 1e-12, "{size} {whole} {sum}");
            }
        }
    }

    #[test]
    fn clearance_is_signed_by_outline_and_hole() {
        let square = |half: f64| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| DVec2::new(x, y) * half)
                .to_vec()
        };
        let ring = [square(4.0), square(1.0)];
        let at = |x: f64| clearance(DVec2::new(x, 0.0), &ring);
        assert_eq!(
            [at(0.0), at(2.0), at(3.5), at(6.0)],
            [(1.0, false), (1.0, true), (0.5, true), (2.0, false)]
        );
    }
}
