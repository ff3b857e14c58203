//! How a frame grows with what it is made of, beside the paper's claims: exponents of power laws, fitted with their bounds.
//!
//! Seconds are medians of frames of the first view, cast anew each time; beside them what was counted, which no busy machine
//! changes. Memory is beside `plan`'s. `--quick` leaves out the largest sizes and repeats less.

#[allow(dead_code, reason = "other benches change how a view samples")]
mod timed;

use gelray::measure::cost::FRAME;
use gelray::measure::growth::{growth, steps};
use gelray::prelude::*;
use gelray::view::samples::Samples;
use timed::{Spread, is_quick, on_threads};

/// A size and what it makes.
type Made = (usize, World);

/// A row of the table: what varies, what the paper claims, sizes and their worlds, and which systems are timed.
struct Row {
    what: &'static str,
    claim: &'static str,
    sizes: &'static [usize],
    of: fn(usize) -> World,
    timed: &'static [&'static str],
}

const ROWS: [Row; 10] = [
    Row {
        what: "pixels across (the exponent of pixels is half)",
        claim: "nearly in proportion to pixels (§7): 2",
        sizes: &[95, 190, 380, 760, 1520],
        of: |n| seen(ball(64, 1.0), n, Sampling::default()),
        timed: &FRAME,
    },
    Row {
        what: "length of rays in voxels, sparse",
        claim: "grows with its logarithm (§6): near 0",
        sizes: &[32, 64, 128, 256, 384],
        of: |n| seen(ball(n, 1.0), 200, per_pixel()),
        timed: &FRAME,
    },
    Row {
        what: "depth complexity, translucent, never stopped",
        claim: "in proportion (§2): 1",
        sizes: &[4, 16, 64, 256],
        of: |n| seen(layers(n, 0.5), 128, Sampling { stop_at: 0.0, ..per_pixel() }),
        timed: &FRAME,
    },
    Row {
        what: "depth complexity, half opaque, stopped",
        claim: "flat where rays stop (§6): 0",
        sizes: &[16, 64, 256],
        of: |n| seen(layers(n, 0.5), 128, per_pixel()),
        timed: &FRAME,
    },
    Row {
        what: "voxels across, all that is made but the frame",
        claim: "in proportion to voxels (§7): 3",
        sizes: &[64, 96, 128, 192, 256, 384],
        of: |n| seen(ball(n, 1.0), 64, Sampling::default()),
        timed: &["ranges", "classify", "relight", "pyramid"],
    },
    Row {
        what: "voxels across, the frame",
        claim: "by rays that step over empty space: near 1",
        sizes: &[64, 96, 128, 192, 256, 384],
        of: |n| seen(ball(n, 1.0), 200, Sampling::default()),
        timed: &FRAME,
    },
    Row {
        what: "polygons of a mesh of one size",
        claim: "by those that a beam meets: below 1",
        sizes: &[1, 10, 100, 1000, 10_000, 100_000],
        of: |n| seen(terrain(n), 200, Sampling::default()),
        timed: &FRAME,
    },
    Row {
        what: "lights that cast shadows: sweeps",
        claim: "in proportion to lights (§4): 1",
        sizes: &[1, 2, 4, 8],
        of: |n| seen(lit(n), 64, Sampling::default()),
        timed: &["light_sweep"],
    },
    Row {
        what: "lights that cast shadows: the frame",
        claim: "none, they are in the gel: 0",
        sizes: &[1, 2, 4, 8],
        of: |n| seen(lit(n), 200, Sampling::default()),
        timed: &FRAME,
    },
    Row {
        what: "volumes that overlap",
        claim: "in proportion to volumes: 1",
        sizes: &[1, 2, 4, 8],
        of: |n| seen(balls(n), 128, Sampling::default()),
        timed: &FRAME,
    },
];

fn main() {
    for row in &ROWS {
        let kept = if is_quick() { row.sizes.len().min(3) } else { row.sizes.len() };
        on_threads(2, || tell(row, &row.sizes[..kept]));
    }
    threads();
}

fn tell(row: &Row, sizes: &[usize]) {
    println!("\n{}; the paper or the plan: {}", row.what, row.claim);
    let (mut seconds, mut samples) = (Vec::new(), Vec::new());
    for (size, mut world) in sizes.iter().map(|&n| -> Made { (n, (row.of)(n)) }) {
        let renderer = Renderer::new().expect("the systems have an order");
        let planned: u64 = planned(&renderer, &mut world);
        let spread = time(&renderer, &mut world, row.timed);
        let counts = world.query::<&Samples>().iter().next().map(|samples| samples.0.counts);
        let counted = counts.map_or(0, |c| c.samples + c.polygon_hits + c.packet_steps);
        println!(
            "  {size:>7} {:>24} ms {counted:>12} counted; plan {:>8.1} MB, most of the program {:>8.1} MB",
            spread.milliseconds(),
            planned as f64 / 1e6,
            timed::peak_megabytes()
        );
        seconds.push([size as f64, spread.median]);
        samples.push([size as f64, counted as f64]);
    }
    for (what, points) in [("seconds", &seconds), ("counts", &samples)] {
        if let Some(found) = growth(points) {
            println!(
                "  exponent of {what} {:.2} ({:.2} to {:.2}), from step to step {:.2?}",
                found.exponent,
                found.low,
                found.high,
                steps(points)
            );
        }
    }
}

/// Bytes that the systems plan for, once the world is complete.
fn planned(renderer: &Renderer, world: &mut World) -> u64 {
    renderer.render(world).expect("a scene made by formula renders");
    let jobs = renderer.schedule().waves().iter().flatten();
    jobs.map(|job| (job.plan)(world).bytes()).sum()
}

