//! The bars of stage 12, by which students are judged, are the counts of the reference.

use checks::tree::{around, half_area};
use raykata::aabb::Aabb;
use raykata::kit::{ReinsertQuery, StreamQuery, WideQuery};
use raykata::wide::{BLOCK, BLOCK_COST, MAX_LEAF, NODE_COST};
use stage12_checks::bars::{CALLS_OF_SEARCH, CALLS_OF_STREAMS, NODES_OPENED, REINSERTED_COSTS, SWEEP_COSTS};
use stage12_checks::places::places_in_scenes;
use stage12_checks::reinsertions::morton_trees;
use stage12_checks::scenes::scenes;
use stage12_checks::streams::streams_through_a_cloud;
use stage12_checks::trees::cost;
use stage12_checks::visits::rays_through_a_cloud;
use stage12_checks::wide_tables::n_calls;

/// The cost of a leaf over this number of primitives, for a box of area 1.
fn leaf_cost(n: usize) -> f64 {
    f64::from(BLOCK_COST) * n.div_ceil(BLOCK) as f64
}

/// The cost of the tree that a full sweep gives, times the half area of its root: at each node every split of the primitives
/// is tried, sorted by their centroids along each axis.
fn sweep(boxes: &mut [Aabb]) -> f64 {
    let area = half_area(&around(&*boxes));
    let n = boxes.len();
    if n <= BLOCK {
        return area * leaf_cost(n);
    }
    let (mut best, mut best_at) = (f64::INFINITY, (0, n / 2));
    for axis in 0..3 {
        boxes.sort_by(|p, q| (p.min + p.max)[axis].total_cmp(&(q.min + q.max)[axis]));
        let areas = |boxes: &mut dyn Iterator<Item = &Aabb>| -> Vec<f64> {
            let mut all = Aabb::EMPTY;
            boxes
                .map(|one| {
                    all = around([&all, one]);
                    half_area(&all)
                })
                .collect()
        };
        let (left, right) = (areas(&mut boxes.iter()), areas(&mut boxes.iter().rev()));
        for middle in 1..n {
            let cost = left[middle - 1] * leaf_cost(middle) + right[n - middle - 1] * leaf_cost(n - middle);
            if cost < best {
                (best, best_at) = (cost, (axis, middle));
            }
        }
    }
    let node = f64::from(NODE_COST) * area;
    if n <= MAX_LEAF && node + best >= area * leaf_cost(n) {
        return area * leaf_cost(n);
    }
    let (axis, middle) = best_at;
    boxes.sort_by(|p, q| (p.min + p.max)[axis].total_cmp(&(q.min + q.max)[axis]));
    let (left, right) = boxes.split_at_mut(middle);
    node + sweep(left) + sweep(right)
}

#[test]
fn the_bars_are_those_of_the_reference() {
    let kit = solutions::kit();
    let mut found = Vec::new();
    for (name, mut boxes) in scenes() {
        let own = cost(&kit.build_binned(std::slice::from_ref(&boxes))[0]);
        let root = half_area(&around(&boxes));
        let swept = sweep(&mut boxes) / root;
        println!(
            "    (\"{name}\", {swept:.3}), // the reference: {own:.3}, {:.3} times as much",
            own / swept
        );
        found.push((name, swept));
    }
    let calls: usize = kit.wide_closest_hit(&rays_through_a_cloud()).iter().map(n_calls).sum();
    println!("{calls} calls");
    // Print all bars of the bonus before the first one is compared.
    let opened: usize =
        kit.cheapest_place(&places_in_scenes()).iter().map(|answer| answer.opened.len()).sum();
    println!("{opened} nodes opened");
    let streams = kit.stream_closest_hits(&streams_through_a_cloud());
    let of_streams: u64 = streams.iter().map(|answer| u64::from(answer.n_calls)).sum();
    let fetched: usize = streams.iter().map(|answer| answer.nodes.len() + answer.blocks.len()).sum();
    println!("{of_streams} calls of streams, {fetched} nodes and blocks fetched");
    // What the same rays cost one by one, for the slides.
    let one_by_one = streams_through_a_cloud().into_iter().flat_map(|query| {
        let StreamQuery { tree, rays, entries, hits } = query;
        let rays = rays.into_iter().zip(entries).zip(hits);
        rays.map(move |((ray, entries), hits)| WideQuery { tree: tree.clone(), ray, entries, hits })
    });
    let alone = kit.wide_closest_hit(&one_by_one.collect::<Vec<_>>());
    let (calls_alone, fetched_alone) = alone.iter().fold((0, 0), |(calls, fetched), one| {
        (calls + n_calls(one), fetched + one.nodes.len() + one.blocks.len())
    });
    println!("{calls_alone} calls one by one, {fetched_alone} nodes and blocks fetched");
    let trees: Vec<ReinsertQuery> = morton_trees().into_iter().map(|(_, query)| query).collect();
    let reinserted: Vec<f64> = kit.reinsert(&trees).iter().map(cost).collect();
    for (((name, _), query), after) in REINSERTED_COSTS.iter().zip(&trees).zip(&reinserted) {
        let before = cost(&query.tree);
        println!(
            "    (\"{name}\", {after:.3}), // before: {before:.3}, {:.1} % saved",
            100.0 * (1.0 - after / before)
        );
    }
    assert_eq!(calls, CALLS_OF_SEARCH);
    assert_eq!((opened, of_streams), (NODES_OPENED, CALLS_OF_STREAMS));
    for ((name, bar), after) in REINSERTED_COSTS.iter().zip(&reinserted) {
        assert!((after - bar).abs() < 1e-3, "{name}: {after}, not {bar}");
    }
    for ((name, swept), (of, bar)) in found.iter().zip(SWEEP_COSTS) {
        assert!(*name == of && (swept - bar).abs() < 1e-3, "{name}: {swept}, {of}: {bar}");
    }
}
