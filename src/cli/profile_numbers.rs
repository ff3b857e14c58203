//! The paper's numbers beside ours, where a scene has what they are of: its variants, frame by frame in turn.

use gelray::Renderer;
use gelray::components::{Sampling, View};
use gelray::measure::cost::{COLORS, Claim, FRAME, PAPER_NUMBERS, PaperNumber};
use gelray::measure::median::median;
use gelray::measure::paired::{Ratio, ratio_of_pairs};
use gelray::measure::spans::{seconds_of, spanned};
use gelray::measure::variants;
use gelray::volume::scene_volumes::visible;
use hecs::World;

use super::failure::Failure;
use super::profile_run::Subject;
use super::profile_saved::{Number, Profile};
use super::steps::Steps;

/// What a ratio is of.
type Change = fn(&mut World);

/// The most pixels along a side of a picture that brute force casts: its rays are sixteen a pixel, and each goes all the way.
const BRUTE_SIDE: u32 = 400;

/// Adds the paper's numbers of some keys to a profile, each as soon as it is known, but for those that it has; `repeat` frames
/// of each of two variants. What a scene cannot tell says why.
pub fn add_numbers(
    subject: &Subject,
    profile: &mut Profile,
    (keys, repeat): (&[&str], usize),
    steps: &Steps,
) -> Result<(), Failure> {
    for paper in PAPER_NUMBERS.iter().filter(|paper| keys.contains(&paper.key)) {
        if profile.numbers.iter().all(|known| known.key != paper.key) {
            steps.begin(paper.what);
            let found = number(paper, subject, profile, repeat)?;
            profile.numbers.push(found);
        }
        steps.done();
    }
    Ok(())
}

/// The keys of all of them, each a step.
pub fn keys() -> Vec<&'static str> {
    PAPER_NUMBERS.iter().map(|number| number.key).collect()
}

fn number(
    paper: &PaperNumber,
    subject: &Subject,
    profile: &Profile,
    repeat: usize,
) -> Result<Number, Failure> {
    let nothing: Change = |_| ();
    let frames = |changes: [Change; 2]| frames(subject, changes, repeat);
    let bytes = |name: &str| profile.stages.iter().find(|s| s.name == name).map_or(0, |s| s.bytes);
    let world = subject.load()?.world;
    let (solid, polygons) = (!visible(&world).is_empty(), variants::has_polygons(&world));
    let needs = |has: bool, what: &str| if has { Ok(()) } else { Err(what.to_owned()) };
    let mixed = needs(solid && polygons, "needs a volume and polygons");
    let found = match paper.key {
        "hybrid" => mixed.map(|()| frames([variants::take_polygons, variants::trace_polygons])),
        "scan_converted" => {
            mixed.map(|()| frames([variants::take_polygons, variants::scan_convert_polygons]))
        }
        "shadows" => needs(variants::has_shadows(&world), "needs a light that casts shadows")
            .map(|()| colors(subject, [variants::take_shadows, nothing], repeat)),
        "textures" => needs(variants::has_textures(&world), "needs textured polygons")
            .map(|()| frames([variants::take_textures, nothing])),
        "brute_force" => needs(solid, "needs a volume").map(|()| brute_force(subject)),
        "rays_per_pixel" => {
            let cast = profile.stages.iter().find(|stage| stage.name == "cast");
            let rays = cast.and_then(|cast| cast.counts.get("rays")).copied().unwrap_or(0);
            let pixels: usize = profile.size.iter().product();
            Ok(Ok(exactly(rays as f64 / pixels as f64)))
        }
        _ => Ok(Ok(exactly((bytes("relight") + bytes("pyramid")) as f64 / 1e6))),
    };
    Ok(match found {
        Ok(ratio) => told(paper, ratio?),
        Err(why) => Number { note: why, ..told(paper, exactly(f64::NAN)) },
    })
}

