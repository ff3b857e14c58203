//! Maps of molecules on a crystal's oblique cell, contoured in standard deviations, from file to picture.

use gelray::volume::grid::Grid;
use glam::{DMat2, DVec2, DVec3};

use crate::{camera, frame, run, stated, view};

const SIZE: [usize; 3] = [40, 36, 44];
const CENTER: [f64; 3] = [18.0, 19.0, 21.0];
/// Width of the blob, in voxels.
const WIDTH: f64 = 6.0;
/// Edges and angles of the cell.
const CELL: [f32; 6] = [40.0, 50.0, 60.0, 65.0, 105.0, 120.0];

fn density([x, y, z]: [usize; 3]) -> f32 {
    let from = DVec3::new(x as f64, y as f64, z as f64) - DVec3::from(CENTER);
    (-from.length_squared() / (2.0 * WIDTH * WIDTH)).exp() as f32
}

fn voxels() -> impl Iterator<Item = [usize; 3]> {
    (0..SIZE.iter().product())
        .map(|at: usize| [at % SIZE[0], at / SIZE[0] % SIZE[1], at / (SIZE[0] * SIZE[1])])
}

/// The file: mode 2, little-endian.
fn map(cell: [f32; 6]) -> Vec<u8> {
    let mut bytes = vec![0; 1024];
    let mut put =
        |word: usize, value: [u8; 4]| bytes[(word - 1) * 4..word * 4].copy_from_slice(&value);
    for (axis, size) in SIZE.into_iter().enumerate() {
        put(1 + axis, (size as i32).to_le_bytes());
        put(8 + axis, (size as i32).to_le_bytes());
        put(17 + axis, (axis as i32 + 1).to_le_bytes());
    }
    put(4, 2_i32.to_le_bytes());
    for (word, value) in (11..).zip(cell) {
        put(word, value.to_le_bytes());
    }
    put(53, *b"MAP ");
    put(54, [0x44, 0x44, 0, 0]);
    bytes.extend(voxels().flat_map(|voxel| density(voxel).to_le_bytes()));
    bytes
}

/// Radius, in voxels, of the ball where the density is so many standard deviations above its mean.
fn radius(deviations: f64) -> f64 {
    let values: Vec<f64> = voxels().map(|voxel| f64::from(density(voxel))).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt();
    WIDTH * (-2.0 * (mean + deviations * deviation).ln()).sqrt()
}

/// How many pixels beyond the silhouette of the contour a window position is, along the line from its middle.
struct Silhouette {
    middle: DVec2,
    inverse: DMat2,
}

impl Silhouette {
    fn new(grid: &Grid, camera: &gelray::view::camera::Camera, radius: f64) -> Self {
        let window = |index: DVec3| camera.project(grid.index_to_world.transform_point3(index)).0;
        let center = DVec3::from(CENTER);
        let middle = window(center);
        // A ball of voxels is seen as an ellipse: the sum of its axes' outer products.
        let axes = DVec3::AXES.map(|axis| (window(center + axis) - middle) * radius);
        let matrix =
            axes.iter().fold(DMat2::ZERO, |sum, a| sum + DMat2::from_cols(*a * a.x, *a * a.y));
        Self { middle, inverse: matrix.inverse() }
    }

    fn beyond(&self, window: DVec2) -> f64 {
        let from = window - self.middle;
        let relative = from.dot(self.inverse * from).sqrt();
        from.length() * (1.0 - 1.0 / relative.max(1e-9))
    }
}

/// The grid of a cell with the same edges at right angles, and the blob at the same place.
fn straightened(grid: &Grid) -> Grid {
    let spacing = [0, 1, 2].map(|axis| f64::from(CELL[axis]) / SIZE[axis] as f64);
    let mut straight = Grid::axis_aligned(SIZE, spacing, [0.0; 3]).unwrap();
    let place = |grid: &Grid| grid.index_to_world.transform_point3(DVec3::from(CENTER));
    straight.index_to_world.translation += place(grid) - place(&straight);
    straight
}

#[test]
fn the_contour_of_an_oblique_map_is_seen_where_the_cell_says() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("oblique.mrc"), map(CELL)).unwrap();
    let volume = "[[entity]]\nname = \"map\"\nvolume = { file = \"oblique.mrc\" }\n\
        classify = { iso = [{ value = \"1.5sigma\", thickness_voxels = 1 }] }\n";
    let radius = radius(1.5);
    println!(
        "contour of radius {radius:.2} voxels\nview       pixels in, out, wrong; in or out that a rectangular cell would get wrong"
    );
    for [azimuth, elevation] in [[0.0, 0.0], [50.0, 20.0], [110.0, -40.0], [200.0, 75.0]] {
        // A pixel a voxel, about.
        let view = view(azimuth, elevation, 64, 64.0, "coarsest = 4, tolerance = 0, stop_at = 0")
            .replace("focal_point = [0, 0, 0], ", "");
        let mut world = stated(&[volume, &view], &[folder.path().to_owned()]);
        run(&mut world);
        let (camera, picture) = (camera(&world), frame(&world));
        let grid = *world.query::<&Grid>().iter().next().unwrap();
        let silhouette = Silhouette::new(&grid, &camera, radius);
        let other = Silhouette::new(&straightened(&grid), &camera, radius);
        let (mut seen, mut clear, mut wrong, mut told) = (0, 0, 0, 0);
        for [x, y] in crate::pixels(&picture) {
            let window = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let (beyond, alpha) = (silhouette.beyond(window), picture.pixel(x, y)[3]);
            // The contour is an ångström thick on either side, and voxels of 1.4 are interpolated.
            let expected = if beyond < -1.0 {
                1.0
            } else if beyond > 3.5 {
                0.0
            } else {
                continue;
            };
            (seen, clear) = if expected > 0.0 { (seen + 1, clear) } else { (seen, clear + 1) };
            wrong += usize::from((alpha - expected).abs() > 0.1);
            told += usize::from((other.beyond(window) < 0.0) != (expected > 0.0));
        }
        println!("{azimuth:>3} {elevation:>4}   {seen} {clear} {wrong}; {told}");
        assert!(wrong == 0 && seen > 200 && clear > 1000 && told > 10);
    }
}
