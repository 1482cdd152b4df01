//! The bars of stage 12, by which students are judged, are the counts of the reference.

use raykata::rubric;
use stage12_checks::bars::{measured, sweep_cost};
use stage12_checks::scenes::scenes;
use stage12_checks::trees::cost;

#[test]
fn the_bars_are_those_of_the_reference() {
    for (name, found) in measured(&*solutions::kit()) {
        assert_eq!(rubric::bar(12, &name), found, "{name}: run `cargo run -p author -- bars`");
    }
}

/// Prints what the slides say about the reference; run it with `--nocapture`.
#[test]
fn the_reference_keeps_its_own_bars() {
    let kit = solutions::kit();
    for (name, boxes) in scenes() {
        let own = cost(&kit.build_binned(std::slice::from_ref(&boxes))[0]);
        let ratio = own / sweep_cost(name);
        println!("{name}: {own:.3}, {ratio:.3} times the cost after a full sweep");
        assert!(ratio <= 1.05, "{name}");
    }
}
