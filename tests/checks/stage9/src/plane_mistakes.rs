//! Searches of binary trees with one mistake each at their planes. A mistake is named only if its search gives exactly the
//! student's answer.

use super::search_mistakes::{Hit, ROOM, Wrong};
use raykata::partition::{Bsp, BspNode, KdNode, KdTree, PolygonBsp, PolygonBspNode};
use raykata::ray::Ray;

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
}

const AT_PLANES: [(AtPlane, &str); 14] = [
    (
        AtPlane::InPlaneBelow,
        "a ray in the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side below only",
    ),
    (
        AtPlane::InPlaneAbove,
        "a ray in the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side above only",
    ),
    (
        AtPlane::StartAhead,
        "a ray that starts on the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side ahead only",
    ),
    (
        AtPlane::StartBehind,
        "a ray that starts on the plane is on both sides: you search only the side from which it comes",
    ),
    (
        AtPlane::BelowAndAhead,
        "a ray in the plane, or that starts on it, is on both sides: you search the side below only, or the side ahead only",
    ),
    (
        AtPlane::AboveAndAhead,
        "a ray in the plane, or that starts on it, is on both sides: you search the side above only, or the side ahead only",
    ),
    (
        AtPlane::OnPlaneBelow,
        "a ray in the plane, or that starts on it, is on both sides: you search the side below only",
    ),
    (
        AtPlane::OnPlaneAbove,
        "a ray in the plane, or that starts on it, is on both sides: you search the side above only",
    ),
    (
        AtPlane::NotCrossedNone,
        "if the plane is behind the ray or beyond its end, the whole ray is on one side, and you must search that side",
    ),
    (
        AtPlane::NotCrossedBelow,
        "if the plane is behind the ray or beyond its end, the ray is on the side of its origin: you always take the side below",
    ),
    (
        AtPlane::NotCrossedAbove,
        "if the plane is behind the ray or beyond its end, the ray is on the side of its origin: you always take the side above",
    ),
    (AtPlane::ParallelNone, "a ray parallel to the plane is on the side of its origin: you search no side"),
    (AtPlane::NearOnly, "you search only the side of the origin: the ray goes on to the other side"),
    (
        AtPlane::ByDirection,
        "you choose the side by the direction alone: the ray is first on the side of its origin",
    ),
];

/// A node of a binary tree, as one ray sees it.
enum Plane<'a> {
    Leaf(&'a [u32]),
    /// The height of the ray's origin above the plane, its change per unit of `t`, the children below and above, the
    /// polygons in the plane, and the height at which a point still counts as in the plane.
    Cut {
        height: f64,
        rate: f64,
        below: u32,
        above: u32,
        on: &'a [u32],
        room: f64,
    },
}

/// A ray in a binary tree whose nodes it sees by `plane`, with the hits of all primitives.
struct Binary<'a> {
    plane: &'a dyn Fn(u32) -> Plane<'a>,
    ray: &'a Ray,
    hits: &'a [f32],
    wrong: AtPlane,
}

impl Binary<'_> {
    fn search(&self, node: u32, (t, t_end): (f64, f64), best: &mut Hit) {
        if best.is_some_and(|(_, best)| f64::from(best) * (1.0 + ROOM) < t) {
            return;
        }
        let (height, rate, below, above, on, room) = match (self.plane)(node) {
            Plane::Leaf(ids) => {
                let kept = Wrong::NoRoom;
                return kept.keep(best, kept.of_cell(ids, self.hits, self.ray));
            }
            Plane::Cut { height, rate, below, above, on, room } => (height, rate, below, above, on, room),
        };
        let crossing = -height / rate;
        let is_crossed = rate != 0.0 && t <= crossing && crossing <= t_end;
        let in_plane = height.abs() <= room && rate == 0.0;
        let starts = height == 0.0 && rate != 0.0;
        let (ahead, behind) = if rate > 0.0 { (above, below) } else { (below, above) };
        // The side of the ray at the middle of its part.
        let middle = if t_end.is_finite() { 0.5 * (t + t_end) } else { 2.0 * t + 1.0 };
        let here = if height + rate * middle > 0.0 { above } else { below };
        let whole = (t, t_end);
        use AtPlane::*;
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
            let kept = Wrong::NoRoom;
            kept.keep(best, kept.of_cell(on, self.hits, self.ray));
        }
        for (child, part) in sides {
            self.search(child, part, best);
        }
    }
}

