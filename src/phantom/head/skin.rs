//! The surface of the head: face, ears and neck; under it skin, fat and muscle.

use crate::phantom::shapes::Piece;

/// The outside of the head.
pub const SKIN: &[Piece] = &[
    // Vault, nape, temples, cheeks, jaw, chin, mouth and neck.
    Piece::ellipsoid([0.0, 8.0, 38.0], [72.0, 92.0, 68.0]),
    Piece::ellipsoid([0.0, -30.0, -20.0], [56.0, 54.0, 72.0]).soft(14.0),
    Piece::ellipsoid([40.0, -22.0, -10.0], [29.0, 44.0, 42.0]).both().soft(16.0),
    Piece::ellipsoid([44.0, 22.0, -14.0], [25.0, 28.0, 34.0]).both().soft(16.0),
    Piece::ellipsoid([40.0, -52.0, -14.0], [20.0, 22.0, 17.0]).both().soft(18.0),
    Piece::capsule([41.0, 0.0, -65.0], [16.0, -61.0, -87.0], [23.0, 20.0]).both().soft(16.0),
    Piece::ellipsoid([33.0, -32.0, -50.0], [26.0, 34.0, 36.0]).both().soft(16.0),
    Piece::ellipsoid([0.0, -82.0, -90.0], [18.0, 15.0, 13.0]).soft(14.0),
    Piece::ellipsoid([0.0, -60.0, -30.0], [36.0, 29.0, 36.0]).soft(16.0),
    Piece::ellipsoid([0.0, -62.0, -54.0], [34.0, 28.0, 30.0]).soft(12.0),
    Piece::capsule([0.0, 30.0, -20.0], [0.0, 34.0, -150.0], [52.0, 51.0]).soft(30.0),
    // Brows, eyes and closed lids.
    Piece::capsule([6.0, -78.0, 24.0], [25.0, -75.0, 28.0], [8.5, 8.0]).both().soft(10.0),
    Piece::capsule([25.0, -75.0, 28.0], [44.0, -63.0, 21.0], [8.0, 8.0]).both().soft(12.0),
    Piece::ellipsoid([29.0, -101.0, 8.0], [16.0, 21.0, 12.0]).both().cut().soft(9.0),
    Piece::ellipsoid([30.0, -70.0, 8.0], [15.0, 14.5, 11.5]).both().soft(4.0),
    Piece::capsule([18.0, -83.0, 6.0], [30.0, -86.0, 3.5], [0.8, 1.2]).both().cut().soft(2.0),
    Piece::capsule([30.0, -86.0, 3.5], [43.0, -79.0, 6.0], [1.2, 0.8]).both().cut().soft(2.0),
    // Nose: ridge, tip, wings and nostrils.
    Piece::capsule([0.0, -83.0, 24.0], [0.0, -100.0, -14.0], [5.5, 8.0]).soft(12.0),
    Piece::ellipsoid([0.0, -104.0, -21.0], [8.5, 9.0, 8.0]).soft(8.0),
    Piece::ellipsoid([9.5, -96.0, -24.5], [6.8, 9.0, 6.5]).both().soft(7.0),
    Piece::capsule([5.5, -103.0, -38.0], [6.0, -90.0, -22.0], [3.0, 4.0]).both().cut(),
    // Lips.
    Piece::capsule([2.5, -89.5, -50.0], [23.0, -82.5, -54.0], [4.2, 1.5]).both().soft(4.0),
    Piece::capsule([3.0, -88.0, -60.0], [20.0, -83.0, -57.0], [4.8, 1.8]).both().soft(4.0),
    Piece::capsule([4.0, -94.5, -54.8], [26.0, -85.5, -55.5], [1.6, 1.0]).both().cut().soft(3.0),
    Piece::capsule([0.0, -97.0, -36.0], [0.0, -95.5, -45.0], [2.0, 2.5]).cut().soft(4.0),
    // Ears: shell, hollow, lobe and the cartilage before the canal.
    Piece::ellipsoid([75.0, 20.0, -2.0], [5.0, 17.0, 28.0]).turned(-28.0, 12.0).both().soft(5.0),
    Piece::ellipsoid([80.0, 15.0, 1.0], [6.0, 11.0, 19.0])
        .turned(-28.0, 12.0)
        .both()
        .cut()
        .soft(4.0),
    Piece::ellipsoid([72.5, 12.0, -25.0], [4.5, 7.0, 8.0]).turned(-20.0, 0.0).both().soft(5.0),
    Piece::capsule([70.0, 3.0, -10.0], [70.5, 3.0, -4.0], [3.5, 3.0]).both().soft(5.0),
];

/// Skin, the fat under it and muscle, by the distance to the surface; fat is thicker in the cheeks and the neck.
pub fn tissue(y: f32, z: f32) -> impl Fn(f32, f32) -> f32 {
    let fat = if z > 30.0 { 2.0 } else { (2.0 + (30.0 - z) * 0.06).min(6.0) };
    move |x, distance| {
        let skin = ((-distance - 2.0) / 1.5).clamp(0.0, 1.0);
        let outer = 1065.0 + (980.0 - 1065.0) * skin;
        let deep = ((-distance - 3.5 - fat) / 2.0).clamp(0.0, 1.0);
        if deep > 0.0 { outer + (muscle(x.abs(), y, z) - outer) * deep } else { outer }
    }
}

/// Muscle with strands of fat between its bundles.
fn muscle(side: f32, y: f32, z: f32) -> f32 {
    let along = wave(0.033 * side + 0.043 * y + 0.008 * z);
    let across = wave(0.047 * side - 0.019 * y + 0.027 * z);
    1076.0 - 48.0 * (along * across - 0.3).max(0.0)
}

/// A wave of period 1 between −1 and 1, of two parabolas.
fn wave(at: f32) -> f32 {
    let part = at - (at + 0.5).floor();
    16.0 * part * (0.5 - part.abs())
}
