//! Facts about materials that are seen through: how opaque the triangles are that are made of them.

use super::materials::{OBJ, USES_IT_TOO, folder, glb, looks};
use super::read;
use crate::formats::made::base64;
use crate::formats::meshes::{PictureAlpha, Triangles, read_mesh};

#[test]
fn a_primitive_without_a_picture_is_as_opaque_as_its_factor_where_that_blends() {
    let opacities = |more: &str| {
        let second =
            format!(r#"{{"pbrMetallicRoughness":{{"baseColorFactor":[1,1,1,0.25]}}{more}}}"#);
        let mesh = read("a.glb", &glb(&looks("", &second))).unwrap();
        let about = mesh.warnings.iter().filter(|warning| warning.contains("seen through"));
        assert_eq!(about.count(), 0, "{:?}", mesh.warnings);
        mesh.opacities
    };
    assert!(opacities("").is_empty(), "what is opaque needs no number");
    assert_eq!(opacities(r#","alphaMode":"BLEND""#), [1.0, 0.25]);
    assert_eq!(opacities(r#","alphaMode":"MASK""#), [1.0, 0.0]);
    assert!(opacities(r#","alphaMode":"MASK","alphaCutoff":0.2"#).is_empty());
}

#[test]
fn the_factor_counts_once_where_a_picture_has_it() {
    let second = USES_IT_TOO.replacen('{', r#"{"alphaMode":"BLEND","#, 1);
    let second = second.replace(r#"{"baseColorT"#, r#"{"baseColorFactor":[1,1,1,0.5],"baseColorT"#);
    let mesh = read("a.glb", &glb(&looks("", &second))).unwrap();
    assert!(mesh.opacities.is_empty() && mesh.pictures[1].alpha == PictureAlpha::Opacity(0.5));
    // One that cannot be had has none.
    let gone = looks("", &second).replace("data:image/png;base64,", "https://a.b/");
    assert_eq!(read("a.glb", &glb(&gone)).unwrap().opacities, [1.0, 0.5]);
}

#[test]
fn triangles_of_an_obj_are_as_opaque_as_their_materials() {
    let mesh = |mtl: &str| {
        let folder = folder(OBJ, Some(mtl));
        read_mesh(&folder.path().join("a.obj")).unwrap()
    };
    assert!(mesh("newmtl bark\nd 1\nnewmtl dark red\nKd 1 0 0\n").opacities.is_empty());
    let clear = mesh("newmtl bark\nTr 0.75\nmap_Kd a.png\nmap_d a.png\nnewmtl dark red\nd 0.5\n");
    assert_eq!(clear.opacities, [1.0, 0.5, 0.25]);
    // The alpha of the picture is beside that.
    assert_eq!(clear.pictures[0].alpha, PictureAlpha::Opacity(1.0));
    assert!(clear.warnings.is_empty(), "{:?}", clear.warnings);
}

/// Two triangles of four vertices of those alphas, whose material has these looks beside a factor.
fn with_alphas(alphas: [f32; 4], looks: &str) -> Triangles {
    let points = [[0.0, 0.0, 0.0_f32], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mut numbers = points.concat();
    for alpha in alphas {
        numbers.extend([1.0, 0.5, 0.25, alpha]);
    }
    // Vertices before, so that numbers of them are not those within the primitive.
    numbers.extend(points.concat());
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let accessor = |at: usize, shape: &str| {
        format!(
            r#"{{"bufferView":0,"byteOffset":{at},"componentType":5126,"count":4,"type":"{shape}"}}"#
        )
    };
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[1,1,1,0.8]}}{looks}}}],"buffers":[{{"uri":"data:;base64,{}","byteLength":{length}}}],"bufferViews":[{{"buffer":0,"byteLength":{length}}}],"accessors":[{},{},{}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":2}},"mode":5}},{{"attributes":{{"POSITION":0,"COLOR_0":1}},"material":0,"mode":5}}]}}]}}"#,
        base64(&bytes),
        accessor(0, "VEC3"),
        accessor(48, "VEC4"),
        accessor(112, "VEC3"),
        length = bytes.len(),
    );
    read("a.gltf", text.as_bytes()).unwrap()
}

#[test]
fn a_triangle_of_a_gltf_is_as_opaque_as_the_mean_of_its_vertices_where_that_blends() {
    let alphas = [1.0, 0.5, 0.0, 0.25];
    let near = |mesh: &Triangles, expected: [f32; 4]| {
        let found = &mesh.opacities;
        found.len() == 4 && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6)
    };
    let blended = with_alphas(alphas, r#","alphaMode":"BLEND""#);
    assert!(near(&blended, [1.0, 1.0, 0.4, 0.2]), "{:?}", blended.opacities);
    assert!(blended.warnings.is_empty(), "{:?}", blended.warnings);
    assert!(blended.color(2).unwrap().0.abs_diff_eq(glam::Vec3::new(1.0, 0.5, 0.25), 1e-6));
    let cut =
        |least: f32| with_alphas(alphas, &format!(r#","alphaMode":"MASK","alphaCutoff":{least}"#));
    assert!(near(&cut(0.3), [1.0, 1.0, 1.0, 0.0]), "{:?}", cut(0.3).opacities);
    assert!(cut(0.1).opacities.is_empty() && cut(0.5).opacities == [1.0, 1.0, 0.0, 0.0]);
    assert!(with_alphas(alphas, "").opacities.is_empty(), "what is stated opaque ignores alpha");
    // What is no number, or more than all there is, is opaque.
    let odd = with_alphas([f32::NAN, 7.0, -1.0, 1.0], r#","alphaMode":"BLEND""#);
    assert!(near(&odd, [1.0, 1.0, 0.8 * 2.0 / 3.0, 0.8 * 2.0 / 3.0]), "{:?}", odd.opacities);
}

#[test]
fn a_picture_of_opacity_is_beside_that_of_color_or_alone() {
    let mesh = |mtl: &str| {
        let folder = folder(OBJ, Some(mtl));
        read_mesh(&folder.path().join("a.obj")).unwrap()
    };
    let mesh = mesh(
        "newmtl bark\nmap_Kd a.png\nmap_d holes.png\nnewmtl dark red\nKd 0.5 0 0\nmap_d -clamp on holes.png\n",
    );
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    let [alone, beside] = [1, 2].map(|at| &mesh.pictures[mesh.picture(at).unwrap() as usize]);
    assert_eq!(
        (&alone.name[..], alone.alpha, &alone.veil),
        ("holes.png", PictureAlpha::Veil, &None)
    );
    assert_eq!((&beside.name[..], beside.alpha), ("a.png", PictureAlpha::Ignored));
    let veil = beside.veil.as_ref().unwrap();
    assert_eq!((&veil.name[..], veil.alpha), ("holes.png", PictureAlpha::Veil));
    assert!(mesh.color(1).unwrap().0.abs_diff_eq(glam::Vec3::new(0.214, 0.0, 0.0), 1e-3));
}