/// A number that no noise is in, or whose noise nobody knows.
fn exactly(ratio: f64) -> Ratio {
    Ratio { ratio, low: f64::NEG_INFINITY, high: f64::INFINITY }
}

fn told(paper: &PaperNumber, Ratio { ratio, low, high }: Ratio) -> Number {
    let claim = match paper.claim {
        Claim::About => "about",
        Claim::Below => "less than",
        Claim::Above => "more than",
    };
    Number {
        key: paper.key.to_owned(),
        what: paper.what.to_owned(),
        paper: format!("{claim} {} {}", paper.number, paper.unit).trim_end().to_owned(),
        ours: ratio.is_finite().then_some(ratio),
        within: (low > 0.0 && high.is_finite()).then_some([low, high]),
        note: paper.unit.to_owned(),
    }
}

/// A variant of the scene whose preparation is done: from here on a turn casts rays.
struct Prepared {
    world: World,
    renderer: Renderer,
}

impl Prepared {
    fn new(subject: &Subject, change: impl FnOnce(&mut World)) -> Result<Self, Failure> {
        let mut prepared = Self { world: subject.load()?.world, renderer: subject.renderer()? };
        change(&mut prepared.world);
        Ok(prepared)
    }

    /// Seconds of some systems in the next picture, turned by so many degrees.
    fn seconds(&mut self, degrees: f64, systems: &[&str]) -> Result<f64, Failure> {
        for view in self.world.query_mut::<&mut View>() {
            view.azimuth += degrees;
        }
        let (made, rows) = spanned(|| self.renderer.render(&mut self.world));
        made?;
        Ok(seconds_of(&rows, systems))
    }
}

/// Frames of a turn by the second of two variants to those by the first.
fn frames(subject: &Subject, changes: [Change; 2], repeat: usize) -> Result<Ratio, Failure> {
    let [mut first, mut second] =
        [Prepared::new(subject, changes[0])?, Prepared::new(subject, changes[1])?];
    first.seconds(0.0, &FRAME)?;
    second.seconds(0.0, &FRAME)?;
    let degrees = 360.0 / repeat.max(1) as f64;
    let pair = |_| Ok([first.seconds(degrees, &FRAME)?, second.seconds(degrees, &FRAME)?]);
    ratio(&(0..repeat).map(pair).collect::<Result<Vec<_>, Failure>>()?)
}

/// Total voxel colors by the second of two variants to those by the first, of scenes read anew.
fn colors(subject: &Subject, changes: [Change; 2], repeat: usize) -> Result<Ratio, Failure> {
    let anew = |change: Change| Prepared::new(subject, change)?.seconds(0.0, &COLORS);
    let pair = |_| Ok([anew(changes[0])?, anew(changes[1])?]);
    ratio(&(0..repeat).map(pair).collect::<Result<Vec<_>, Failure>>()?)
}

/// One frame by brute force to the median of three as stated; so long a one needs no repetition.
fn brute_force(subject: &Subject) -> Result<Ratio, Failure> {
    let small = |world: &mut World| {
        for view in world.query_mut::<&mut View>() {
            view.size = view.size.map(|n| n.min(BRUTE_SIDE));
        }
    };
    let mut stated = Prepared::new(subject, small)?;
    let mut brute = Prepared::new(subject, |world| {
        small(world);
        for sampling in world.query_mut::<&mut Sampling>() {
            *sampling = variants::brute_force(sampling);
        }
    })?;
    stated.seconds(0.0, &FRAME)?;
    let turned = (0..3).map(|_| stated.seconds(1e-6, &FRAME)).collect::<Result<Vec<_>, _>>()?;
    Ok(exactly(brute.seconds(0.0, &FRAME)? / median(&turned)))
}

fn ratio(pairs: &[[f64; 2]]) -> Result<Ratio, Failure> {
    ratio_of_pairs(pairs)
        .ok_or_else(|| Failure::Said("a frame took no time that can be measured".to_owned()))
}
