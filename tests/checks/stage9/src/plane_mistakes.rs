//! Searches of binary trees with one mistake each at their planes. A mistake is named only if its search gives exactly the
//! student's answer.

use super::search_mistakes::{Hit, Mistakes, ROOM, Wrong};
use checks::prelude::*;
use raykata::partition::{CutPlane, Tree, TreeNode};

/// How a search of a binary tree treats a plane.
#[derive(Clone, Copy, PartialEq)]
enum AtPlane {
    /// A ray in the plane is on the lower side only, or on the upper one.
    InPlaneBelow,
    InPlaneAbove,
    /// A ray that starts on the plane is on the side to which it goes only, or on the other side only.
    StartAhead,
    StartBehind,
    /// A ray in the plane is on the lower side, or the upper one, and one that starts on it is on the side to which it goes.
    BelowAndAhead,
    AboveAndAhead,
    /// A ray in the plane, or that starts on it, is on the lower side only, or on the upper one.
    OnPlaneBelow,
    OnPlaneAbove,
    /// A ray that does not cross the plane within its part is on no side, on the lower side only, or on the upper one.
    NotCrossedNone,
    NotCrossedBelow,
    NotCrossedAbove,
    /// A ray parallel to the plane is on no side.
    ParallelNone,
    /// Only the side of the origin is searched.
    NearOnly,
    /// The lower side is searched only if the ray goes down, and the upper one only if it goes up.
    ByDirection,
    /// The polygons on the planes are not tested.
    PolygonsLeftOut,
    /// A ray is in the plane only if its height is exactly 0, or at most the room of the tree.
    WithoutError,
}

const AT_PLANES: [(AtPlane, &str); 16] = named![
    AtPlane::InPlaneBelow =>
        "a ray in the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side below only",
    AtPlane::InPlaneAbove =>
        "a ray in the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side above only",
    AtPlane::StartAhead =>
        "a ray that starts on the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side ahead only",
    AtPlane::StartBehind => "a ray that starts on the plane is on both sides: you search only the side from which it comes",
    AtPlane::BelowAndAhead =>
        "a ray in the plane, or that starts on it, is on both sides: you search the side below only, or the side ahead only",
    AtPlane::AboveAndAhead =>
        "a ray in the plane, or that starts on it, is on both sides: you search the side above only, or the side ahead only",
    AtPlane::OnPlaneBelow => "a ray in the plane, or that starts on it, is on both sides: you search the side below only",
    AtPlane::OnPlaneAbove => "a ray in the plane, or that starts on it, is on both sides: you search the side above only",
    AtPlane::NotCrossedNone =>
        "if the plane is behind the ray or beyond its end, the whole ray is on one side, and you must search that side",
    AtPlane::NotCrossedBelow =>
        "if the plane is behind the ray or beyond its end, the ray is on the side of its origin: you always take the side below",
    AtPlane::NotCrossedAbove =>
        "if the plane is behind the ray or beyond its end, the ray is on the side of its origin: you always take the side above",
    AtPlane::ParallelNone => "a ray parallel to the plane is on the side of its origin: you search no side",
    AtPlane::NearOnly => "you search only the side of the origin: the ray goes on to the other side",
    AtPlane::ByDirection => "you choose the side by the direction alone: the ray is first on the side of its origin",
    AtPlane::WithoutError =>
        "a ray in the plane is on both sides, and its computed height may be a rounding error in place of 0",
    AtPlane::PolygonsLeftOut => "step 2 of the slide is missing: you do not test the polygons on the plane",
];

/// A ray in a binary tree, with the hits of all primitives.
struct Binary<'a, N> {
    planes: &'a Planes<'a, N>,
    ray: &'a Ray,
    hits: &'a [f32],
    wrong: AtPlane,
}

/// A binary tree with its planes.
pub(super) struct Planes<'a, N> {
    pub tree: &'a Tree<N>,
    /// The plane of an inner node; `None` for a leaf. What an inner node lists lies in its plane.
    pub plane: fn(&N) -> Option<CutPlane>,
    /// The height above a plane at which a point still counts as in the plane.
    pub room: f64,
}

