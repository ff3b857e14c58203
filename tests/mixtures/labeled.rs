//! Labels of a segmentation, by themselves and over another volume; and molecules, whose faces have colors of their own.

use std::path::PathBuf;

use gelray::scene::{Source, load};

use crate::{EVERY_PIXEL, at, difference, gel, made, run, stated, view};

/// A folder with labels on 32³ voxels of 2 world units around the origin: 1 where x is below 0, 2 above, 0 on all sides.
fn folder() -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let label = |at: usize| {
        let place = [at % 32, at / 32 % 32, at / 1024];
        let inside = place.iter().all(|n| (6..26).contains(n));
        if inside { 1 + u8::from(place[0] >= 16) } else { 0 }
    };
    let header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 32 32 32\nspace dimension: 3\nspace directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: (-31,-31,-31)\nencoding: raw\n\n";
    let bytes = [header.as_bytes(), &(0..32 * 1024).map(label).collect::<Vec<u8>>()].concat();
    std::fs::write(folder.path().join("labels.nrrd"), bytes).unwrap();
    std::fs::write(folder.path().join("labels.ctbl"), "1 left 255 0 0 255\n2 right 0 255 0 255\n")
        .unwrap();
    std::fs::write(folder.path().join("two.pdb"), PDB).unwrap();
    std::fs::write(folder.path().join("far.pdb"), PDB.replace("0.600", "8.000")).unwrap();
    let data = vec![folder.path().to_owned()];
    (folder, data)
}

/// Carbon and oxygen, bonded.
const PDB: &str = "\
ATOM      1  C   GLY A   1      -0.600   0.000   0.000  1.00 10.00           C
ATOM      2  O   GLY A   1       0.600   0.000   0.000  1.00 10.00           O
";

const ALONE: &str = "[[entity]]\nname = \"labels\"\nvolume = { file = \"labels.nrrd\" }\nlabels = { colors = \"labels.ctbl\" }\nmaterial = { ambient = 1, diffuse = 0 }\n";

#[test]
fn each_label_has_its_color_by_itself() {
    let (_folder, data) = folder();
    let mut world = stated(&[ALONE, &view(0.0, 0.0, 32, 60.0, EVERY_PIXEL)], &data);
    run(&mut world);
    let [left, right, beside] = [-10.0, 10.0, 28.0].map(|x| at(&world, [x, 0.0, 0.0]));
    assert!(difference(left, [1.0, 0.0, 0.0, 1.0]) < 0.01, "{left:?}");
    assert!(difference(right, [0.0, 1.0, 0.0, 1.0]) < 0.01, "{right:?}");
    // The last of a Gaussian.
    assert!(beside[3] < 0.02, "{beside:?}");
}

#[test]
fn a_table_of_the_scene_comes_before_that_of_a_file_and_a_label_of_neither_is_clear() {
    let (_folder, data) = folder();
    let text =
        ALONE.replace("colors = \"labels.ctbl\"", "table = [{ label = 2, color = \"blue\" }]");
    let mut world = stated(&[&text, &view(0.0, 0.0, 32, 60.0, EVERY_PIXEL)], &data);
    run(&mut world);
    assert!(difference(at(&world, [10.0, 0.0, 0.0]), [0.0, 0.0, 1.0, 1.0]) < 0.01);
    assert_eq!(at(&world, [-14.0, 0.0, 0.0]), [0.0; 4]);
}

#[test]
fn labels_of_a_file_tint_another_volume_and_mask_it() {
    let (_folder, data) = folder();
    let labels = "labels = { file = \"labels.nrrd\", table = [{ label = 1, color = \"red\" }], outside = 0 }\nmaterial = { ambient = 1, diffuse = 0 }";
    let ball = gel("ball", [0.0, 1.0], labels);
    let mut world = stated(&[&ball, &view(0.0, 0.0, 32, 60.0, EVERY_PIXEL)], &data);
    run(&mut world);
    let left = at(&world, [-10.0, 0.0, 0.0]);
    assert!(difference(left, [1.0, 0.0, 0.0, 1.0]) < 0.01, "{left:?}");
    assert_eq!(at(&world, [10.0, 0.0, 0.0]), [0.0; 4]);
    let plain = made(&[&gel("ball", [0.0, 1.0], ""), &view(0.0, 0.0, 32, 60.0, EVERY_PIXEL)]);
    assert!(at(&plain, [10.0, 0.0, 0.0])[3] > 0.99);
}

#[test]
fn what_labels_cannot_go_with_is_said() {
    let (_folder, data) = folder();
    let refused = |text: &str| match load(&Source::inline("x", text), &[], &data, false) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{text}"),
    };
    let both = format!("{ALONE}classify = {{ iso = [{{ value = 1 }}] }}\n");
    assert!(refused(&both).contains("`classify` has no use"));
    assert!(refused(&ALONE.replace("labels.ctbl", "none.ctbl")).contains("`none.ctbl` is not in"));
    assert!(refused(&ALONE.replace("labels.ctbl", "two.pdb")).contains("line 1 is no row"));
}

#[test]
fn the_halves_of_a_bond_have_the_colors_of_their_atoms_traced_and_scan_converted() {
    let (_folder, data) = folder();
    let molecule = "[[entity]]\nname = \"pair\"\nmolecule = { file = \"two.pdb\", carbon = \"#00ff00\" }\nsurface = { ambient = 1, diffuse = 0 }\n";
    let mut world = stated(&[molecule, &view(0.0, 0.0, 64, 2.0, EVERY_PIXEL)], &data);
    run(&mut world);
    let [carbon, oxygen] = [-0.3, 0.3].map(|x| at(&world, [x, 0.0, 0.0]));
    assert!(carbon[1] > 0.99 && carbon[0] < 0.01, "{carbon:?}");
    assert!(oxygen[0] > 0.7 && oxygen[1] < 0.1, "{oxygen:?}");
    let thick = molecule
        .replace("carbon", "radius = 3, carbon")
        .replace("two.pdb\"", "far.pdb\", style = \"balls\"");
    let both = format!("{thick}voxelize = {{}}\n");
    let mut world = stated(
        &[&gel("ball", [0.0, 0.0], ""), &both, &view(0.0, 0.0, 32, 30.0, EVERY_PIXEL)],
        &data,
    );
    run(&mut world);
    let [carbon, oxygen] = [-8.0, 8.0].map(|x| at(&world, [x, 0.0, 0.0]));
    assert!(carbon[1] > 2.0 * carbon[0] && oxygen[0] > 2.0 * oxygen[1], "{carbon:?} {oxygen:?}");
}
