//! Facts about whole scenes: what they become, and what is said of those that cannot be used.

mod faults;
mod pictured;

use hecs::World;

use super::{EMBEDDED, Scene, Source, grammar, load, schema, table};
use crate::components::{
    CastsShadow, Classify, Light, Material, Name, OpacityUnit, Order, Sampling, Skip, Surface,
    View, Voxelize,
};
use crate::light::strength::ProjectedBy;
use crate::polygon::face::Faces;
use crate::polygon::texture::{Lies, TexturedBy};
use crate::view::extent::Extent;
use crate::volume::grid::{Grid, Painted, Scalars};

const BALL: &str = "[[entity]]\nname = \"ball\"\nvolume = { file = \"phantom:ball\" }\nclassify = { iso = [{ value = 0.5 }] }\n";
const PLANE: &str = "[[entity]]\nname = \"plane\"\npolygon = { vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] }\n";

fn loaded(text: &str, overrides: &[&str]) -> Result<Scene, String> {
    let overrides: Vec<_> = overrides.iter().map(|&o| o.to_owned()).collect();
    load(&Source::inline("s.toml", text), &overrides, &[], false).map_err(|e| e.to_string())
}

fn refused(text: &str) -> String {
    match loaded(text, &[]) {
        Ok(_) => panic!("this scene should be refused:\n{text}"),
        Err(sentence) => sentence,
    }
}

fn only<T: Clone + Send + Sync + 'static>(world: &World) -> T {
    let mut query = world.query::<&T>();
    let all: Vec<_> = query.iter().cloned().collect();
    assert_eq!(all.len(), 1, "one of {}", std::any::type_name::<T>());
    all[0].clone()
}

fn named(world: &World, name: &str) -> hecs::Entity {
    let mut query = world.query::<(hecs::Entity, &Name)>();
    let found = query.iter().find(|(_, n)| n.0 == name).map(|(entity, _)| entity);
    found.unwrap_or_else(|| panic!("no entity is called {name}"))
}

#[test]
fn a_scene_of_one_volume_gets_its_grid_its_contour_a_head_light_and_an_observer() {
    let scene = Source::embedded("minimal_1").unwrap();
    let Scene { world, warnings, name, .. } = load(&scene, &[], &[], false).unwrap();
    assert_eq!(name, "minimal_1");
    assert_eq!(only::<Grid>(&world).voxels(), only::<Scalars>(&world).len());
    assert_eq!(only::<Classify>(&world).iso.len(), 1);
    assert_eq!(only::<Material>(&world), Material::default());
    assert!(only::<OpacityUnit>(&world).0 > 0.0);
    assert!(warnings.iter().any(|w| w.contains("`volume`: no `classify`")), "{warnings:?}");
    assert!(world.get::<&Light>(named(&world, "head light")).is_ok());
    let observer = named(&world, "observer");
    assert_eq!(*world.get::<&View>(observer).unwrap(), View::default());
    assert_eq!(*world.get::<&Sampling>(observer).unwrap(), Sampling::default());
    let corners = Extent::of(only::<Grid>(&world).corners());
    assert_eq!(corners, Some(*world.get::<&Extent>(observer).unwrap()));
}

#[test]
fn every_embedded_scene_loads_and_its_orders_follow_its_lines() {
    for (name, text) in EMBEDDED {
        let scene = load(&Source::embedded(name).unwrap(), &[], &[], false);
        let Scene { world, resolved, .. } = scene.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(resolved, text);
        assert!(text.starts_with("# "), "{name} says what it shows");
        let mut orders: Vec<_> = world.query::<&Order>().iter().map(|order| order.0).collect();
        orders.sort_unstable();
        assert_eq!(orders, (0..orders.len() as u32).collect::<Vec<_>>());
        only::<View>(&world);
        only::<Extent>(&world);
        assert!(world.query::<&Light>().iter().count() > 0);
    }
}

#[test]
fn polygons_become_faces_with_a_surface_and_stay_to_be_voxelized_if_stated() {
    let Scene { world, .. } =
        loaded(&format!("{BALL}{PLANE}"), &["plane.voxelize.matte=under"]).unwrap();
    let plane = named(&world, "plane");
    assert_eq!(world.get::<&Faces>(plane).unwrap().0.len(), 1);
    assert_eq!(*world.get::<&Surface>(plane).unwrap(), Surface::default());
    assert!(world.get::<&Voxelize>(plane).is_ok());
}

