//! Furniture: what is drawn over a picture, what stands in the gel, and what neither costs a scene without any.

use gelray::polygon::face::Faces;
use gelray::scene::{Source, load};

use crate::{EVERY_PIXEL, at, entity, frame, gel, made, pixels, rendered, run, stated, view};

fn ball() -> String {
    gel("ball", [0.0, 1.0], "")
}

fn seen() -> String {
    view(0.0, 0.0, 200, 80.0, EVERY_PIXEL)
}

/// The pixels that furniture has changed.
fn changed(keys: &str) -> Vec<[usize; 2]> {
    let text = format!("[[entity]]\n{keys}\n");
    let [with, without] = [rendered(&[&ball(), &text, &seen()]), rendered(&[&ball(), &seen()])];
    pixels(&with).filter(|&[x, y]| with.pixel(x, y) != without.pixel(x, y)).collect()
}

#[test]
fn a_scale_bar_is_as_long_as_it_says_and_stands_in_its_corner() {
    let drawn =
        changed("scale_bar = { length_mm = 20, corner = \"bottom-left\", color = \"red\" }");
    assert!(drawn.iter().all(|[x, y]| *x < 100 && *y > 150), "{drawn:?}");
    // 80 units are 200 pixels.
    let lowest = drawn.iter().map(|[_, y]| *y).max().unwrap();
    assert_eq!(drawn.iter().filter(|[_, y]| *y == lowest).count(), 50);
}

#[test]
fn a_title_is_at_the_top_and_legends_on_their_side() {
    let title = changed("title = { text = \"Figure 1\" }");
    assert!(!title.is_empty() && title.iter().all(|[_, y]| *y < 30));
    let legend =
        changed("legend = { entries = [{ color = \"red\", text = \"bone\" }], of = \"gel\" }");
    assert!(legend.len() > 300 && legend.iter().all(|[x, y]| *x > 120 && *y < 120));
}

#[test]
fn the_line_of_a_callout_is_hidden_by_the_gel_and_its_text_is_not() {
    let callout = |y: f64| {
        let text = format!(
            "[[entity]]\nname = \"here\"\ncallout = {{ text = \"here\", at = [0, {y}, 0], from = [34, {y}, 0], width_mm = 1.5, color = \"red\" }}\n"
        );
        made(&[&ball(), &text, &seen()])
    };
    let [before, behind] = [callout(-30.0), callout(30.0)];
    let is_red = |color: [f32; 4]| color[0] > 0.9 && color[1] < 0.1;
    assert!(is_red(at(&before, [10.0, 0.0, 0.0])) && !is_red(at(&behind, [10.0, 0.0, 0.0])));
    assert!(is_red(at(&behind, [30.0, 0.0, 0.0])));
    let letters = |world: &_| {
        pixels(&frame(world))
            .filter(|[x, _]| *x > 186)
            .filter(|&[x, y]| frame(world).pixel(x, y)[0] > 0.3)
            .count()
    };
    assert!(letters(&behind) > 10 && letters(&behind) == letters(&before));
}

#[test]
fn a_bounding_box_has_twelve_rods_around_all_volumes() {
    let world = made(&[&ball(), "[[entity]]\nname = \"box\"\nbounding_box = {}\n", &seen()]);
    let faces = world.get::<&Faces>(entity(&world, "box")).unwrap().clone();
    assert_eq!(faces.0.len(), 12 * 6);
    assert!(faces.middle().unwrap().length() < 1e-9);
}

#[test]
fn axes_stand_along_the_near_edges_with_a_tick_at_round_values_and_a_cube_in_its_corner() {
    let world = made(&[&ball(), "[[entity]]\nname = \"axes\"\naxes = { step_mm = 10 }\n", &seen()]);
    let faces = world.get::<&Faces>(entity(&world, "axes")).unwrap().clone();
    let volume = entity(&world, "gel");
    let corners = world.get::<&gelray::volume::grid::Grid>(volume).unwrap().corners();
    let [low, high] = [f64::min, f64::max]
        .map(|pick| corners.iter().map(|corner| corner.x).reduce(pick).unwrap());
    let ticks = (high / 10.0).floor() - (low / 10.0).ceil() + 1.0;
    assert_eq!(faces.0.len(), 6 * (3 + 3 * ticks as usize));
    let cube = changed("orientation_cube = { corner = \"bottom-right\" }");
    assert!(cube.len() > 100 && cube.iter().all(|[x, y]| *x > 160 && *y > 160));
}

#[test]
fn a_scene_without_furniture_makes_none_and_a_turn_makes_it_anew() {
    let mut world = stated(&[&ball(), &seen()], &[]);
    assert!(run(&mut world).iter().any(|ran| ran.name == "furnish" && ran.made == 0));
    let mut world = stated(&[&ball(), "[[entity]]\ntitle = { text = \"T\" }\n", &seen()], &[]);
    assert!(run(&mut world).iter().any(|ran| ran.name == "furnish" && ran.made == 1));
    assert!(run(&mut world).iter().all(|ran| ran.made == 0));
}

#[test]
fn a_legend_of_what_has_no_colors_and_a_line_of_no_length_are_refused() {
    let line = format!(
        "{}[[entity]]\ncallout = {{ text = \"a\", at = [0, 0, 0], from = [0, 0, 0] }}\n",
        ball()
    );
    let Err(error) = load(&Source::inline("x", line.as_str()), &[], &[], false) else { panic!() };
    assert!(error.to_string().contains("must differ"), "{error}");
    let mut world = stated(&[&ball(), "[[entity]]\nlegend = { of = \"none\" }\n", &seen()], &[]);
    let jobs = gelray::schedule::Schedule::new(gelray::systems::JOBS).unwrap();
    let error = jobs.run(&mut world, &gelray::schedule::Watch::default()).unwrap_err();
    assert!(error.to_string().contains("`transfer` or `colormap`"), "{error}");
}
