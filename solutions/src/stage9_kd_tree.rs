//! Stage 9 · the kd-tree: planes across the axes divide space, and five heuristics choose the
//! planes.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`KdTree`] with `add_node`, `set_leaf` and `set_children`; [`ListGrowth`], whose `divide`
//! returns `None` where all leaves together would list more than
//! [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive, which is the
//! most that is allowed.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, or if the ray misses the bounds, the result is `None`.

use crate::stage9_cells::{ROUNDING, around, may_stop_before, padded_boxes, part_above, span, test_cell};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, KdHeuristics, KdNode, KdTree, ListGrowth};
use raykata::ray::Ray;

/// Planes across the axes divide space. Five heuristics choose them, each alone or together. What
/// if all boxes are on both sides?
///
/// Exactly:
///
/// 1. Divide a node of more than `leaf_size` primitives, unless it is at depth
///    [`KdTree::most_depth`] (root: 0), all would be on both sides, or
///    [`ListGrowth::divide`] returns `None`.
/// 2. A plane lies within its cell. The bounds contain all padded boxes.
/// 3. List a primitive once in every leaf that its box touches, on both sides of a touched plane.
/// 4. Leave out empty boxes. Without a usable box there are no nodes.
/// 5. `longest_axis`: cut across the cell's longest side. Off: x, y, z in turn, x first.
/// 6. `balanced_counts`: minimise the difference of counts.
/// 7. `few_straddlers`: minimise the number on both sides. With both, minimise the sum; with
///    neither, cut the cell in the middle.
/// 8. `cut_off_empty_space`: first cut off an empty margin of over a tenth of the cell.
/// 9. `stop_at_overlap`: make a leaf if at least 60 % of one side, but not 0, would be on both.
///
/// Source: "Heuristics" 1 to 5.
pub fn build(bounds: &[Aabb], heuristics: &KdHeuristics, leaf_size: usize) -> KdTree {
    // <solution>
    let boxes = padded_boxes(bounds);
    let around = around(&boxes);
    let mut tree = KdTree::new(around);
    if !boxes.is_empty() {
        let max_depth = KdTree::most_depth(boxes.len());
        let rules = Rules { heuristics: *heuristics, leaf_size, max_depth };
        divide(&mut tree, &boxes, around, (0, ListGrowth::ROOT), &rules);
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

fn divide(
    tree: &mut KdTree,
    boxes: &[(u32, Aabb)],
    cell: Aabb,
    (depth, growth): (usize, ListGrowth),
    rules: &Rules,
) -> u32 {
    // Choose a plane, unless the node must be a leaf.
    let node = tree.add_node(depth, rules.max_depth);
    let divided = boxes.len() > rules.leaf_size && depth < rules.max_depth;
    let cut = divided.then(|| choose_cut(boxes, &cell, depth, &rules.heuristics)).flatten();
    // Refuse a plane if the two sides repeat too many primitives.
    let n_below = |cut| boxes.len() + sides(boxes, cut).n_both;
    match cut.and_then(|cut| Some((cut, growth.divide(boxes.len(), n_below(cut))?))) {
        None => {
            let ids: Vec<u32> = boxes.iter().map(|(id, _)| *id).collect();
            tree.set_leaf(node, &ids);
        }
        Some((Cut { axis, position }, growth)) => {
            // Divide the boxes between the two sides. A box that touches the plane goes to both.
            let part = |keep: &dyn Fn(&Aabb) -> bool| -> Vec<(u32, Aabb)> {
                boxes.iter().filter(|(_, one)| keep(one)).copied().collect()
            };
            let deeper = (depth + 1, growth);
            let (mut below, mut above) = (cell, cell);
            below.max[axis] = position;
            above.min[axis] = position;
            let left = divide(tree, &part(&|one| one.min[axis] <= position), below, deeper, rules);
            let right = divide(tree, &part(&|one| one.max[axis] >= position), above, deeper, rules);
            tree.set_children(node, axis, position, left, right);
        }
    }
    node
}

/// A plane across `axis`, at the coordinate `position`.
#[derive(Clone, Copy)]
struct Cut {
    axis: usize,
    position: f32,
}

/// The plane, or `None` if the node should be a leaf.
fn choose_cut(boxes: &[(u32, Aabb)], cell: &Aabb, depth: usize, heuristics: &KdHeuristics) -> Option<Cut> {
    // Cut off an empty margin first.
    if heuristics.cut_off_empty_space
        && let Some(cut) = widest_margin(boxes, cell)
    {
        return Some(cut);
    }
    // Order the axes: in turn by depth, or the longest side of the cell first.
    let mut axes = [depth % 3, (depth + 1) % 3, (depth + 2) % 3];
    if heuristics.longest_axis {
        let size = |axis: usize| f64::from(cell.max[axis]) - f64::from(cell.min[axis]);
        axes.sort_by(|&p, &q| size(q).total_cmp(&size(p)).then(p.cmp(&q)));
    }
    // Take the first axis on which the cell can be cut: a flat cell has no plane inside.
    let cut = |axis: usize| Some(Cut { axis, position: position(boxes, cell, axis, heuristics)? });
    let cut = axes.into_iter().find_map(cut)?;

    // Refuse a plane that divides nothing, or one with too much overlap.
    let Sides { n_left, n_right, n_both } = sides(boxes, cut);
    let overlap = n_both > 0 && 10 * n_both >= 6 * n_left.min(n_right);
    (n_both < boxes.len() && !(heuristics.stop_at_overlap && overlap)).then_some(cut)
}

/// The numbers of primitives on the left, on the right, and on both sides of a plane.
struct Sides {
    n_left: usize,
    n_right: usize,
    n_both: usize,
}

fn sides(boxes: &[(u32, Aabb)], Cut { axis, position }: Cut) -> Sides {
    let n_left = boxes.iter().filter(|(_, one)| one.min[axis] <= position).count();
    let n_right = boxes.iter().filter(|(_, one)| one.max[axis] >= position).count();
    Sides { n_left, n_right, n_both: n_left + n_right - boxes.len() }
}

/// The cut that removes the widest empty margin, if it is wider than a tenth of the cell.
fn widest_margin(boxes: &[(u32, Aabb)], cell: &Aabb) -> Option<Cut> {
    let around = around(boxes);
    let mut widest = (0.1, None);
    for axis in 0..3 {
        let [low, high] = [cell.min[axis], cell.max[axis]].map(f64::from);
        // Put the plane one float away from the primitives: if they touched it, they would be on
        // both sides.
        for (position, margin) in [
            (around.min[axis].next_down(), f64::from(around.min[axis]) - low),
            (around.max[axis].next_up(), high - f64::from(around.max[axis])),
        ] {
            let share = margin / (high - low);
            if share > widest.0 && cell.min[axis] < position && position < cell.max[axis] {
                widest = (share, Some(Cut { axis, position }));
            }
        }
    }
    widest.1
}

/// The best coordinate for a plane across `axis`; `None` if the cell has no extent on this axis.
fn position(boxes: &[(u32, Aabb)], cell: &Aabb, axis: usize, heuristics: &KdHeuristics) -> Option<f32> {
    // Cut in the middle if both heuristics are off.
    let (low, high) = (cell.min[axis], cell.max[axis]);
    let midpoint = |p: f32, q: f32| 0.5 * p + 0.5 * q;
    let middle = midpoint(low, high);
    let inside = |at: &f32| low < *at && *at < high;
    if !heuristics.balanced_counts && !heuristics.few_straddlers {
        return Some(middle).filter(inside);
    }

    // Compute the cost of a plane from the numbers of boxes on its two sides.
    let cost = |n_left: usize, n_right: usize| {
        let balance = if heuristics.balanced_counts { n_left.abs_diff(n_right) } else { 0 };
        balance + if heuristics.few_straddlers { n_left + n_right - boxes.len() } else { 0 }
    };
    // Try the middle of the cell first: of equal planes the one nearest to it wins.
    let Sides { n_left, n_right, .. } = sides(boxes, Cut { axis, position: middle });
    let mut best = inside(&middle).then_some((cost(n_left, n_right), 0.0, middle));

    // Sort where boxes begin and end: counts change only there. Begins come first at equal
    // coordinates, so that a plane between them and the ends touches all of these boxes.
    let mut edges: Vec<(f32, bool)> =
        boxes.iter().flat_map(|(_, one)| [(one.min[axis], false), (one.max[axis], true)]).collect();
    edges.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    // Move a plane from edge to edge. Behind a begin one more box is on the left, behind an end one
    // less on the right.
    let (mut n_left, mut n_right) = (0, boxes.len());
    for pair in edges.windows(2) {
        let [(low, is_end), (high, next_is_end)] = [pair[0], pair[1]];
        n_left += usize::from(!is_end);
        n_right -= usize::from(is_end);
        let at = midpoint(low, high);
        let is_between = (low < at && at < high) || (low == high && !is_end && next_is_end);
        let this = (cost(n_left, n_right), (f64::from(at) - f64::from(middle)).abs(), at);
        if is_between && inside(&at) && best.is_none_or(|best| (this.0, this.1) < (best.0, best.1)) {
            best = Some(this);
        }
    }
    best.map(|(_, _, at)| at)
}
// </solution>

/// The ray is in each cell for an interval `t..t'`. A plane cuts it in two: search the near side
/// first, then the far side, unless the best hit lies before it. Is a hit on the face of the cell
/// before `t'`?
///
/// Exactly:
///
/// 1. Visit a node at most once, and only if the ray enters it before the best hit.
/// 2. A ray in the plane, or that starts on it, is on both sides: a primitive in the plane may be
///    listed on one side only.
///
/// Source: "kd-Tree Traversal" with `t` and `t'`.
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
    // <stub> todo!("search the near side of each plane first, then the far side unless the best hit is before it")
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
    // Stop if the best hit lies before this node.
    if may_stop_before(best, part.0) {
        return;
    }
    probe.visit(node);
    match tree.nodes[node as usize] {
        KdNode::Leaf { first, count } => test_cell(tree.primitives(first, count), probe, ray, best),
        KdNode::Inner { axis, at, left, right } => {
            // Compute the height of the origin above the plane, and its change per unit of t.
            let axis = usize::from(axis);
            let (height, rate) =
                (f64::from(ray.origin[axis]) - f64::from(at), f64::from(ray.direction[axis]));
            // A ray in the plane, or that starts on it, is on both sides.
            // Find the part of the ray on each side, and search the nearer side first.
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