#[test]
fn polygons_alone_make_a_scene_with_a_head_light() {
    let Scene { world, .. } = loaded(PLANE, &[]).unwrap();
    assert!(only::<Extent>(&world).radius() > 0.0);
    only::<Light>(&world);
}

#[test]
fn exact_settings_take_the_place_of_those_stated_but_the_distance_stays() {
    let text = format!(
        "{PLANE}[[entity]]\nview = {{}}\nsampling = {{ distance_mm = 0.25, stop_at = 0.1 }}\n"
    );
    let world = load(&Source::inline("s", text), &[], &[], true).unwrap().world;
    let Sampling { distance_mm, stop_at, skip, coarsest, .. } = only(&world);
    assert_eq!((distance_mm, stop_at, skip, coarsest), (Some(0.25), 0.0, Skip::Pyramid, 1));
}

#[test]
fn a_level_in_sigma_is_a_number_in_the_world() {
    let level = |value: &str| {
        let scene = loaded(BALL, &[&format!("ball.classify.iso.0.value={value}")]).unwrap();
        only::<Classify>(&scene.world).iso[0].value
    };
    let (mean, one, two) = (level("0sigma"), level("1sigma"), level("2 sigma"));
    assert!(one > mean && ((two - one) - (one - mean)).abs() < 1e-3 * (one - mean).abs());
}

#[test]
fn the_middle_of_the_volume_is_where_center_says() {
    let world = loaded(BALL, &["ball.volume.center=[10, 20, 30]"]).unwrap().world;
    let center = only::<Extent>(&world).center();
    assert!(center.distance(glam::DVec3::new(10.0, 20.0, 30.0)) < 1e-9);
}

#[test]
fn a_file_that_is_nowhere_is_stood_in_for_with_a_warning_or_refused_with_a_remedy() {
    let there = BALL.replace(
        "\"phantom:ball\"",
        "\"no.nrrd\", stand_in = \"phantom:ball\", spacing_mm = [9, 9, 9]",
    );
    let Scene { world, warnings, .. } = loaded(&there, &[]).unwrap();
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("`phantom:ball` stands in") && w.contains("data folder")),
        "{warnings:?}"
    );
    assert_ne!(only::<Grid>(&world).spacing(), glam::DVec3::splat(9.0));
    let sentence = refused(&BALL.replace("phantom:ball", "no.nrrd"));
    assert!(
        sentence.starts_with("s.toml:3:")
            && sentence.contains("`no.nrrd` is not in the working folder"),
        "{sentence}"
    );
}

#[test]
fn a_file_is_found_in_a_folder_of_a_data_folder() {
    let data = tempfile::tempdir().unwrap();
    std::fs::create_dir(data.path().join("inner")).unwrap();
    std::fs::write(data.path().join("inner/is.nrrd"), "not a volume").unwrap();
    let source = Source::inline("s.toml", BALL.replace("phantom:ball", "is.nrrd"));
    let error = load(&source, &[], &[data.path().to_path_buf()], false).err().unwrap();
    assert!(
        matches!(&error, crate::Error::Format { path, .. } if path.ends_with("inner/is.nrrd")),
        "{error}"
    );
}

#[test]
fn a_volume_of_rgba_is_neither_classified_nor_shaded_and_needs_no_light() {
    let folder = tempfile::tempdir().unwrap();
    let header = "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 4 2 2 2\nkinds: RGBA-color domain domain domain\nspacings: nan 1 1 1\nencoding: ascii\n\n";
    let text = format!("{header}{}", "255 128 0 64\n".repeat(8));
    std::fs::write(folder.path().join("painted.nrrd"), text).unwrap();
    let data = [folder.path().to_path_buf()];
    let painted = "[[entity]]\nname = \"gel\"\nvolume = { file = \"painted.nrrd\" }\n";
    let world = load(&Source::inline("s.toml", painted), &[], &data, false).unwrap().world;
    assert_eq!(only::<Painted>(&world).len(), 8);
    assert!(world.query::<&Classify>().iter().next().is_none());
    assert!(world.query::<&Material>().iter().next().is_none());
    assert!(world.query::<&Light>().iter().next().is_none());
    for key in ["classify = { iso = [{ value = 1 }] }", "material = {}"] {
        let source = Source::inline("s.toml", format!("{painted}{key}\n"));
        let error = load(&source, &[], &data, false).err().unwrap().to_string();
        assert!(error.starts_with("s.toml:4:") && error.contains("RGBA, classified"), "{error}");
    }
}

