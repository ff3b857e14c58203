//! How fast a field by formula is approached as its grid is refined: the order of each filter, of values and of gradients.

use fearless_simd::Level;
use gelray::components::Filter;
use gelray::schedule::Watch;
use gelray::shared::Shared;
use gelray::volume::coefficients::Coefficients;
use gelray::volume::field::{Field, Sampled, Spot};
use gelray::volume::grid::{Grid, Scalars};
use glam::{DVec3, Vec3};

/// A smooth function over 0..1 on each axis, and its gradient.
fn smooth(p: DVec3) -> (f64, DVec3) {
    let (k, phase) = (DVec3::new(3.0, 2.0, 4.0), DVec3::new(0.3, 1.1, 0.7));
    let angle = p * k + phase;
    let (s, c) = (angle.to_array().map(f64::sin), angle.to_array().map(f64::cos));
    let slopes = DVec3::new(c[0] * s[1] * s[2], s[0] * c[1] * s[2], s[0] * s[1] * c[2]) * k;
    (s[0] * s[1] * s[2], slopes)
}

/// Root mean squares of what values and gradients are off by, away from the borders, of `n` voxels along each axis.
fn errors(filter: Filter, n: usize) -> [f64; 2] {
    let h = 1.0 / (n - 1) as f64;
    let grid = Grid::axis_aligned([n; 3], [h; 3], [0.0; 3]).unwrap();
    let place = |at: usize| DVec3::new((at % n) as f64, (at / n % n) as f64, (at / n / n) as f64);
    let voxels = (0..n * n * n).map(|at| smooth(place(at) * h).0 as f32).collect();
    let scalars = Scalars::F32(Shared::new(voxels));
    let splines = Coefficients::of(&scalars, &grid, &Watch::default()).values;
    let scalars = if filter == Filter::Interpolating { &splines } else { &scalars };
    let field = Field::new(scalars, &grid, filter);
    // The same places for every grid, spread by an irrational turn on each axis.
    let turns = DVec3::new(0.754_877_666, 0.569_840_291, 0.438_579_021);
    let places: Vec<DVec3> =
        (1..2000).map(|i| (turns * f64::from(i)).fract() * 0.5 + 0.25).collect();
    let spot = |p: &DVec3| {
        let (index, cell) = (*p / h, (*p / h).floor());
        let part = (index - cell).as_vec3().to_array();
        Spot { cell: cell.to_array().map(|c| c as usize), part }
    };
    let spots: Vec<Spot> = places.iter().map(spot).collect();
    let mut made = vec![Sampled::default(); spots.len()];
    field.sample(Level::new(), &spots, &mut made);
    let sums = places.iter().zip(&made).fold([0.0; 2], |[value, slope], (&p, made)| {
        let (f, gradient) = smooth(p);
        let off = (Vec3::from(made.gradient).as_dvec3() - gradient).length_squared();
        [value + (f64::from(made.value) - f).powi(2), slope + off]
    });
    sums.map(|sum| (sum / places.len() as f64).sqrt())
}

#[test]
fn filters_approach_a_smooth_field_in_the_order_that_theory_gives_them() {
    // Orders of values and of gradients: a linear field and its central differences, a smoothing spline, a cubic that is
    // exact for squares, a spline that is exact for cubes.
    let orders = [
        (Filter::Linear, [2.0, 2.0]),
        (Filter::Cubic, [2.0, 2.0]),
        (Filter::CatmullRom, [3.0, 2.0]),
        (Filter::Interpolating, [4.0, 3.0]),
    ];
    for (filter, stated) in orders {
        let [coarse, fine] = [13, 25].map(|n| errors(filter, n));
        for of in 0..2 {
            let order = (coarse[of] / fine[of]).log2();
            // Faster is possible: what borders do to a spline dies out by a factor a voxel.
            assert!(order > stated[of] - 0.35, "{filter:?} {of}: order {order}");
        }
    }
}
