//! The task that other renderers were timed with, beside their numbers: what a frame takes and how true it is.
//!
//! CT head of 256 × 256 × 113 voxels (where `GELRAY_DATA` is set, else the phantom), 380 × 380 pixels, parallel, 256 mm
//! across the frame, 36 views by 10° at an elevation of 15°; opacity 0 at value 1324 rising to 1 at 1724; bone colour,
//! a head light, one sample per millimetre. Best of five per view, then median [least–most] over the views.
//!
//! A head light turns with the view, so every frame shades its voxels anew: `frame` is all that a view's picture takes,
//! `rays` is casting and resampling alone. `--quick` takes fewer views and repetitions.

mod timed;

use gelray::components::{Sampling, TexelKind};
use gelray::measure::cost::FRAME;
use gelray::measure::error::compare;
use gelray::scene::Source;
use gelray::view::picture::Frame;
use gelray::view::picture::Picture;
use timed::{Setting, Spread, is_quick, on_threads};

const TASK: &str = r#"
[[entity]]
name = "head"
volume = { file = "cthead.nrrd", stand_in = "phantom:head", spacing_mm = [1, 1, -2], center = [0, 0, 0] }
classify = { transfer = [{ value = 1324, opacity = 0 }, { value = 1724, opacity = 1 }] }
material = { color = [1, 0.93, 0.80], ambient = 0.25, diffuse = 0.7, specular = 0.2, shininess = 20 }

[[entity]]
name = "head light"
light = { toward = "observer", strength = 1 }

[[entity]]
name = "observer"
view = { elevation = 15, focal_point = [0, 0, 0], height_mm = 256, size = [380, 380] }
sampling = { distance_mm = 1.0 }
"#;

/// What a peer took for the task, measured on 2026-11-22 on two cores of a shared Zen 4 server whose clock drifted by 1.4
/// between runs: ratios above that mean something, finer ones do not.
struct Peer {
    name: &'static str,
    /// Milliseconds a frame on one thread and on two; `None` where it was not measured or uses one alone.
    milliseconds: [Option<f64>; 2],
    megabytes: Option<f64>,
    quality: &'static str,
}

const fn peer(
    name: &'static str,
    milliseconds: [Option<f64>; 2],
    megabytes: Option<f64>,
    quality: &'static str,
) -> Peer {
    Peer { name, milliseconds, megabytes, quality }
}

#[rustfmt::skip]
static PEERS: [Peer; 9] = [
    peer("VTK 9.7.2, fixed-point CPU caster", [Some(116.0), Some(70.0)], Some(310.0), "reference-like"),
    peer("… every second pixel", [Some(30.0), Some(21.0)], Some(308.0), "33.6 dB against itself at every pixel"),
    peer("… half the sample distance", [Some(151.0), Some(80.0)], Some(311.0), ""),
    peer("VTK, GPU caster on software GL", [Some(1422.0), Some(730.0)], Some(299.0), "translucent polygons right"),
    peer("VolPack, shear-warp, classified", [Some(2.95), None], Some(62.0), "voxel resolution, warped up: soft"),
    peer("VolPack, octree, unclassified", [Some(6.7), None], Some(54.0), "classification changes at once"),
    peer("SPLASH-2 volrend, every pixel", [Some(48.0), Some(27.0)], Some(31.0), "grey"),
    peer("… adaptive", [Some(22.0), Some(12.0)], Some(32.0), "41 dB against itself at every pixel"),
    peer("yt, software volume renderer", [None, Some(6650.0)], Some(574.0), "no shading"),
];

