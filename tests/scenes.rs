//! Every scene in `scenes/` is a test: it is read, rendered small, and looks as its golden picture.
//!
//! Stand-ins take the place of real data, so that the goldens are the same everywhere. `GELRAY_BLESS=1` writes them anew.

use std::fs;
use std::path::{Path, PathBuf};

use gelray::components::{Estimate, View};
use gelray::formats::pictures::encoded::to_bytes;
use gelray::formats::pictures::{read_picture, write_picture};
use gelray::scene::{EMBEDDED, Source, load};
use gelray::schedule::{Job, Schedule, Watch};
use gelray::systems::JOBS;
use gelray::view::picture::{Frame, Picture};
use hecs::{Entity, World};

/// The longest side of a golden, in pixels.
const LONGEST: u32 = 96;

/// What a channel may differ by, in codes of 255.
const TOLERANCE: u8 = 2;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The names of the files of one ending in a folder, without it, sorted.
fn names(of: &str, ending: &str) -> Vec<String> {
    let files = fs::read_dir(folder(of)).unwrap().map(|entry| entry.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|end| end == ending));
    let name = |path: PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    let mut names: Vec<_> = files.map(name).collect();
    names.sort();
    names
}

/// The world of a scene whose picture is at most `longest` pixels a side; the shape of the picture stays.
fn loaded(name: &str, most: u32) -> Result<World, gelray::Error> {
    let source = Source::read(folder("scenes").join(format!("{name}.toml")))?;
    let mut world = load(&source, &[], &[], false)?.world;
    for view in world.query_mut::<&mut View>() {
        let longest = view.size[0].max(view.size[1]).max(most);
        view.size = view.size.map(|side| (side * most).div_ceil(longest));
    }
    Ok(world)
}

/// Renders a scene at the size of a golden.
fn rendered(name: &str) -> Result<Picture, String> {
    let told = |error: gelray::Error| error.to_string();
    let mut world = loaded(name, LONGEST).map_err(told)?;
    let schedule = Schedule::new(JOBS).map_err(told)?;
    schedule.run(&mut world, &Watch::default()).map_err(told)?;
    let mut frames = world.query::<&Frame>();
    frames.iter().next().map(|frame| frame.0.clone()).ok_or_else(|| "there is no frame".to_owned())
}

/// The sRGB codes of a picture over black, and its alpha: what faint colours are hardly seen of hardly counts.
fn seen(picture: &Picture) -> Vec<u8> {
    let mut codes = to_bytes(picture);
    for [color @ .., alpha] in codes.as_chunks_mut::<4>().0 {
        for code in color {
            *code = ((u16::from(*code) * u16::from(*alpha) + 127) / 255) as u8;
        }
    }
    codes
}

fn compared(name: &str, made: &Picture, golden: &Path) -> Result<(), String> {
    const REMEDY: &str = "render it with GELRAY_BLESS=1, look at it, and commit it if it is right";
    if !golden.is_file() {
        return Err(format!("{name}: there is no golden picture; {REMEDY}"));
    }
    let kept = read_picture(golden).map_err(|error| error.to_string())?;
    if made.size != kept.size {
        return Err(format!("{name}: the golden has {:?} pixels, not {:?}", kept.size, made.size));
    }
    let (made, kept) = (seen(made), seen(&kept));
    let worst = made.iter().zip(&kept).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    let off = made.iter().zip(&kept).filter(|(a, b)| a.abs_diff(**b) > TOLERANCE).count();
    if off == 0 {
        return Ok(());
    }
    Err(format!(
        "{name}: {off} channels differ by more than {TOLERANCE} of 255, the worst by {worst}; {REMEDY}"
    ))
}

