//! Facts about what is said of a text that is no scene, and where it points.

use crate::scene::error::Text;
use crate::scene::parse::parse;

fn refused(text: &str) -> String {
    match parse(Text { file: "s.toml", text }) {
        Ok(_) => panic!("this scene should be refused:\n{text}"),
        Err(error) => error.to_string(),
    }
}

/// A scene of one entity whose third line is `line`; the sentence about it.
fn line(noun: &str, line: &str) -> String {
    refused(&format!("[[entity]]\n{noun}\n{line}\n"))
}

const VOLUME: &str = "volume = { file = \"a\" }";
const VIEW: &str = "view = {}";

#[test]
fn a_misspelt_word_is_pointed_at_and_the_nearest_known_one_suggested() {
    let component = line(VOLUME, "clasify = {}");
    assert!(
        component.starts_with(
            "s.toml:3:1: entity `volume`: there is no component `clasify`; did you mean `classify`?"
        ),
        "{component}"
    );
    let owned = line(VIEW, "stop_at = 0.1");
    assert!(
        owned.contains("it is a key of `sampling`; write `sampling = { stop_at = … }`"),
        "{owned}"
    );
    let key = line(VOLUME, "material = { ambient = 0.1, colr = \"#ffffff\" }");
    assert!(
        key.starts_with("s.toml:3:29: ")
            && key.contains("`material` has no key `colr`; did you mean `color`?"),
        "{key}"
    );
    let nested = line(VOLUME, "classify = { iso = [{ value = 3, opacty = 1 }] }");
    assert!(
        nested.starts_with("s.toml:3:34: ")
            && nested.contains("`classify.iso.0` has no key `opacty`; did you mean `opacity`?"),
        "{nested}"
    );
    let word = line(VIEW, "sampling = { skip = \"pyramids\" }");
    assert!(
        word.starts_with("s.toml:3:21: ") && word.contains("did you mean `pyramid`?"),
        "{word}"
    );
    let top = refused("[[entity]]\nview = {}\n[[entities]]\n");
    assert!(top.starts_with("s.toml:3:3: ") && top.contains("did you mean `entity`?"), "{top}");
}

#[test]
fn a_wrong_type_is_pointed_at_and_the_right_one_named() {
    let number = line(VIEW, "sampling = { stop_at = \"never\" }");
    assert_eq!(
        number,
        "s.toml:3:24: entity `observer`: `sampling.stop_at` is the string \"never\"; it must be a number"
    );
    let length = line("light = { toward = [0, 1] }", "");
    assert!(
        length.starts_with("s.toml:2:20: ") && length.contains("array of 2; it must be one of 3"),
        "{length}"
    );
    let table = line(VOLUME, "material = 3");
    assert!(table.starts_with("s.toml:3:12: ") && table.contains("a table"), "{table}");
    let color = line(VOLUME, "material = { color = \"#12345\" }");
    assert!(
        color.starts_with("s.toml:3:22: ") && color.contains("\"#12345\" is no colour"),
        "{color}"
    );
    let level = line(VOLUME, "classify = { iso = [{ value = \"3 sigmas\" }] }");
    assert!(level.starts_with("s.toml:3:31: ") && level.contains("is no level"), "{level}");
}

#[test]
fn numbers_out_of_their_range_are_pointed_at() {
    let cases = [
        (VOLUME, "material = { ambient = 1.5 }", "at least 0 and at most 1"),
        (VOLUME, "material = { diffuse = nan }", "finite"),
        (VOLUME, "material = { shininess = 1e300 }", "finite"),
        (VOLUME, "classify = { iso = [{ value = 1, opacity = -0.1 }] }", "at least 0"),
        (VOLUME, "classify = { iso = [{ value = 1, thickness_voxels = -1 }] }", "at least 0"),
        (VIEW, "sampling = { distance_mm = 0 }", "above 0"),
        (VIEW, "sampling = { stop_at = 1 }", "below 1"),
        (VIEW, "sampling = { coarsest = 3 }", "1, 2, 4, 8, 16 or 32"),
        (VIEW, "sampling = { coarsest = 64 }", "at most 32"),
        (VIEW, "sampling = { coarsest = 2, finest = 4 }", "swap"),
        (VIEW, "sampling = { per_voxel = 0.25 }", "from 0.5"),
        (VIEW, "sampling = { per_voxel = 17 }", "at most 16"),
        ("view = { elevation = 91 }", "", "at most 90"),
        ("view = { height_mm = 0 }", "", "above 0"),
        ("view = { size = [0, 1] }", "", "at least 1"),
        ("view = { size = [1, 16385] }", "", "at most 16384"),
        ("view = { size = [1, 99999999999999999999999999999999999999999999] }", "", "finite"),
        ("light = { toward = [0, 0, 0] }", "", "any length above 0"),
    ];
    for (noun, text, says) in cases {
        let sentence = line(noun, text);
        assert!(
            sentence.contains(says) && sentence.starts_with("s.toml:"),
            "{sentence}\nshould say: {says}"
        );
    }
}

