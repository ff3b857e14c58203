//! gelray beside VolPack and VTK on the very same voxels, interleaved view by view: times, their ratios, and errors.
//!
//! CT head of 256 × 256 × 113 voxels (where `GELRAY_DATA` is set, else the phantom), 380 × 380 pixels, parallel, 256 mm
//! across the frame, 36 views by 10° at an elevation of 15°, one thread each, one sample per millimetre. Two tasks: the
//! voxels painted once, by this program, and given to each renderer; and the scalars themselves under a light at the
//! observer with highlights, so that every view is shaded anew. Best of three per view; ratios are medians over views of
//! one view's ratios; errors are of the luminance over every sixth view against gelray, exact at a quarter of the
//! distance between samples, after each picture was moved to where it fits best. `--quick` takes fewer views, and `--csv DIR`
//! writes a file for each task that `gelray trade --points` draws beside our own choices.

mod errors;
#[path = "../limit.rs"]
mod limit;
mod ours;
mod program;
#[allow(dead_code, reason = "other benches print spreads of seconds")]
#[path = "../timed.rs"]
mod timed;
mod voxels;

use std::path::Path;

use errors::{Grey, Registered};
use gelray::components::{Sampling, TexelKind};
use gelray::volume::grid::{Grid, Scalars};
use ours::Ours;
use program::{Program, Told};
use timed::{Spread, is_quick};
use voxels::Voxels;

const ELEVATION: f64 = 15.0;
const WIDTH: usize = 380;

const VIEW: &str = r#"
[[entity]]
name = "observer"
view = { elevation = 15, focal_point = [0, 0, 0], height_mm = 256, size = [380, 380] }
sampling = { distance_mm = 1.0 }
"#;

const PAINTED: &str = r#"
[[entity]]
name = "head"
volume = { file = "painted.nrrd", center = [0, 0, 0] }
"#;

const FULL: &str = r#"
[[entity]]
name = "head"
volume = { file = "cthead.nrrd", stand_in = "phantom:head", spacing_mm = [1, 1, -2], center = [0, 0, 0] }
classify = { transfer = [{ value = 1324, opacity = 0 }, { value = 1724, opacity = 1 }] }
material = { color = [1, 0.93, 0.80], ambient = 0.25, diffuse = 0.7, specular = 0.2, shininess = 20 }

[[entity]]
name = "head light"
light = { toward = "observer", strength = 1 }
"#;

/// Who makes the frames of a row.
enum Maker {
    Ours(Box<Ours>),
    Peer(Program),
}

/// A renderer in one way of rendering, and what was measured of it view by view.
struct Row {
    name: &'static str,
    maker: Maker,
    milliseconds: Vec<f64>,
    /// Casting and resampling alone; of gelray.
    rays: Vec<f64>,
    samples: Vec<f64>,
    errors: Vec<Registered>,
}

impl Row {
    fn new(name: &'static str, maker: Maker) -> Self {
        let (milliseconds, rays, samples, errors) = Default::default();
        Self { name, maker, milliseconds, rays, samples, errors }
    }

    /// The best of some frames of a view, and its error where a reference is given.
    fn view(&mut self, azimuth: f64, reference: Option<&Grey>) {
        let (mut best, mut rays, mut picture) = (f64::INFINITY, f64::INFINITY, None);
        for left in (0..if is_quick() { 2 } else { 3 }).rev() {
            // A view a hair off is another view: nothing that was made for the last serves it.
            let azimuth = azimuth + 1e-3 * f64::from(left);
            let (took, made) = match &mut self.maker {
                Maker::Peer(program) => program.frame(azimuth).expect("a peer answers"),
                Maker::Ours(ours) => {
                    let framed = ours.frame(azimuth, 1);
                    rays = rays.min(framed.milliseconds[1]);
                    self.samples.push(framed.counts.samples as f64);
                    (framed.milliseconds[0], framed.picture)
                }
            };
            best = best.min(took);
            picture = Some(made);
        }
        self.milliseconds.push(best);
        self.rays.push(rays);
        self.errors.extend(reference.zip(picture).map(|(exact, made)| made.registered(exact)));
    }

