//! What the laws of both builders of BSP trees share: hulls, and the judgement of a tree over them.

use super::lists::{self, Fault};
use checks::prelude::*;
use raykata::partition::{MOST_REFERENCES, corners};

pub(super) fn describe(BspQuery { hulls, leaf_size, max_depth }: &BspQuery) -> String {
    format!("build over {} hulls, leaf_size {leaf_size}, max_depth {max_depth}", hulls.len())
}

/// Whether a tree must contain a hull: it has corners, and all are finite.
pub(super) fn usable(hull: &[Vec3]) -> bool {
    !hull.is_empty() && hull.iter().all(|corner| corner.is_finite())
}

/// The largest coordinate of all finite corners, at least 0.
pub(super) fn size(query: &BspQuery) -> f64 {
    let sizes = query.hulls.iter().flatten().filter(|p| p.is_finite()).map(|p| p.abs().max_element());
    f64::from(sizes.fold(0.0, f32::max))
}

/// Judges a tree of `n_nodes` nodes and `levels` levels. If no hull is usable, it must have no nodes; otherwise `fault`
/// judges it.
pub(super) fn judge_tree(
    query: &BspQuery,
    source: &'static str,
    (n_nodes, levels): (usize, usize),
    fault: impl FnOnce() -> Option<Fault>,
) -> CheckResult {
    let nothing = !query.hulls.iter().any(|hull| usable(hull));
    lists::judge_tree(
        || describe(query),
        source,
        (nothing, n_nodes),
        || lists::too_deep(levels, query.max_depth, "the tree is deeper than max_depth").or_else(fault),
    )
}

/// Named polygons for which the recursion of a builder may not end, each with the most references per polygon.
pub(super) fn infinite_polygons() -> [(&'static str, Vec<Vec<Vec3>>, usize); 3] {
    let square = |s: f32| vec![vec3(-s, -s, 0.0), vec3(s, -s, 0.0), vec3(s, s, 0.0), vec3(-s, s, 0.0)];
    let star = (0..30).map(|i| {
        let (y, x) = (i as f32 * 0.21).sin_cos();
        vec![vec3(x, y, -1.0), vec3(-x, -y, -1.0), vec3(-x, -y, 1.0), vec3(x, y, 1.0)]
    });
    let line = (0..20).map(|i| [0.0, 0.5, 0.7].map(|x| vec3(i as f32 + x, 0.0, 0.0)).to_vec());
    [
        // Each plane has all squares on it, and on one of its sides: one node lists all of them.
        ("forty squares in one plane", (1..=40).map(|i| square(i as f32)).collect(), 1),
        ("thirty sheets through one line", star.collect(), MOST_REFERENCES),
        ("twenty slivers in a line", line.collect(), MOST_REFERENCES),
    ]
}

/// The hulls of boxes for which the recursion may not end, each set with the most references per box. `n` are in one place.
pub(super) fn infinite_boxes(n: usize) -> impl Iterator<Item = (&'static str, Vec<Vec<Vec3>>, usize)> {
    let hulls = |(name, all): (_, Vec<Aabb>)| (name, all.iter().map(corners).collect(), MOST_REFERENCES);
    lists::infinite(n).into_iter().map(hulls)
}

/// `n` parallel squares side by side across a diagonal: planes across an axis do not divide them, but their own planes
/// do.
pub(super) fn sheets(n: usize) -> Vec<Vec<Vec3>> {
    let sheet = |at: f32| {
        let p = |u: f32, v: f32| vec3(at + u, at - u, v);
        vec![p(-40.0, -40.0), p(40.0, -40.0), p(40.0, 40.0), p(-40.0, 40.0)]
    };
    (0..n).map(|i| sheet(0.25 * i as f32)).collect()
}
