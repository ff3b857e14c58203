//! Facts about the materials of files: the pictures and colors that they lay on triangles.

use std::path::PathBuf;

use glam::{DVec2, Vec3};
use proptest::prelude::*;

use super::read;
use crate::components::Wrap;
use crate::formats::made::base64;
use crate::formats::meshes::{PictureAlpha, PicturePlace, Triangles, read_mesh};
use crate::formats::pictures::png_bytes;
use crate::view::picture::Picture;

/// A PNG of one pixel of that red.
fn pixel(red: f32) -> Vec<u8> {
    png_bytes(&Picture::new([1, 1], vec![[red, 0.0, 0.0, 1.0]]).unwrap(), &[]).unwrap()
}

/// A `.glb` of two primitives of the same triangle; the buffer's view 1 is a picture.
pub(super) fn glb(looks: &str) -> Vec<u8> {
    let numbers =
        [0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0.25, 9., 9., 9., 9., 9., 9_f32];
    let mut buffer: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    let (start, picture) = (buffer.len(), pixel(1.0));
    buffer.extend(&picture);
    let accessor = |at: usize, shape: &str| {
        format!(
            r#"{{"bufferView":0,"byteOffset":{at},"componentType":5126,"count":3,"type":"{shape}"}}"#
        )
    };
    let accessors = [accessor(0, "VEC3"), accessor(36, "VEC2"), accessor(60, "VEC2")].join(",");
    let primitive = |material: usize| {
        format!(
            r#"{{"attributes":{{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2}},"material":{material}}}"#
        )
    };
    let mut text = format!(
        r#"{{"asset":{{"version":"2.0"}},{looks},"buffers":[{{"byteLength":{}}}],"bufferViews":[{{"buffer":0,"byteLength":{start}}},{{"buffer":0,"byteOffset":{start},"byteLength":{}}}],"accessors":[{accessors}],"meshes":[{{"primitives":[{},{}]}}]}}"#,
        buffer.len(),
        picture.len(),
        primitive(0),
        primitive(1),
    );
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let length = |n: usize| (n as u32).to_le_bytes();
    let head = [*b"glTF", [2, 0, 0, 0], length(28 + text.len() + buffer.len())].concat();
    let chunks =
        [&length(text.len()), b"JSON", text.as_bytes(), &length(buffer.len()), b"BIN\0", &buffer];
    [head, chunks.concat()].concat()
}

/// Looks of a first material that uses texture 0 with more said, and a second.
pub(super) fn looks(more: &str, second: &str) -> String {
    format!(
        r#""materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0{more}}}}}}},{second}],"textures":[{{"source":0}},{{"source":1,"sampler":0}}],"samplers":[{{"wrapS":33071,"wrapT":33071}}],"images":[{{"bufferView":1,"mimeType":"image/png"}},{{"uri":"data:image/png;base64,{}"}}]"#,
        base64(&pixel(0.25))
    )
}

pub(super) const USES_IT_TOO: &str = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}"#;

fn red(mesh: &Triangles, at: usize) -> f32 {
    mesh.pictures[at].decoded().unwrap().pixels[0][0]
}

#[test]
fn each_primitive_has_the_picture_of_its_material() {
    let mesh = read("a.glb", &glb(&looks("", USES_IT_TOO))).unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_eq!([mesh.picture(0), mesh.picture(1), mesh.picture(2)], [Some(0), Some(1), None]);
    assert!((red(&mesh, 0) - 1.0).abs() < 1e-6 && (red(&mesh, 1) - 0.25).abs() < 2e-3);
    assert_eq!(
        [mesh.pictures[0].wrap, mesh.pictures[1].wrap],
        [[Wrap::Repeat; 2], [Wrap::Clamp; 2]]
    );
    let mirrored = looks("", USES_IT_TOO).replace("33071", "33648");
    assert_eq!(read("a.glb", &glb(&mirrored)).unwrap().pictures[1].wrap, [Wrap::Mirror; 2]);
    let unlike = looks("", USES_IT_TOO).replace("33071,", "33648,");
    let unlike = read("a.glb", &glb(&unlike)).unwrap();
    assert!(unlike.warnings.is_empty(), "{:?}", unlike.warnings);
    assert_eq!(unlike.pictures[1].wrap, [Wrap::Mirror, Wrap::Clamp]);
    assert_eq!(mesh.pictures[0].weighed().unwrap().0, [1, 1]);
    assert!(mesh.colors.is_empty(), "no factor is stated");
}

#[test]
fn a_primitive_without_a_picture_has_the_factor_of_its_material() {
    let second = r#"{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1]}}"#;
    let mesh = read("a.glb", &glb(&looks("", second))).unwrap();
    assert_eq!([mesh.picture(0), mesh.picture(1)], [Some(0), None]);
    assert_eq!(mesh.color(0).unwrap().0, Vec3::ONE);
    assert!(mesh.color(1).unwrap().0.abs_diff_eq(Vec3::new(0.5, 0.25, 1.0), 1e-6));
    assert!(mesh.warnings.len() == 1 && mesh.warnings[0].contains("1 of its pictures"));
}