fn at_planes<'a>(
    plane: &'a dyn Fn(u32) -> Plane<'a>,
    ray: &'a Ray,
    hits: &'a [f32],
    found: Hit,
) -> Vec<(bool, &'static str)> {
    let range = (f64::from(ray.t_min), f64::from(ray.t_max));
    let gives = |wrong: AtPlane| {
        let mut best = None;
        Binary { plane, ray, hits, wrong }.search(0, range, &mut best);
        best == found
    };
    let left_out = (
        gives(AtPlane::PolygonsLeftOut),
        "step 2 of the slide is missing: you do not test the polygons on the plane",
    );
    AT_PLANES.map(|(wrong, text)| (gives(wrong), text)).into_iter().chain([left_out]).collect()
}

/// The known mistakes at the planes of a kd-tree, each with whether it finds this hit.
pub(super) fn of_kd_tree(tree: &KdTree, ray: &Ray, hits: &[f32], found: Hit) -> Vec<(bool, &'static str)> {
    let plane = |node: u32| match tree.nodes.get(node as usize).copied() {
        // A tree without nodes lists nothing.
        None => Plane::Leaf(&[]),
        Some(KdNode::Leaf { first, count }) => Plane::Leaf(tree.primitives(first, count)),
        Some(KdNode::Inner { axis, at, left, right }) => {
            let axis = usize::from(axis);
            let height = f64::from(ray.origin[axis]) - f64::from(at);
            Plane::Cut {
                height,
                rate: f64::from(ray.direction[axis]),
                below: left,
                above: right,
                on: &[],
                room: 0.0,
            }
        }
    };
    at_planes(&plane, ray, hits, found)
}

/// The known mistakes at the planes of a BSP tree, each with whether it finds this hit.
pub(super) fn of_bsp(bsp: &Bsp, ray: &Ray, hits: &[f32], found: Hit) -> Vec<(bool, &'static str)> {
    let plane = |node: u32| match bsp.nodes.get(node as usize).copied() {
        // A tree without nodes lists nothing.
        None => Plane::Leaf(&[]),
        Some(BspNode::Leaf { first, count }) => Plane::Leaf(bsp.primitives(first, count)),
        Some(BspNode::Inner { plane, back, front }) => {
            let (height, rate) = (plane.distance(ray.origin), plane.normal.dot(ray.direction.as_dvec3()));
            Plane::Cut { height, rate, below: back, above: front, on: &[], room: 0.0 }
        }
    };
    at_planes(&plane, ray, hits, found)
}

/// The known mistakes at the planes of a BSP tree with polygons in its nodes, each with whether it finds this hit.
pub(super) fn of_polygon_bsp(
    bsp: &PolygonBsp,
    ray: &Ray,
    hits: &[f32],
    found: Hit,
) -> Vec<(bool, &'static str)> {
    let plane = |node: u32| match bsp.nodes.get(node as usize).copied() {
        // A tree without nodes lists nothing.
        None => Plane::Leaf(&[]),
        Some(PolygonBspNode::Leaf { first, count }) => Plane::Leaf(bsp.primitives(first, count)),
        Some(PolygonBspNode::Inner { plane, first, count, back, front }) => {
            let (height, rate) = (plane.distance(ray.origin), plane.normal.dot(ray.direction.as_dvec3()));
            Plane::Cut {
                height,
                rate,
                below: back,
                above: front,
                on: bsp.primitives(first, count),
                room: bsp.room,
            }
        }
    };
    at_planes(&plane, ray, hits, found)
}
