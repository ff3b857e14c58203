//! Pixel filters: what is constant stays constant, what is linear stays linear, and the box is the exact mean of what lies
//! between the rays (algorithm §5).

use std::sync::Arc;

use gelray::components::{PixelFilter, Sampling, View};
use gelray::schedule::{Job, Schedule, Watch};
use gelray::systems::resample::Resample;
use gelray::view::picture::Frame;
use gelray::view::picture::Picture;
use gelray::view::samples::Samples;
use gelray::view::samples::{Colors, Counts, Layout, NONE, POSITIONS, SampleArray};
use glam::{DVec3, DVec4};
use hecs::World;

use super::support::{Mixture, assert_sound, flat, head, sampling_of_the_head, square};

const FILTERS: [PixelFilter; 3] = [PixelFilter::Box, PixelFilter::Tent, PixelFilter::Mitchell];

/// Resamples the array of a field of window coordinates, cast at every position or every fourth.
fn resampled(
    size: [usize; 2],
    filter: PixelFilter,
    coarsest: usize,
    field: impl Fn(f64, f64) -> [f32; 4],
) -> Picture {
    let layout = Layout::new(size, coarsest, filter.reach());
    let mut colors = Colors::new(&layout);
    let blocks = colors.lattice.len();
    let every = coarsest == 1;
    if every {
        colors.fine = vec![[[0.0; 4]; POSITIONS * POSITIONS]; blocks];
    }
    let mut cast = vec![0_u16; blocks];
    let [across, down] = layout.positions();
    for (i, j) in (0..down).flat_map(|j| (0..across).map(move |i| (i, j))) {
        let (within, block) = layout.place(i, j);
        let color = field(layout.window(i), layout.window(j));
        if within == 0 {
            colors.lattice[block] = color;
        } else if every {
            colors.fine[block][within] = color;
        }
        cast[block] |= if every || within == 0 { 1 << within } else { 0 };
    }
    let opened = (0..blocks as u32).map(|block| if every { block } else { NONE }).collect();
    let splits = vec![if every { 0b1_1111 } else { 0 }; blocks];
    let (voxel_rays, counts) = (None, Counts::default());
    let array = SampleArray { layout, colors, opened, cast, splits, voxel_rays, counts };
    let mut world = World::new();
    let sampling = Sampling { pixel_filter: filter, ..Sampling::default() };
    let view = View { size: size.map(|n| n as u32), ..View::default() };
    let view = world.spawn((view, sampling, Samples(Arc::new(array))));
    let schedule = Schedule::new(&[Job::of::<Resample>()]).unwrap();
    schedule.run(&mut world, &Watch::default()).unwrap();
    world.get::<&Frame>(view).unwrap().0.clone()
}

#[test]
fn every_filter_leaves_a_constant_picture_as_it_is() {
    let mut off = 0.0_f32;
    for (filter, coarsest) in FILTERS.into_iter().flat_map(|f| [1, 4].map(|c| (f, c))) {
        for color in [[0.0; 4], [1.0; 4], [0.25, 0.5, 0.125, 0.75]] {
            let made = resampled([9, 7], filter, coarsest, |_, _| color);
            assert!(made.pixels.iter().all(|pixel| *pixel == color), "{filter:?} {color:?}");
        }
        let color = [0.1, 0.7, 0.123_456, 0.987_654];
        let made = resampled([9, 7], filter, coarsest, |_, _| color);
        let pixels = made.pixels.iter().flat_map(|p| p.iter().zip(color));
        off = pixels.map(|(p, c)| (p / c - 1.0).abs()).fold(off, f32::max);
    }
    println!(
        "constant pictures through box, tent and Mitchell: equal, or off by {off:.1e} of any colour"
    );
    assert!(off <= f32::EPSILON);
}

#[test]
fn every_filter_leaves_a_linear_ramp_as_it_is() {
    let ramp = |x: f64, y: f64| {
        [0.1 + 0.05 * x, 0.9 - 0.04 * y, 0.2 + 0.01 * x + 0.02 * y, 0.95].map(|c| c as f32)
    };
    for (filter, coarsest) in FILTERS.into_iter().flat_map(|f| [1, 4].map(|c| (f, c))) {
        let made = resampled([12, 10], filter, coarsest, ramp);
        let mut off = 0.0_f32;
        for (y, x) in (0..10).flat_map(|y| (0..12).map(move |x| (y, x))) {
            let expected = ramp(x as f64 + 0.5, y as f64 + 0.5);
            for (seen, expected) in made.pixel(x, y).iter().zip(expected) {
                off = off.max((seen - expected).abs());
            }
        }
        println!("a ramp through {filter:?} of positions {coarsest} apart: off by {off:.1e}");
        assert!(off < 1e-6);
    }
}

