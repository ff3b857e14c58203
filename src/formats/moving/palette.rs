//! The best 256 colors of a frame: boxes of colors split where they vary most (Wu 1991), then each moved to the middle of
//! what is nearest to it.
//!
//! The most frequent color, which is the background's as a rule, is one of them exactly, so that an even background stays
//! even. Colors count by the root of how many pixels they have: small things keep a color of their own.

use std::collections::BTreeMap;

use super::colors::{Point, dot, minus, nearest, point};

/// Colors that a palette has.
pub(crate) const MOST: usize = 256;

/// Rounds of moving colors to the middle of what is nearest to them.
const ROUNDS: usize = 3;

/// A color and how much it counts.
#[derive(Clone, Copy)]
struct Weighed {
    color: Point,
    weight: f32,
}

/// The palette of a frame, at most [`MOST`] colors; all of the frame's if it has no more.
pub(crate) fn palette(pixels: &[[u8; 3]]) -> Vec<[u8; 3]> {
    let mut counted: BTreeMap<[u8; 3], u32> = BTreeMap::new();
    for pixel in pixels {
        *counted.entry(*pixel).or_default() += 1;
    }
    if counted.len() <= MOST {
        return counted.into_keys().collect();
    }
    let most = counted.values().copied().max().unwrap_or(0);
    let background = counted.iter().find(|(_, count)| **count == most).map(|(color, _)| *color);
    let colors = gathered(counted.into_iter().filter(|(color, _)| Some(*color) != background));
    let mut middles: Vec<Point> =
        split(colors.clone(), MOST - 1).iter().map(|b| middle(b)).collect();
    for _ in 0..ROUNDS {
        settle(&mut middles, &colors);
    }
    let rounded = middles.into_iter().map(|color| color.map(|c| c.round() as u8));
    let mut palette: Vec<_> = background.into_iter().chain(rounded).collect();
    palette.sort_unstable();
    palette.dedup();
    palette
}

/// Colors of one cell of 8 × 8 × 8 codes as their mean: fewer to look at, and hardly less said.
fn gathered(counted: impl Iterator<Item = ([u8; 3], u32)>) -> Vec<Weighed> {
    let mut cells: BTreeMap<[u8; 3], ([f64; 3], u32)> = BTreeMap::new();
    for (color, count) in counted {
        let (sum, number) = cells.entry(color.map(|code| code >> 3)).or_default();
        for (sum, code) in sum.iter_mut().zip(color) {
            *sum += f64::from(code) * f64::from(count);
        }
        *number += count;
    }
    let weighed = |(sum, number): ([f64; 3], u32)| Weighed {
        color: sum.map(|sum| (sum / f64::from(number)) as f32),
        weight: (number as f32).sqrt(),
    };
    cells.into_values().map(weighed).collect()
}

/// Splits all colors into boxes, the one that varies most first, until there are `most` or each is of one color.
fn split(colors: Vec<Weighed>, most: usize) -> Vec<Vec<Weighed>> {
    let mut boxes = vec![(spread(&colors), colors)];
    while boxes.len() < most {
        let widest = boxes.iter().enumerate().max_by(|a, b| a.1.0.0.total_cmp(&b.1.0.0));
        let Some((at, &((variance, _), _))) = widest else { break };
        if variance <= 0.0 {
            break;
        }
        let ((_, axis), mut colors) = boxes.swap_remove(at);
        colors.sort_by(|a, b| a.color[axis].total_cmp(&b.color[axis]));
        let mean = middle(&colors)[axis];
        let place = colors.partition_point(|c| c.color[axis] < mean).clamp(1, colors.len() - 1);
        let upper = colors.split_off(place);
        boxes.push((spread(&colors), colors));
        boxes.push((spread(&upper), upper));
    }
    boxes.into_iter().map(|(_, colors)| colors).collect()
}

/// How much the colors of a box differ from their mean, squared and summed, and along which axis most.
fn spread(colors: &[Weighed]) -> (f32, usize) {
    let mean = middle(colors);
    let mut axes = [0.0; 3];
    for Weighed { color, weight } in colors {
        let apart = minus(*color, mean);
        for (axis, sum) in axes.iter_mut().enumerate() {
            let mut only = [0.0; 3];
            only[axis] = apart[axis];
            *sum += weight * dot(only, only);
        }
    }
    let axis = (0..3).max_by(|a, b| axes[*a].total_cmp(&axes[*b])).unwrap_or(0);
    let alone = colors.len() < 2;
    (if alone { 0.0 } else { axes.iter().sum() }, axis)
}

fn middle(colors: &[Weighed]) -> Point {
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for Weighed { color, weight } in colors {
        for (sum, channel) in sum.iter_mut().zip(color) {
            *sum += weight * channel;
        }
        total += weight;
    }
    sum.map(|sum| if total > 0.0 { sum / total } else { 0.0 })
}

/// Moves each color to the middle of those that it is nearest to.
fn settle(middles: &mut [Point], colors: &[Weighed]) {
    let mut parts: Vec<Vec<Weighed>> = vec![Vec::new(); middles.len()];
    for color in colors {
        parts[nearest(middles, color.color)].push(*color);
    }
    for (middle_, part) in middles.iter_mut().zip(&parts).filter(|(_, part)| !part.is_empty()) {
        *middle_ = middle(part);
    }
}

/// The points of a palette.
pub fn points(palette: &[[u8; 3]]) -> Vec<Point> {
    palette.iter().map(|code| point(*code)).collect()
}
