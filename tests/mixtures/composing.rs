//! Everything in one scene: shadows, a cut, polygons of both methods, textures, two contours and a shaft of light.

use gelray::components::View;
use gelray::view::picture::Picture;

use crate::{entity, frame, rendered, run, stated, view};

/// A scene in lines of TOML; an empty line is an effect left out.
#[derive(Clone)]
pub struct Mixture {
    pub clip: &'static str,
    pub shadow: &'static str,
    pub shaft: &'static str,
    pub texture: &'static str,
    pub method: &'static str,
    pub toward: [f64; 3],
    pub sampling: String,
}

/// The corners of what is cut out.
pub const CUT: [[f64; 3]; 2] = [[0.0, -40.0, 0.0], [40.0, 3.0, 40.0]];
/// The polygon that carries the texture, and the one that is scan-converted.
pub const TEXTURED: [[f64; 3]; 4] =
    [[-28.0, -6.0, 27.0], [27.0, -2.0, 27.0], [27.0, -2.0, -20.0], [-28.0, -6.0, -20.0]];
pub const SCANNED: [[f64; 3]; 4] =
    [[-20.0, -29.0, -12.3], [20.0, -29.0, -8.0], [20.0, 24.0, -8.0], [-20.0, 24.0, -12.3]];

impl Mixture {
    pub fn whole() -> Self {
        Self {
            clip: "clip = { box = [[0, -40, 0], [40, 3, 40]] }",
            shadow: "casts_shadow = {}",
            shaft: "shaft = { opacity = 0.01 }",
            texture: "textured = { texture = \"grid\", repeats = [2, 2] }",
            method: "voxelize = { matte = \"over\" }",
            toward: [0.4, -0.5, 0.8],
            sampling: String::new(),
        }
    }

    /// The scene, each entity's TOML.
    pub fn parts(&self, [azimuth, elevation]: [f64; 2]) -> Vec<String> {
        let Self { clip, shadow, shaft, texture, method, toward, sampling } = self;
        let volume = format!(
            "[[entity]]\nname = \"gel\"\nvolume = {{ file = \"phantom:ball\" }}\nclassify = {{ iso = [\
             {{ value = 0.5, opacity = 0.7, form = \"around\" }}, \
             {{ value = 0.1, opacity = 0.15, form = \"around\", color = \"#80b0ff\" }}] }}\n{clip}\n"
        );
        let textured = crate::polygon(
            "textured",
            &TEXTURED,
            &format!("surface = {{ color = \"#ffe0a0\", opacity = 0.6 }}\n{texture}"),
        );
        let scanned = crate::polygon(
            "scanned",
            &SCANNED,
            &format!("surface = {{ color = \"#40c060\", opacity = 0.5 }}\n{method}"),
        );
        let key = format!(
            "[[entity]]\nname = \"key\"\nlight = {{ toward = {toward:?}, strength = 0.8 }}\n{shadow}\n{shaft}\n\
             projects = {{ texture = \"disc\", size_mm = [72, 72], wrap = \"vanish\" }}\n"
        );
        let fill =
            "[[entity]]\nname = \"fill\"\nlight = { toward = [-0.6, -0.8, 0.1], strength = 0.3 }\n"
                .to_owned();
        vec![volume, textured, scanned, key, fill, view(azimuth, elevation, 96, 96.0, sampling)]
    }

    pub fn rendered(&self, from: [f64; 2]) -> Picture {
        rendered(&self.parts(from).iter().map(String::as_str).collect::<Vec<_>>())
    }
}

const VIEWS: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [35.0, 20.0],
    [90.0, -15.0],
    [140.0, 50.0],
    [180.0, 0.0],
    [222.0, -60.0],
    [270.0, 10.0],
    [300.0, 90.0],
];

/// The pictures from every view, of one world that is turned.
fn turned(mixture: &Mixture, threads: usize) -> [Picture; 8] {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let parts = mixture.parts(VIEWS[0]);
        let mut world = stated(&parts.iter().map(String::as_str).collect::<Vec<_>>(), &[]);
        let observer = entity(&world, "observer");
        VIEWS.map(|[azimuth, elevation]| {
            let view =
                View { azimuth, elevation, ..(*world.get::<&View>(observer).unwrap()).clone() };
            world.insert_one(observer, view).unwrap();
            run(&mut world);
            frame(&world)
        })
    })
}

#[test]
fn a_scene_of_everything_is_finite_and_in_range_from_everywhere() {
    for (picture, view) in turned(&Mixture::whole(), 2).iter().zip(VIEWS) {
        for pixel in picture.pixels.iter() {
            let [r, g, b, alpha] = *pixel;
            assert!((0.0..=1.0).contains(&alpha), "{view:?} {pixel:?}");
            // Two lights of 0.8 and 0.3 fall together on what reflects 0.8 of them, and 0.3 is ambient.
            let bright = |c: &f32| (0.0..=1.2 * alpha + 1e-6).contains(c);
            assert!([r, g, b].iter().all(bright), "{view:?} {pixel:?}");
        }
        let covered = picture.pixels.iter().filter(|pixel| pixel[3] > 0.05).count();
        assert!(covered > 1500, "{view:?}: {covered}");
    }
}

#[test]
fn a_scene_of_everything_is_the_same_bytes_on_any_threads_and_with_or_without_the_pyramid() {
    // Dust is everywhere and nothing may be stepped over; without it, the pyramid does its work.
    for shaft in [Mixture::whole().shaft, ""] {
        let bits = |threads: usize, skip: &str| -> Vec<[u32; 4]> {
            let sampling = format!("skip = \"{skip}\"");
            let pictures = turned(&Mixture { shaft, sampling, ..Mixture::whole() }, threads);
            pictures.iter().flat_map(|p| p.pixels.to_vec()).map(|p| p.map(f32::to_bits)).collect()
        };
        let known = bits(1, "pyramid");
        for (threads, skip) in [(2, "pyramid"), (1, "none"), (2, "none")] {
            assert!(bits(threads, skip) == known, "{shaft}: {threads} threads, skip = {skip}");
        }
    }
}
