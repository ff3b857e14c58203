//! `--maps`: depth, normal and entity of what is seen first, as layers of floats.

use super::Place;

/// A ball of gel before a polygon.
const SCENE: &str = "
[[entity]]
name = \"wall\"
polygon = { vertices = [[-20, 30, -20], [20, 30, -20], [20, 30, 20], [-20, 30, 20]] }
[[entity]]
name = \"ball\"
volume = { file = \"phantom:ball\" }
classify = { iso = [{ value = 0.5 }] }
[[entity]]
name = \"eye\"
view = { size = [60, 60], height_mm = 60, focal_point = [0, 0, 0] }
";

/// The layers of a pixel.
fn pixel(array: &[u8], [x, y]: [usize; 2]) -> [f32; 5] {
    let values = array[128..].as_chunks::<4>().0;
    std::array::from_fn(|layer| f32::from_le_bytes(values[(y * 60 + x) * 5 + layer]))
}

#[test]
fn a_pixel_has_the_depth_the_normal_and_the_entity_that_it_shows_first() {
    let place = Place::new();
    place.write("s.toml", SCENE);
    place.done("render s.toml -q -o a.png --maps a.npy");
    let maps = place.read("a.npy");
    assert!(String::from_utf8_lossy(&maps[..128]).contains("(60, 60, 5)"));
    // The observer stands at -y: the wall's depth is its y, and it faces -y.
    assert_eq!(pixel(&maps, [12, 12]), [30.0, 0.0, -1.0, 0.0, 1.0]);
    let [depth, .., entity] = pixel(&maps, [1, 1]);
    assert!(depth.is_nan() && entity == 0.0);
    // The ball: nearer in its middle, and its normals point away from its middle.
    let [middle, x, y, z, entity] = pixel(&maps, [30, 30]);
    assert!(entity == 2.0 && y < -0.99 && x.abs() < 0.1 && z.abs() < 0.1, "{middle} {x} {y} {z}");
    for (at, [x, z]) in [([38, 30], [8.5, -0.5]), ([25, 36], [-4.5, -6.5]), ([30, 20], [0.5, 9.5])]
    {
        let [depth, nx, ny, nz, entity] = pixel(&maps, at);
        let radius = (x * x + z * z + depth * depth).sqrt();
        assert!(entity == 2.0 && (radius - middle.abs()).abs() < 0.7, "{at:?} {radius} {middle}");
        let along = (nx * x + ny * depth + nz * z) / radius;
        assert!(along > 0.98, "{at:?} {along}");
    }
}

#[test]
fn maps_of_a_picture_are_layers_of_an_exr_by_the_file_s_name() {
    let place = Place::new();
    place.done("render cross.toml -q -o a.png --maps a.exr");
    let text = String::from_utf8_lossy(&place.read("a.exr")).into_owned();
    for name in ["N.X", "N.Y", "N.Z", "Z", "entity"] {
        assert!(text.contains(&format!("{name}\0")), "{name}");
    }
    place.refused("render cross.toml -q -o a.png --maps a.png", 2, &[".exr or .npy"]);
}

#[test]
fn maps_of_values_lie_on_their_surface() {
    let place = Place::new();
    place.write("s.toml", SCENE);
    for (words, apart) in [("thickness_voxels=0", 0.01), ("thickness_voxels=1", 0.5)] {
        let set = format!("--set ball.classify.iso.0.{words} --set ball.volume.reconstruct=values");
        place.done(&format!("render s.toml -q -o a.png --maps a.npy {set}"));
        let maps = place.read("a.npy");
        let radii = [[30, 30], [38, 30], [25, 36], [30, 20], [41, 41]].map(|[x, y]| {
            let [depth, nx, ny, nz, entity] = pixel(&maps, [x, y]);
            let (x, z) = (x as f32 + 0.5 - 30.0, 30.0 - y as f32 - 0.5);
            let radius = (x * x + z * z + depth * depth).sqrt();
            let along = (nx * x + ny * depth + nz * z) / radius;
            assert!(entity == 2.0 && along > 0.99, "{words} {along}");
            radius
        });
        let [low, high] = [f32::min, f32::max].map(|pick| radii.into_iter().reduce(pick).unwrap());
        assert!(high - low < apart, "{words} {radii:?}");
        // The wall is seen beside the ball, as it was.
        assert_eq!(pixel(&maps, [12, 12]), [30.0, 0.0, -1.0, 0.0, 1.0]);
    }
}

#[test]
fn a_smooth_mesh_has_the_normals_of_what_it_stands_for() {
    let place = Place::new();
    let ball =
        "mesh = { ellipsoid = { center = [0, 0, 0], radii = [20, 20, 20], subdivisions = 3 } }";
    place.write(
        "s.toml",
        format!("[[entity]]\nname = \"ball\"\n{ball}\n[[entity]]\nname = \"eye\"\nview = {{ size = [60, 60], height_mm = 60, focal_point = [0, 0, 0] }}\n"),
    );
    // The most that a normal is off from the sphere's, degrees.
    let off = |more: &str| {
        place.done(&format!("render s.toml -q -o a.png --maps a.npy {more}"));
        let maps = place.read("a.npy");
        let of = |[x, y]: [usize; 2]| {
            let [depth, nx, ny, nz, entity] = pixel(&maps, [x, y]);
            let (x, z) = (x as f32 + 0.5 - 30.0, 30.0 - y as f32 - 0.5);
            assert!(entity == 1.0 && ny < 0.0);
            let along = (nx * x + ny * depth + nz * z) / (x * x + z * z + depth * depth).sqrt();
            along.min(1.0).acos().to_degrees()
        };
        [[30, 30], [38, 31], [25, 36], [30, 17], [41, 39], [20, 33]]
            .map(of)
            .into_iter()
            .fold(0.0, f32::max)
    };
    let (flat, smooth) = (off(""), off("--set ball.smooth.crease_degrees=60"));
    assert!(flat > 1.5 && smooth < 0.5, "{flat} {smooth}");
}

#[test]
fn integrated_values_are_met_where_they_are_seen_at_long_steps() {
    let place = Place::new();
    // A shell much thinner than a step.
    let transfer = "classify = { transfer = [{ value = 0.48, opacity = 0 }, { value = 0.49, opacity = 1 }, { value = 0.51, opacity = 1 }, { value = 0.52, opacity = 0 }] }";
    place.write("s.toml", SCENE.replace("classify = { iso = [{ value = 0.5 }] }", transfer));
    let met = |more: &str| {
        let values = "--set ball.volume.reconstruct=values --set eye.sampling.distance_mm=4";
        place.done(&format!("render s.toml -q -o a.png --maps a.npy {values} {more}"));
        let maps = place.read("a.npy");
        // A square within the ball's outline.
        let all = (0..900).map(|at| [15 + at % 30, 15 + at / 30]);
        all.filter(|at| pixel(&maps, *at)[4] == 2.0).count()
    };
    let (samples, integrated) = (met(""), met("--set eye.sampling.integrate=true"));
    assert!(samples < 400 && integrated == 900, "{samples} {integrated}");
}