/// Frames, each cast anew; or, where systems before the frame are asked for, worlds whose material is another each time.
fn time(renderer: &Renderer, world: &mut World, systems: &[&str]) -> Spread {
    let repeat = if is_quick() { 3 } else { 7 };
    let run = |turn: u32| {
        let by = 1e-4 * f64::from(turn + 1);
        world.query_mut::<&mut View>().into_iter().for_each(|view| view.azimuth += by);
        let lights = world.query_mut::<&mut Light>().into_iter();
        lights.for_each(|light| light.strength *= 1.0 - by as f32);
        for classify in world.query_mut::<&mut Classify>() {
            classify.iso.iter_mut().for_each(|contour| contour.value += by as f32);
        }
        let ran = renderer.render(world).expect("a scene made by formula renders").ran;
        ran.iter().filter(|ran| systems.contains(&ran.name)).map(|ran| ran.seconds).sum()
    };
    Spread::of(&(0..repeat).map(run).collect::<Vec<f64>>())
}

/// The head of two threads over one, as the exponent of threads.
fn threads() {
    println!("\nthreads; in proportion: -1");
    let mut seconds = Vec::new();
    for count in [1, 2] {
        let spread = on_threads(count, || {
            let mut world = seen(ball(128, 1.0), 760, Sampling::default());
            let renderer = Renderer::new().expect("the systems have an order");
            renderer.render(&mut world).expect("a scene made by formula renders");
            time(&renderer, &mut world, &FRAME)
        });
        println!("  {count:>7} {:>24} ms", spread.milliseconds());
        seconds.push([count as f64, spread.median]);
    }
    println!("  exponent {:.2?}", steps(&seconds));
}

/// A ray a pixel.
fn per_pixel() -> Sampling {
    Sampling { coarsest: 4, finest: 4, tolerance: 0.0, ..Sampling::default() }
}

/// The world with a view of so many pixels a side.
fn seen(mut world: World, size: usize, sampling: Sampling) -> World {
    let view = View { azimuth: 30.0, elevation: 20.0, size: [size as u32; 2], ..View::default() };
    world.spawn((view, sampling));
    if world.query::<&Light>().iter().next().is_none() {
        world.spawn((Light::from_direction([-0.4, -0.8, 0.5]),));
    }
    world
}

/// A thin shell, 100 world units across, in n³ voxels.
fn ball(n: usize, opacity: f32) -> World {
    let mut world = World::new();
    add_ball(&mut world, n, [0.0; 3], opacity);
    world
}

fn add_ball(world: &mut World, n: usize, at: [f64; 3], opacity: f32) {
    let middle = (n - 1) as f32 / 2.0;
    let place = |index: usize| (index as f32 - middle) / middle;
    let value = |index: usize| {
        let [z, y, x] = [index / (n * n), index / n % n, index % n].map(place);
        (4000.0 * (1.0 - (x * x + y * y + z * z).sqrt())).max(0.0) as u16
    };
    let voxels: Vec<u16> = (0..n * n * n).map(value).collect();
    let spacing = 100.0 / (n - 1) as f64;
    let (_, scalars) = volume(voxels, [n; 3], [spacing; 3]).expect("a cube is filled");
    let corner = at.map(|c| c - 50.0);
    let grid = Grid::axis_aligned([n; 3], [spacing; 3], corner).expect("a cube is a grid");
    let contour = Contour { opacity, ..Contour::at(1000.0) };
    world.spawn((grid, scalars, Classify { iso: vec![contour], ..Classify::default() }));
}

/// Balls that overlap.
fn balls(n: usize) -> World {
    let mut world = World::new();
    for at in 0..n {
        let aside = 8.0 * (at as f64 - 0.5 * (n - 1) as f64);
        add_ball(&mut world, 48, [aside, -aside, 0.5 * aside], 0.2);
    }
    world
}

/// Squares one behind the other, across the line of sight.
fn layers(n: usize, opacity: f32) -> World {
    let mut world = World::new();
    for at in 0..n {
        let y = 40.0 * (at as f64 / n as f64 - 0.5);
        let square = [[-50.0, y, -50.0], [50.0, y, -50.0], [50.0, y, 50.0], [-50.0, y, 50.0]];
        let faces = polygon(&square).expect("a square is a polygon");
        world.spawn((faces, Surface { opacity, ..Surface::default() }));
    }
    world
}

/// A ball under lights that cast shadows.
fn lit(n: usize) -> World {
    let mut world = ball(64, 1.0);
    for at in 0..n {
        let turn = at as f64;
        let light = Light::from_direction([turn.cos(), turn.sin(), 0.7]);
        world.spawn((Light { strength: 1.0 / n as f32, ..light }, CastsShadow::default()));
    }
    world
}

/// A mesh of about n triangles over a square.
fn terrain(n: usize) -> World {
    let side = ((n as f64 / 2.0).sqrt().round() as u32).max(1);
    let place = |at: u32| 100.0 * (f64::from(at) / f64::from(side) - 0.5);
    let height = |x: f64, y: f64| 8.0 * (0.13 * x).sin() * (0.11 * y).cos();
    let vertex = |at: u32| {
        let (x, y) = (place(at % (side + 1)), place(at / (side + 1)));
        [x, y, height(x, y)]
    };
    let vertices: Vec<_> = (0..(side + 1) * (side + 1)).map(vertex).collect();
    let cell = |at: u32| {
        let first = at / side * (side + 1) + at % side;
        let (right, below) = (first + 1, first + side + 1);
        [[first, right, below], [right, below + 1, below]]
    };
    let mut faces: Vec<_> = (0..side * side).flat_map(cell).collect();
    faces.truncate(n.max(1));
    let faces = triangles(&vertices, &faces).expect("a terrain is a mesh");
    let mut world = World::new();
    world.spawn((faces, Surface::default()));
    world
}
