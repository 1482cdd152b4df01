//! Functions about bounding volume hierarchies: the invariants of a tree, its expected cost, its text and the least
//! cost of a cut. `search` has tables of answers and the nodes that a search needs.

mod search;

pub use search::{
    closest_in_table, closest_of, hits_of, move_apart, needed, overlapped, search_query, sphere_box, tie,
    tied,
};

use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, INTERSECTION_COST, PrimitiveRef, TRAVERSAL_COST};

/// The smallest box around all of `boxes`.
pub fn around<'a>(boxes: impl IntoIterator<Item = &'a Aabb>) -> Aabb {
    boxes.into_iter().fold(Aabb::EMPTY, |all, one| Aabb::new(all.min.min(one.min), all.max.max(one.max)))
}

/// The smallest box around all of `primitives`.
pub fn around_all(primitives: &[PrimitiveRef]) -> Aabb {
    around(primitives.iter().map(|p| &p.bounds))
}

/// The smallest box around the centroids of `primitives`.
pub fn around_centroids(primitives: &[PrimitiveRef]) -> Aabb {
    let centroids: Vec<Aabb> = primitives.iter().map(|p| Aabb::new(p.centroid, p.centroid)).collect();
    around(&centroids)
}

/// Half the surface area of a box; 0 for an empty one.
pub fn half_area(bounds: &Aabb) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    let size = (bounds.max - bounds.min).as_dvec3();
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// The references to `boxes` that builders get, with the centroids.
pub fn references(boxes: &[Aabb]) -> Vec<PrimitiveRef> {
    let reference = |(id, bounds): (usize, &Aabb)| PrimitiveRef {
        id: id as u32,
        bounds: *bounds,
        centroid: 0.5 * (bounds.min + bounds.max),
    };
    boxes.iter().enumerate().map(reference).collect()
}

/// The cost of a cut, `A(L) n(L) + A(R) n(R)`, with half areas.
pub fn cut_cost(left: &[PrimitiveRef], right: &[PrimitiveRef]) -> f64 {
    let side = |part: &[PrimitiveRef]| half_area(&around_all(part)) * part.len() as f64;
    side(left) + side(right)
}

/// All cuts across an axis, each as the primitives on the left and on the right. There is one cut behind each centroid
/// but the last. Primitives with the same centroid keep their order.
pub fn cuts(primitives: &[PrimitiveRef], axis: usize) -> Vec<[Vec<PrimitiveRef>; 2]> {
    let before = |p: usize, q: usize| {
        let [p_at, q_at] = [p, q].map(|index| primitives[index].centroid[axis]);
        p_at.total_cmp(&q_at).then(p.cmp(&q)).is_lt()
    };
    let sides = |last: usize| {
        let side = |right: bool| {
            let there = (0..primitives.len()).filter(|&index| before(last, index) == right);
            there.map(|index| primitives[index]).collect::<Vec<PrimitiveRef>>()
        };
        [side(false), side(true)]
    };
    (0..primitives.len()).map(sides).filter(|[_, right]| !right.is_empty()).collect()
}

/// The least cost of all cuts across these axes.
pub fn least_cost(
    primitives: &[PrimitiveRef],
    axes: &[usize],
    cost: &dyn Fn(&[PrimitiveRef], &[PrimitiveRef]) -> f64,
) -> f64 {
    let cuts = axes.iter().flat_map(|&axis| cuts(primitives, axis));
    cuts.map(|[left, right]| cost(&left, &right)).fold(f64::INFINITY, f64::min)
}

/// Whether a leaf is cheaper than a cut of this cost; `None` if the two differ by so little that rounding decides.
pub fn leaf_is_cheaper(primitives: &[PrimitiveRef], cost: f64) -> Option<bool> {
    let area = half_area(&around_all(primitives));
    let (traversal, intersection) = (f64::from(TRAVERSAL_COST), f64::from(INTERSECTION_COST));
    let leaf = intersection * area * primitives.len() as f64;
    let split = traversal * area + intersection * cost;
    ((leaf - split).abs() > 1e-4 * leaf).then_some(leaf < split)
}

/// A tree to search. It joins neighbours in the list, from the leaves up, and so follows none of the rules by which
/// students build.
pub fn joined(boxes: &[Aabb], leaf_size: usize) -> Bvh {
    let references = references(boxes);
    let leaves: Vec<&[PrimitiveRef]> = references.chunks(leaf_size).collect();
    let mut bounds: Vec<Aabb> = leaves.iter().map(|leaf| around_all(leaf)).collect();
    let mut pairs = Vec::new();
    let mut level: Vec<usize> = (0..leaves.len()).collect();
    while level.len() > 1 {
        let mut above = Vec::new();
        for pair in level.chunks(2) {
            if let [left, right] = *pair {
                above.push(bounds.len());
                bounds.push(around([&bounds[left], &bounds[right]]));
                pairs.push((left, right));
            } else {
                above.extend_from_slice(pair);
            }
        }
        level = above;
    }
    // Number the nodes in reverse order: the root, which was made last, gets 0, and every parent precedes its children.
    let mut bvh = Bvh::for_primitives(boxes.len());
    bounds.iter().rev().for_each(|one| _ = bvh.add_node(*one));
    let number = |made: usize| (bounds.len() - 1 - made) as u32;
    leaves.iter().enumerate().for_each(|(made, leaf)| bvh.set_leaf(number(made), leaf));
    for (index, (left, right)) in pairs.into_iter().enumerate() {
        bvh.set_children(number(leaves.len() + index), number(left), number(right));
    }
    bvh
}

