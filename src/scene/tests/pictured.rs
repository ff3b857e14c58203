//! Facts about meshes whose files bring pictures: they are textured by them, unless the scene lays another on them.

use std::path::Path;

use glam::DVec2;
use hecs::World;

use super::{loaded, only};
use crate::components::color::to_linear;
use crate::components::{TextureFilter, Textured, Wrap};
use crate::formats::pictures::write_picture;
use crate::polygon::face::{FaceColors, FaceOpacities};
use crate::polygon::texture::{Footprint, Laid, OwnTextures, TexturedBy};
use crate::scene::{Kept, Loads, Scene, Source, load, load_keeping};
use crate::view::picture::Picture;

/// A folder of a mesh of two triangles, the second with a picture.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("a.mtl", "newmtl bark\nKd 0.5 0.5 0.5\nd 0.25\nmap_Kd -clamp on bark.png\n");
    write(
        "a.obj",
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1 2 4\nusemtl bark\nf 1/1 2/2 3/3\n",
    );
    let picture = Picture::new([2, 1], vec![[1.0; 4], [0.5, 0.0, 0.0, 1.0]]).unwrap();
    write_picture(&folder.path().join("bark.png"), &picture, &[]).unwrap();
    folder
}

fn scene(folder: &Path, more: &str) -> Result<Scene, String> {
    let text = format!("[[entity]]\nname = \"tree\"\nmesh = {{ file = \"a.obj\" }}\n{more}\n");
    let data = [folder.to_owned()];
    load(&Source::inline("s.toml", text), &[], &data, false).map_err(|error| error.to_string())
}

#[test]
fn a_mesh_is_textured_by_its_file_and_the_picture_is_among_the_files() {
    let folder = folder();
    let Scene { world, warnings, files, .. } = scene(folder.path(), "").unwrap();
    let TexturedBy { laid, .. } = only(&world);
    assert!(laid.on(0).is_none(), "a triangle without a picture shows none");
    let opacities: FaceOpacities = only(&world);
    assert_eq!([0, 1, 2].map(|at| FaceOpacities::of(Some(&opacities), at)), [1.0, 0.25, 1.0]);
    assert_eq!(laid.on(1).unwrap().size(), [2, 1]);
    assert_eq!(files, ["a.obj", "a.mtl", "bark.png"].map(|name| folder.path().join(name)));
    assert!(!warnings.iter().any(|warning| warning.contains("tree")), "{warnings:?}");
    assert!(world.query::<&Textured>().iter().next().is_none(), "nothing is stated for the scene");
}

#[test]
fn a_texture_that_the_scene_states_takes_the_place_of_the_file_s() {
    let folder = folder();
    std::fs::write(folder.path().join("bark.png"), "damaged").unwrap();
    let Scene { world, files, warnings, .. } =
        scene(folder.path(), "textured = { texture = \"checker\" }").unwrap();
    assert!(matches!(only::<TexturedBy>(&world).laid, Laid::One(_)));
    assert!(world.query::<&FaceColors>().iter().next().is_none(), "and it is not tinted");
    assert!(world.query::<&FaceOpacities>().iter().next().is_none(), "and all of it is there");
    assert!(only::<OwnTextures>(&world).all().is_empty() && files.len() == 2, "it is not read");
    assert!(!warnings.iter().any(|warning| warning.contains("bark")), "{warnings:?}");
}

#[test]
fn a_statement_that_names_the_mesh_says_how_its_own_pictures_are_laid() {
    let folder = folder();
    let stated = "textured = { texture = \"tree\", wrap = \"vanish\", repeats = [2, 2] }";
    let world = scene(folder.path(), stated).unwrap().world;
    let TexturedBy { laid, textured, .. } = only(&world);
    let (own, filter) = (only::<OwnTextures>(&world), textured.filter);
    assert_eq!(laid, Laid::Each(own.with(Wrap::Vanish, filter)));
    assert_eq!(textured.repeats, [2.0, 2.0]);
    assert_eq!(own, own.with(Wrap::Clamp, filter), "by itself it is laid as its file has it");
    std::fs::remove_file(folder.path().join("bark.png")).unwrap();
    let refused = scene(folder.path(), stated).err().unwrap();
    assert!(refused.contains("called `tree`"), "{refused}");
}

#[test]
fn a_picture_that_is_missing_or_damaged_is_one_sentence_and_leaves_the_mesh() {
    let folder = folder();
    for (content, said) in [(Some("damaged"), "PNG"), (None, "not found")] {
        let path = folder.path().join("bark.png");
        match content {
            Some(content) => std::fs::write(path, content).unwrap(),
            None => std::fs::remove_file(path).unwrap(),
        }
        let Scene { world, warnings, .. } = scene(folder.path(), "").unwrap();
        let about: Vec<_> =
            warnings.iter().filter(|warning| warning.contains("bark.png")).collect();
        assert!(about.len() == 1 && about[0].contains(said), "{warnings:?}");
        assert!(world.query::<&TexturedBy>().iter().next().is_none());
    }
}

