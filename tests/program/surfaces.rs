//! Meshes of files: lit by their own normals, and textured where they say.

use gelray::formats::read_picture;

use super::Place;

/// A square of two triangles that faces the observer, a texture, and a light from the left.
fn scene(noun: &str) -> String {
    format!(
        "[[entity]]\nname = \"square\"\n{noun}\ntextured = {{ texture = \"portrait\", filter = \"bilinear\" }}\n[[entity]]\nname = \"key\"\nlight = {{ toward = [-1, -1, 0.5] }}\n[[entity]]\nview = {{ size = [48, 48], height_mm = 24, azimuth = 20, elevation = 10 }}\n"
    )
}

const SQUARE: &str = "v -10 0 10\nv 10 0 10\nv 10 0 -10\nv -10 0 -10\n";

fn apart(place: &Place, a: &str, b: &str) -> f32 {
    let pixels = |name| read_picture(&place.path(name)).unwrap().pixels.to_vec();
    let both = pixels(a).into_iter().zip(pixels(b));
    let apart =
        |(a, b): ([f32; 4], [f32; 4])| (0..4).map(|at| (a[at] - b[at]).abs()).fold(0.0, f32::max);
    both.map(apart).fold(0.0, f32::max)
}

#[test]
fn places_in_a_file_lay_a_texture_as_corners_do() {
    let place = Place::new();
    let polygon =
        "polygon = { vertices = [[-10, 0, 10], [10, 0, 10], [10, 0, -10], [-10, 0, -10]] }";
    let places = "vt 0 1\nvt 1 1\nvt 1 0\nvt 0 0\nf 1/1 3/3 2/2\nf 1/1 4/4 3/3\n";
    place.write("square.obj", format!("{SQUARE}{places}"));
    let mesh = "mesh = { file = \"square.obj\" }\nsurface = { two_sided = true }";
    place.write("mesh.toml", scene(mesh));
    place.write("polygon.toml", scene(&format!("{polygon}\nsurface = {{ two_sided = true }}")));
    place.done("render polygon.toml --exact -o a.npy");
    place.done("render mesh.toml --exact -o b.npy");
    assert!(apart(&place, "a.npy", "b.npy") < 1e-4, "{}", apart(&place, "a.npy", "b.npy"));
    // Without them, corners have to be stated.
    place.write("square.obj", format!("{SQUARE}f 1 3 2\nf 1 4 3\n"));
    place.refused("render mesh.toml -o c.npy", 1, &["where its texture lies", "`corners`"]);
    place.done("render mesh.toml --exact -o c.npy --set square.textured.corners=[[-10,0,10],[10,0,10],[-10,0,-10]]");
    assert!(apart(&place, "a.npy", "c.npy") < 1e-4);
}

#[test]
fn a_picture_of_a_file_s_own_is_laid_as_one_that_is_stated() {
    let place = Place::new();
    place.done("render cross.toml -o bark.png");
    place.write("square.mtl", "newmtl bark\nKd 1 1 1\nmap_Kd bark.png\nmap_d bark.png\n");
    let places = "vt 0 1\nvt 1 1\nvt 1 0\nvt 0 0\nf 1/1 3/3 2/2\nf 1/1 4/4 3/3\n";
    place.write("square.obj", format!("mtllib square.mtl\nusemtl bark\n{SQUARE}{places}"));
    let mesh = "mesh = { file = \"square.obj\" }";
    let stated = scene(mesh).replace("portrait", "bark");
    place.write(
        "stated.toml",
        format!("{stated}[[entity]]\nname = \"bark\"\ntexture = {{ file = \"bark.png\" }}\n"),
    );
    place.write("own.toml", scene(mesh).replace("portrait", "square"));
    place.done("render stated.toml --exact -o a.npy");
    place.done("render own.toml --exact -o b.npy");
    assert!(apart(&place, "a.npy", "b.npy") < 1e-6, "{}", apart(&place, "a.npy", "b.npy"));
    // Without a word of the scene it is there too, and no picture takes its place.
    place.write(
        "plain.toml",
        scene(mesh)
            .lines()
            .filter(|line| !line.starts_with("textured"))
            .collect::<Vec<_>>()
            .join("\n"),
    );
    place.done("render plain.toml --exact -o c.npy");
    assert!(apart(&place, "a.npy", "c.npy") < 0.2, "another filter");
    place.refused("render plain.toml -o bark.png", 2, &["bark.png"]);
    place.write("square.mtl", "newmtl bark\nKd 1 1 1\n");
    place.done("render plain.toml --exact -o d.npy");
    assert!(apart(&place, "a.npy", "d.npy") > 0.3, "the picture makes a difference");
}

#[test]
fn normals_of_a_file_light_it_unless_those_of_triangles_are_asked_for() {
    let place = Place::new();
    let scene = |more: &str| {
        format!(
            "[[entity]]\nname = \"square\"\nmesh = {{ file = \"square.obj\" }}\n{more}\n[[entity]]\nname = \"key\"\nlight = {{ toward = [-1, -1, 0.5] }}\n[[entity]]\nview = {{ size = [48, 48], height_mm = 24 }}\n"
        )
    };
    // The normals of a sphere, all on the observer's side.
    let normals =
        "vn -1 -1 1\nvn 1 -1 1\nvn 1 -1 -1\nvn -1 -1 -1\nf 1//1 4//4 3//3\nf 1//1 3//3 2//2\n";
    place.write("square.obj", format!("{SQUARE}{normals}"));
    place.write("flat.toml", scene(""));
    place.write("smooth.toml", scene("smooth = {}"));
    place.write("triangles.toml", scene("smooth = { normals = \"triangles\" }"));
    for name in ["flat", "smooth", "triangles"] {
        place.done(&format!("render {name}.toml -o {name}.npy"));
    }
    assert!(apart(&place, "flat.npy", "triangles.npy") < 1e-6);
    let picture = read_picture(&place.path("smooth.npy")).unwrap();
    let red = |x: usize, y: usize| picture.pixels[y * 48 + x][0];
    // It is light at the left and above, where the light comes from, and dark across from there.
    assert!(
        red(8, 8) > 2.0 * red(39, 39) && red(8, 8) > red(24, 24),
        "{} {}",
        red(8, 8),
        red(39, 39)
    );
}
