//! The bars of stage 12, by which students are judged, are the counts of the reference.

use raykata::kit::{ReinsertQuery, StreamQuery, WideQuery};
use raykata::rubric;
use stage12_checks::bars::{measured, sweep_cost};
use stage12_checks::reinsertions::morton_trees;
use stage12_checks::scenes::scenes;
use stage12_checks::streams::streams_through_a_cloud;
use stage12_checks::trees::cost;
use stage12_checks::wide_tables::n_calls;

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
    let streams = kit.stream_closest_hits(&streams_through_a_cloud());
    let fetched: usize = streams.iter().map(|answer| answer.nodes.len() + answer.blocks.len()).sum();
    // What the same rays cost one by one.
    let one_by_one = streams_through_a_cloud().into_iter().flat_map(|query| {
        let StreamQuery { tree, rays, entries, hits } = query;
        let rays = rays.into_iter().zip(entries).zip(hits);
        rays.map(move |((ray, entries), hits)| WideQuery { tree: tree.clone(), ray, entries, hits })
    });
    let alone = kit.wide_closest_hit(&one_by_one.collect::<Vec<_>>());
    let (calls_alone, fetched_alone) = alone.iter().fold((0, 0), |(calls, fetched), one| {
        (calls + n_calls(one), fetched + one.nodes.len() + one.blocks.len())
    });
    println!(
        "streams fetch {fetched} nodes and blocks; one by one {fetched_alone}, with {calls_alone} calls"
    );
    assert!(fetched < fetched_alone);
    let trees: Vec<ReinsertQuery> = morton_trees().into_iter().map(|(_, query)| query).collect();
    for (query, after) in trees.iter().zip(kit.reinsert(&trees)) {
        let (before, after) = (cost(&query.tree), cost(&after));
        println!("reinsert: {before:.3} becomes {after:.3}, {:.1} % saved", 100.0 * (1.0 - after / before));
        assert!(after < before);
    }
}
