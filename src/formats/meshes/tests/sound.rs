//! One sound file of each format of meshes, all of the same tetrahedron.

use crate::formats::made::{base64, zlib};

pub(super) const POINTS: [[f32; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
pub(super) const SIDES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn lines(rows: impl Iterator<Item = String>) -> String {
    rows.map(|row| row + "\n").collect()
}

fn row(numbers: &[f32]) -> String {
    numbers.iter().map(f32::to_string).collect::<Vec<_>>().join(" ")
}

/// The tetrahedron, by format and name.
pub(super) fn sound() -> Vec<(&'static str, Vec<u8>)> {
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
        ("g.gltf", gltf()),
        ("h.glb", glb("\"nodes\":[{\"mesh\":0}]", "\"scene\":0")),
        ("i.vtp", vtp("ascii")),
        ("j.vtp", vtp("binary")),
        ("k.vtp", vtp("appended")),
        ("l.vtk", vtk(false, false)),
        ("m.vtk", vtk(false, true)),
        ("n.vtk", vtk(true, false)),
    ]
}

/// The points as floats, and the corners of the sides as numbers of 16 bits.
fn buffer() -> Vec<u8> {
    let points = POINTS.iter().flatten().flat_map(|n| n.to_le_bytes());
    points.chain(SIDES.iter().flatten().flat_map(|n| (*n as u16).to_le_bytes())).collect()
}

/// The JSON of a glTF of that buffer; `more` are members of the whole.
fn json(uri: &str, nodes: &str, more: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},{nodes},{more},"buffers":[{{{uri}"byteLength":72}}],"bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":24}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},{{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}]}}"#
    )
}

fn gltf() -> Vec<u8> {
    let uri = format!(r#""uri":"data:application/octet-stream;base64,{}","#, base64(&buffer()));
    json(&uri, r#""nodes":[{"mesh":0}]"#, r#""scenes":[{"nodes":[0]}]"#).into_bytes()
}

pub(super) fn glb(nodes: &str, more: &str) -> Vec<u8> {
    let mut text = json("", nodes, more);
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let binary = buffer();
    let length = |n: usize| (n as u32).to_le_bytes();
    let all = length(12 + 8 + text.len() + 8 + binary.len());
    let head = [*b"glTF", [2, 0, 0, 0], all].concat();
    let chunks =
        [&length(text.len()), b"JSON", text.as_bytes(), &length(binary.len()), b"BIN\0", &binary];
    [head, chunks.concat()].concat()
}

/// A `.vtp`, its arrays as text, as base64, or packed by zlib at the end.
fn vtp(format: &str) -> Vec<u8> {
    let points = POINTS.iter().flatten().flat_map(|n| n.to_le_bytes()).collect();
    let corners = SIDES.iter().flatten().flat_map(|n| (*n as i64).to_le_bytes()).collect();
    let ends = [3_i64, 6, 9, 12].iter().flat_map(|n| n.to_le_bytes()).collect();
    let texts = [
        POINTS.map(|point| row(&point)).join(" "),
        SIDES.map(|side| side.map(|n| n.to_string()).join(" ")).join("\n"),
        "3 6 9 12".to_owned(),
    ];
    let raw: [Vec<u8>; 3] = [points, corners, ends];
    let mut appended = Vec::new();
    let mut array = |at: usize, kind: &str, name: &str| {
        let bytes = &raw[at];
        let (more, inner) = match format {
            "ascii" => (String::new(), texts[at].clone()),
            "binary" => {
                let all = [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat();
                (String::new(), base64(&all))
            }
            _ => {
                let offset = appended.len();
                let packed = zlib(bytes);
                let table = [1, bytes.len(), 0, packed.len()].map(|n| (n as u32).to_le_bytes());
                appended.extend([table.concat(), packed].concat());
                (format!(" offset=\"{offset}\""), String::new())
            }
        };
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"{format}\"{more}>{inner}</DataArray>\n"
        )
    };
    let [points, corners, ends] = [
        array(0, "Float32", "Points"),
        array(1, "Int64", "connectivity"),
        array(2, "Int64", "offsets"),
    ];
    let packed = if format == "appended" { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
    let text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt32\"{packed}>\n<PolyData>\n<Piece NumberOfPoints=\"4\" NumberOfPolys=\"4\">\n<Points>{points}</Points>\n<Polys>{corners}{ends}</Polys>\n</Piece>\n</PolyData>\n"
    );
    let end: &[u8] = b"</AppendedData></VTKFile>\n";
    [text.as_bytes(), b"<AppendedData encoding=\"raw\">\n_", &appended, end].concat()
}

/// A `.vtk`, binary or text, of the newer version that has offsets or the older.
fn vtk(binary: bool, newer: bool) -> Vec<u8> {
    let numbers = |floats: &[f32], ints: &[i32]| -> Vec<u8> {
        if binary {
            let ints = ints.iter().flat_map(|n| n.to_be_bytes());
            return floats.iter().flat_map(|n| n.to_be_bytes()).chain(ints).collect();
        }
        let words = floats.iter().map(f32::to_string).chain(ints.iter().map(i32::to_string));
        words.collect::<Vec<_>>().join(" ").into_bytes()
    };
    let head = format!(
        "# vtk DataFile Version 4.2\nx\n{}\nDATASET POLYDATA\nPOINTS 4 float\n",
        if binary { "BINARY" } else { "ASCII" }
    );
    let points = numbers(POINTS.as_flattened(), &[]);
    let corners = SIDES.map(|side| side.map(|n| n as i32));
    let polygons = if newer {
        let ends = numbers(&[], &[0, 3, 6, 9, 12]);
        let corners = numbers(&[], corners.as_flattened());
        let names = [&b"\nPOLYGONS 5 12\nOFFSETS int\n"[..], b"\nCONNECTIVITY int\n"];
        [names[0], &ends, names[1], &corners].concat()
    } else {
        let counted = corners.map(|[a, b, c]| [3, a, b, c]);
        [b"\nPOLYGONS 4 16\n", &numbers(&[], counted.as_flattened())[..]].concat()
    };
    [head.as_bytes(), &points, b"\nMETADATA\nINFORMATION 0\n\n", &polygons, b"\nPOINT_DATA 4\nx"]
        .concat()
}
