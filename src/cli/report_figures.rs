//! What the paper says of its figures, in its words, by the embedded scenes that render them.

/// A figure of the paper.
pub struct Claim {
    /// The embedded scene.
    pub scene: &'static str,
    /// What the paper says of it.
    pub quote: &'static str,
    /// Whether the figure shows where rays were cast, and not what they saw.
    pub shows_rays: bool,
}

const fn picture(scene: &'static str, quote: &'static str) -> Claim {
    Claim { scene, quote, shows_rays: false }
}

const fn rays(scene: &'static str, quote: &'static str) -> Claim {
    Claim { scene, quote, shows_rays: true }
}

/// All figures of pictures, in the paper's order, and the shaft of light that its §8 only speaks of.
pub static CLAIMS: [Claim; 11] = [
    picture(
        "figure_06a",
        "Figures 6a and 6b were generated using slightly fewer than one ray per pixel on average, and took 80 seconds and 70 seconds respectively to generate. For comparison, the volumetric data without the polygons can be rendered with the same level of refinement in about 50 seconds.",
    ),
    picture(
        "figure_06b",
        "The cost of scan-converting a polygon is proportional to its surface area. The large polygons used here were scan-converted in about 1 second each.",
    ),
    picture(
        "figure_07a",
        "In general, polygon edges produced by the hybrid ray tracer are sharper than those produced by 3D scan-conversion, although a higher image generation cost is paid for the better rendition.",
    ),
    picture(
        "figure_07b",
        "If the polygonal data is sufficiently bandlimited prior to sampling, this method also produces images free from aliasing artifacts.",
    ),
    rays(
        "figure_08a",
        "As expected, the number of rays per unit area is lowest in the interiors of homogeneous regions, higher along the silhouettes of volumetric objects, and in the case of the hybrid ray tracer, higher still along polygonal edges.",
    ),
    rays(
        "figure_08b",
        "White pixels in the visualizations correspond to cast rays, and black pixels to samples filled in by interpolation.",
    ),
    picture(
        "figure_09",
        "The addition of shadows roughly doubles the time required to compute the array of total voxel colors, but does not affect the time required to generate each frame in a rotation sequence.",
    ),
    picture(
        "figure_10",
        "The effect on image generation time of adding textures depends on the number and size of textured polygons. For this example, image generation time increased by roughly 50%.",
    ),
    picture(
        "figure_11",
        "The same CT dataset used in the previous figures has now been rendered to show both bone and soft tissue. A portion of the CT data has been clipped away to show the 3D relationship between the various objects.",
    ),
    picture(
        "figure_12",
        "Figure 12 illustrates how scan-converted backdrop planes and cast shadows can be used to enhance comprehension of an isovalue contour surface from an electron density map of Staphylococcus Aureus ribonuclease.",
    ),
    picture(
        "shaft",
        "If the profile is loaded into the array of initial light strengths, and all voxels in the volumetric data are assigned a slightly non-zero opacity, one obtains the effect of sculpted shafts of light passing through a dust-filled room.",
    ),
];

/// Pairs that are laid over each other, and what is to be seen.
pub static PAIRS: [([&str; 2], &str); 2] = [
    (["figure_06a", "figure_06b"], "Polygons by the hybrid ray tracer, and scan-converted"),
    (["figure_07a", "figure_07b"], "The same in detail"),
];

/// What the paper says of a scene.
pub fn claim(scene: &str) -> Option<&'static Claim> {
    CLAIMS.iter().find(|claim| claim.scene == scene)
}
