//! `gelray render --target`: the settings that it finds keep the target, are told, and are noted.

use super::Place;

/// Decibels between two pictures.
fn decibels(place: &Place, a: &str, b: &str) -> f64 {
    place.done(&format!("compare {a} {b} --stats c.json"));
    place.json("c.json")["linear"]["psnr_db"].as_f64().unwrap()
}

#[test]
fn a_target_in_decibels_is_kept_and_not_by_much_and_equal_commands_give_equal_bytes() {
    let place = Place::new();
    let words = "render minimal_3 --size 72x72";
    let exact = "--exact --set observer.sampling.distance_mm=0.25";
    place.done(&format!("{words} {exact} -o exact.npy"));
    let ran = place.done(&format!("{words} --target psnr=42 -o a.npy"));
    assert!(ran.err.contains("expected: 42."), "{}", ran.err);
    assert!(ran.err.contains("sampling = {"), "{}", ran.err);
    let kept = decibels(&place, "a.npy", "exact.npy");
    println!("{kept:.2} dB for 42; {}", ran.err);
    assert!((41.8..43.2).contains(&kept), "{kept}");
    place.done(&format!("{words} --target psnr=42 -o b.png"));
    place.done(&format!("{words} --target psnr=42 -o c.png -t 1"));
    assert_eq!(place.read("b.png"), place.read("c.png"));
    let noted = String::from_utf8_lossy(&place.read("b.png")).contains("tolerance");
    assert!(noted, "the PNG notes the settings that were chosen");
}

#[test]
fn a_target_of_several_views_is_kept_at_the_worst_and_the_picture_is_of_the_stated_view() {
    let place = Place::new();
    let words = "render minimal_3 --size 96x96";
    let target = "--target psnr=42 --views 3";
    let ran = place.done(&format!("{words} {target} -o a.npy"));
    assert!(ran.err.contains("at the worst of 3 views"), "{}", ran.err);
    let stated = ran.err.lines().find(|line| line.starts_with("sampling = ")).unwrap();
    let mut kept = Vec::new();
    for view in 0..3 {
        let turned = format!("{words} --set observer.view.azimuth={}", 120 * view);
        let exact = "--exact --set observer.sampling.distance_mm=0.25";
        place.done(&format!("{turned} {exact} -o exact.npy"));
        place.done(&format!("{turned} {} -o b.npy", overrides(stated)));
        kept.push(decibels(&place, "b.npy", "exact.npy"));
        if view == 0 {
            assert_eq!(
                place.read("a.npy"),
                place.read("b.npy"),
                "the picture is of the stated view"
            );
        }
    }
    println!("{kept:.2?} dB for 42; {}", ran.err);
    let worst = kept.into_iter().fold(f64::INFINITY, f64::min);
    assert!((41.5..43.5).contains(&worst), "{worst}");
    place.refused(&format!("{words} --views 3"), 2, &["--target"]);
}

/// The settings of a line `sampling = { … }` as overrides.
fn overrides(stated: &str) -> String {
    let table: toml::Table = stated.parse().unwrap();
    let settings = table["sampling"].as_table().unwrap();
    let each = |(key, value)| format!("--set observer.sampling.{key}={value}");
    settings.iter().map(each).collect::<Vec<_>>().join(" ")
}

#[test]
fn other_targets_are_kept_at_a_fraction_of_the_size_or_refused_in_a_sentence() {
    let place = Place::new();
    let words = "render minimal_2 --size 48x48 -o a.png";
    for target in ["max=0.2", "ssim=0.9", "ms=100000"] {
        let ran = place.done(&format!("{words} --target {target}"));
        assert!(ran.err.contains("sampling = {"), "{}", ran.err);
    }
    std::fs::remove_file(place.path("a.png")).unwrap();
    place.refused(&format!("{words} --target ms=0.000001"), 1, &["allow for more time"]);
    place.refused(&format!("{words} --target psnr=300"), 1, &["ask for less"]);
    place.refused(&format!("{words} --target speed=3"), 2, &["psnr=45"]);
    place.refused(&format!("{words} --target psnr=40 --exact"), 2, &["--exact"]);
}