#[test]
fn every_scene_looks_as_its_golden_picture() {
    let bless = std::env::var_os("GELRAY_BLESS").is_some_and(|value| value != "0");
    let mut faults = Vec::new();
    for name in names("scenes", "toml") {
        let golden = folder("tests/goldens").join(format!("{name}.png"));
        let outcome = rendered(&name).and_then(|made| {
            if bless {
                return write_picture(&golden, &made, &[]).map_err(|error| error.to_string());
            }
            compared(&name, &made, &golden)
        });
        faults.extend(outcome.err());
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A traced polygon that casts a shadow: what no scene of the paper's figures has.
const SHADOWING: &str = r#"
entity = [
    { name = "ball", volume = { file = "phantom:ball" }, classify = { iso = [{ value = 0.5 }] } },
    { polygon = { vertices = [[0, 0, 28], [9, 0, 28], [0, 9, 28]] } },
    { light = { toward = [0, 0, 1] }, casts_shadow = {} },
    { title = { text = "a" } },
    { view = { size = [8, 8] } },
]
"#;

/// A volume that is projected: of it the rays themselves read the ranges.
const PROJECTED: &str = r#"
entity = [
    { volume = { file = "phantom:ball" }, projection = "maximum" },
    { volume = { file = "phantom:ball" }, projection = "sabella" },
    { view = { size = [8, 8] } },
]
"#;

/// How many products a job makes and keeps, run alone; `None` if it fails.
fn ran(job: &Job, world: &mut World) -> Option<(u32, u32)> {
    let ran = Schedule::new(&[*job]).unwrap().run(world, &Watch::default()).ok()?;
    Some((ran[0].made, ran[0].reused))
}

#[test]
fn a_system_reads_the_products_that_it_names_and_no_other() {
    let mut idle: Vec<_> =
        JOBS.iter().flat_map(|job| job.reads.iter().map(move |read| (job, *read))).collect();
    let inline = |(name, scene): (&str, &str)| {
        (name.to_owned(), load(&Source::inline(name, scene), &[], &[], false).unwrap().world)
    };
    let mut worlds: Vec<_> =
        [("shadowing", SHADOWING), ("projected", PROJECTED)].into_iter().map(inline).collect();
    worlds.extend(names("scenes", "toml").into_iter().map(|name| {
        let world = loaded(&name, 8).unwrap();
        (name, world)
    }));
    for (name, mut world) in worlds {
        let view = world.query::<Entity>().with::<&View>().iter().next().unwrap();
        world.insert_one(view, Estimate::default()).unwrap();
        Schedule::new(JOBS).unwrap().run(&mut world, &Watch::default()).unwrap();
        for job in JOBS {
            let others = JOBS.iter().map(|other| other.makes);
            let others = others.filter(|key| *key != job.makes && !job.reads.contains(key));
            let hidden: Vec<_> = others.map(|key| key.hide(&mut world)).collect();
            let kept = ran(job, &mut world).is_some_and(|(made, _)| made == 0);
            assert!(kept, "{name}: {} reads what it does not name", job.name);
            for restore in hidden {
                restore(&mut world);
            }
        }
        idle.retain(|(job, read)| {
            // What the jobs before it made anew is read once.
            ran(job, &mut world);
            let with = ran(job, &mut world);
            let restore = read.hide(&mut world);
            let without = ran(job, &mut world);
            restore(&mut world);
            ran(job, &mut world);
            with == without
        });
    }
    let idle: Vec<_> = idle.iter().map(|(job, read)| format!("{} {read:?}", job.name)).collect();
    assert!(idle.is_empty(), "named and never read: {idle:?}");
}

#[test]
fn every_golden_has_its_scene_and_every_scene_is_embedded() {
    let mut embedded: Vec<_> = EMBEDDED.iter().map(|(name, _)| (*name).to_owned()).collect();
    embedded.sort();
    let scenes = names("scenes", "toml");
    assert_eq!(scenes, embedded);
    let orphans: Vec<_> =
        names("tests/goldens", "png").into_iter().filter(|name| !scenes.contains(name)).collect();
    assert!(orphans.is_empty(), "goldens without a scene: {orphans:?}");
}

#[test]
fn a_golden_notices_a_pixel_that_is_off_by_three() {
    let made = Picture::new([2, 1], vec![[0.5, 0.5, 0.5, 1.0]; 2]).unwrap();
    let mut pixels = made.pixels.to_vec();
    pixels[1][1] = 0.52;
    let other = Picture::new([2, 1], pixels).unwrap();
    let file = tempfile::Builder::new().suffix(".png").tempfile().unwrap();
    write_picture(file.path(), &other, &[]).unwrap();
    assert!(compared("made", &other, file.path()).is_ok());
    let fault = compared("made", &made, file.path()).unwrap_err();
    assert!(fault.contains("1 channels differ") && fault.contains("GELRAY_BLESS"), "{fault}");
}
