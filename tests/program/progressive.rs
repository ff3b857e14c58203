//! `gelray render --progressive`: pictures of what is known so far.

use gelray::formats::read_picture;
use gelray::measure::error::compare;

use super::Place;

#[test]
fn pictures_get_better_from_one_to_the_next_and_the_last_is_the_plain_one() {
    let place = Place::new();
    for (scene, more) in [("minimal_3", ""), ("minimal_5", " --exact"), ("cross.toml", "")] {
        let name = scene.replace('.', "_");
        let render = format!("render {scene} -q -t 2 --size 400x300{more}");
        place.done(&format!("{render} -o {name}.png"));
        place.done(&format!("{render} -o {name}.again.png --progressive {name} --every 1ms"));
        let mut names: Vec<_> = std::fs::read_dir(place.path(&name))
            .unwrap()
            .map(|entry| format!("{name}/{}", entry.unwrap().file_name().display()))
            .collect();
        names.sort();
        assert!(names.len() >= 3, "{scene}: {names:?}");
        let plain = place.read(&format!("{name}.png"));
        assert_eq!(place.read(&format!("{name}.again.png")), plain, "{scene}");
        assert_eq!(place.read(names.last().unwrap()), plain, "{scene}");
        let pictures: Vec<_> =
            names.iter().map(|name| read_picture(&place.path(name)).unwrap()).collect();
        let whole = pictures.last().unwrap();
        let off: Vec<f64> =
            pictures.iter().map(|picture| compare(picture, whole).unwrap().linear.rmse).collect();
        assert!(off.is_sorted_by(|before, after| *after <= before * 1.02), "{scene}: {off:?}");
        assert!(off[0] > 0.0 && off[off.len() - 1] == 0.0, "{scene}: {off:?}");
    }
}

#[test]
fn a_folder_with_pictures_of_another_run_is_refused_and_so_is_a_time_without_a_unit() {
    let place = Place::new();
    place.done("render cross.toml -o a.png --progressive so_far");
    let again = "render cross.toml -o a.png --progressive so_far";
    place.refused(again, 2, &["progress.0000.png is there already", "empty folder"]);
    place.refused("render cross.toml -o a.png --progressive new --every 5", 2, &["100ms"]);
    place.refused("render cross.toml -o a.png --every 5ms", 2, &["--progressive"]);
}
