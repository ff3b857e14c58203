//! Facts about meshes: the same tetrahedron in every format, and files that are not what they say.

use proptest::prelude::*;

use glam::DVec3;

use super::*;

const POINTS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
const SIDES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn lines(rows: impl Iterator<Item = String>) -> String {
    rows.map(|row| row + "\n").collect()
}

fn row(numbers: &[f32]) -> String {
    numbers.iter().map(f32::to_string).collect::<Vec<_>>().join(" ")
}

/// The tetrahedron, by format and name.
fn sound() -> Vec<(&'static str, Vec<u8>)> {
    let corners = |side: &[usize; 3]| side.map(|at| POINTS[at]);
    let mut binary = [vec![b' '; 80], 4_u32.to_le_bytes().to_vec()].concat();
    for side in &SIDES {
        let numbers = [[0.0; 3]].into_iter().chain(corners(side)).flatten();
        binary.extend(numbers.flat_map(f32::to_le_bytes));
        binary.extend([0, 0]);
    }
    let facet = |side: &[usize; 3]| {
        let vertices = lines(corners(side).iter().map(|point| format!("vertex {}", row(point))));
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet")
    };
    let text = format!("solid x\n{}endsolid x\n", lines(SIDES.iter().map(facet)));
    let obj = lines(POINTS.iter().map(|point| format!("v {}", row(point))))
        + "vn 0 0 1\nf 1/1 3/2 2/3\nf 1//1 2//1 4//1\nf -4 -1 -2\nf 2 3 4\n";
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let ply_text = header("ascii")
        + &lines(POINTS.iter().map(|point| format!("{} 255", row(point))))
        + &lines(SIDES.iter().map(|[a, b, c]| format!("3 {a} {b} {c}")));
    let ply = |big: bool| {
        let float = |n: f32| if big { n.to_be_bytes() } else { n.to_le_bytes() };
        let int = |n: usize| if big { (n as u32).to_be_bytes() } else { (n as u32).to_le_bytes() };
        let mut bytes =
            header(if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
        for point in POINTS {
            bytes.extend(point.into_iter().flat_map(float).chain([255]));
        }
        for side in SIDES {
            bytes.extend([3].into_iter().chain(side.into_iter().flat_map(int)));
        }
        bytes
    };
    vec![
        ("a.stl", binary),
        ("b.stl", text.into_bytes()),
        ("c.obj", obj.into_bytes()),
        ("d.ply", ply_text.into_bytes()),
        ("e.ply", ply(false)),
        ("f.ply", ply(true)),
    ]
}

fn read(name: &str, bytes: &[u8]) -> Result<Triangles, String> {
    let format = mesh_format(Path::new(name)).unwrap();
    (format.read)(bytes).and_then(checked)
}

#[test]
fn a_tetrahedron_is_the_same_in_every_format() {
    for (name, bytes) in sound() {
        let mesh = read(name, &bytes).unwrap();
        let corners = mesh.faces.iter().map(|face| face.map(|at| mesh.vertices[at as usize]));
        let expected = SIDES.map(|side| side.map(|at| DVec3::from(POINTS[at].map(f64::from))));
        assert_eq!(corners.collect::<Vec<_>>(), expected, "{name}");
        assert!(mesh.warnings.is_empty(), "{name} {:?}", mesh.warnings);
    }
}

#[test]
fn a_square_is_two_triangles_and_that_is_said() {
    let mesh = read("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
    assert_eq!(mesh.faces, [[0, 1, 2], [0, 2, 3]]);
    assert!(mesh.warnings[0].contains("1 of its polygons"));
}

#[test]
fn what_is_wrong_is_said() {
    for (name, bytes, said) in [
        ("a.obj", &b"v 0 0 0\nf 1 2 3\n"[..], "line 2"),
        ("a.obj", b"v 0 0\n", "line 1"),
        ("a.obj", b"v 0 0 0\n", "no face"),
        ("a.obj", b"v 0 0 nan\nv 1 1 1\nv 1 1 2\nf 1 2 3\n", "not finite"),
        ("a.stl", b"solid x\nvertex 1 2\n", "line 2"),
        ("a.stl", b"hello", "truncated"),
        ("a.ply", b"hello\n", "`ply`"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n0\n", "truncated"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_index\nend_header\n3 0 1 2\n", "beyond"),
    ] {
        let problem = read(name, bytes).unwrap_err();
        assert!(problem.contains(said), "{problem}");
    }
}

/// Reads the bytes; what comes out, if anything, names vertices that there are, no more than the bytes could hold.
fn consistent(name: &str, bytes: &[u8]) {
    if let Ok(mesh) = read(name, bytes) {
        assert!(mesh.faces.len() + mesh.vertices.len() <= bytes.len());
    }
}

#[test]
fn no_part_of_a_file_is_more_than_it_is() {
    for (name, bytes) in sound() {
        (0..bytes.len()).for_each(|length| consistent(name, &bytes[..length]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn changed_bytes_never_panic(
        file in 0..6_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let (name, mut bytes) = sound().swap_remove(file);
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        consistent(name, &bytes);
    }
}

#[test]
fn triangles_have_the_mean_of_the_colors_of_their_vertices() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        read_mesh(&path).unwrap()
    };
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 255 255\n3 0 1 2\n";
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 1 1\nf 1 2 3\n";
    for triangles in [read("a.ply", ply), read("a.obj", obj)] {
        let color = triangles.color(triangles.faces[0]).unwrap().0;
        assert!(color.abs_diff_eq(glam::Vec3::new(1.0, 2.0, 1.0) / 3.0, 1e-6), "{color}");
    }
    let partly = read("b.obj", "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 1 1\nf 1 2 3\n");
    assert!(partly.colors.is_empty() && partly.warnings[0].contains("no color"));
}
