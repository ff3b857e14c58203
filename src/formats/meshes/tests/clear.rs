//! Facts about materials that are seen through: how opaque the triangles are that are made of them.

use super::materials::{OBJ, USES_IT_TOO, folder, glb, looks};
use super::read;
use crate::formats::meshes::{PictureAlpha, read_mesh};

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