#[test]
fn a_picture_of_opacity_makes_holes_in_that_of_color_and_one_that_is_missing_leaves_it() {
    let folder = folder();
    let write = |text: &str| std::fs::write(folder.path().join("a.mtl"), text).unwrap();
    let grey = [to_linear(0.5), to_linear(0.5), to_linear(0.5), 1.0];
    let holes = Picture::new([2, 2], vec![[1.0; 4], [0.0, 0.0, 0.0, 1.0], [1.0; 4], grey]).unwrap();
    write_picture(&folder.path().join("holes.png"), &holes, &[]).unwrap();
    let alphas = |world: &World| {
        let TexturedBy { laid, .. } = only(world);
        let texture = laid.on(1).unwrap().with(Wrap::Clamp, TextureFilter::Nearest);
        let point = Footprint::new(DVec2::ZERO, DVec2::ZERO);
        let at = |u, v| texture.filtered(DVec2::new(u, v), &point);
        let corners = [at(0.2, 0.2), at(0.8, 0.2), at(0.2, 0.8), at(0.8, 0.8)];
        (texture.size(), corners.map(|texel| (texel.w * 100.0).round() as i32), at(0.2, 0.2))
    };
    write("newmtl bark\nmap_Kd bark.png\nmap_d holes.png\n");
    let Scene { world, warnings, files, .. } = scene(folder.path(), "").unwrap();
    assert!(!warnings.iter().any(|warning| warning.contains("tree")), "{warnings:?}");
    assert_eq!(alphas(&world), ([2, 2], [100, 0, 100, 50], glam::Vec4::ONE));
    assert!(files.contains(&folder.path().join("holes.png")));
    write("newmtl bark\nKd 1 0 0\nmap_d holes.png\n");
    let world = scene(folder.path(), "").unwrap().world;
    assert_eq!(alphas(&world), ([2, 2], [100, 0, 100, 50], glam::Vec4::ONE));
    assert_eq!(
        FaceColors::of(Some(&only(&world)), 1).unwrap().0,
        glam::Vec3::X,
        "its own color tints it"
    );
    write("newmtl bark\nmap_Kd bark.png\nmap_d no.png\n");
    let Scene { world, warnings, .. } = scene(folder.path(), "").unwrap();
    assert_eq!(alphas(&world).1, [100; 4]);
    let about: Vec<_> = warnings.iter().filter(|warning| warning.contains("no.png")).collect();
    assert!(about.len() == 1 && about[0].contains("not found"), "{warnings:?}");
}

#[test]
fn pictures_that_no_triangle_lies_in_are_said() {
    let folder = folder();
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl bark\nf 1 2 3\n";
    std::fs::write(folder.path().join("a.obj"), text).unwrap();
    let Scene { world, warnings, .. } = scene(folder.path(), "").unwrap();
    assert!(warnings.iter().any(|warning| warning.contains("state `textured`")), "{warnings:?}");
    assert!(world.query::<&TexturedBy>().iter().next().is_none());
    let corners = "textured = { texture = \"tree\", corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }";
    assert!(only::<TexturedBy>(&scene(folder.path(), corners).unwrap().world).laid.on(0).is_some());
}

#[test]
fn pictures_take_no_more_memory_than_is_allowed_and_are_read_once() {
    let folder = folder();
    let big = Picture::new([512, 512], vec![[1.0; 4]; 512 * 512]).unwrap();
    write_picture(&folder.path().join("bark.png"), &big, &[]).unwrap();
    let source =
        Source::inline("s.toml", "[[entity]]\nname = \"tree\"\nmesh = { file = \"a.obj\" }\n");
    let mut loads = Loads {
        source,
        data: vec![folder.path().to_owned()],
        exact: false,
        most_bytes: Some(1 << 20),
    };
    let refused = load_keeping(&loads, &[], &mut Kept::default()).err().unwrap();
    assert!(matches!(refused, crate::error::Error::Memory { .. }), "{refused}");
    loads.most_bytes = Some(1 << 28);
    let mut kept = Kept::default();
    let mut scene = load_keeping(&loads, &[], &mut kept).unwrap();
    let before: OwnTextures = only(&scene.world);
    std::fs::remove_file(folder.path().join("bark.png")).unwrap();
    scene.restate(&loads, &["tree.surface.ambient=0.5".to_owned()], &mut kept).unwrap();
    assert_eq!(only::<OwnTextures>(&scene.world), before);
    assert!(
        loaded("[[entity]]\nmesh = { ellipsoid = { center = [0, 0, 0], radii = [1, 1, 1] } }", &[])
            .is_ok()
    );
}