    /// The median of the ratios to another row's frames of the same views.
    fn ratio(&self, other: &Self) -> f64 {
        let pairs = self.milliseconds.iter().zip(&other.milliseconds);
        Spread::of(&pairs.map(|(a, b)| a / b).collect::<Vec<_>>()).median
    }

    /// What `gelray trade --points` reads: a name, milliseconds a frame and decibels, medians over views.
    fn point(&self) -> String {
        let decibels: Vec<f64> = self.errors.iter().map(|error| error.decibels).collect();
        let [time, decibels] = [&self.milliseconds, &decibels].map(|of| Spread::of(of).median);
        format!("\"{}\",{time},{decibels}\n", self.name)
    }

    fn print(&self, others: &[&Self]) {
        let of = |values: Vec<f64>| Spread::of(&values);
        let time = of(self.milliseconds.clone());
        let decibels = of(self.errors.iter().map(|error| error.decibels).collect());
        let shift = [0, 1].map(|axis| of(self.errors.iter().map(|e| e.shift[axis]).collect()));
        print!("{:32} {:>8.2} [{:.2}–{:.2}]", self.name, time.median, time.least, time.most);
        for other in others {
            print!("  {:>7.3}", self.ratio(other));
        }
        print!("  {:>5.1} [{:.1}–{:.1}]", decibels.median, decibels.least, decibels.most);
        println!("  {:>5.2} {:>5.2}", shift[0].median, shift[1].median);
    }
}

/// Renders all views in all ways, one view after the other in turn; the first row is the way that all are measured by.
fn race(title: &str, scene: &str, rows: &mut [Row], folder: &Path) {
    let mut reference = Ours::open(scene, folder, |sampling| {
        // Empty gel is stepped over, which changes no bit.
        *sampling = Sampling { skip: sampling.skip, ..sampling.exact() };
        sampling.distance_mm = Some(0.25);
    });
    for view in (0..36).step_by(if is_quick() { 12 } else { 1 }) {
        let azimuth = f64::from(view) * 10.0;
        let exact = (view % 6 == 0).then(|| reference.frame(azimuth, 2).picture);
        for row in rows.iter_mut() {
            row.view(azimuth, exact.as_ref());
        }
    }
    let peers: Vec<&Row> = rows.iter().filter(|row| matches!(row.maker, Maker::Peer(_))).collect();
    println!("\n{title}\n{:32} {:>22}", "", "ms a frame [min–max]");
    for peer in &peers {
        println!("{:>57} ÷ {}", "ratio", peer.name);
    }
    println!("{:>57} dB after registration [min–max], shift in pixels", "then");
    for row in rows.iter() {
        row.print(&peers);
    }
}

/// Writes the points of a task to the folder that `--csv` names, if it does.
fn keep_points(task: &str, rows: &[Row]) {
    let Some(folder) = std::env::args().skip_while(|word| word != "--csv").nth(1) else { return };
    let path = Path::new(&folder).join(format!("{task}.csv"));
    let points: String = rows.iter().map(Row::point).collect();
    std::fs::write(&path, format!("name,milliseconds,psnr_db\n{points}"))
        .expect("the folder of --csv takes a file");
    println!("points for `gelray trade --points`: {}", path.display());
}

fn every(positions: u32) -> impl Fn(&mut Sampling) {
    move |sampling| (sampling.coarsest, sampling.finest) = (positions, positions)
}

fn per_voxel(rays: f64) -> impl Fn(&mut Sampling) {
    move |sampling| sampling.per_voxel = rays
}

