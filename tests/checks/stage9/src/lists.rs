//! The laws that all builders share: which primitives a cell lists.

use checks::prelude::*;
use raykata::kit::kit_error::{self, KitError};
use raykata::partition::{Cell, CellTree, Tree, TreeNode};
use std::collections::BTreeSet;

/// Boxes on a lattice, so that many touch or are flat, on a finer grid, and with full mantissas. Some are empty.
/// A volume is a normal number in single precision at any of these scales.
pub(super) fn some_boxes() -> impl Strategy<Value = Vec<Aabb>> + Clone {
    let corner_and_size = prop_oneof![
        2 => (nasty::lattice(4), nasty::lattice(2)),
        3 => (point(4), point(2)),
        1 => (rough_point(4.0), rough_point(2.0)),
    ];
    let one = (corner_and_size, 0..20i32).prop_map(|((corner, size), kind)| match kind {
        0 => Aabb::EMPTY,
        // A box is empty if it is inverted along one axis.
        1 => Aabb::new(corner, corner + vec3(size.x.abs(), -1.0, size.z.abs())),
        _ => Aabb::new(corner, corner + size.abs()),
    });
    // A third of the scenes are 2^16 units from the origin, whose coordinates decide about the room.
    (prop::collection::vec(one, 1..24), nasty::scale(-30..=30), -1..=4i32).prop_map(|(boxes, scale, far)| {
        let away = if far.abs() == 1 { Vec3::splat(65536.0 * far as f32) } else { Vec3::ZERO };
        boxes.into_iter().map(|one| Aabb::new(scale * (one.min + away), scale * (one.max + away))).collect()
    })
}

/// A fault if the bounds of a structure do not contain all boxes that are not empty, with at least half of the room that
/// `padded_boxes` leaves. The other half is for its roundings.
fn bounds_fault(bounds: &Aabb, boxes: &[Aabb]) -> Option<Fault> {
    let all = checks::tree::around(boxes.iter().filter(|one| !one.is_empty()));
    let (low, high) = (all.min.as_dvec3(), all.max.as_dvec3());
    let extent = (high - low).max_element() * (-19f64).exp2();
    let room = extent.max(low.abs().max(high.abs()).max_element() * (-23f64).exp2());
    let most = DVec3::splat(f32::MAX.into());
    let has_room = bounds.min.as_dvec3().cmple((low - room).max(-most)).all()
        && bounds.max.as_dvec3().cmpge((high + room).min(most)).all();
    let (yours, expected) = (format!("the bounds {}", bounds.paste()), format!("around {}", all.paste()));
    if !bounds.contains_box(&all) {
        return Some(fact(yours, expected, "bounds must contain all boxes that are not empty"));
    }
    let mistake = "the bounds leave no room for rounding: build over padded_boxes, whose room also grows with the coordinates";
    (!has_room && !all.is_empty())
        .then(|| fact(yours, format!("{expected}, and {room:.1e} or more on each side"), mistake))
}

/// Whether a box is too far from a cell that lists it: farther than a 64th of the whole extent, and farther than 2⁻²⁰
/// of the largest coordinate, which is more than the room that builders leave. For a single point only the second limit
/// counts.
pub(super) fn is_far_off(all: &Aabb, cell: &Aabb, one: &Aabb) -> bool {
    let largest = all.min.abs().max(all.max.abs()).max_element();
    let room = ((all.max - all.min).max_element() / 64.0).max(2f32.powi(-20) * largest);
    let gap = (one.min - cell.max).max(cell.min - one.max);
    !(gap.max_element() <= room)
}