/// Ways of casting, each by how it changes the settings of the task.
type Way = (&'static str, fn(&mut Sampling));

static WAYS: [Way; 4] = [
    ("gelray, a ray a pixel", |sampling| (sampling.coarsest, sampling.finest) = (4, 4)),
    ("gelray, adaptive", |_| ()),
    ("… 16-bit gel", |sampling| sampling.texel = TexelKind::U16),
    ("… 8-bit gel", |sampling| sampling.texel = TexelKind::U8),
];

fn main() {
    let first = open(|_| ());
    first.warnings.iter().for_each(|warning| println!("{warning}"));
    let views: Vec<f64> =
        (0..36).step_by(if is_quick() { 6 } else { 1 }).map(|n| f64::from(n) * 10.0).collect();
    let references = on_threads(2, || references(&views));
    println!(
        "{:34} {:>24} {:>24}  quality",
        "ms a frame, median [least–most]", "1 thread", "2 threads"
    );
    for way in &WAYS {
        let [one, two] = [1, 2].map(|threads| on_threads(threads, || timed(way, &views)));
        let quality = Spread::of(&quality(&two.pictures, &references));
        println!(
            "{:34} {:>24} {:>24}  {:.1} dB against exact, at least {:.1}",
            format!("{}, frame", way.0),
            one.frame.milliseconds(),
            two.frame.milliseconds(),
            quality.median,
            quality.least,
        );
        let rays = [one, two].map(|timed| timed.rays.milliseconds());
        println!("{:34} {:>24} {:>24}", "    rays", rays[0], rays[1]);
    }
    PEERS.iter().for_each(Peer::print);
}

impl Peer {
    fn print(&self) {
        let [one, two] =
            self.milliseconds.map(|ms| ms.map_or("–".to_owned(), |ms| ms.to_string()));
        let memory = self.megabytes.map_or_else(String::new, |mb| format!("{mb} MB; "));
        println!("{:34} {one:>24} {two:>24}  {memory}{}", self.name, self.quality);
    }
}

fn open(change: fn(&mut Sampling)) -> Setting {
    let mut setting = Setting::open(&Source::inline("task", TASK)).expect("the task is a scene");
    setting.sample(change);
    setting
}

/// The exact picture of each view: a ray at every position, never stopped. Empty gel is stepped over, which changes no bit.
fn references(views: &[f64]) -> Vec<Picture> {
    let mut setting = open(|sampling| {
        *sampling = Sampling { skip: sampling.skip, ..sampling.exact() };
    });
    let reference = |&azimuth: &f64| {
        setting.turn(azimuth);
        setting.run();
        picture(&mut setting)
    };
    views.iter().map(reference).collect()
}

/// The picture of the last run.
fn picture(setting: &mut Setting) -> Picture {
    let mut frames = setting.world.query_mut::<&Frame>().into_iter();
    frames.next().expect("a view has its frame").0.clone()
}

/// What the views took in one way, and their pictures.
struct Timed {
    frame: Spread,
    rays: Spread,
    pictures: Vec<Picture>,
}

fn timed(way: &Way, views: &[f64]) -> Timed {
    let mut setting = open(way.1);
    let (mut frames, mut rays, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    setting.run();
    for azimuth in views {
        let mut best = [f64::INFINITY; 2];
        for left in (0..if is_quick() { 2 } else { 5 }).rev() {
            // A view a hair off is another view, and its head light another light: shading and rays are made anew.
            setting.turn(azimuth + 1e-3 * f64::from(left));
            let (ran, seconds) = setting.run();
            let cast = ran.iter().filter(|ran| FRAME.contains(&ran.name)).map(|ran| ran.seconds);
            best = [best[0].min(seconds), best[1].min(cast.sum())];
        }
        frames.push(best[0]);
        rays.push(best[1]);
        pictures.push(picture(&mut setting));
    }
    Timed { frame: Spread::of(&frames), rays: Spread::of(&rays), pictures }
}

/// Peak signal-to-noise ratios of pictures against their references, decibels, in linear light.
fn quality(pictures: &[Picture], references: &[Picture]) -> Vec<f64> {
    let pairs = pictures.iter().zip(references);
    pairs.map(|(made, exact)| compare(made, exact).map_or(f64::NAN, |d| d.linear.psnr_db)).collect()
}
