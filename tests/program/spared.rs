//! No file that a run reads is ever written over, whatever names and links lead to it.

use super::{CROSS, Place, small_nrrd};

/// A folder with a scene that reads a texture, a volume and, through its header, the volume's voxels in a file apart.
fn place() -> Place {
    let place = Place::new();
    place.done("render cross.toml -q -o tex.png --size 8x8");
    let bytes = small_nrrd();
    let header =
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 5 4\nencoding: raw\ndata file: v.bin\n\n";
    place.write("v.nhdr", header);
    place.write("v.bin", &bytes[bytes.len() - 120..]);
    let scene = CROSS.replace(
        "surface = { color = \"#d03030\", opacity = 0.5 }",
        "surface = { opacity = 0.5 }\ntextured = { texture = \"picture\" }",
    );
    let more = "[[entity]]\nname = \"picture\"\ntexture = { file = \"tex.png\" }\n[[entity]]\nname = \"v\"\nvolume = { file = \"v.nhdr\" }\nclassify = { iso = [{ value = 100 }] }\n";
    place.write("s.toml", format!("{scene}\n{more}"));
    place
}

#[test]
fn no_output_may_name_what_the_scene_reads() {
    let place = place();
    let kept = ["s.toml", "tex.png", "v.nhdr", "v.bin"].map(|name| (name, place.read(name)));
    place.refused("render s.toml -o tex.png", 2, &["--output names tex.png, which is read"]);
    for name in ["s.toml", "tex.png", "v.nhdr", "v.bin", "./v.bin"] {
        let words = format!("render s.toml -o a.png --stats {name}");
        place.refused(&words, 2, &["--stats names", "which is read"]);
        let words = format!("render s.toml -o a.png --trace {name}");
        place.refused(&words, 2, &["--trace names", "which is read"]);
    }
    place.refused("render s.toml -o a.png --rays tex.png", 2, &["--rays names", "which is read"]);
    place.refused("plan s.toml -o v.bin", 2, &["which is read"]);
    place.refused("info v.nhdr -o v.nhdr", 2, &["which is read"]);
    place.done("render s.toml -o a.png --stats a.json");
    assert!(kept.iter().all(|(name, bytes)| place.read(name) == *bytes));
}

#[cfg(unix)]
#[test]
fn links_of_both_kinds_are_seen_through() {
    let place = place();
    std::fs::hard_link(place.path("tex.png"), place.path("hard.png")).unwrap();
    std::os::unix::fs::symlink("v.bin", place.path("soft.json")).unwrap();
    std::fs::hard_link(place.path("cross.toml"), place.path("one.png")).unwrap();
    std::fs::hard_link(place.path("cross.toml"), place.path("two.png")).unwrap();
    place.refused("render s.toml -o hard.png", 2, &["which is read"]);
    place.refused("render s.toml -o a.png --stats soft.json", 2, &["which is read"]);
    place.refused("render s.toml -o one.png --rays two.png", 2, &["both name"]);
}
