//! Stage 9 · the kd-tree: planes across the axes, put where five heuristics want them.
//!
//! Slides: "Kd-Trees", "Heuristics" 1 to 5, "kd-Tree Traversal" with `t` and `t'`.
//!
//! Given: [`KdTree`] with `add_node`, `set_leaf` and `set_children`.

use crate::stage9_cells::{ROUNDING, look_into, part_above, settled, span, widened};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, KdHeuristics, KdNode, KdTree};
use raykata::ray::Ray;

/// Builds a kd-tree from the top down. A node with more than `leaf_size` primitives is divided, if it is not at
/// [`KdTree::most_depth`] yet and not all primitives would be on both sides. A primitive that touches a plane is on both.
///
/// Each heuristic does one thing: `longest_axis` cuts across the longest side of the cell, or else across x, y, z by
/// turns, from x at the root; `balanced_counts` keeps the counts of the two sides alike; `few_straddlers` keeps those on
/// both few (together, the sum of the difference and the number on both is least; with neither the cut is in the middle);
/// `cut_off_empty_space` takes a margin of a tenth of the cell or more away first; `stop_at_overlap` makes a leaf if 60 %
/// of those on one side would also be on the other.
pub fn build(bounds: &[Aabb], heuristics: &KdHeuristics, leaf_size: usize) -> KdTree {
    // <solution>
    let widened = widened(bounds);
    let mut tree = KdTree::new(widened.around);
    if !widened.boxes.is_empty() {
        let max_depth = KdTree::most_depth(widened.boxes.len());
        let rules = Rules { heuristics: *heuristics, leaf_size, max_depth };
        divide(&mut tree, &widened.boxes, widened.around, 0, &rules);
    }
    tree
    // <stub> todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
    // </solution>
}

// <solution>
struct Rules {
    heuristics: KdHeuristics,
    leaf_size: usize,
    max_depth: usize,
}

fn divide(tree: &mut KdTree, boxes: &[(u32, Aabb)], cell: Aabb, depth: usize, rules: &Rules) -> u32 {
    let node = tree.add_node(depth, rules.max_depth);
    let divided = boxes.len() > rules.leaf_size && depth < rules.max_depth;
    match divided.then(|| choose_cut(boxes, &cell, depth, &rules.heuristics)).flatten() {
        None => {
            let ids: Vec<u32> = boxes.iter().map(|(id, _)| *id).collect();
            tree.set_leaf(node, &ids);
        }
        Some((axis, at)) => {
            let part = |keep: &dyn Fn(&Aabb) -> bool| -> Vec<(u32, Aabb)> {
                boxes.iter().filter(|(_, one)| keep(one)).copied().collect()
            };
            let (mut below, mut above) = (cell, cell);
            below.max[axis] = at;
            above.min[axis] = at;
            let left = divide(tree, &part(&|one| one.min[axis] <= at), below, depth + 1, rules);
            let right = divide(tree, &part(&|one| one.max[axis] >= at), above, depth + 1, rules);
            tree.set_children(node, axis, at, left, right);
        }
    }
    node
}

/// Axis and place of the plane, if the node should be divided.
fn choose_cut(
    boxes: &[(u32, Aabb)],
    cell: &Aabb,
    depth: usize,
    heuristics: &KdHeuristics,
) -> Option<(usize, f32)> {
    if heuristics.cut_off_empty_space
        && let Some(cut) = widest_margin(boxes, cell)
    {
        return Some(cut);
    }
    let mut axes = [depth % 3, (depth + 1) % 3, (depth + 2) % 3];
    if heuristics.longest_axis {
        let size = |axis: usize| f64::from(cell.max[axis]) - f64::from(cell.min[axis]);
        axes.sort_by(|&p, &q| size(q).total_cmp(&size(p)).then(p.cmp(&q)));
    }
    // A cell may be flat on an axis, and then there is nothing to cut.
    let (axis, at) = axes.into_iter().find_map(|axis| Some((axis, place(boxes, cell, axis, heuristics)?)))?;

    let (n_left, n_right, n_both) = sides(boxes, axis, at);
    let overlap = n_both > 0 && 10 * n_both >= 6 * n_left.min(n_right);
    (n_both < boxes.len() && !(heuristics.stop_at_overlap && overlap)).then_some((axis, at))
}

/// How many are on the left, on the right, and on both sides.
fn sides(boxes: &[(u32, Aabb)], axis: usize, at: f32) -> (usize, usize, usize) {
    let n_left = boxes.iter().filter(|(_, one)| one.min[axis] <= at).count();
    let n_right = boxes.iter().filter(|(_, one)| one.max[axis] >= at).count();
    (n_left, n_right, n_left + n_right - boxes.len())
}

