//! One scene by both methods: the same away from edges, and sharper edges from the hybrid ray tracer (the paper's figures 6, 7).

use gelray::view::picture::Picture;
use glam::DVec2;

use crate::{camera, difference, frame, gel, made, near, nothing, pixels, polygon, rendered, view};

const LIGHT: &str = "[[entity]]\nname = \"key\"\nlight = { toward = [-0.4, -0.8, 0.5] }\n";
const VOXELIZE: &str = "voxelize = { matte = \"over\" }";

/// A figure: its name, its TOML without a surface, and from where it is seen.
struct Figure {
    name: &'static str,
    toml: &'static str,
    from: [f64; 2],
    /// Whether all of it is seen face-on; aslant, translucent gel is denser than a polygon.
    facing: bool,
}

const FIGURES: [Figure; 5] = [
    Figure {
        name: "plane, facing",
        toml: "polygon = { vertices = [[-20, 0.3, -20], [20, 0.3, -20], [20, 0.3, 20], [-20, 0.3, 20]] }",
        from: [0.0, 0.0],
        facing: true,
    },
    Figure {
        name: "plane, aslant",
        toml: "polygon = { vertices = [[-20, 14, -20], [20, -14, -20], [20, -14, 20], [-20, 14, 20]] }",
        from: [0.0, 0.0],
        facing: false,
    },
    Figure {
        name: "box, facing",
        toml: "mesh = { prism = { from = [0, 0, -15], to = [0, 0, 15], radius = 20, sides = 4 } }",
        from: [45.0, 0.0],
        facing: true,
    },
    Figure {
        name: "box, aslant",
        toml: "mesh = { prism = { from = [0, 0, -15], to = [0, 0, 15], radius = 20, sides = 4 } }",
        from: [20.0, 25.0],
        facing: false,
    },
    Figure {
        name: "ellipsoid",
        toml: "mesh = { ellipsoid = { center = [1, 2, -1], radii = [22, 16, 19], subdivisions = 3 } }",
        from: [20.0, 15.0],
        facing: false,
    },
];

impl Figure {
    fn seen(&self, gel: &str, opacity: f64, keys: &str) -> Picture {
        let surface = format!("surface = {{ color = \"#d0a060\", opacity = {opacity} }}");
        let figure = format!("[[entity]]\nname = \"figure\"\n{}\n{surface}\n{keys}\n", self.toml);
        let [azimuth, elevation] = self.from;
        let view = view(azimuth, elevation, 64, 64.0, "coarsest = 4, tolerance = 0, stop_at = 0");
        rendered(&[gel, &figure, LIGHT, &view])
    }

    /// Mean difference of the two methods over what the figure covers, more than `REACH` pixels from its edges; how many.
    fn difference(&self, gel: &str, opacity: f64) -> (f64, usize) {
        const REACH: usize = 4;
        let edges = self.seen(&nothing(), 1.0, "");
        let (hybrid, scanned) = (self.seen(gel, opacity, ""), self.seen(gel, opacity, VOXELIZE));
        let (mut sum, mut count) = (0.0, 0);
        for [x, y] in pixels(&edges) {
            let here = edges.pixel(x, y);
            if here[3] < 0.999
                || near(&edges, [x, y], REACH, |other| difference(other, here) > 0.15)
            {
                continue;
            }
            let (a, b) = (hybrid.pixel(x, y), scanned.pixel(x, y));
            sum += a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / 4.0;
            count += 1;
        }
        (sum / count as f64, count)
    }
}

#[test]
fn hybrid_and_scan_converted_pictures_agree_away_from_edges() {
    let gels = [
        ("nothing", nothing()),
        (
            "gel",
            gel(
                "ramp",
                [0.02, 0.02],
                "material = { color = \"#40a080\", ambient = 1, diffuse = 0 }",
            ),
        ),
    ];
    println!("figure          in       opacity  mean difference  pixels");
    for (place, gel) in &gels {
        for figure in &FIGURES {
            for opacity in [1.0, 0.5] {
                let (mean, count) = figure.difference(gel, opacity);
                println!("{:<15} {place:<8} {opacity:<8} {mean:<16.4} {count}", figure.name);
                assert!(count > 100, "{}: {count} pixels", figure.name);
                // Aslant, gel is denser, "as the paper welcomes": by (1 - α)^(1/cos) at most, of a mean over channels.
                let most = if opacity == 1.0 || figure.facing { 0.02 } else { 0.08 };
                assert!(mean <= most, "{} {opacity} in {place}: {mean}", figure.name);
            }
        }
    }
}

/// Where the edge of [`EDGE`] is at height z.
fn edge_at(z: f64) -> f64 {
    5.0 + z / 10.0
}

/// An edge that runs aslant over voxels and pixels.
const EDGE: [[f64; 3]; 4] =
    [[-40.0, 0.3, -40.0], [1.0, 0.3, -40.0], [9.0, 0.3, 40.0], [-40.0, 0.3, 40.0]];

/// The distance, in pixels, over which opacity rises from 10 to 90 %: from the mean of all pixels as far from the edge.
fn edge_width(world: &hecs::World) -> f64 {
    const BINS: usize = 200;
    let (picture, camera) = (frame(world), camera(world));
    // A tenth of a pixel each.
    let mut bins = [(0.0, 0.0); BINS];
    for [x, y] in pixels(&picture) {
        let point = camera.origin(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
        let bin = (edge_at(point.z) - point.x) / camera.pixel * 10.0 + BINS as f64 / 2.0;
        if let Some((sum, count)) = bins.get_mut(bin as usize).filter(|_| bin >= 0.0) {
            *sum += f64::from(picture.pixel(x, y)[3]);
            *count += 1.0;
        }
    }
    let profile = bins.map(|(sum, count)| sum / f64::max(count, 1.0));
    let crossing = |part: f64| {
        let level = part * profile[BINS - 1];
        let bin = (1..BINS).find(|&bin| profile[bin] >= level && profile[bin - 1] < level).unwrap();
        bin as f64 + (level - profile[bin]) / (profile[bin] - profile[bin - 1])
    };
    (crossing(0.9) - crossing(0.1)) / 10.0
}

#[test]
fn edges_of_hybrid_polygons_are_sharper_and_as_sharp_however_near_they_are_seen() {
    println!("pixels a voxel  opacity  10-90 % width in pixels: hybrid, scan-converted");
    for (height, opacity) in [(48.0, 1.0), (24.0, 1.0), (12.0, 1.0), (48.0, 0.5), (12.0, 0.5)] {
        let width = |keys: &str| {
            let keys = format!("surface = {{ opacity = {opacity} }}\n{keys}");
            let polygon = polygon("edge", &EDGE, &keys);
            let view = view(0.0, 0.0, 48, height, "distance_mm = 0.5");
            edge_width(&made(&[&nothing(), &polygon, LIGHT, &view]))
        };
        let (hybrid, scanned) = (width(""), width(VOXELIZE));
        println!("{:<15} {opacity:<8} {hybrid:.3}  {scanned:.3}", 48.0 / height);
        assert!(hybrid < 1.0, "{hybrid}");
        // A ball of one voxel's radius blurs by about a voxel, which more pixels show the better.
        assert!(scanned > 0.9 * 48.0 / height && scanned > 1.2 * hybrid, "{hybrid} {scanned}");
    }
}