#[test]
fn textures_reach_the_polygons_and_lights_that_name_them() {
    let text = format!(
        "{BALL}{PLANE}textured = {{ texture = \"slide\" }}\n[[entity]]\nname = \"slide\"\ntexture = {{ formula = \"grid\" }}\n[[entity]]\nname = \"key\"\nlight = {{ toward = [0, 0, 1] }}\ncasts_shadow = {{}}\nprojects = {{ texture = \"checker\", size_mm = [10, 10] }}\n"
    );
    let world = loaded(&text, &[]).unwrap().world;
    let TexturedBy { lies, .. } = only(&world);
    assert_eq!(lies, Lies::Corners([glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y]));
    assert!(only::<ProjectedBy>(&world).picture.size[0] > 0);
    assert_eq!(only::<CastsShadow>(&world), CastsShadow::default());
    let sentence = refused(&text.replace("texture = \"slide\"", "texture = \"slid\""));
    assert!(sentence.contains("called `slid` (there are: `slide`)"), "{sentence}");
}

#[test]
fn scenes_that_cannot_be_rendered_are_refused_in_a_sentence() {
    let view = |rest: &str| format!("{BALL}[[entity]]\nview = {{}}\n{rest}\n");
    let light =
        |rest: &str| format!("{BALL}[[entity]]\nlight = {{ toward = [0, 0, 1] }}\n{rest}\n");
    let mesh = |rest: &str| format!("[[entity]]\nmesh = {{ {rest} }}\n");
    let cases = [
        ("[[entity]]\nlight = { toward = [0, 0, 1] }".to_owned(), "nothing to see"),
        (view("depth_cue = { k1 = 1, k2 = -10 }"), "must stay above 0"),
        (light("casts_shadow = { k2 = -10 }"), "must stay above 0"),
        (light("projects = { texture = \"no such\", size_mm = [1, 1] }"), "no such"),
        (format!("{PLANE}voxelize = {{}}"), "no volume to scan-convert it into"),
        (
            mesh(
                "vertices = [[1e154, 0, 0], [1.1e154, 0, 0], [1e154, 1e153, 0], [-1e154, 0, 0], [-1.1e154, 0, 0], [-1e154, 1e153, 0]], faces = [[0, 1, 2], [3, 4, 5]]",
            ),
            "too far apart",
        ),
        (PLANE.replace("[1, 1, 0]", "[1, 1, 0.1]"), "split it into triangles"),
        (PLANE.replace("[1, 0, 0], [1, 1, 0], [0, 1, 0]", "[1, 0, 0], [2, 0, 0]"), "one line"),
        (mesh("vertices = [[0, 0, 0], [1, 0, 0]], faces = [[0, 1, 2]]"), "there are 2 vertices"),
        (mesh("vertices = [[0, 0, 0], [1, 0, 0]], faces = [[0, 1, 0]]"), "face 0 of its mesh"),
        (
            format!(
                "{}textured = {{ texture = \"grid\" }}",
                mesh("prism = { from = [0, 0, 0], to = [0, 0, 1], radius = 1 }")
            ),
            "state `corners`",
        ),
        (
            format!(
                "{PLANE}textured = {{ texture = \"grid\", corners = [[0, 0, 0], [1, 0, 0], [2, 0, 0]] }}"
            ),
            "three that span it",
        ),
        (BALL.replace("phantom:ball", "phantom:bowl"), "bowl"),
    ];
    for (text, says) in cases {
        let sentence = refused(&text);
        assert!(sentence.contains(says), "{sentence}\nshould say: {says}");
        assert!(sentence.starts_with("s.toml:") && !sentence.contains('\n'), "{sentence}");
    }
}

#[test]
fn the_schema_names_every_component_and_the_embedded_scenes_keep_to_it() {
    let schema = schema();
    let entity = &schema["properties"]["entity"]["items"];
    for row in &table::COMPONENTS {
        // A table of keys, or one of a few words.
        let component = &entity["properties"][row.key];
        let words = component["oneOf"].as_array().is_some_and(|words| {
            !words.is_empty() && words.iter().all(|word| word["const"].is_string())
        });
        assert!(component["properties"].is_object() || words, "{}", row.key);
    }
    assert_eq!(entity["properties"]["sampling"]["properties"]["stop_at"]["default"], 0.02);
    for (name, text) in EMBEDDED {
        let root = toml::de::DeTable::parse(text).unwrap();
        let value = toml::Spanned::new(0..0, toml::de::DeValue::Table(root.into_inner()));
        grammar::check(&value, &schema, "scene")
            .unwrap_or_else(|f| panic!("{name}: {}", f.message));
    }
}
