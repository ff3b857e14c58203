//! Meshes whose materials are seen through: each triangle as one whose surface states that opacity, by both methods.

use std::fmt::Write;

use gelray::view::picture::Picture;

use crate::{EVERY_PIXEL, KEY, difference, frame, gel, pixels, polygon, run, stated, view};

/// A square of two triangles upright at a y.
fn square(y: f64) -> [[f64; 3]; 4] {
    [[-20.0, y, -20.0], [20.0, y, -20.0], [20.0, y, 20.0], [-20.0, y, 20.0]]
}

const OPACITIES: [f64; 2] = [0.25, 0.6];

/// Two squares before and within a ball as one mesh of two materials, or as two polygons that state the same.
fn seen(as_mesh: bool, keys: &str, times: f64) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let (mut obj, mut mtl, mut polygons) =
        (String::from("mtllib a.mtl\n"), String::new(), String::new());
    for (at, (y, opacity)) in [-31.0, 3.0].into_iter().zip(OPACITIES).enumerate() {
        for [x, y, z] in square(y) {
            let _ = writeln!(obj, "v {x} {y} {z}");
        }
        let _ = writeln!(obj, "usemtl m{at}\nf -4 -3 -2\nf -4 -2 -1");
        let _ = writeln!(mtl, "newmtl m{at}\nKd 1 1 1\nd {opacity}");
        let surface = format!("surface = {{ opacity = {} }}\n{keys}", opacity * times);
        polygons += &polygon(&format!("p{at}"), &square(y), &surface);
    }
    std::fs::write(folder.path().join("a.obj"), obj).unwrap();
    std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
    let mesh = format!(
        "[[entity]]\nname = \"squares\"\nmesh = {{ file = \"a.obj\" }}\nsurface = {{ opacity = {times} }}\n{keys}\n"
    );
    let squares = if as_mesh { mesh } else { polygons };
    let gel = gel("ball", [0.0, 0.3], "");
    let view = view(20.0, 15.0, 48, 80.0, EVERY_PIXEL);
    let mut world = stated(&[&gel, &squares, KEY, &view], &[folder.path().to_owned()]);
    run(&mut world);
    frame(&world)
}

/// The greatest difference between the two, and whether anything is seen at all.
fn apart(keys: &str, times: f64) -> f32 {
    let [mesh, polygons] = [true, false].map(|as_mesh| seen(as_mesh, keys, times));
    assert!(pixels(&mesh).any(|[x, y]| mesh.pixel(x, y)[3] > 0.2));
    let apart = pixels(&mesh).map(|[x, y]| difference(mesh.pixel(x, y), polygons.pixel(x, y)));
    apart.fold(0.0, f32::max)
}

#[test]
fn a_traced_triangle_is_as_opaque_as_its_material_times_its_surface() {
    for times in [1.0, 0.5] {
        let apart = apart("", times);
        println!("{times}: {apart}");
        assert!(apart < 1e-4, "{times}: {apart}");
    }
}

#[test]
fn what_is_seen_through_is_wholly_there_for_every_operator() {
    for matte in ["under", "in", "out", "atop"] {
        let keys = format!("voxelize = {{ matte = \"{matte}\" }}");
        let apart = apart(&keys, 1.0);
        println!("{matte}: {apart}");
        assert!(apart < 1e-3, "{matte}: {apart}");
    }
}

#[test]
fn a_scan_converted_triangle_is_as_opaque_as_its_material() {
    for keys in ["voxelize = { calibrated = false }", "voxelize = {}"] {
        let apart = apart(keys, 1.0);
        println!("{keys}: {apart}");
        assert!(apart < 1e-3, "{keys}: {apart}");
    }
}
