//! Scenes that are taken to an extreme, and what their pictures should be.

/// What a picture is held against.
pub enum Truth {
    /// That of another scene.
    Scene(String),
    /// An opacity in closed form, in 64 bits, of every pixel.
    Opacity(f64),
    /// Nothing but that every pixel is finite and 0 ≤ α ≤ 1.
    Sound,
}

/// The shell of a ball in voxels of an edge, moved.
fn ball(edge: f64, moved: f64) -> String {
    format!(
        "[[entity]]\nname = \"ball\"\nvolume = {{ file = \"phantom:ball\", spacing_mm = [{edge:?}, {edge:?}, {edge:?}], center = {:?} }}\nclassify = {{ iso = [{{ value = \"0.5sigma\", opacity = 0.3, form = \"around\" }}] }}\n",
        [moved; 3]
    )
}

fn square(at: usize, vertices: [[f64; 3]; 4], opacity: f64) -> String {
    format!(
        "[[entity]]\nname = \"square {at}\"\npolygon = {{ vertices = {vertices:?} }}\nsurface = {{ opacity = {opacity:?} }}\n"
    )
}

/// A view of some degrees about z, with its samples a distance apart, of a window so high about a point on the diagonal.
fn view((azimuth, distance): (u32, f64), height: f64, moved: f64) -> String {
    format!(
        "[[entity]]\nname = \"observer\"\nview = {{ azimuth = {azimuth}, elevation = {}, size = [48, 48], height_mm = {height:?}, focal_point = {:?} }}\n[entity.sampling]\nstop_at = 0.0\ncoarsest = 4\ndistance_mm = {distance:?}\n",
        azimuth / 2,
        [moved; 3]
    )
}

/// A ball and two crossing squares, scaled and moved.
pub fn world(scale: f64, moved: f64) -> String {
    let squares = [[0.2, 0.5, -0.4], [-0.5, 0.3, 0.2]].map(|[x, y, z]: [f64; 3]| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[a, b]| [a + x * b, y * a - b * 0.3, b + z * a].map(|n| n * 22.0 * scale + moved))
    });
    let [first, second] = squares;
    let squares = square(0, first, 0.5) + &square(1, second, 0.7);
    ball(scale, moved) + &squares + &view((30, scale), 64.0 * scale, moved)
}

/// Squares one behind the other, and what they cover together: 1 − (1 − α)ⁿ.
pub fn layers(count: u32, opacity: f64) -> (String, Truth) {
    // What a scene states is kept in 32 bits.
    let opacity = opacity as f32;
    let mut text = String::new();
    for at in 0..count {
        let y = 20.0 * (f64::from(at) / f64::from(count) - 0.5);
        let corners = [[-40.0, -40.0], [40.0, -40.0], [40.0, 40.0], [-40.0, 40.0]];
        text.push_str(&square(at as usize, corners.map(|[x, z]| [x, y, z]), f64::from(opacity)));
    }
    let covered = -(f64::from(count) * (-f64::from(opacity)).ln_1p()).exp_m1();
    (text + &view((0, 1.0), 16.0, 0.0), Truth::Opacity(covered))
}

/// Even gel, a ray's samples a distance apart, and what it covers: 1 − (1 − α)⁶³ of 64 voxels.
pub fn even(distance: f64) -> (String, Truth) {
    let gel = "[[entity]]\nname = \"gel\"\nvolume = { file = \"phantom:slab\" }\nclassify = { transfer = [{ value = 0.0, opacity = 0.02 }, { value = 1.0, opacity = 0.02 }] }\n";
    let covered = -(63.0 * (-f64::from(0.02_f32)).ln_1p()).exp_m1();
    // A window within the volume, so that each ray has its whole depth.
    (gel.to_owned() + &view((0, distance), 16.0, 0.0), Truth::Opacity(covered))
}

/// The shell in voxels that are longer along z, its steps a part of the shortest edge.
pub fn stretched(long: f64, step: f64) -> String {
    let ball = format!(
        "[[entity]]\nname = \"ball\"\nvolume = {{ file = \"phantom:ball\", spacing_mm = [1.0, 1.0, {long:?}], center = [0.0, 0.0, 0.0] }}\nclassify = {{ iso = [{{ value = \"0.5sigma\", opacity = 0.3, form = \"around\" }}] }}\n"
    );
    ball + &view((30, step), 64.0, 0.0)
}

/// The ball and its squares, in perspective.
pub fn perspective(degrees: f64) -> String {
    world(1.0, 0.0).replace("view = { ", &format!("view = {{ field_of_view = {degrees:?}, "))
}

/// The ball and a square some degrees from the line of sight.
pub fn grazing(degrees: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let corners = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];
    let edge_on = corners.map(|[x, z]| [x * sin, x * cos, z]);
    ball(1.0, 0.0) + &square(0, edge_on, 0.5) + &view((0, 1.0), 64.0, 0.0)
}
