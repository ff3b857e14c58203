//! The matting operators, seen: a red polygon that crosses a green ball, whose front is cut away.

use crate::{EVERY_PIXEL, at, difference, gel, made, polygon, view};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const NOTHING: [f32; 4] = [0.0; 4];

#[test]
fn operators_show_polygon_and_ball_where_porter_and_duff_say() {
    let material = "material = { color = \"#00ff00\", ambient = 1, diffuse = 0 }";
    let ball =
        gel("ball", [0.0, 1.0], &format!("{material}\nclip = {{ planes = [[0, -1, 0, 0]] }}"));
    // Its layer of opaque voxels begins at the cut. At the left it goes on beyond the ball, at the right the ball beyond it.
    let square = [[-30.0, 1.5, -30.0], [12.0, 1.5, -30.0], [12.0, 1.5, 30.0], [-30.0, 1.5, 30.0]];
    let view = view(0.0, 0.0, 96, 64.0, EVERY_PIXEL);
    println!("operator  where both are, polygon alone, ball alone");
    for (matte, both, polygon_alone) in [
        ("over", RED, RED),
        ("under", GREEN, RED),
        // Within the ball the polygon, and no ball beside it where the polygon is; behind it the ball goes on.
        ("in", RED, NOTHING),
        ("out", GREEN, RED),
        ("atop", RED, NOTHING),
    ] {
        let keys = format!(
            "surface = {{ color = \"#ff0000\", ambient = 1, diffuse = 0 }}\nvoxelize = {{ matte = \"{matte}\" }}"
        );
        let world = made(&[&ball, &polygon("pane", &square, &keys), &view]);
        let seen =
            [[-5.0, 0.0, 3.0], [-26.5, 0.0, 0.0], [18.0, 0.0, 0.0]].map(|point| at(&world, point));
        println!("{matte:<9} {seen:.3?}");
        for (seen, expected) in seen.iter().zip([both, polygon_alone, GREEN]) {
            assert!(difference(*seen, expected) < 0.02, "{matte}: {seen:?} {expected:?}");
        }
    }
}
