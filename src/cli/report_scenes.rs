//! Scenes made by formula for the report: those that are taken to an extreme, and what their pictures should be.

/// What a picture is held against.
pub enum Truth {
    /// That of another scene.
    Scene(String),
    /// An opacity in closed form, in 64 bits, of every pixel.
    Opacity(f64),
    /// Nothing but that every pixel is finite and 0 ≤ α ≤ 1.
    Sound,
}

/// The shell of a ball in voxels of such edges, moved.
fn ball(edges: [f64; 3], moved: f64) -> String {
    format!(
        "[[entity]]\nname = \"ball\"\nvolume = {{ file = \"phantom:ball\", spacing_mm = {edges:?}, center = {:?} }}\nclassify = {{ iso = [{{ value = \"0.5sigma\", opacity = 0.3, form = \"around\" }}] }}\n",
        [moved; 3]
    )
}

fn square(at: u32, vertices: [[f64; 3]; 4], opacity: f64) -> String {
    format!(
        "[[entity]]\nname = \"square {at}\"\npolygon = {{ vertices = {vertices:?} }}\nsurface = {{ opacity = {opacity:?} }}\n"
    )
}

/// The corners of a square by half its side.
fn corners(half: f64) -> [[f64; 2]; 4] {
    [[-half, -half], [half, -half], [half, half], [-half, half]]
}

/// So many squares one behind the other, evenly over a depth.
pub fn squares(count: u32, (half, depth): (f64, f64), opacity: f64) -> String {
    let one = |at: u32| {
        let y = depth * (f64::from(at) / f64::from(count) - 0.5);
        square(at, corners(half).map(|[x, z]| [x, y, z]), opacity)
    };
    (0..count).map(one).collect()
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
        corners(1.0)
            .map(|[a, b]| [a + x * b, y * a - b * 0.3, b + z * a].map(|n| n * 22.0 * scale + moved))
    });
    let [first, second] = squares;
    let squares = square(0, first, 0.5) + &square(1, second, 0.7);
    ball([scale; 3], moved) + &squares + &view((30, scale), 64.0 * scale, moved)
}

/// Squares one behind the other, and what they cover together: 1 − (1 − α)ⁿ.
pub fn layers(count: u32, opacity: f64) -> (String, Truth) {
    // What a scene states is kept in 32 bits.
    let opacity = f64::from(opacity as f32);
    let covered = -(f64::from(count) * (-opacity).ln_1p()).exp_m1();
    let squares = squares(count, (40.0, 20.0), opacity);
    (squares + &view((0, 1.0), 16.0, 0.0), Truth::Opacity(covered))
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
    ball([1.0, 1.0, long], 0.0) + &view((30, step), 64.0, 0.0)
}

/// The ball and its squares, in perspective.
pub fn perspective(degrees: f64) -> String {
    world(1.0, 0.0).replace("view = { ", &format!("view = {{ field_of_view = {degrees:?}, "))
}

/// The ball and a square some degrees from the line of sight.
pub fn grazing(degrees: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let edge_on = corners(20.0).map(|[x, z]| [x * sin, x * cos, z]);
    ball([1.0; 3], 0.0) + &square(0, edge_on, 0.5) + &view((0, 1.0), 64.0, 0.0)
}