/// The cut that takes the widest empty margin away, if it is a tenth of the cell.
fn widest_margin(boxes: &[(u32, Aabb)], cell: &Aabb) -> Option<(usize, f32)> {
    let around =
        boxes.iter().fold(Aabb::EMPTY, |all, (_, one)| Aabb::new(all.min.min(one.min), all.max.max(one.max)));
    let mut widest = (0.1, None);
    for axis in 0..3 {
        let [low, high] = [cell.min[axis], cell.max[axis]].map(f64::from);
        // One step off the primitives, which would otherwise touch the plane and be on both sides.
        for (at, margin) in [
            (around.min[axis].next_down(), f64::from(around.min[axis]) - low),
            (around.max[axis].next_up(), high - f64::from(around.max[axis])),
        ] {
            let share = margin / (high - low);
            if share > widest.0 && cell.min[axis] < at && at < cell.max[axis] {
                widest = (share, Some((axis, at)));
            }
        }
    }
    widest.1
}

/// The best place for a plane across `axis`, if the cell has any extent there.
fn place(boxes: &[(u32, Aabb)], cell: &Aabb, axis: usize, heuristics: &KdHeuristics) -> Option<f32> {
    let (low, high) = (cell.min[axis], cell.max[axis]);
    let midpoint = |p: f32, q: f32| 0.5 * p + 0.5 * q;
    let middle = midpoint(low, high);
    let inside = |at: &f32| low < *at && *at < high;
    if !heuristics.balanced_counts && !heuristics.few_straddlers {
        return Some(middle).filter(inside);
    }

    // Counts change only where a box begins or ends; half way between two such places nothing is touched.
    let sorted = |side: fn(&Aabb) -> glam::Vec3| {
        let mut sorted: Vec<f32> = boxes.iter().map(|(_, one)| side(one)[axis]).collect();
        sorted.sort_by(f32::total_cmp);
        sorted
    };
    let (begins, ends) = (sorted(|one| one.min), sorted(|one| one.max));
    let mut edges: Vec<f32> = begins.iter().chain(&ends).copied().collect();
    edges.sort_by(f32::total_cmp);
    let gaps = edges.windows(2).map(|pair| midpoint(pair[0], pair[1]));

    let cost = |at: f32| {
        let n_left = begins.partition_point(|begin| *begin <= at);
        let n_right = boxes.len() - ends.partition_point(|end| *end < at);
        let balance = if heuristics.balanced_counts { n_left.abs_diff(n_right) } else { 0 };
        balance + if heuristics.few_straddlers { n_left + n_right - boxes.len() } else { 0 }
    };
    let off = |at: f32| (f64::from(at) - f64::from(middle)).abs();
    gaps.chain([middle]).filter(inside).min_by(|&p, &q| cost(p).cmp(&cost(q)).then(off(p).total_cmp(&off(q))))
}
// </solution>

/// The closest hit, with the interval of `t` in which the ray is in each cell: the nearer side of a plane first, then the
/// farther one, unless the best hit lies before it.
///
/// Where the formula lies: `hit.distance < t'` drops a wall on the face of the box, and what reaches out of its leaf; and
/// a ray in the plane, or from it, is on both sides, for a builder may list what lies in the plane on one side only.
pub fn closest_hit(tree: &KdTree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if tree.nodes.is_empty() {
        return None;
    }
    let part = span(ray, &Cell::new(&tree.bounds))?;
    let mut ray = *ray;
    let mut best = None;
    search(tree, 0, part, probe, &mut ray, &mut best);
    best
    // <stub> todo!("search the nearer side of each plane first, then the farther one if it can matter")
    // </solution>
}

// <solution>
fn search(
    tree: &KdTree,
    node: u32,
    part: (f64, f64),
    probe: &mut impl Cells,
    ray: &mut Ray,
    best: &mut Option<PrimitiveHit>,
) {
    if settled(best, part.0) {
        return;
    }
    probe.visit(node);
    match tree.nodes[node as usize] {
        KdNode::Leaf { first, count } => look_into(tree.primitives(first, count), probe, ray, best),
        KdNode::Inner { axis, at, left, right } => {
            let axis = usize::from(axis);
            let (height, rate) =
                (f64::from(ray.origin[axis]) - f64::from(at), f64::from(ray.direction[axis]));
            let room = ROUNDING * height.abs();
            let above = part_above(height, rate, room, part).map(|part| (right, part));
            let below = part_above(-height, -rate, room, part).map(|part| (left, part));
            let in_order = if rate > 0.0 { [below, above] } else { [above, below] };
            for (child, part) in in_order.into_iter().flatten() {
                search(tree, child, part, probe, ray, best);
            }
        }
    }
}
// </solution>
