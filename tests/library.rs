//! The library from outside: worlds from arrays in memory, what they leave out, what is kept, and what is refused.

use gelray::prelude::*;
use gelray::scene::{Kept, Loads, Source, load, load_keeping};
use gelray::view::extent::Extent;

const SCENE: &str = "
[[entity]]
volume = { file = \"phantom:ball\" }
classify = { iso = [{ value = 0.5 }] }
[[entity]]
polygon = { vertices = [[-30, -30, 3], [30, -30, 3], [30, 30, 8], [-30, 30, 8]] }
surface = { opacity = 0.5 }
";

const SQUARE: [[f64; 3]; 4] =
    [[-30.0, -30.0, 3.0], [30.0, -30.0, 3.0], [30.0, 30.0, 8.0], [-30.0, 30.0, 8.0]];

fn bits(picture: &Picture) -> Vec<[u32; 4]> {
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

fn rendered(world: &mut World) -> Rendered {
    Renderer::new().unwrap().render(world).unwrap()
}

fn small() -> View {
    View { size: [40, 40], ..View::default() }
}

/// The ball of [`SCENE`].
fn ball() -> (Grid, Scalars) {
    let world = load(&Source::inline("s.toml", SCENE), &[], &[], false).unwrap().world;
    let (grid, scalars) = {
        let mut volumes = world.query::<(&Grid, &Scalars)>();
        let (grid, scalars) = volumes.iter().next().unwrap();
        (*grid, scalars.clone())
    };
    (grid, scalars)
}

/// A world of a ball, a square and a view, and nothing else.
fn world() -> (World, [Entity; 3]) {
    let mut world = World::new();
    let (grid, scalars) = ball();
    let ball = world.spawn((grid, scalars, Classify::iso(0.5)));
    let square =
        world.spawn((polygon(&SQUARE).unwrap(), Surface { opacity: 0.5, ..Surface::default() }));
    let view = world.spawn((small(),));
    (world, [ball, square, view])
}

#[test]
fn a_world_from_arrays_is_the_scene_that_states_the_same() {
    let mut scene = load(&Source::inline("s.toml", SCENE), &[], &[], false).unwrap().world;
    for view in scene.query_mut::<&mut View>() {
        *view = small();
    }
    let (mut world, _) = world();
    let (ours, theirs) = (rendered(&mut world).picture, rendered(&mut scene).picture);
    assert_eq!(bits(&ours), bits(&theirs));
    assert!(ours.pixel(20, 20)[3] > 0.9, "there is something to see");
}

/// A world without a component.
fn without<T: hecs::Component>(mut world: World) -> World {
    let carriers = world.query_mut::<(Entity, &T)>().into_iter();
    let carriers: Vec<_> = carriers.map(|(entity, _)| entity).collect();
    assert!(!carriers.is_empty());
    for entity in carriers {
        let _ = world.remove_one::<T>(entity);
    }
    world
}

#[test]
fn nothing_vanishes_where_a_component_is_left_out() {
    let loaded = || load(&Source::inline("s.toml", SCENE), &[], &[], false).unwrap().world;
    let made = |mut world: World| {
        for view in world.query_mut::<&mut View>() {
            view.size = [40, 40];
        }
        bits(&rendered(&mut world).picture)
    };
    let whole = made(loaded());
    assert_eq!(made(without::<Order>(loaded())), whole, "order");
    assert_eq!(made(without::<OpacityUnit>(loaded())), whole, "opacity unit");
    assert_eq!(made(without::<Sampling>(loaded())), whole, "sampling");
    assert_eq!(made(without::<Extent>(loaded())), whole, "extent");
    assert_eq!(made(without::<Material>(loaded())), whole, "material");
    assert_eq!(made(without::<Faces>(loaded())), whole, "faces of a polygon");
}

#[test]
fn what_was_filled_in_follows_what_changes_and_gives_way_to_what_is_stated() {
    let (mut changed, [_, square, view]) = world();
    let first = rendered(&mut changed);
    assert!(first.notices.is_empty(), "{:?}", first.notices);
    assert_eq!(changed.query_mut::<&Light>().into_iter().count(), 1, "a head light");
    let far = SQUARE.map(|[x, y, z]| [x, y, z + 40.0]);
    changed.insert_one(square, polygon(&far).unwrap()).unwrap();
    changed.spawn((Light::from_direction([0.0, -1.0, 1.0]),));
    let again = rendered(&mut changed).picture;
    let lights: Vec<_> = changed.query_mut::<&Light>().into_iter().map(|l| l.toward).collect();
    assert_eq!(lights, [Toward::Direction([0.0, -1.0, 1.0])], "the head light went");
    let (mut new, [_, square, _]) = world();
    new.insert_one(square, polygon(&far).unwrap()).unwrap();
    new.spawn((Light::from_direction([0.0, -1.0, 1.0]),));
    assert_eq!(bits(&again), bits(&rendered(&mut new).picture));
    assert_ne!(bits(&again), bits(&first.picture));
    // Without a view there is one, until one is stated.
    changed.despawn(view).unwrap();
    assert_eq!(rendered(&mut changed).picture.size, [380, 380]);
    changed.spawn((small(),));
    assert_eq!(bits(&rendered(&mut changed).picture), bits(&again));
}

#[test]
fn a_turn_of_the_view_casts_rays_and_makes_nothing_else() {
    let (mut world, [.., view]) = world();
    world.spawn((Light::from_direction([0.0, -1.0, 1.0]),));
    let renderer = Renderer::new().unwrap();
    renderer.render(&mut world).unwrap();
    world.get::<&mut View>(view).unwrap().azimuth = 30.0;
    let turned = renderer.render(&mut world).unwrap();
    let made: Vec<_> = turned.ran.iter().filter(|ran| ran.made > 0).map(|ran| ran.name).collect();
    assert_eq!(made, ["cast", "resample"]);
}

#[test]
fn scalars_without_a_classification_are_drawn_at_the_value_that_they_suggest_and_that_is_said() {
    let mut world = World::new();
    world.spawn(ball());
    world.spawn((small(),));
    let seen = rendered(&mut world);
    assert!(seen.notices.len() == 1 && seen.notices[0].contains("isovalue"), "{:?}", seen.notices);
    assert!(seen.picture.pixel(20, 20)[3] > 0.9);
}

#[test]
fn a_texture_is_a_picture_on_a_named_entity() {
    let mut world = World::new();
    let (red, green) = ([255, 0, 0, 255], [0, 255, 0, 255]);
    let picture = Picture::from_srgb([2, 1], &[red, green]).unwrap();
    let texture = world.spawn((Name("halves".to_owned()), picture));
    let vertices = vec![[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];
    let stated = Polygon { vertices, holes: Vec::new() };
    world.spawn((stated, Textured { wrap: Wrap::Clamp, ..Textured::by("halves") }));
    world.spawn((View { height_mm: Some(2.0), ..small() },));
    let hues = |world: &mut World| {
        let picture = rendered(world).picture;
        [5, 35].map(|x| picture.pixel(x, 20)).map(|[r, g, ..]| r > g)
    };
    assert_eq!(hues(&mut world), [true, false]);
    world.insert_one(texture, Picture::from_srgb([2, 1], &[green, red]).unwrap()).unwrap();
    assert_eq!(hues(&mut world), [false, true], "other pixels are seen at once");
}

#[test]
fn furniture_that_a_caller_spawns_is_drawn_and_leaves_the_rays_alone() {
    let (mut world, _) = world();
    let plain = rendered(&mut world);
    let bar = world.spawn((ScaleBar::default(),));
    let barred = rendered(&mut world);
    let color = |rendered: &Rendered, n: usize| rendered.samples.color(n % 160, n / 160);
    assert!((0..160 * 160).all(|n| color(&plain, n) == color(&barred, n)));
    assert_ne!(bits(&plain.picture), bits(&barred.picture), "the bar lies over the picture");
    world.despawn(bar).unwrap();
    assert_eq!(
        bits(&plain.picture),
        bits(&rendered(&mut world).picture),
        "and goes with its entity"
    );
    world.spawn((BoundingBox::default(),));
    let boxed = rendered(&mut world).picture;
    let mut pairs = boxed.pixels.iter().zip(plain.picture.pixels.iter());
    assert!(pairs.any(|(boxed, plain)| boxed[0] < plain[0] - 0.05), "gray edges on white");
}

#[test]
fn work_is_stopped_from_outside_and_goes_on_to_the_same_picture() {
    let (mut stopped, _) = world();
    let renderer = Renderer::new().unwrap();
    renderer.watch().stop();
    assert!(matches!(renderer.render(&mut stopped), Err(Error::Interrupted)));
    renderer.watch().go_on();
    let picture = renderer.render(&mut stopped).unwrap().picture;
    assert_eq!(bits(&picture), bits(&rendered(&mut world().0).picture));
    let (stage, done, total) = renderer.watch().progress();
    assert!(!stage.is_empty() && done == total, "{stage}: {done} of {total}");
}

/// The sentence that a world is refused with, after a change of it.
fn refused(change: impl FnOnce(&mut World, [Entity; 3])) -> String {
    let (mut world, entities) = world();
    change(&mut world, entities);
    match Renderer::new().unwrap().render(&mut world) {
        Err(Error::Entity { problem, .. }) => problem,
        Err(other) => panic!("not an entity's fault: {other}"),
        Ok(_) => panic!("this world should be refused"),
    }
}

#[test]
fn what_cannot_be_rendered_is_refused_by_entity_in_one_sentence() {
    let put = |which: usize, component: fn(&mut World, Entity)| {
        refused(move |world, entities| component(world, entities[which]))
    };
    let unit = put(0, |world, ball| world.insert_one(ball, OpacityUnit(f64::NAN)).unwrap());
    assert!(unit.contains("above 0"), "{unit}");
    let few = put(0, |world, ball| world.insert_one(ball, Scalars::from(vec![0_u8; 9])).unwrap());
    assert!(few.contains("9 voxels"), "{few}");
    let opacity = put(1, |world, square| {
        world.insert_one(square, Surface { opacity: 2.0, ..Surface::default() }).unwrap();
    });
    assert!(opacity.contains("opacity") && opacity.contains('1'), "{opacity}");
    let size = put(2, |world, view| {
        world.insert_one(view, View { size: [0, 40], ..View::default() }).unwrap();
    });
    assert!(size.contains("size"), "{size}");
    let nan = put(2, |world, view| {
        world.insert_one(view, View { azimuth: f64::NAN, ..small() }).unwrap();
    });
    assert!(nan.contains("azimuth"), "{nan}");
    let light = put(0, |world, _| _ = world.spawn((Light::from_direction([0.0; 3]),)));
    assert!(light.contains("direction"), "{light}");
    let texture = put(1, |world, square| world.insert_one(square, Textured::by("no")).unwrap());
    assert!(texture.contains("no texture of the scene is called `no`"), "{texture}");
    let mesh = Mesh { vertices: vec![[0.0; 3]], faces: vec![vec![0, 1, 2]], ..Mesh::default() };
    let mesh = refused(move |world, _| _ = world.spawn((mesh,)));
    assert!(mesh.contains("vertex 1"), "{mesh}");
    let nothing = Renderer::new().unwrap().render(&mut World::new()).err().unwrap().to_string();
    assert!(nothing.contains("there is nothing to see"), "{nothing}");
}

/// A segmentation of two labels, and a molecule of two atoms in it, scan-converted.
const SEGMENTED: &str = r#"
[[entity]]
name = "parts"
volume = { file = "labels.nrrd" }
labels = { table = [{ label = 1, color = "red", opacity = 0.4 }] }
[[entity]]
name = "atoms"
molecule = { file = "two.pdb", style = "balls" }
voxelize = {}
[[entity]]
mesh = { file = "one.obj" }
smooth = {}
voxelize = {}
[[entity]]
light = { toward = [0, -1, 0], strength = 1 }
[[entity]]
name = "observer"
view = { azimuth = 10, size = [24, 24] }
"#;

#[test]
fn a_scene_that_is_stated_again_reads_and_makes_its_labels_meshes_and_molecules_once() {
    let folder = tempfile::tempdir().unwrap();
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n";
    let labels = (0..512).map(|at| u8::from(at % 8 > 2));
    let labels: Vec<u8> = header.bytes().chain(labels).collect();
    std::fs::write(folder.path().join("labels.nrrd"), labels).unwrap();
    let atom = |number: u8, x: f32| {
        format!(
            "ATOM  {number:5}  C   GLY A   7    {x:8.3}   0.000   0.000  1.00 10.00           C\n"
        )
    };
    std::fs::write(folder.path().join("two.pdb"), atom(1, 0.0) + &atom(2, 1.5)).unwrap();
    let data = vec![folder.path().to_owned()];
    std::fs::write(folder.path().join("one.obj"), "v 1 1 1\nv 5 1 1\nv 1 5 2\nf 1 2 3\n").unwrap();
    let source = Source::inline("s.toml", SEGMENTED);
    let loads = Loads { source, data, exact: false, most_bytes: None };
    let mut kept = Kept::default();
    let mut scene = load_keeping(&loads, &[], &mut kept).unwrap();
    let files = scene.files.clone();
    let renderer = Renderer::new().unwrap();
    renderer.render(&mut scene.world).unwrap();
    for file in ["two.pdb", "one.obj"] {
        std::fs::remove_file(folder.path().join(file)).unwrap();
    }
    scene.restate(&loads, &["observer.view.azimuth=70".to_owned()], &mut kept).unwrap();
    let ran = renderer.render(&mut scene.world).unwrap().ran;
    let made: Vec<_> = ran.iter().filter(|ran| ran.made > 0).map(|ran| ran.name).collect();
    assert_eq!(made, ["cast", "resample"]);
    // Its first loading told of all files.
    assert_eq!(files.len(), 3);
    let other = "atoms.molecule.style=\"sticks\"".to_owned();
    assert!(scene.restate(&loads, &[other], &mut kept).is_err(), "the file is asked for again");
}
