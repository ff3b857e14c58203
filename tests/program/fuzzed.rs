//! What the fuzz bench tries is worth trying: most of its scenes are taken and rendered, and none of them does harm.

use super::Place;
use super::random::Random;
use super::scenes;

#[test]
fn at_least_half_of_the_scenes_that_are_made_up_are_rendered() {
    let place = Place::new();
    let tried = 600;
    let taken = (0..tried)
        .filter(|run| scenes::load(&mut Random::new(*run), &place.path("")).expect("no fault"))
        .count();
    assert!(2 * taken > tried as usize, "{taken} of {tried}");
}
