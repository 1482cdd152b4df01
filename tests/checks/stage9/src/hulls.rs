//! What the laws of both builders of BSP trees share: hulls, and the judgement of a tree over them.

use super::lists::{self, Fault};
use checks::broken::CheckResult;
use glam::{Vec3, vec3};
use raykata::kit::BspQuery;

/// The call of a builder, as source code.
pub(super) fn describe(query: &BspQuery) -> String {
    let hulls: Vec<String> = query.hulls.iter().map(checks::paste::list).collect();
    format!("build(&[{}], {}, {})", hulls.join(", "), query.leaf_size, query.max_depth)
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

/// `n` parallel squares side by side across a diagonal: planes across an axis do not divide them, but their own planes
/// do.
pub(super) fn sheets(n: usize) -> Vec<Vec<Vec3>> {
    let sheet = |at: f32| {
        let p = |u: f32, v: f32| vec3(at + u, at - u, v);
        vec![p(-40.0, -40.0), p(40.0, -40.0), p(40.0, 40.0), p(-40.0, 40.0)]
    };
    (0..n).map(|i| sheet(0.25 * i as f32)).collect()
}