#[test]
fn places_are_of_the_stated_set_and_moved_as_stated() {
    let place = |more: &str| {
        let mesh = read("a.glb", &glb(&looks(more, USES_IT_TOO))).unwrap();
        mesh.places.of(0, mesh.faces[0]).unwrap()
    };
    assert_eq!(place(""), [DVec2::ZERO, DVec2::X, DVec2::new(0.0, 0.25)]);
    assert_eq!(place(r#","texCoord":1"#), [DVec2::splat(9.0); 3]);
    let moved = |more: &str| format!(r#","extensions":{{"KHR_texture_transform":{{{more}}}}}"#);
    let scaled = place(&moved(r#""offset":[0.5,0],"scale":[2,4]"#));
    assert_eq!(scaled, [DVec2::new(0.5, 0.0), DVec2::new(2.5, 0.0), DVec2::new(0.5, 1.0)]);
    assert_eq!(place(&moved(r#""texCoord":1"#)), [DVec2::splat(9.0); 3]);
}

#[test]
fn alpha_counts_as_the_material_has_it() {
    let alpha = |more: &str| {
        let own = format!(
            r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}},"baseColorFactor":[1,1,1,0.5]}}{more}}}"#
        );
        let mesh = read("a.glb", &glb(&looks("", &own))).unwrap();
        // Pictures that differ in this are two, and those that do not are one.
        mesh.pictures.last().unwrap().alpha
    };
    assert_eq!(alpha(""), PictureAlpha::Ignored);
    assert_eq!(alpha(r#","alphaMode":"BLEND""#), PictureAlpha::Opacity(0.5));
    let cut = PictureAlpha::Cut { factor: 0.5, least: 0.5 };
    assert_eq!(alpha(r#","alphaMode":"MASK""#), cut);
    assert_eq!(alpha(r#","alphaMode":"MASK","alphaCutoff":0"#), PictureAlpha::Ignored);
}

#[test]
fn what_cannot_be_had_of_a_picture_is_a_sentence_and_leaves_the_triangles() {
    let other = |from: &str, to: &str| looks("", USES_IT_TOO).replace(from, to);
    let images = r#""bufferView":1"#;
    for (looks, said) in [
        (other(images, r#""bufferView":7"#), "outside its buffers"),
        (other(images, r#""uri":"https://a.b/c.png""#), "nothing is fetched"),
        (other(images, r#""uri":"data:image/png,abc""#), "no base64"),
        (other(images, r#""name":"bark""#), "picture bark is nowhere"),
        (other(r#""source":0"#, r#""source":5"#), "names picture 5"),
        (other(r#"{"source":0}"#, "{}"), "no format that is read"),
    ] {
        let mesh = read("a.glb", &glb(&looks)).unwrap();
        assert_eq!(mesh.faces.len(), 2);
        let about = mesh.warnings.iter().filter(|warning| warning.contains(said)).count();
        assert_eq!(about, 1, "{said}: {:?}", mesh.warnings);
    }
    let mesh = read("a.glb", &glb(&other(images, r#""uri":"no%20such.png""#))).unwrap();
    assert_eq!(mesh.pictures[0].place, PicturePlace::Beside(PathBuf::from("no such.png")));
    let problem = mesh.pictures[0].weighed().unwrap_err();
    assert!(problem.contains("not found") && problem.contains(';'), "{problem}");
}

#[test]
fn pictures_that_share_their_bytes_do_not_outgrow_the_file() {
    let uses: Vec<_> = (0..200).map(|at| format!(r#"{{"source":{at}}}"#)).collect();
    let images = vec![r#"{"bufferView":0}"#; 200].join(",");
    let materials: Vec<_> = (0..200)
        .map(|at| format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{at}}}}}}}"#))
        .collect();
    let nodes: Vec<_> = (0..200)
        .map(|at| format!(r#"{{"attributes":{{"POSITION":0}},"material":{at}}}"#))
        .collect();
    let zeros = base64(&vec![0; 1_000_000]);
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"materials":[{}],"textures":[{}],"images":[{images}],"buffers":[{{"uri":"data:;base64,{zeros}","byteLength":1000000}}],"bufferViews":[{{"buffer":0,"byteLength":1000000}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],"meshes":[{{"primitives":[{}]}}]}}"#,
        materials.join(","),
        uses.join(","),
        nodes.join(",")
    );
    let mesh = read("a.gltf", text.as_bytes()).unwrap();
    assert!(mesh.pictures.len() < 4 && mesh.warnings[0].contains("more than the file holds"));
}

/// A folder of an OBJ and its materials.
pub(super) fn folder(obj: &str, mtl: Option<&str>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.obj"), obj).unwrap();
    if let Some(mtl) = mtl {
        std::fs::write(folder.path().join("two words.mtl"), mtl).unwrap();
    }
    folder
}

pub(super) const OBJ: &str = "mtllib two words.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nusemtl dark red\nf 1/1 2/2 3/3\nusemtl bark\nf 1/1 2/2 3/3\n";

#[test]
fn triangles_of_an_obj_have_the_colors_and_pictures_of_their_materials() {
    let mtl =
        "newmtl bark\r\nmap_Kd C:\\of another\\bark 1.png\r\nnewmtl dark red\r\nKd 0.5 0 0\r\n";
    let folder = folder(OBJ, Some(mtl));
    std::fs::write(folder.path().join("bark 1.png"), pixel(0.25)).unwrap();
    let mesh = read_mesh(&folder.path().join("a.obj")).unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_eq!([0, 1, 2].map(|at| mesh.picture(at)), [None, None, Some(0)]);
    let colors = [0, 1, 2].map(|at| mesh.color(at).unwrap().0);
    assert!(colors[0] == Vec3::ONE && colors[2] == Vec3::ONE);
    assert!(colors[1].abs_diff_eq(Vec3::new(0.214, 0.0, 0.0), 1e-3), "{}", colors[1]);
    assert!((red(&mesh, 0) - 0.25).abs() < 2e-3);
    assert_eq!(mesh.beside, [folder.path().join("two words.mtl")]);
}

#[test]
fn what_an_obj_names_and_is_not_there_or_not_read_is_one_sentence_each() {
    let said = |obj: &str, mtl: Option<&str>| {
        let folder = folder(obj, mtl);
        read_mesh(&folder.path().join("a.obj")).unwrap().warnings
    };
    let missing = said(&OBJ.replace("two words", "no"), None);
    assert!(missing.len() == 1 && missing[0].contains("no.mtl is not there"), "{missing:?}");
    let unknown = said(OBJ, Some("newmtl bark\nKd 1 1 1\n"));
    assert!(unknown.len() == 1 && unknown[0].contains("1 of its materials are in no file"));
    let clear =
        "newmtl bark\nd 0\nnewmtl dark red\nTr 1\nmap_d -s 2 2 a.png\nmap_Kd -t 2 2 b.png\n";
    let clear = said(OBJ, Some(clear));
    assert!(clear.len() == 4, "{clear:?}");
    assert!(clear[0].contains("turbulence") && clear[1].contains("as those of `map_Kd`"));
    assert!(clear[2].contains("1 of its materials are wholly clear (`d` is 0)"));
    assert!(clear[3].contains("clear by `Tr 1` without a `d`") && clear[3].contains("write `d 1`"));
    let many: Vec<_> = (0..70).map(|at| format!("mtllib {at}.mtl\n")).collect();
    let many = said(&(many.concat() + OBJ), Some(""));
    assert!(many.iter().any(|warning| warning.contains("more than 64")), "{many:?}");
}

#[test]
fn the_alpha_of_a_picture_counts_where_it_is_named_as_that_of_opacity() {
    let alpha = |more: &str| {
        let folder =
            folder(OBJ, Some(&format!("newmtl bark\nmap_Kd a.png\n{more}newmtl dark red\n")));
        read_mesh(&folder.path().join("a.obj")).unwrap().pictures[0].alpha
    };
    assert_eq!(alpha(""), PictureAlpha::Ignored);
    assert_eq!(alpha("map_d a.png\n"), PictureAlpha::Opacity(1.0));
}

#[test]
fn colors_of_vertices_come_before_those_of_materials() {
    let obj =
        OBJ.replace("v 0 0 0\nv 1 0 0\nv 0 1 0", "v 0 0 0 0 1 0\nv 1 0 0 0 1 0\nv 0 1 0 0 1 0");
    let folder = folder(&obj, Some("newmtl bark\nnewmtl dark red\nKd 1 0 0\n"));
    let mesh = read_mesh(&folder.path().join("a.obj")).unwrap();
    assert_eq!(mesh.color(1).unwrap().0, Vec3::Y);
}

/// Reads the bytes; pictures of what comes out, if anything, are decoded or are not.
fn read_all(bytes: &[u8]) {
    if let Ok(mesh) = read("a.glb", bytes) {
        let held = |place: &PicturePlace| match place {
            PicturePlace::Within(bytes) => bytes.len(),
            PicturePlace::Beside(_) => 0,
        };
        assert!(mesh.pictures.iter().map(|own| held(&own.place)).sum::<usize>() <= bytes.len());
        for at in 0..mesh.faces.len() {
            let _ = (mesh.picture(at), mesh.color(at));
        }
        for own in &mesh.pictures {
            let small = own.weighed().is_ok_and(|(_, weight)| weight.kept < 1 << 20);
            let _ = small.then(|| own.decoded());
        }
    }
}

#[test]
fn no_part_of_a_pictured_file_is_more_than_it_is() {
    let bytes = glb(&looks("", USES_IT_TOO));
    (0..bytes.len()).for_each(|length| read_all(&bytes[..length]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn changed_bytes_of_a_pictured_file_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let second = r#"{"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5],"baseColorTexture":{"index":1,"texCoord":1,"extensions":{"KHR_texture_transform":{"rotation":1,"scale":[2,2]}}}}}"#;
        let mut bytes = glb(&looks("", second));
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        read_all(&bytes);
    }
}