#[test]
fn no_filter_leaves_the_range_of_colors() {
    // Mitchell's filter overshoots at edges: there too a colour stays within 0..=α.
    let polygons = [([1.0; 3], 1.0, 0.0), ([0.0; 3], 1.0, 2.0), ([0.9, 0.1, 0.4], 0.3, 4.0)];
    let polygons = polygons.map(|(color, opacity, x)| {
        (
            vec![square(DVec3::new(x - 2.0, x, 0.3), DVec3::new(0.1, 1.0, 0.05), 2.2)],
            flat(color, opacity),
        )
    });
    for pixel_filter in FILTERS {
        let sampling = Sampling { pixel_filter, ..Sampling::default() };
        let scene = Mixture { sampling, ..Mixture::polygons(polygons.to_vec()) };
        let made = scene.seen((10.0, 5.0), 24, 9.0).render();
        assert_sound(&made.picture, &format!("{pixel_filter:?}"));
    }
}

/// C at any window place by definition: bilinear in the smallest region, whose corners were cast or are interpolated.
struct Definition<'a>(&'a SampleArray);

impl Definition<'_> {
    /// C at a position that is a corner of a region of `side` positions.
    fn corner(&self, i: usize, j: usize, side: usize) -> DVec4 {
        let array = self.0;
        if array.is_cast(i, j) {
            return DVec4::from(array.color(i, j).map(f64::from));
        }
        self.bilinear([i as f64, j as f64], 2 * side)
    }

    fn bilinear(&self, at: [f64; 2], side: usize) -> DVec4 {
        let whole = at.map(|p| (p / side as f64).floor() as usize * side);
        let part: [f64; 2] = std::array::from_fn(|a| (at[a] - whole[a] as f64) / side as f64);
        let corner = |x: usize, y: usize| {
            // A corner that weighs nothing need not be there.
            let weight = (if x == 1 { part[0] } else { 1.0 - part[0] })
                * (if y == 1 { part[1] } else { 1.0 - part[1] });
            if weight == 0.0 {
                DVec4::ZERO
            } else {
                self.corner(whole[0] + x * side, whole[1] + y * side, side) * weight
            }
        };
        corner(0, 0) + corner(1, 0) + corner(0, 1) + corner(1, 1)
    }

    /// C at a place in positions, off all region borders.
    fn color(&self, at: [f64; 2]) -> DVec4 {
        let [x, y] = at.map(|p| p as usize);
        let (bx, by) = (x / POSITIONS, y / POSITIONS);
        let split = self.0.splits[by * self.0.layout.blocks()[0] + bx];
        let child = 1 + 2 * (y / 2 % 2) + x / 2 % 2;
        let side = if split & 1 == 0 {
            4
        } else if split >> child & 1 == 0 {
            2
        } else {
            1
        };
        self.bilinear(at, side)
    }

    /// The mean over a pixel: sixteen squares of one position, each by the midpoint rule, which is exact for what is bilinear.
    fn pixel(&self, x: usize, y: usize) -> DVec4 {
        let first = |p: usize| (p * POSITIONS + self.0.layout.margin - POSITIONS / 2) as f64 + 0.5;
        let squares = (0..16).map(|n| [first(x) + f64::from(n % 4), first(y) + f64::from(n / 4)]);
        squares.map(|at| self.color(at)).sum::<DVec4>() / 16.0
    }
}

#[test]
fn a_box_is_the_exact_mean_of_the_interpolation_between_the_rays() {
    let mut shown = head();
    let settings = [
        (8, 1, 0.02),
        (16, 1, 0.05),
        (32, 1, 0.1),
        (32, 2, 0.02),
        (4, 1, 0.02),
        (8, 8, 0.02),
        (1, 1, 0.0),
        (2, 1, 0.02),
    ];
    for (coarsest, finest, tolerance) in settings {
        let sampling = Sampling { coarsest, finest, tolerance, ..sampling_of_the_head() };
        let made = shown.render(|view| view.size = [37, 30], sampling);
        let definition = Definition(&made.array);
        let mut off = 0.0_f64;
        for (y, x) in (0..30).flat_map(|y| (0..37).map(move |x| (y, x))) {
            let seen = DVec4::from(made.picture.pixel(x, y).map(f64::from));
            off = off.max((seen - definition.pixel(x, y)).abs().max_element());
        }
        println!(
            "box over regions of {coarsest} to {finest} positions: off by {off:.1e}, {:.2} rays a pixel",
            made.rays_per_pixel()
        );
        assert!(off < 1e-6, "{coarsest} {finest}");
    }
}
