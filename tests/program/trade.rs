//! `gelray trade`: choices measured, kept and picked from.

use super::Place;

#[test]
fn a_trade_leaves_numbers_pictures_and_a_page_and_prints_what_keeps_the_target() {
    let place = Place::new();
    let words = "trade cross.toml -o t --size 24x20 --repeat 1 --combinations 2";
    let ran = place.done(&format!("{words} --target psnr=30"));
    let trade = place.json("t/trade.json");
    let points = trade["points"].as_array().unwrap();
    assert_eq!(points[0]["name"], "as stated");
    for knob in ["distance_mm", "skip", "stop_at", "tolerance", "coarsest", "finest", "texel"] {
        let swept = |point: &serde_json::Value| point["name"].as_str().unwrap().starts_with(knob);
        assert!(points.iter().any(swept), "{knob}");
    }
    let exact = points.iter().find(|point| point["name"] == "coarsest = 1").unwrap();
    assert!(exact["rmse"].as_f64() <= points[0]["rmse"].as_f64(), "{exact}");
    let lines = String::from_utf8(place.read("t/trade.csv")).unwrap().lines().count();
    assert_eq!(lines, points.len() + 1);
    let page = String::from_utf8(place.read("t/index.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("as stated") && !page.contains("http"));
    // What is printed is a component, and renders.
    let sampling = ran.out.lines().find_map(|line| line.strip_prefix("sampling = ")).unwrap();
    let scene = String::from_utf8(place.read("cross.toml")).unwrap();
    place.write("fast.toml", format!("{scene}sampling = {sampling}\n"));
    place.done("render fast.toml -o fast.png");
    // What is measured already is not measured anew: times are what they were, but for the last bit that JSON has.
    let told = |trade: &serde_json::Value| -> Vec<(String, f64)> {
        let points = trade["points"].as_array().unwrap().iter();
        let told = |p: &serde_json::Value| {
            (p["name"].as_str().unwrap().to_owned(), p["milliseconds"].as_f64().unwrap())
        };
        points.map(told).collect()
    };
    place.done(&format!("{words} --resume"));
    let (before, after) = (told(&trade), told(&place.json("t/trade.json")));
    assert_eq!(before.len(), after.len());
    for (a, b) in before.iter().zip(&after) {
        assert!(a.0 == b.0 && (a.1 / b.1 - 1.0).abs() < 1e-12, "{a:?} {b:?}");
    }
    let ran = place.run(&format!("{words} --resume --views 2"));
    assert!(ran.code == 1 && ran.err.contains("leave --resume away"), "{}", ran.err);
    let ran = place.run(&format!("{words} --resume --target psnr=900"));
    assert!(ran.code == 0 || ran.err.contains("ask for less"), "{}", ran.err);
}

#[test]
fn a_trade_is_refused_in_a_sentence() {
    let place = Place::new();
    place.refused("trade cross.toml", 2, &["needs a folder", "-o DIR"]);
    place.refused("trade cross.toml -o t --target speed=3", 2, &["psnr=45"]);
    place.refused("trade cross.toml -o t --exact", 2, &["no use for --exact"]);
    place.refused("trade nowhere.toml -o t", 1, &["nowhere.toml"]);
}
