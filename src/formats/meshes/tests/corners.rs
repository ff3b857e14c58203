//! Facts about what files state at the corners of triangles: normals, and places in a texture.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::read;
use crate::formats::made::base64;

/// A triangle whose corners have these normals and places, in every format that has them.
const NORMALS: [DVec3; 3] = [DVec3::Z, DVec3::X, DVec3::Y];
const PLACES: [DVec2; 3] = [DVec2::ZERO, DVec2::X, DVec2::new(0.0, 0.25)];

fn gltf(node: &str) -> String {
    let numbers = [
        0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0., 0.,
        0.25_f32,
    ];
    let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    let uri = base64(&bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0{node}}}],"buffers":[{{"uri":"data:;base64,{uri}","byteLength":96}}],"bufferViews":[{{"buffer":0,"byteLength":96}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},{{"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"}},{{"bufferView":0,"byteOffset":72,"componentType":5126,"count":3,"type":"VEC2"}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}}}}]}}]}}"#
    )
}

fn vtp() -> String {
    let array = |kind: &str, name: &str, width: usize, text: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{width}\" format=\"ascii\">{text}</DataArray>"
        )
    };
    format!(
        "<VTKFile><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><PointData Normals=\"n\" TCoords=\"t\">{}{}</PointData><Points>{}</Points><Polys>{}{}</Polys></Piece></PolyData></VTKFile>",
        array("Float32", "n", 3, "0 0 1 1 0 0 0 1 0"),
        array("Float32", "t", 2, "0 1 1 1 0 0.75"),
        array("Float32", "p", 3, "0 0 0 1 0 0 0 1 0"),
        array("Int32", "connectivity", 1, "0 1 2"),
        array("Int32", "offsets", 1, "3"),
    )
}

/// A file of each format that has them.
fn files() -> [(&'static str, String); 6] {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nvt 0 .75\nvt 0 1\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\nf 1/3/3 2/1/1 -1/-2/-2\n";
    let floats =
        |names: &str| format!("property float {}\n", names.replace(' ', "\nproperty float "));
    let ply = |vertex: &str, face: &str, rows: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\n{}element face 1\nproperty list uchar int vertex_indices\n{face}end_header\n{rows}",
            floats(vertex)
        )
    };
    let of_vertices = ply(
        "x y z nx ny nz s t",
        "",
        "0 0 0 0 0 1 0 1\n1 0 0 1 0 0 1 1\n0 1 0 0 1 0 0 0.75\n3 0 1 2\n",
    );
    let of_faces = ply(
        "x y z nx ny nz",
        "property list uchar float texcoord\n",
        "0 0 0 0 0 1\n1 0 0 1 0 0\n0 1 0 0 1 0\n3 0 1 2 6 0 1 1 1 0 0.75\n",
    );
    let vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\nCELL_DATA 1\nNORMALS m float\n1 1 1\nFIELD f 2\na 2 1 int\n1 2\nb 1 1 vtkIdType\n3\nPOINT_DATA 3\nSCALARS s int\nLOOKUP_TABLE default\n1 2 3\nSCALARS r unsigned_char 2\nLOOKUP_TABLE l\n1 2 3 4 5 6\nLOOKUP_TABLE l 1\n0 0 0 1\nNORMALS n float\n0 0 1 1 0 0 0 1 0\nTEXTURE_COORDINATES t 2 double\n0 1 1 1 0 .75\nFIELD f 1\na 1 3 float\n1 2 3\n";
    [
        ("a.obj", obj.to_owned()),
        ("a.ply", of_vertices),
        ("b.ply", of_faces),
        ("a.gltf", gltf("")),
        ("a.vtp", vtp()),
        ("a.vtk", vtk.to_owned()),
    ]
}

#[test]
fn normals_and_places_are_the_same_in_every_format() {
    for (name, text) in files() {
        let mesh = read(name, text.as_bytes()).unwrap();
        assert_eq!(mesh.normals.of(0, mesh.faces[0]), Some(NORMALS), "{name}");
        assert_eq!(mesh.places.of(0, mesh.faces[0]), Some(PLACES), "{name}");
        assert!(mesh.warnings.is_empty(), "{name}: {:?}", mesh.warnings);
    }
}

/// Reads the bytes, and what is at the corners of what comes out, if anything.
fn read_all(name: &str, bytes: &[u8]) {
    if let Ok(mesh) = read(name, bytes) {
        for (at, face) in mesh.faces.iter().enumerate() {
            let _ = (mesh.normals.of(at, *face), mesh.places.of(at, *face));
        }
        assert!(mesh.normals.values.len() + mesh.places.values.len() <= bytes.len());
    }
}

#[test]
fn no_part_of_a_file_is_more_than_it_is() {
    for (name, text) in files() {
        (0..text.len()).for_each(|length| read_all(name, &text.as_bytes()[..length]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn changed_bytes_never_panic(
        file in 0..6_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let (name, text) = files()[file].clone();
        let mut bytes = text.into_bytes();
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        read_all(name, &bytes);
    }
}

#[test]
fn colors_of_points_in_older_vtk_files_are_read() {
    let text = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\nPOINT_DATA 3\nCOLOR_SCALARS c 3\n1 0 0 1 0 0 1 0 0\n";
    let mesh = read("a.vtk", text.as_bytes()).unwrap();
    assert_eq!(mesh.color(0).unwrap().0, glam::Vec3::X);
}

#[test]
fn corners_without_a_normal_leave_their_triangle_without() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 2//1 4 3//1\nf 2//1 4//7 3//1\n";
    let mesh = read("a.obj", text.as_bytes()).unwrap();
    let own = |at: usize| mesh.normals.of(at, mesh.faces[at]);
    assert_eq!([own(0), own(1), own(2)], [Some([DVec3::Z; 3]), None, None]);
    assert_eq!(mesh.places.of(0, mesh.faces[0]), None);
}

#[test]
fn normals_stand_on_what_a_node_stretches_and_turns() {
    let node = r#","scale":[2,1,4],"rotation":[0.7071067811865476,0,0,0.7071067811865476]"#;
    let mesh = read("a.gltf", gltf(node).as_bytes()).unwrap();
    let [z, x, y] = mesh.normals.of(0, mesh.faces[0]).unwrap().map(DVec3::normalize);
    // A quarter turn about x: y becomes z, and z the other way of y.
    assert!(z.abs_diff_eq(-DVec3::Y, 1e-12) && x.abs_diff_eq(DVec3::X, 1e-12));
    assert!(y.abs_diff_eq(DVec3::Z, 1e-12));
}

#[test]
fn normals_of_what_a_node_mirrors_stay_outside() {
    let mesh = read("a.gltf", gltf(r#","scale":[-3,1,1]"#).as_bytes()).unwrap();
    let [z, y, x] = mesh.normals.of(0, mesh.faces[0]).unwrap().map(DVec3::normalize);
    // The triangle runs the other way around, and still to +z.
    assert_eq!((mesh.faces[0], z, y, x), ([0, 2, 1], DVec3::Z, DVec3::Y, -DVec3::X));
}

#[test]
fn what_follows_the_points_of_an_older_vtk_file_may_be_damaged() {
    let text = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\nPOINT_DATA 3\nNORMALS n float\n0 0 1 1\n";
    let mesh = read("a.vtk", text.as_bytes()).unwrap();
    assert!(mesh.normals.values.is_empty());
    assert!(mesh.warnings[0].contains("of its points is left out"), "{:?}", mesh.warnings);
}
