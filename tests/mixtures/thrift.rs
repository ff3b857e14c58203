//! What a scene costs that asks for little, and what a turn of the view makes again.

use gelray::components::{View, Voxelize};
use gelray::light::strength::LightStrength;
use gelray::schedule::{Job, Ran, Schedule, System, Watch};
use gelray::systems::{classify, light_sweep::LightSweep, matte, ranges, scan_convert};

use crate::{KEY, entity, gel, level, run, stated, strength, view};

/// What systems made: name and number of products, of those that made any.
fn made(ran: &[Ran]) -> Vec<(&'static str, u32)> {
    ran.iter().filter(|ran| ran.made > 0).map(|ran| (ran.name, ran.made)).collect()
}

#[test]
fn moving_the_observer_casts_rays_and_makes_nothing_else() {
    let ball = gel("ball", [0.0, 0.5], "");
    let seen = view(10.0, 20.0, 24, 70.0, "");
    let hybrid = level(
        "hybrid",
        2.0,
        30.0,
        "surface = { opacity = 0.5 }\ntextured = { texture = \"grid\" }",
    );
    let scanned = level("scanned", 10.0, 30.0, "surface = { opacity = 0.5 }\nvoxelize = {}");
    let fill = "[[entity]]\nname = \"fill\"\nlight = { toward = [1, -1, 0.2], strength = 0.3 }\n";
    let shaft = "[[entity]]\nname = \"lamp\"\nlight = { toward = [1, 0, 1] }\ncasts_shadow = {}\nshaft = { opacity = 0.01 }\n";
    let mut world = stated(&[&ball, &hybrid, &scanned, KEY, fill, shaft, &seen], &[]);
    let first = made(&run(&mut world));
    assert!(
        first.contains(&("light_sweep", 2)) && first.contains(&("scan_convert", 2)),
        "{first:?}"
    );
    let observer = entity(&world, "observer");
    for azimuth in [40.0, 220.0] {
        world.get::<&mut View>(observer).unwrap().azimuth = azimuth;
        assert_eq!(made(&run(&mut world)), [("cast", 1), ("resample", 1)]);
    }
    assert_eq!(made(&run(&mut world)), []);
}

#[test]
fn a_turn_of_the_view_makes_gel_again_only_where_shading_depends_on_it() {
    for (material, lamp, again) in [
        ("diffuse = 0.8", "[1, 0, 1]", [false, false]),
        ("specular = 0.3", "[1, 0, 1]", [true, false]),
        ("diffuse = 0.8", "\"observer\"", [true, true]),
    ] {
        let ball = gel("ball", [0.0, 0.5], &format!("material = {{ {material} }}"));
        let light = format!(
            "[[entity]]\nname = \"key\"\nlight = {{ toward = {lamp} }}\ncasts_shadow = {{}}\n"
        );
        let mut world = stated(&[&ball, &light, &view(10.0, 20.0, 16, 70.0, "")], &[]);
        run(&mut world);
        let observer = entity(&world, "observer");
        world.get::<&mut View>(observer).unwrap().azimuth = 40.0;
        let names: Vec<_> = made(&run(&mut world)).into_iter().map(|(name, _)| name).collect();
        let [gel, light] = again;
        assert_eq!(
            [names.contains(&"relight"), names.contains(&"light_sweep")],
            [gel, light],
            "{material} {lamp}: {names:?}"
        );
    }
}

#[test]
fn a_scene_without_casts_shadow_has_no_light_strength_and_no_coverage_of_hybrid_polygons() {
    let ball = gel("ball", [0.0, 0.5], "");
    let plane = level("plane", 2.0, 30.0, "");
    let light = "[[entity]]\nname = \"key\"\nlight = { toward = [0, 0, 1] }\nshaft = { opacity = 0.01, attenuated = false }\n";
    let mut world = stated(&[&ball, &plane, light, &view(0.0, 0.0, 16, 70.0, "")], &[]);
    let plan = LightSweep::plan(&world);
    assert!(plan.makes.is_empty() && plan.why.contains("casts_shadow"), "{plan:?}");
    let names: Vec<_> = made(&run(&mut world)).into_iter().map(|(name, _)| name).collect();
    assert!(!names.contains(&"light_sweep") && !names.contains(&"scan_convert"), "{names:?}");
    assert!(strength(&world).is_none());
}

#[test]
fn the_shadows_of_a_head_take_less_than_five_megabytes_where_nothing_reads_the_whole_buffer() {
    const HEAD: &str = "[[entity]]\nname = \"head\"\nvolume = { file = \"phantom:head\" }\nclassify = { iso = [{ value = 1300 }] }\n";
    let plane = level("plane", 0.0, 60.0, "surface = { opacity = 0.5 }");
    let mut world = stated(&[HEAD, &plane, KEY, &view(0.0, 0.0, 16, 300.0, "")], &[]);
    let jobs = [
        Job::of::<ranges::FindRanges>(),
        Job::of::<classify::ClassifyVoxels>(),
        Job::of::<scan_convert::ScanConvert>(),
        Job::of::<matte::MattePolygons>(),
        Job::of::<LightSweep>(),
    ];
    let schedule = Schedule::new(&jobs).unwrap();
    let mut bytes = || {
        schedule.run(&mut world, &Watch::default()).unwrap();
        world.get::<&LightStrength>(entity(&world, "key")).unwrap().bytes()
    };
    let whole = bytes();
    let plane = entity(&world, "plane");
    world
        .insert_one(plane, Voxelize { matte: gelray::components::Matte::Over, calibrated: true })
        .unwrap();
    schedule.run(&mut world, &Watch::default()).unwrap();
    let own = world.get::<&LightStrength>(entity(&world, "key")).unwrap().bytes();
    println!("with the whole buffer for a hybrid polygon {whole} bytes, without {own}");
    assert!(own <= 5_000_000 && whole > own, "{own} {whole}");
}