/// A fault of a structure: `(yours, expected, mistakes)`, each mistake with whether it is proven.
pub(super) type Fault = (String, String, Vec<(bool, &'static str)>);

/// A fault that proves its mistake.
pub(super) fn fact(yours: String, expected: String, mistake: &'static str) -> Fault {
    (yours, expected, vec![(true, mistake)])
}

/// The fault of a tree with more levels than a tree of depth `most` has.
pub(super) fn too_deep(levels: usize, most: usize, mistake: &'static str) -> Option<Fault> {
    let describe = || fact(format!("a node at depth {}", levels - 1), format!("at most {most}"), mistake);
    (levels > most + 1).then(describe)
}

/// A leaf, or a cell of a grid: its name, its place, and the primitives that it lists.
pub(super) type Listed<N> = (N, Cell, Vec<u32>);

/// The leaves of a tree of cells.
pub(super) fn leaves<N: TreeNode<Region = Cell>>(tree: &CellTree<N>) -> Vec<Listed<u32>> {
    let mut leaves = Vec::new();
    tree.walk(64, |node, cell, _| {
        if tree.nodes[node as usize].is_leaf() {
            leaves.push((node, cell, tree.listed(node).to_vec()));
        }
    });
    leaves
}

/// The primitives that the leaves below a node list, each once.
pub(super) fn below<N: TreeNode>(tree: &Tree<N>, node: u32) -> BTreeSet<u32> {
    let here = tree.listed(node).iter().copied();
    here.chain(tree.nodes[node as usize].children().flat_map(|child| below(tree, child))).collect()
}

/// The first fault in the lists of leaves or of cells, which are called `kind`.
pub(super) fn listing_fault<N: std::fmt::Display>(
    kind: &str,
    bounds: &Aabb,
    boxes: &[Aabb],
    leaves: &[Listed<N>],
) -> Option<Fault> {
    let (yours, expected, mut mistakes) = first_fault(kind, bounds, boxes, leaves)?;
    // The numbers that primitives have once the empty boxes are left out.
    let usable: Vec<&Aabb> = boxes.iter().filter(|one| !one.is_empty()).collect();
    let is_right = |cell: &Cell, id: u32| {
        usable.get(id as usize).is_some_and(|one| !is_far_off(bounds, &cell.to_box(), one))
    };
    let renumbered = leaves.iter().all(|(_, cell, listed)| listed.iter().all(|id| is_right(cell, *id)));
    let text = "your numbers are those of the boxes that are not empty: a primitive keeps its number";
    mistakes.insert(0, (usable.len() < boxes.len() && renumbered, text));
    Some((yours, expected, mistakes))
}

fn first_fault<N: std::fmt::Display>(
    kind: &str,
    bounds: &Aabb,
    boxes: &[Aabb],
    leaves: &[Listed<N>],
) -> Option<Fault> {
    if let Some(fault) = bounds_fault(bounds, boxes) {
        return Some(fault);
    }
    for (node, cell, listed) in leaves {
        for (id, one) in boxes.iter().enumerate() {
            let times = listed.iter().filter(|&&other| other == id as u32).count();
            let describe = |times: usize| format!("primitive {id} is listed {times} times in {kind} {node}");
            if one.is_empty() {
                if times > 0 {
                    let mistake = "you list an empty box: leave it out";
                    return Some(fact(describe(times), describe(0), mistake));
                }
                continue;
            }
            let elsewhere = || leaves.iter().any(|(.., listed)| listed.contains(&(id as u32)));
            // All cells of a grid over a single point are that point: one of them that lists the primitive is enough.
            let at_one_point = bounds.min == bounds.max && times == 0;
            if cell.touches(one) && times != 1 && !(at_one_point && elsewhere()) {
                let touches = (0..3).any(|axis| {
                    let [low, high] = [one.min[axis], one.max[axis]].map(f64::from);
                    high == cell.min[axis] || low == cell.max[axis]
                });
                let missing = times == 0;
                let nowhere = missing && !elsewhere();
                // Each cell lists only primitives that it overlaps, so that their places are right.
                let is_right = |cell: &Cell, id: &u32| {
                    boxes.get(*id as usize).is_some_and(|one| !is_far_off(bounds, &cell.to_box(), one))
                };
                let right = |(_, cell, listed): &Listed<N>| listed.iter().all(|id| is_right(cell, id));
                let elsewhere = missing && !nowhere && leaves.iter().all(right);
                return Some((
                    describe(times),
                    describe(1),
                    named![
                        elsewhere && touches => "a primitive that touches a plane belongs to both sides",
                        elsewhere => "a primitive that overlaps or touches several cells belongs to all of them",
                        nowhere => "you leave out a primitive: no cell lists it",
                        !missing => "you list a primitive twice in one cell",
                    ].to_vec(),
                ));
            }
            if times > 0 && is_far_off(bounds, &cell.to_box(), one) {
                let mistake = "you list a primitive in a cell that it does not overlap";
                return Some(fact(describe(times), describe(0), mistake));
            }
        }
    }
    None
}

/// Judges a tree of `n_nodes` nodes. If there is `nothing` to list, it must have no nodes; otherwise `fault` judges it.
pub(super) fn judge_tree(
    describe: impl FnOnce() -> String,
    source: &'static str,
    (nothing, n_nodes): (bool, usize),
    fault: impl FnOnce() -> Option<Fault>,
) -> CheckResult {
    let fault = match (nothing, n_nodes) {
        (true, 0) => None,
        (true, n) => {
            let mistake = "you make nodes although there are no primitives";
            Some(fact(format!("{n} nodes"), "no nodes".into(), mistake))
        }
        (false, 0) => {
            let mistake = "you make no node although there are primitives";
            Some(fact("no nodes".into(), "at least one node".into(), mistake))
        }
        (false, _) => fault(),
    };
    fault.map_or(Ok(()), |(yours, expected, mistakes)| {
        Err(Broken::with_texts(describe(), yours, expected, source).explained_by(mistakes))
    })
}

/// The tree that `build` makes; an error if it panics, because its recursion does not end or its leaves list too many
/// references. There is a diagnosis for each of the two.
pub(super) fn ended<T>(
    input: &str,
    source: &'static str,
    [too_deep, too_many]: [&'static str; 2],
    build: impl FnOnce() -> T,
) -> Result<T, Broken> {
    kit_error::catch(build).map_err(|error| match error {
        KitError::Panicked { message, .. } => {
            let mistakes =
                [(message.contains("references"), too_many), (message.contains("at depth"), too_deep)];
            Broken::with_texts(input, message, "a tree", source).explained_by(mistakes)
        }
        error => kit_error::unwind(error),
    })
}

/// Whether the leaves hold at most `most` references. A primitive counts once per leaf that lists it.
pub(super) fn judge_references(input: &str, yours: &[u32], most: usize, says: &'static str) -> CheckResult {
    let describe = |n: usize| format!("{n} references");
    if yours.len() <= most {
        return Ok(());
    }
    let broken =
        Broken::with_texts(input, describe(yours.len()), format!("at most {}", describe(most)), "counted");
    Err(broken.explained_by([(yours.len() > most, says)]))
}

/// Long thin boxes, each along an axis through the whole cube, crossing each other: at each level of a tree most of them
/// are in twice as many cells.
pub(super) fn needles(n: usize) -> Vec<Aabb> {
    let needle = |i: usize| {
        // Spread the needles over the cube by the multiples of the golden ratio and of another irrational number.
        let [u, v] = [0.618_034, 0.754_878].map(|step: f32| (i as f32 * step).fract());
        let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
        low[i % 3] = 0.0;
        high[i % 3] = 1.0;
        for (axis, at) in [(i + 1, u), (i + 2, v)] {
            low[axis % 3] = at;
            high[axis % 3] = at + 1e-3;
        }
        Aabb::new(low, high)
    };
    (0..n).map(needle).collect()
}

/// Named sets of boxes for which the recursion of a builder may not end. `n` of them are in one place.
pub(super) fn infinite(n: usize) -> Vec<(&'static str, Vec<Aabb>)> {
    let cube = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let corner = Aabb::new(Vec3::splat(9.0), Vec3::splat(9.0));
    let concentric = (1..=24).map(|i| Aabb::new(Vec3::splat(-i as f32), Vec3::splat(i as f32))).collect();
    let line = (0..64).map(|i| Aabb::new(Vec3::X * i as f32, Vec3::X * i as f32)).collect();
    let halving =
        (0..100).map(|i| Aabb::new(Vec3::splat(2f32.powi(-i)), Vec3::splat(2f32.powi(-i)))).collect();
    // Six of ten boxes cover everything.
    let long = (0..10).map(|i| {
        let x = i as f32;
        if i < 6 {
            Aabb::new(Vec3::ZERO, Vec3::splat(10.0))
        } else {
            Aabb::new(Vec3::splat(x), Vec3::splat(x + 0.5))
        }
    });
    vec![
        ("no boxes", Vec::new()),
        ("one box", vec![cube]),
        ("two boxes", vec![cube, corner]),
        ("many boxes in one place", vec![cube; n]),
        ("many points in one place", vec![Aabb::new(Vec3::ONE, Vec3::ONE); n]),
        ("many boxes in one place and a point", std::iter::repeat_n(cube, n).chain([corner]).collect()),
        ("24 concentric boxes", concentric),
        ("64 points in a line", line),
        ("100 points, each half as far as the one before", halving),
        ("ten boxes of which six cover everything", long.collect()),
        ("400 long needles along the axes", needles(400)),
        ("empty boxes", vec![Aabb::EMPTY; 3]),
    ]
}