impl<N: TreeNode> Binary<'_, N> {
    fn search(&self, node: u32, (t, t_end): (f64, f64), best: &mut Hit) {
        if best.is_some_and(|(_, best)| f64::from(best) * (1.0 + ROOM) < t) {
            return;
        }
        let Planes { tree, plane, room } = *self.planes;
        // A tree without nodes lists nothing.
        let Some(inner) = tree.nodes.get(node as usize) else { return };
        let keep_listed = |best: &mut Hit| {
            let kept = Wrong::Right;
            kept.keep(best, kept.of_cell(tree.listed(node), self.hits, self.ray));
        };
        let mut children = inner.children();
        let (Some(plane), Some(below), Some(above)) = (plane(inner), children.next(), children.next()) else {
            return keep_listed(best);
        };
        use AtPlane::*;
        let (height, rate) =
            (plane.distance(self.ray.origin), plane.normal.dot(self.ray.direction.as_dvec3()));
        let crossing = -height / rate;
        let is_crossed = rate != 0.0 && t <= crossing && crossing <= t_end;
        // The height is rounded up to four times, each time by at most 2^-53 of a sum of these sizes.
        let sizes = plane.normal.abs().dot(self.ray.origin.as_dvec3().abs()) + plane.offset.abs();
        let error = if self.wrong == WithoutError { 0.0 } else { (-50f64).exp2() * sizes };
        let in_plane = height.abs() <= room + error && rate == 0.0;
        let starts = height == 0.0 && rate != 0.0;
        let (ahead, behind) = if rate > 0.0 { (above, below) } else { (below, above) };
        // The side of the ray at the middle of its part.
        let middle = if t_end.is_finite() { 0.5 * (t + t_end) } else { 2.0 * t + 1.0 };
        let here = if height + rate * middle > 0.0 { above } else { below };
        let whole = (t, t_end);
        let sides: Vec<(u32, (f64, f64))> = match self.wrong {
            InPlaneBelow | BelowAndAhead | OnPlaneBelow if in_plane => vec![(below, whole)],
            InPlaneAbove | AboveAndAhead | OnPlaneAbove if in_plane => vec![(above, whole)],
            OnPlaneBelow if starts => vec![(below, whole)],
            OnPlaneAbove if starts => vec![(above, whole)],
            StartAhead | BelowAndAhead | AboveAndAhead if starts => vec![(ahead, whole)],
            StartBehind if starts => vec![(behind, whole)],
            ParallelNone if rate == 0.0 => vec![],
            NotCrossedNone if !is_crossed => vec![],
            NotCrossedBelow if !is_crossed => vec![(below, whole)],
            NotCrossedAbove if !is_crossed => vec![(above, whole)],
            ByDirection => vec![(ahead, whole)],
            NearOnly if is_crossed && !starts => vec![(behind, (t, crossing))],
            _ if in_plane => vec![(below, whole), (above, whole)],
            _ if is_crossed => vec![(behind, (t, crossing)), (ahead, (crossing, t_end))],
            _ => vec![(here, whole)],
        };
        let tests_polygons = match self.wrong {
            PolygonsLeftOut => false,
            NotCrossedNone => is_crossed,
            _ => is_crossed || in_plane,
        };
        let mut sides = sides.into_iter();
        if let Some((child, part)) = sides.next() {
            self.search(child, part, best);
        }
        if tests_polygons {
            keep_listed(best);
        }
        for (child, part) in sides {
            self.search(child, part, best);
        }
    }
}

/// The known mistakes at the planes of a tree, each with whether it finds this hit.
pub(super) fn at_planes<N: TreeNode>(
    planes: &Planes<'_, N>,
    ray: &Ray,
    hits: &[f32],
    found: Hit,
) -> Mistakes {
    let range = (f64::from(ray.t_min), f64::from(ray.t_max));
    let gives = |wrong: AtPlane| {
        let mut best = None;
        Binary { planes, ray, hits, wrong }.search(0, range, &mut best);
        best == found
    };
    AT_PLANES.map(|(wrong, text)| (gives(wrong), text)).into()
}
