//! Scenes as small as a billionth and as large as a billion, far from the origin, in windows of every size (algorithm §10).

use gelray::components::{Sampling, View};
use gelray::view::picture::Picture;
use gelray::volume::grid::Grid;
use glam::DVec3;

use super::support::{
    Mixture, assert_sound, centred, every_pixel, flat, homogeneous, paint, square, worst,
};

/// A ball of gel with two polygons, scaled and moved.
fn scaled(scale: f64, offset: f64) -> Result<Picture, String> {
    let move_to = |p: DVec3| p * scale + DVec3::splat(offset);
    let grid = Grid::axis_aligned([15; 3], [scale; 3], move_to(DVec3::splat(-7.0)).to_array())?;
    let gel = paint(&grid, |at| {
        let r = DVec3::from(at.map(|n| n as f64 - 7.0)).length();
        [0.9, 0.6, 0.3, (0.3 * (6.0 - r).clamp(0.0, 1.0)) as f32]
    });
    let planes = [
        (DVec3::new(0.2, 0.4, 0.1), DVec3::new(0.3, 1.0, 0.2)),
        (DVec3::X, DVec3::new(1.0, 0.4, -0.3)),
    ];
    let polygons = planes.map(|(center, normal)| {
        (
            vec![square(center, normal, 5.0).into_iter().map(move_to).collect()],
            flat([0.1, 0.4, 0.9], 0.5),
        )
    });
    let view = View {
        azimuth: 25.0,
        elevation: 15.0,
        focal_point: Some([offset; 3]),
        height_mm: Some(16.0 * scale),
        size: [20; 2],
        ..View::default()
    };
    let sampling = Sampling { distance_mm: Some(0.6 * scale), ..every_pixel() };
    let scene = Mixture { polygons: polygons.to_vec(), view, sampling, ..Mixture::of(grid, gel) };
    scene.try_render().map(|made| made.picture)
}

#[test]
fn a_scene_scaled_or_moved_is_the_same_picture() {
    let here = scaled(1.0, 0.0).unwrap();
    assert!(here.pixels.iter().filter(|pixel| pixel[3] > 0.5).count() > 100);
    for (scale, offset) in [
        (1e-9, 0.0),
        (1e-6, 0.0),
        (1e-3, 0.0),
        (1e3, 0.0),
        (1e6, 0.0),
        (1e9, 0.0),
        (1.0, 1e6),
        (1.0, -1e6),
        (1e6, 1e6),
        (1e-3, 1e3),
    ] {
        let picture = scaled(scale, offset).unwrap();
        let what = format!("scaled by {scale:e}, moved by {offset:e}");
        assert_sound(&picture, &what);
        let off = worst(&here, &picture);
        println!("{what}: off by {off:.1e}");
        assert!(off < 1e-4, "{what}: {off}");
    }
    // Of a micrometre a thousand kilometres away 64 bits know five digits' tenth: no panic, and a sound picture if one.
    for (scale, offset) in [(1e-6, 1e6), (1e-9, 1e6), (1e-12, 1e6), (1e-30, 0.0), (1e30, 0.0)] {
        let what = format!("scaled by {scale:e}, moved by {offset:e}");
        match scaled(scale, offset) {
            Ok(picture) => assert_sound(&picture, &what),
            Err(sentence) => println!("{what}: {sentence}"),
        }
    }
}

#[test]
fn windows_of_every_size_and_shape_are_sound() {
    let grid = centred([9; 3], 1.0);
    let gel = homogeneous(&grid, [0.9, 0.3, 0.1, 0.2]);
    let oblique = vec![square(DVec3::ZERO, DVec3::new(0.3, 1.0, 0.2), 6.0)];
    for height in [1e-9, 1e-3, 1.0, 30.0, 1e4, 1e9] {
        for size in [[1, 1], [1, 40], [40, 1], [13, 7]] {
            for (coarsest, outlines) in [(1, true), (8, false), (32, true)] {
                let sampling = Sampling { coarsest, outlines, ..Sampling::default() };
                let polygons = vec![(oblique.clone(), flat([0.2, 0.9, 1.0], 0.5))];
                let mut scene = Mixture { polygons, sampling, ..Mixture::of(grid, gel.clone()) }
                    .seen((20.0, 10.0), 1, height);
                scene.view.size = size;
                let picture = scene.render().picture;
                assert_sound(&picture, &format!("{size:?} pixels of a window {height:e} high"));
                let filled = picture.pixels.iter().all(|pixel| pixel[3] > 0.5);
                assert!(filled || height > 1.0 / 40.0, "{size:?} {height:e}");
            }
        }
    }
}

#[test]
fn fields_of_view_from_a_thousandth_of_a_degree_to_179_are_sound() {
    let grid = centred([9; 3], 1.0);
    let gel = homogeneous(&grid, [0.9, 0.3, 0.1, 0.2]);
    let oblique = vec![square(DVec3::ZERO, DVec3::new(0.3, 1.0, 0.2), 6.0)];
    let seen =
        |field_of_view: Option<f64>, height: f64| {
            let polygons = vec![(oblique.clone(), flat([0.2, 0.9, 1.0], 0.5))];
            let mut scene =
                Mixture { polygons, sampling: every_pixel(), ..Mixture::of(grid, gel.clone()) }
                    .seen((20.0, 10.0), 16, height);
            scene.view.field_of_view = field_of_view;
            scene.render().picture
        };
    // From far away, half inside of the gel, and deep inside.
    for height in [40.0, 5.0, 0.1] {
        let parallel = seen(None, height);
        for degrees in [1e-3, 0.1, 5.0, 60.0, 120.0, 170.0, 179.0] {
            let picture = seen(Some(degrees), height);
            assert_sound(&picture, &format!("{degrees}° of a window {height} high"));
            let off = worst(&parallel, &picture);
            assert!(degrees > 0.01 || off < 1e-3, "{degrees}°, {height}: {off}");
        }
    }
}
