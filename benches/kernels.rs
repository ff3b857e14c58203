//! What the kernels cost: a sample of gel, a thickened slab, a leap, a polygon met, and each stage of preparation; and
//! the sampling limit of this machine, that casters are measured by.

mod limit;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use gelray::components::{TexelKind, View};
use gelray::scene::{Source, load};
use gelray::schedule::{Made, Product, Schedule, Watch};
use gelray::systems::JOBS;
use gelray::view::composite::thicken;
use gelray::volume::gel::{CELLS, GelBricks};
use gelray::volume::layer::Opacity;
use gelray::volume::pyramid::Pyramid;
use gelray::volume::ranges::Ranges;
use gelray::with_texels;
use glam::{Vec3, Vec4};
use hecs::{Entity, World};

fn main() {
    let [float, sixteen, eight] = limit::per_sample();
    let with = limit::instructions();
    println!(
        "sampling limit ({with}): {float:.2} ns a sample of 32-bit floats, {sixteen:.2} of 16 bits, {eight:.2} of 8"
    );
    divan::main();
}

const TEXELS: [TexelKind; 3] = [TexelKind::F32, TexelKind::U16, TexelKind::U8];

/// 4096 samples of a brick that the cache holds, as far apart as a ray's.
#[divan::bench(args = TEXELS)]
fn sample(bencher: Bencher, kind: TexelKind) {
    let value = |n: usize| (n * 7919 % 101) as f32 / 101.0;
    let fill = |[x, y, z]: [usize; 3], row: &mut [Vec4]| {
        for (i, texel) in row.iter_mut().enumerate() {
            *texel = Vec4::splat(value(x + i + 9 * y + 81 * z));
        }
    };
    let gel = GelBricks::make(kind, [9; 3], |_| true, &fill);
    let places: Vec<_> = (0..4096)
        .map(|i| ([i % CELLS, i / 3 % CELLS, i / 7 % CELLS], Vec3::new(value(i), 0.3, 0.6)))
        .collect();
    bencher.counter(ItemsCount::new(places.len())).bench(|| {
        with_texels!(black_box(&gel), texels => {
            let sampled = places.iter().map(|(cell, at)| texels.slices().sample(0, *cell, *at));
            sampled.fold(Vec4::ZERO, |sum, sample| sum + sample)
        })
    });
}

/// 4096 slabs cut at `ratio` of their thickness.
#[divan::bench(args = [0.5, 0.3, 2.0])]
fn thickened(bencher: Bencher, ratio: f64) {
    let opacities: Vec<_> = (0..4096).map(|i| f64::from(i) / 4096.0).collect();
    bencher.counter(ItemsCount::new(opacities.len())).bench(|| {
        let slabs = opacities.iter().map(|opacity| thicken(*opacity, black_box(ratio)));
        slabs.sum::<f64>()
    });
}

/// A world with every product made, and a schedule of one stage alone.
struct Stage {
    world: World,
    schedule: Schedule,
}

impl Stage {
    fn new(scene: &str, stage: &str) -> Self {
        let mut world = load(&Source::inline("bench", scene), &[], &[], false).unwrap().world;
        Schedule::new(JOBS).unwrap().run(&mut world, &Watch::default()).unwrap();
        let jobs: Vec<_> = JOBS.iter().filter(|job| job.name == stage).copied().collect();
        Self { world, schedule: Schedule::new(&jobs).unwrap() }
    }

    /// Takes the stage's product off and makes it again.
    fn again<P: Product>(&mut self) {
        let carriers: Vec<_> = self.world.query_mut::<Entity>().with::<&P>().into_iter().collect();
        for entity in carriers {
            self.world.remove::<(P, Made<P>)>(entity).unwrap();
        }
        let ran = self.schedule.run(&mut self.world, &Watch::default()).unwrap();
        assert!(ran[0].made > 0);
    }
}

/// A ball in a volume of 64³ voxels, seen from close by.
const BALL: &str = r#"
[[entity]]
volume = { file = "phantom:ball" }

[[entity]]
name = "observer"
view = { azimuth = 30, elevation = 20, size = [64, 64] }
sampling = { coarsest = 4, finest = 4 }
"#;

/// A polygon that is scan-converted into it.
const SQUARE: &str = r"
[[entity]]
polygon = { vertices = [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]] }
voxelize = {}
";

fn stage<P: Product>(bencher: Bencher, stage: &str) {
    stage_of::<P>(bencher, BALL, stage);
}

fn stage_of<P: Product>(bencher: Bencher, scene: &str, stage: &str) {
    let mut stage = Stage::new(scene, stage);
    bencher.counter(ItemsCount::new(64_usize.pow(3))).bench_local(|| stage.again::<P>());
}

#[divan::bench]
fn ranges(bencher: Bencher) {
    stage::<Ranges>(bencher, "ranges");
}

#[divan::bench]
fn classify(bencher: Bencher) {
    stage::<Opacity>(bencher, "classify");
}

/// Voxels are matted with a polygon's on the way.
#[divan::bench]
fn relight_matted(bencher: Bencher) {
    stage_of::<gelray::volume::gel::Gel>(bencher, &format!("{BALL}{SQUARE}"), "relight");
}

#[divan::bench]
fn relight(bencher: Bencher) {
    stage::<gelray::volume::gel::Gel>(bencher, "relight");
}

#[divan::bench]
fn pyramid(bencher: Bencher) {
    stage::<Pyramid>(bencher, "pyramid");
}

/// Rays of 64 × 64 pixels through a thin, faint shell: leaps over what it encloses, or every sample of it.
#[divan::bench(args = ["pyramid", "none"])]
fn hollow(bencher: Bencher, skip: &str) {
    let volume = "volume = { file = \"phantom:ball\" }";
    let shell = "classify = { iso = [{ value = 0.4, opacity = 0.01, thickness_voxels = 0.5, form = \"around\" }] }";
    let scene = BALL
        .replace(volume, &format!("{volume}\n{shell}"))
        .replace("finest = 4", &format!("finest = 4, skip = \"{skip}\""));
    rays(bencher, &scene);
}

/// Rays of 64 × 64 pixels through sixteen faint polygons without a volume.
#[divan::bench]
fn polygons_met(bencher: Bencher) {
    let polygon = |n: i32| {
        let y = f64::from(n) * 0.5;
        format!(
            "[[entity]]\npolygon = {{ vertices = [[-9, {y}, -9], [9, {y}, -9], [9, {y}, 9], [-9, {y}, 9]] }}\nsurface = {{ opacity = 0.1 }}\n"
        )
    };
    let polygons: String = (0..16).map(polygon).collect();
    let view = "[[entity]]\nname = \"observer\"\nview = { azimuth = 20, size = [64, 64], height_mm = 16 }\n";
    rays(bencher, &format!("{polygons}{view}sampling = {{ coarsest = 4, finest = 4 }}\n"));
}

/// Casts the rays of a scene again and again, each time from a view a hair off the last.
fn rays(bencher: Bencher, scene: &str) {
    let mut stage = Stage::new(scene, "cast");
    bencher.counter(ItemsCount::new(64_usize * 64)).bench_local(|| {
        stage.world.query_mut::<&mut View>().into_iter().for_each(|view| view.azimuth += 1e-6);
        stage.schedule.run(&mut stage.world, &Watch::default()).unwrap();
    });
}
