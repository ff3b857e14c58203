//! Facts about pictures that materials of an OBJ scale and shift, and about files of materials that cannot be read.

use glam::DVec2;

use super::materials::{OBJ, folder};
use crate::formats::meshes::{Triangles, read_mesh};

fn mesh(obj: &str, mtl: &str) -> Triangles {
    let folder = folder(obj, Some(mtl));
    read_mesh(&folder.path().join("a.obj")).unwrap()
}

/// Where the corners of a triangle lie in its picture, v running up.
fn upward(mesh: &Triangles, at: usize) -> [DVec2; 3] {
    let places = mesh.places.of(at, mesh.faces[at]).unwrap();
    places.map(|place| DVec2::new(place.x, 1.0 - place.y))
}

#[test]
fn a_picture_is_scaled_and_then_shifted_on_the_triangles_of_its_material_alone() {
    let mtl = "newmtl bark\nmap_Kd -s 2 4 -o 0.5 0.25 a.png\nnewmtl dark red\nmap_Kd -o 1 b.png\n";
    let found = mesh(OBJ, mtl);
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let plain = [DVec2::ZERO, DVec2::X, DVec2::Y];
    assert_eq!(upward(&found, 0), plain);
    assert_eq!(upward(&found, 1), plain.map(|uv| uv + DVec2::X));
    let there = |uv: DVec2| uv * DVec2::new(2.0, 4.0) + DVec2::new(0.5, 0.25);
    assert_eq!(upward(&found, 2), plain.map(there));
}

#[test]
fn places_are_kept_once_for_each_way_that_they_are_moved() {
    let many = OBJ.to_owned() + &"f 1/1 2/2 3/3\n".repeat(100);
    let found = mesh(&many, "newmtl bark\nmap_Kd -s 2 2 a.png\nnewmtl dark red\nmap_Kd a.png\n");
    assert_eq!([found.places.values.len(), found.faces.len()], [6, 103]);
    // And without places nothing is moved.
    let bare = OBJ.replace("vt 0 0\nvt 1 0\nvt 0 1\n", "");
    assert!(mesh(&bare, "newmtl bark\nmap_Kd -s 2 a.png\n").places.values.is_empty());
}

#[test]
fn a_file_of_materials_that_is_there_and_cannot_be_read_is_told_with_its_reason() {
    let said = |make: &dyn Fn(&std::path::Path)| {
        let folder = folder(OBJ, None);
        let one = OBJ.replace("two words.mtl", "materials.mtl");
        make(&folder.path().join("materials.mtl"));
        std::fs::write(folder.path().join("a.obj"), one).unwrap();
        read_mesh(&folder.path().join("a.obj")).unwrap().warnings
    };
    let folder = said(&|path| std::fs::create_dir(path).unwrap());
    assert!(folder.len() == 1 && folder[0].contains("materials.mtl is a folder"), "{folder:?}");
    #[cfg(unix)]
    {
        let circle = said(&|path| std::os::unix::fs::symlink(path, path).unwrap());
        assert!(circle.len() == 1 && !circle[0].contains("not there"), "{circle:?}");
        assert!(circle[0].contains("cannot be read (") && circle[0].contains("os error"));
    }
}