/// What gelray needs at the least: its samples at a ray a pixel, times what one takes.
fn against_the_limit(rows: &[Row]) {
    let [float, sixteen, eight] = limit::per_sample();
    println!(
        "\nthe sampling limit of this machine ({}): {float:.2} ns a sample of 32-bit floats, {sixteen:.2} of 16 bits, {eight:.2} of 8",
        limit::instructions()
    );
    for row in rows.iter().filter(|row| !row.samples.is_empty()) {
        let (samples, rays) = (Spread::of(&row.samples).median, Spread::of(&row.rays).median);
        let least = samples * sixteen * 1e-6;
        println!(
            "{:32} {:.3} M samples, {least:.2} ms at the limit; rays take {rays:.2} ms, {:.1} times that",
            row.name,
            samples * 1e-6,
            rays / least
        );
    }
}

fn ours(name: &'static str, scene: &str, folder: &Path, change: impl Fn(&mut Sampling)) -> Row {
    Row::new(name, Maker::Ours(Box::new(Ours::open(scene, folder, change))))
}

/// The row of a peer, or a line that says how it is installed.
fn peer(name: &'static str, started: Result<Program, String>) -> Option<Row> {
    let said = started.map_err(|missing| println!("{name} is left out: {missing}"));
    said.ok().map(|program| Row::new(name, Maker::Peer(program)))
}

fn main() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let folder = folder.path();
    let full = format!("{FULL}{VIEW}");
    let source = gelray::scene::Source::inline("task", full.as_str());
    let mut head = timed::Setting::open(&source).expect("the task is a scene");
    let (scalars, size) = {
        let mut volumes = head.world.query_mut::<(&Scalars, &Grid)>().into_iter();
        let (scalars, grid) = volumes.next().expect("the task has a volume");
        (scalars.clone(), grid.size)
    };
    let voxels = Voxels::new(&scalars, size, 2.0);
    voxels.write(folder).expect("the temporary folder takes the voxels");
    let told =
        |voxels| Told { folder, voxels, size, z_spacing: 2.0, width: WIDTH, elevation: ELEVATION };
    let painted = format!("{PAINTED}{VIEW}");
    let mut rows = vec![
        ours("gelray, a ray a pixel", &painted, folder, every(4)),
        ours("gelray, every second pixel", &painted, folder, every(8)),
        ours("gelray, adaptive", &painted, folder, |_| ()),
        ours("gelray, four rays a voxel", &painted, folder, per_voxel(4.0)),
        ours("gelray, three rays a voxel", &painted, folder, per_voxel(3.0)),
        ours("gelray, two rays a voxel", &painted, folder, per_voxel(2.0)),
        ours("gelray, a ray a voxel", &painted, folder, per_voxel(1.0)),
        ours("gelray, a ray for two voxels", &painted, folder, per_voxel(0.5)),
        ours("gelray, the same in 8 bits", &painted, folder, |sampling| {
            (sampling.texel, sampling.stop_at) = (TexelKind::U8, 0.05);
            per_voxel(0.5)(sampling);
        }),
    ];
    rows.extend(peer("VolPack", told("pairs.raw").volpack()));
    rows.extend(peer("VTK", told("pairs.raw").vtk("painted", 1.0)));
    rows.extend(peer("VTK, every second pixel", told("pairs.raw").vtk("painted", 2.0)));
    race("the same voxels, painted once", &painted, &mut rows, folder);
    keep_points("painted", &rows);
    against_the_limit(&rows);
    let first = ours("gelray, a ray a pixel", &full, folder, every(4));
    if let Maker::Ours(ours) = &first.maker {
        ours.warnings().iter().for_each(|warning| println!("{warning}"));
    }
    let mut rows = vec![first, ours("gelray, adaptive", &full, folder, |_| ())];
    rows.push(ours("gelray, two rays a voxel", &full, folder, per_voxel(2.0)));
    rows.push(ours("gelray, a ray a voxel", &full, folder, per_voxel(1.0)));
    rows.extend(peer("VTK", told("scalars.raw").vtk("scalars", 1.0)));
    race("the whole task: shaded anew for every view", &full, &mut rows, folder);
    keep_points("scalars", &rows);
    for row in rows.iter().filter(|row| !row.samples.is_empty()) {
        println!("{:32} of which rays {:.2} ms", row.name, Spread::of(&row.rays).median);
    }
}