#[test]
fn keys_of_a_component_that_do_not_suit_each_other_are_refused() {
    let cases = [
        (VOLUME, "classify = {}", "state one of `iso`"),
        (
            VOLUME,
            "classify = { iso = [{ value = 1 }], regions = [{ value = 1, opacity = 1 }] }",
            "exactly one",
        ),
        (
            VOLUME,
            "classify = { regions = [{ value = 2, opacity = 1 }, { value = 1, opacity = 1 }] }",
            "rising order",
        ),
        (
            VOLUME,
            "classify = { transfer = [{ value = 2, opacity = 1 }, { value = 2, opacity = 1 }] }",
            "rising order",
        ),
        (
            VOLUME,
            "classify = { materials = [{ probability = [[2, 1], [1, 1]], opacity = 1 }] }",
            "rising order",
        ),
        (
            VOLUME,
            "classify = { materials = [{ probability = [[2, 7]], opacity = 1 }] }",
            "within 0 and 1",
        ),
        (VOLUME, "classify = { iso = [{ value = 1 }], gradient = [[0, 0]] }", "without `transfer`"),
        ("light = { toward = [0, 0, 0] }", "", "no direction in [0.0, 0.0, 0.0]"),
        ("light = { toward = [0, 0, 1], strength = 3e38 }", "", "at most 1e15"),
        (VOLUME, "clip = {}", "`planes` or `box`"),
        (VOLUME, "clip = { planes = [[0, 0, 0, 1]] }", "normal"),
        (VOLUME, "clip = { box = [[0, 0, 0], [0, 1, 1]] }", "differ"),
        ("volume = { file = \"\" }", "", "names no file"),
        ("volume = { file = \"a\", spacing_mm = [1, 0, 1] }", "", "spacing of 0"),
        ("volume = { file = \"a\", endian = \"middle\" }", "", "\"little\" or \"big\""),
        ("mesh = {}", "", "exactly one"),
        ("mesh = { prism = { from = [0, 0, 0], to = [0, 0, 0], radius = 1 } }", "", "differ"),
        ("texture = {}", "", "`file` or `formula`"),
        ("texture = { file = \"a\", formula = \"b\" }", "", "both"),
    ];
    for (noun, text, says) in cases {
        let sentence = line(noun, text);
        assert!(
            sentence.contains(says) && sentence.starts_with("s.toml:"),
            "{sentence}\nshould say: {says}"
        );
    }
}

#[test]
fn entities_that_do_not_suit_the_scene_are_refused() {
    let polygon =
        "[[entity]]\nname = \"p\"\npolygon = { vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }\n";
    let cases = [
        ("", "the scene is empty"),
        ("entity = 3", "must be tables"),
        ("volume = { file = \"a\" }", "write `[[entity]]`"),
        ("[[entity]]\nname = \"a\"", "is nothing"),
        ("[[entity]]\nname = 3\nview = {}", "`name` must be"),
        ("[[entity]]\nview = {}\nlight = { toward = \"observer\" }", "make two entities"),
        (
            "[[entity]]\nview = {}\n[[entity]]\nname = \"b\"\nview = {}",
            "`b` is a second view, after `observer`",
        ),
        (
            "[[entity]]\nname = \"a\"\nview = {}\n[[entity]]\nname = \"a\"\nlight = { toward = \"observer\" }",
            "a second entity is called `a`",
        ),
        ("[[entity]]\nname = \"a\"\nclassify = {}", "add `volume`"),
        ("[[entity]]\nview = {}\nmaterial = {}", "add `volume`"),
        ("[[entity]]\nview = {}\nclip = {}", "add `volume`"),
        ("[[entity]]\nview = {}\nsurface = {}", "add `polygon` or `mesh`"),
        ("[[entity]]\nview = {}\nvoxelize = {}", "add `polygon` or `mesh`"),
        ("[[entity]]\nview = {}\ntextured = {}", "add `polygon` or `mesh`"),
        ("[[entity]]\nview = {}\ncasts_shadow = {}", "add `light`"),
        ("[[entity]]\nview = {}\nprojects = {}", "add `light`"),
        ("[[entity]\n", "this is not TOML"),
    ];
    for (text, says) in cases {
        let sentence = refused(text);
        assert!(
            sentence.contains(says) && sentence.starts_with("s.toml:"),
            "{sentence}\nshould say: {says}"
        );
    }
    assert!(parse(Text { file: "s.toml", text: polygon }).is_ok());
}

#[test]
fn entities_without_a_name_are_called_what_they_are() {
    let text = "[[entity]]\nview = {}\n[[entity]]\nname = \"light\"\nlight = { toward = \"observer\" }\n[[entity]]\nlight = { toward = [0, 0, 1] }\n";
    let stated = parse(Text { file: "s.toml", text }).unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<_> = stated.entries.iter().map(|entry| entry.name.as_str()).collect();
    assert_eq!(names, ["observer", "light", "light 2"]);
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn no_damage_to_a_scene_and_no_override_brings_it_down(
        scene in 0..crate::scene::EMBEDDED.len(),
        from in 0..1500_usize,
        length in 0..12_usize,
        put in "[\\[\\]{}=,.\"#a-f0-9 \n-]{0,6}",
        path in "(head|observer|plane|x)(\\.(classify|iso|view|volume|size|0|1|value|x)){0,5}=?[a-z0-9\\[{]{0,4}",
    ) {
        let text = crate::scene::EMBEDDED[scene].1;
        let end = |at: usize| text.floor_char_boundary(at.min(text.len()));
        let damaged = format!("{}{put}{}", &text[..end(from)], &text[end(from + length)..]);
        if let Err(error) = parse(Text { file: "s.toml", text: &damaged }) {
            assert!(error.to_string().starts_with("s.toml:"), "{error}");
        }
        let _ = crate::scene::overrides::apply("s.toml", &damaged, std::slice::from_ref(&path));
        if let Err(error) = crate::scene::overrides::apply("s.toml", text, std::slice::from_ref(&path)) {
            assert!(error.to_string().starts_with("override `"), "{error}");
        }
    }
}
