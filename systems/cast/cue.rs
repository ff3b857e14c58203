//! Depth cueing: reflected light fades with depth while rays are cast, and ambient light does not (algorithm §3).

/// How reflected light fades with depth: divided by `k1 + k2 (t − near)`, t the depth along the ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cue {
    /// k_1.
    pub k1: f64,
    /// k_2, per world unit.
    pub k2: f64,
    /// Depth of the near side of the scene's bounding sphere.
    pub near: f64,
}

impl Cue {
    /// What reflected light at depth `t` is multiplied by; above 0 within the scene.
    #[must_use]
    pub fn factor(&self, t: f64) -> f64 {
        1.0 / (self.k1 + self.k2 * (t - self.near).max(0.0))
    }
}
