//! Facts about the table of knobs: it has a row for each key of `sampling`, and each turns its own.

use super::*;

#[test]
fn every_key_of_sampling_is_a_knob_or_named_as_none() {
    let stated = Sampling { distance_mm: Some(1.0), ..Sampling::default() };
    let table = toml::Table::try_from(stated).unwrap();
    for key in table.keys() {
        let is_knob = KNOBS.iter().any(|knob| knob.key == key);
        assert!(is_knob != NO_KNOBS.contains(&key.as_str()), "{key}");
    }
    assert_eq!(table.len(), KNOBS.len() + NO_KNOBS.len());
}

#[test]
fn each_setting_changes_its_own_key_alone_and_leaves_what_may_be_rendered() {
    for knob in KNOBS {
        for &setting in knob.range {
            let stated = Sampling { distance_mm: Some(0.7), ..Sampling::default() };
            let mut turned = stated.clone();
            knob.turn(&mut turned, setting, 2.0);
            let [a, b] = [stated, turned.clone()].map(|s| toml::Table::try_from(s).unwrap());
            let changed: Vec<_> = a.iter().filter(|(key, value)| b[*key] != **value).collect();
            let may = |key: &str| key == knob.key || (knob.key == "coarsest" && key == "finest");
            assert!(changed.iter().all(|(key, _)| may(key)), "{}: {changed:?}", knob.key);
            assert!(turned.finest <= turned.coarsest && turned.coarsest.is_power_of_two());
        }
    }
}

#[test]
fn exact_is_the_exact_end_of_all_knobs_but_those_that_stay() {
    let exact =
        Sampling { distance_mm: Some(3.0), skip: Skip::None, ..Sampling::default() }.exact();
    let expected = Sampling {
        distance_mm: Some(3.0),
        skip: Skip::None,
        stop_at: 0.0,
        tolerance: 0.0,
        edge_tolerance: 0.0,
        coarsest: 1,
        finest: 1,
        texel: TexelKind::F32,
        ..Sampling::default()
    };
    assert_eq!(exact, expected);
}
