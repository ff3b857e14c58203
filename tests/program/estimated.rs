//! `gelray render --estimate`: what the last line, the notes and `--stats` say of a picture's error.

use super::Place;

#[test]
fn a_picture_tells_its_own_error_in_its_last_line_its_notes_and_its_stats() {
    let place = Place::new();
    let words = "render cross.toml --set observer.sampling.finest=4 --size 96x80";
    let ran = place.done(&format!("{words} -o a.png --estimate --stats a.json"));
    assert!(ran.err.lines().last().unwrap().contains(" in nine of ten cases"), "{}", ran.err);
    let error = place.json("a.json")["error"].clone();
    let [psnr, low, high, max] = ["psnr_db", "low", "high", "max"].map(|key| error[key].as_f64());
    assert!(low < psnr && psnr < high && max > Some(0.0), "{error}");
    let noted = String::from_utf8_lossy(&place.read("a.png")).contains("psnr_db");
    assert!(noted, "the PNG notes the error");
    // The picture is the one without, but for the note.
    place.done(&format!("{words} -o a.npy --estimate"));
    place.done(&format!("{words} -o b.npy --stats b.json"));
    assert_eq!(place.read("a.npy"), place.read("b.npy"));
    assert!(place.json("b.json").get("error").is_none());
    // And the estimate holds the truth.
    place.done(&format!("{words} -o exact.npy --exact"));
    place.done("compare b.npy exact.npy --stats c.json");
    let truth = place.json("c.json")["linear"]["psnr_db"].as_f64().unwrap();
    assert!(low.unwrap() <= truth && truth <= high.unwrap(), "{truth}: {error}");
}

#[test]
fn equal_seeds_give_equal_estimates_on_any_number_of_threads() {
    let place = Place::new();
    let words = "render minimal_3 --size 64x64 --estimate -o a.png";
    let estimate = |more: &str| {
        place.done(&format!("{words} --stats a.json {more}"));
        place.json("a.json")["error"].to_string()
    };
    let one = estimate("-t 1");
    assert_eq!(estimate("-t 3"), one);
    assert_ne!(estimate("--set observer.estimate.seed=1"), one);
    place.refused(&format!("{words} --set observer.estimate.share=0"), 2, &["share"]);
}
