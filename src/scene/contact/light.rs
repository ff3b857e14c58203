//! Light that models form: strong from one side, little of it from everywhere.

/// The entity of the strongest light, from above on the left.
pub(super) fn key(shadow: bool) -> String {
    let (said, line) = if shadow {
        (
            " and casts the shadows; the others show what it leaves dark",
            "casts_shadow = { bias_voxels = 3 }\n",
        )
    } else {
        ("; the others show what it leaves dark", "")
    };
    format!(
        "\n# The strongest light comes from above on the left{said}.\n[[entity]]\nname = \"key\"\nlight = {{ toward = [-0.35, -0.8, 0.6], strength = 0.95 }}\n{line}"
    )
}

/// The entities of the weaker lights.
pub(super) const LIGHTS: &str = "
[[entity]]
name = \"fill\"
light = { toward = [0.9, -0.45, 0.1], strength = 0.22, color = \"#cfe0ff\" }

[[entity]]
name = \"rim\"
light = { toward = [0.6, 0.8, 0.5], strength = 0.3 }
";
