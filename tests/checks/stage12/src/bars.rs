//! The bars: what the reference needs, by which the counts of students are judged. They stand in `[stage12.bars]` of
//! `rubric.toml`. `author bars` measures them and writes them there; run it after a change of the reference, of a scene or of a
//! count.

use super::scenes::scenes;
use super::visits::rays_through_a_cloud;
use super::wide_tables::n_calls;
use checks::prelude::*;
use checks::tree::{around, half_area};
use raykata::rubric;
use raykata::wide::{BLOCK, BLOCK_COST, MAX_LEAF, NODE_COST};

/// The calls of `wide_closest_hit` for all [`rays_through_a_cloud`]: nodes, blocks and exact tests together.
pub fn calls_of_search() -> usize {
    rubric::bar(12, SEARCH) as usize
}

/// The cost of the tree over a scene that a full sweep gives: at each node it tries every split of the primitives, sorted along
/// each axis, by the costs of this stage.
pub fn sweep_cost(scene: &str) -> f64 {
    rubric::bar(12, &swept(scene))
}

const SEARCH: &str = "calls of wide_closest_hit";

fn swept(scene: &str) -> String {
    format!("cost after a full sweep: {scene}")
}

/// All bars as `kit` gives them, in the order in which the rubric lists them. Costs are rounded to thousandths.
pub fn measured(kit: &dyn Kit) -> Vec<(String, f64)> {
    let rounded = |cost: f64| (1000.0 * cost).round() / 1000.0;
    let calls: usize = kit.wide_closest_hit(&rays_through_a_cloud()).iter().map(n_calls).sum();
    let mut bars = vec![(SEARCH.into(), calls as f64)];
    for (scene, mut boxes) in scenes() {
        let root = half_area(&around(&boxes));
        bars.push((swept(scene), rounded(sweep(&mut boxes) / root)));
    }
    bars
}

/// The cost of the tree that a full sweep gives, times the half area of its root: at each node every split of the primitives
/// is tried, sorted by their centroids along each axis.
fn sweep(boxes: &mut [Aabb]) -> f64 {
    let leaf_cost = |n: usize| f64::from(BLOCK_COST) * n.div_ceil(BLOCK) as f64;
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
