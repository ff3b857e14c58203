//! A picture that judges itself: the interval holds the truth, whatever lies over it, and nothing is done where none asks.

use gelray::components::{Estimate, Sampling, View};
use gelray::measure::error::compare;
use gelray::measure::judged::Judged;
use hecs::World;

use super::{frame, gel, level, run, stated, view};

const SEEDS: u32 = 12;

fn judged(world: &World) -> Option<Judged> {
    world.query::<&Judged>().iter().next().cloned()
}

fn ask(world: &mut World, estimate: Estimate) {
    let view = world.query_mut::<hecs::Entity>().with::<&View>().into_iter().next().unwrap();
    world.insert_one(view, estimate).unwrap();
}

/// Some scenes with some settings each, from a fine picture to one that misses much.
fn cases() -> Vec<(String, String)> {
    let red = "surface = { color = \"#d03030\", opacity = 0.6 }";
    let furniture = "[[entity]]\nname = \"title\"\ntitle = { text = \"gel\" }\n";
    let scenes = [
        gel("ball", [0.0, 0.3], ""),
        gel("ball", [0.0, 0.9], "") + &level("plane", 3.0, 20.0, red),
        gel("ball", [0.0, 0.05], "") + &level("plane", 3.0, 20.0, red) + furniture,
    ];
    let settings = [
        "",
        "distance_mm = 2, finest = 4",
        "tolerance = 0.1, coarsest = 32, stop_at = 0.2, outlines = false",
    ];
    let both = scenes.iter().flat_map(|scene| settings.map(|s| (scene.clone(), s)));
    both.zip(0..)
        .map(|((scene, settings), turn)| {
            (scene, view(20.0 + 40.0 * f64::from(turn), 25.0, 60, 50.0, settings))
        })
        .collect()
}

#[test]
fn the_interval_holds_the_truth_in_nine_of_ten_cases() {
    let (mut held, mut count) = (0, 0);
    for (scene, view) in cases() {
        let mut world = stated(&[&scene, &view], &[]);
        run(&mut world);
        let made = frame(&world);
        for sampling in world.query_mut::<&mut Sampling>() {
            let distance = sampling.distance_mm.unwrap_or(1.0);
            *sampling = Sampling { distance_mm: Some(distance / 4.0), ..sampling.exact() };
        }
        run(&mut world);
        let truth = compare(&made, &frame(&world)).unwrap().linear;
        let mut world = stated(&[&scene, &view], &[]);
        let holds = |seed: u32, world: &mut World| {
            ask(world, Estimate { seed, ..Estimate::default() });
            let ran = run(world);
            let cast = ran.iter().find(|ran| ran.name == "cast").unwrap();
            assert_eq!(cast.made == 0, seed > 0, "another seed casts no picture anew");
            let told = judged(world).unwrap();
            assert!(told.max <= truth.max + 1e-3, "{} {}", told.max, truth.max);
            told.low <= truth.psnr_db && truth.psnr_db <= told.high
        };
        let here = (0..SEEDS).filter(|&seed| holds(seed, &mut world)).count();
        println!("{:.1} dB: {here} of {SEEDS} intervals hold it", truth.psnr_db);
        held += here;
        count += SEEDS as usize;
    }
    println!("{held} of {count} intervals hold the truth");
    assert!(held * 10 >= count * 9, "{held} of {count}");
}

#[test]
fn nobody_is_judged_who_does_not_ask() {
    let (scene, view) = cases().swap_remove(0);
    let mut world = stated(&[&scene, &view], &[]);
    let ran = run(&mut world);
    assert!(judged(&world).is_none());
    assert_eq!(ran.iter().find(|ran| ran.name == "judge").unwrap().made, 0);
    ask(&mut world, Estimate::default());
    run(&mut world);
    let few = judged(&world).unwrap();
    ask(&mut world, Estimate { share: 200.0, ..Estimate::default() });
    run(&mut world);
    let many = judged(&world).unwrap();
    assert!(many.pixels > 2 * few.pixels && many.high - many.low < few.high - few.low);
    assert!(many.beyond < few.beyond);
}