/// The axes on which a box is longest: several if their lengths differ by at most 1e-6 of the longest.
pub fn longest_axes(bounds: &Aabb) -> Vec<usize> {
    let size = bounds.max - bounds.min;
    (0..3).filter(|&axis| size[axis] >= size.max_element() * (1.0 - 1e-6)).collect()
}

/// The expected cost of a tree for a ray that enters its root: each node is weighted with its area divided by the area
/// of the root.
pub fn expected_cost(bvh: &Bvh) -> f64 {
    let area = |node: usize| half_area(&bvh.nodes[node].bounds);
    let cost = |node: usize| match bvh.nodes[node].contents {
        Contents::Inner { .. } => f64::from(TRAVERSAL_COST),
        Contents::Leaf { count, .. } => f64::from(INTERSECTION_COST) * f64::from(count),
    };
    (0..bvh.nodes.len()).map(|node| area(node) * cost(node)).sum::<f64>() / area(0)
}

/// The first fault of a well-formed tree over `boxes`: `(yours, expected)`.
pub fn fault(bvh: &Bvh, boxes: &[Aabb], leaf_size: usize) -> Option<(String, String)> {
    let wrong = |yours: String, expected: &str| Some((yours, expected.to_owned()));
    let n = boxes.len();
    if n == 0 {
        return if bvh.nodes.is_empty() {
            None
        } else {
            wrong(format!("{} nodes", bvh.nodes.len()), "no nodes")
        };
    }
    let mut seen = vec![0; n];
    let mut waiting = if bvh.nodes.is_empty() { Vec::new() } else { vec![0] };
    while let Some(node) = waiting.pop() {
        let this = &bvh.nodes[node];
        match this.contents {
            Contents::Inner { left, right } => {
                for child in [left as usize, right as usize] {
                    if !this.bounds.contains_box(&bvh.nodes[child].bounds) {
                        return wrong(
                            format!("node {child} sticks out of its parent {node}"),
                            "boxes within boxes",
                        );
                    }
                    waiting.push(child);
                }
            }
            Contents::Leaf { first, count } => {
                if count == 0 || count as usize > leaf_size {
                    return wrong(
                        format!("leaf {node} holds {count}"),
                        &format!("1 to {leaf_size} primitives per leaf"),
                    );
                }
                for &id in bvh.primitives(first, count) {
                    let Some(bounds) = boxes.get(id as usize) else {
                        return wrong(format!("primitive {id}"), &format!("primitives 0..{n}"));
                    };
                    seen[id as usize] += 1;
                    if !bounds.min.is_nan() && !this.bounds.contains_box(bounds) {
                        return wrong(
                            format!("primitive {id} sticks out of leaf {node}"),
                            "boxes around their primitives",
                        );
                    }
                }
            }
        }
    }
    let missing = seen.iter().position(|&times| times != 1);
    missing.and_then(|id| {
        wrong(format!("primitive {id} is in {} leaves", seen[id]), "each primitive in exactly one leaf")
    })
}

/// A tree as text: one line per node, indented by depth, with children in the order of their boxes.
pub fn as_text(bvh: &Bvh) -> String {
    let mut text = String::new();
    if let Some(root) = bvh.root() {
        write_node(bvh, root, 0, &mut text);
    }
    text
}

fn write_node(bvh: &Bvh, node: u32, depth: usize, text: &mut String) {
    let Aabb { min, max } = bvh.nodes[node as usize].bounds;
    let bounds =
        format!("({:.3} {:.3} {:.3})..({:.3} {:.3} {:.3})", min.x, min.y, min.z, max.x, max.y, max.z);
    let indent = "  ".repeat(depth);
    match bvh.nodes[node as usize].contents {
        Contents::Leaf { first, count } => {
            let mut ids = bvh.primitives(first, count).to_vec();
            ids.sort_unstable();
            text.push_str(&format!("{indent}leaf {bounds} {ids:?}\n"));
        }
        Contents::Inner { left, right } => {
            text.push_str(&format!("{indent}node {bounds}\n"));
            let mut children = [left, right];
            let low = |child: u32| bvh.nodes[child as usize].bounds.min;
            children.sort_by(|&p, &q| {
                low(p).to_array().map(f32::to_bits).cmp(&low(q).to_array().map(f32::to_bits))
            });
            children.into_iter().for_each(|child| write_node(bvh, child, depth + 1, text));
        }
    }
}
