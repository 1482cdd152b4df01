//! Searches with one mistake each, which go through the same structures and hits as the searches of students. A mistake is
//! named only if its search gives exactly the student's answer.

use super::parts::Leaf;
use super::scenes::closest;
use raykata::partition::{Bsp, BspNode, Cell, KdNode, KdTree, Octree, OctreeNode};
use raykata::ray::Ray;

type Hit = Option<(u32, f32)>;

/// How a search goes through the cells that the ray enters, in the order of their entries.
#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    /// A leaf returns its closest hit, and the search ends.
    FirstCellWithAHit,
    /// The same, if the hit lies before the end of the cell, or at it; other hits are dropped.
    BeforeTheEnd,
    BeforeTheEndOrAt,
    /// A cell keeps the first hit of its list, or the last one.
    FirstOfCell,
    LastOfCell,
    /// Of two hits at the same `t` the first one is kept, or the last one.
    TieToTheFirst,
    TieToTheLast,
    /// Of all hits the farthest is kept.
    Farthest,
    /// Only the first cell is searched.
    FirstCellOnly,
    /// The search ends at a cell that begins behind the best hit, without room for rounding, or at it.
    NoRoom,
    NoRoomOrAt,
}

impl Wrong {
    /// Whether the search keeps `q` in place of `p`.
    fn takes(self, (p, p_t): (u32, f32), (q, q_t): (u32, f32)) -> bool {
        match self {
            Wrong::TieToTheFirst => q_t < p_t,
            Wrong::TieToTheLast => q_t <= p_t,
            Wrong::Farthest => q_t > p_t,
            _ => (q_t, q) < (p_t, p),
        }
    }

    /// Keeps the hit of a cell in `best`.
    fn keep(self, best: &mut Hit, hit: Hit) {
        if let Some(hit) = hit
            && best.is_none_or(|best| self.takes(best, hit))
        {
            *best = Some(hit);
        }
    }

    /// The hit that the search finds in a cell with these primitives.
    fn of_cell(self, ids: &[u32], hits: &[f32], ray: &Ray) -> Hit {
        let mut counting = ids.iter().map(|&id| (id, hits[id as usize])).filter(|(_, t)| ray.contains(*t));
        match self {
            Wrong::FirstOfCell => counting.next(),
            Wrong::LastOfCell => counting.next_back(),
            _ => counting.fold(None, |mut best, hit| {
                self.keep(&mut best, Some(hit));
                best
            }),
        }
    }

    fn search(self, leaves: &[Leaf], hits: &[f32], ray: &Ray) -> Hit {
        let mut best: Hit = None;
        for (index, leaf) in leaves.iter().enumerate() {
            let behind = |room: f64| best.is_some_and(|(_, t)| f64::from(t) * (1.0 + room) < leaf.enter);
            let at = best.is_some_and(|(_, t)| f64::from(t) == leaf.enter);
            match self {
                Wrong::FirstCellOnly if index > 0 => break,
                Wrong::NoRoom if behind(0.0) => break,
                Wrong::NoRoomOrAt if behind(0.0) || at => break,
                _ if behind(1e-6) => break,
                _ => {}
            }
            let hit = self.of_cell(&leaf.ids, hits, ray);
            let is_before = hit.is_some_and(|(_, t)| f64::from(t) < leaf.exit);
            let is_at = hit.is_some_and(|(_, t)| f64::from(t) == leaf.exit);
            match self {
                Wrong::FirstCellWithAHit if hit.is_some() => return hit,
                Wrong::BeforeTheEnd if is_before => return hit,
                Wrong::BeforeTheEndOrAt if is_before || is_at => return hit,
                Wrong::BeforeTheEnd | Wrong::BeforeTheEndOrAt => {}
                _ => self.keep(&mut best, hit),
            }
        }
        best
    }
}

/// The text of the mistake of a search that ends after the first cell.
pub(super) const FIRST_CELL_ONLY: &str = "you search only the first cell that the ray enters";

const MISTAKES: [(Wrong, &str); 11] = [
    (
        Wrong::TieToTheFirst,
        "of two hits at the same t the smaller primitive number wins: you keep the first one",
    ),
    (
        Wrong::TieToTheLast,
        "of two hits at the same t the smaller primitive number wins: you keep the last one",
    ),
    (Wrong::FirstOfCell, "you take the first hit in the list of a cell: keep the nearest of all"),
    (Wrong::LastOfCell, "you take the last hit in the list of a cell: keep the nearest of all"),
    (Wrong::Farthest, "you keep the farther of two hits"),
    (
        Wrong::BeforeTheEnd,
        "traps A4 and A6: `hit.distance < t'` loses a hit on the far face of its cell, and behind it: a hit counts wherever its cell ends",
    ),
    (
        Wrong::BeforeTheEndOrAt,
        "traps A4 and A6: `hit.distance <= t'` loses a hit behind the end of its cell: a hit counts wherever its cell ends",
    ),
    (
        Wrong::FirstCellWithAHit,
        "trap A8 (A9 for octrees): `Some hit → Some hit` stops at the first cell with a hit, and a later cell has a nearer hit: go on until the next cell begins behind the best hit",
    ),
    (Wrong::FirstCellOnly, FIRST_CELL_ONLY),
    (
        Wrong::NoRoom,
        "trap A6: t of a hit and t of a cell are rounded differently; stop only if the hit is before the cell by more than the rounding error",
    ),
    (
        Wrong::NoRoomOrAt,
        "trap A6: you stop at a cell that begins exactly at the best hit, but another primitive there may have the same t",
    ),
];

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
}

const AT_PLANES: [(AtPlane, &str); 14] = [
    (
        AtPlane::InPlaneBelow,
        "trap A5: a ray in the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side below only",
    ),
    (
        AtPlane::InPlaneAbove,
        "trap A5: a ray in the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side above only",
    ),
    (
        AtPlane::StartAhead,
        "trap A5: a ray that starts on the plane is on both sides, and a primitive in the plane may be listed on one side only: you search the side ahead only",
    ),
    (
        AtPlane::StartBehind,
        "trap A5: a ray that starts on the plane is on both sides: you search only the side from which it comes",
    ),
    (
        AtPlane::BelowAndAhead,
        "trap A5: a ray in the plane, or that starts on it, is on both sides: you search the side below only, or the side ahead only",
    ),
    (
        AtPlane::AboveAndAhead,
        "trap A5: a ray in the plane, or that starts on it, is on both sides: you search the side above only, or the side ahead only",
    ),
    (
        AtPlane::OnPlaneBelow,
        "trap A5: a ray in the plane, or that starts on it, is on both sides: you search the side below only",
    ),
    (
        AtPlane::OnPlaneAbove,
        "trap A5: a ray in the plane, or that starts on it, is on both sides: you search the side above only",
    ),
    (
        AtPlane::NotCrossedNone,
        "trap A7: if the plane is behind the ray or beyond its end, the whole ray is on one side, and you must search that side",
    ),
    (
        AtPlane::NotCrossedBelow,
        "trap A7: if the plane is behind the ray or beyond its end, the ray is on the side of its origin: you always take the side below",
    ),
    (
        AtPlane::NotCrossedAbove,
        "trap A7: if the plane is behind the ray or beyond its end, the ray is on the side of its origin: you always take the side above",
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
    /// The height of the ray's origin above the plane, its change per unit of `t`, and the children below and above.
    Cut {
        height: f64,
        rate: f64,
        below: u32,
        above: u32,
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
        if best.is_some_and(|(_, best)| f64::from(best) * (1.0 + 1e-6) < t) {
            return;
        }
        let (height, rate, below, above) = match (self.plane)(node) {
            Plane::Leaf(ids) => {
                let kept = Wrong::NoRoom;
                return kept.keep(best, kept.of_cell(ids, self.hits, self.ray));
            }
            Plane::Cut { height, rate, below, above } => (height, rate, below, above),
        };
        let crossing = -height / rate;
        let is_crossed = rate != 0.0 && t <= crossing && crossing <= t_end;
        let in_plane = height == 0.0 && rate == 0.0;
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
    AT_PLANES.map(|(wrong, text)| (gives(wrong), text)).into()
}

/// The known mistakes at the planes of a kd-tree, each with whether it finds this hit.
pub(super) fn of_kd_tree(tree: &KdTree, ray: &Ray, hits: &[f32], found: Hit) -> Vec<(bool, &'static str)> {
    let plane = |node: u32| match tree.nodes[node as usize] {
        KdNode::Leaf { first, count } => Plane::Leaf(tree.primitives(first, count)),
        KdNode::Inner { axis, at, left, right } => {
            let axis = usize::from(axis);
            let height = f64::from(ray.origin[axis]) - f64::from(at);
            Plane::Cut { height, rate: f64::from(ray.direction[axis]), below: left, above: right }
        }
    };
    at_planes(&plane, ray, hits, found)
}

/// The known mistakes at the planes of a BSP tree, each with whether it finds this hit.
pub(super) fn of_bsp(bsp: &Bsp, ray: &Ray, hits: &[f32], found: Hit) -> Vec<(bool, &'static str)> {
    let plane = |node: u32| match bsp.nodes[node as usize] {
        BspNode::Leaf { first, count } => Plane::Leaf(bsp.primitives(first, count)),
        BspNode::Inner { plane, back, front } => {
            let (height, rate) = (plane.distance(ray.origin), plane.normal.dot(ray.direction.as_dvec3()));
            Plane::Cut { height, rate, below: back, above: front }
        }
    };
    at_planes(&plane, ray, hits, found)
}

/// The hit of a search of an octree that keeps one of several octants with the same entry: the last one, as a map with the
/// entries as keys does, or the first one.
fn one_of_equal_entries(octree: &Octree, ray: &Ray, hits: &[f32], keeps_last: bool) -> Hit {
    fn below(
        octree: &Octree,
        node: u32,
        cell: &Cell,
        (ray, hits, keeps_last): (&Ray, &[f32], bool),
        best: &mut Hit,
    ) {
        let kept = Wrong::NoRoom;
        let first = match octree.nodes[node as usize] {
            OctreeNode::Leaf { first, count } => {
                return kept.keep(best, kept.of_cell(octree.primitives(first, count), hits, ray));
            }
            OctreeNode::Inner { first } => first,
        };
        let mut entered: Vec<(f64, u32, Cell)> = Vec::new();
        for octant in 0..8 {
            let cell = cell.octant(octant);
            let Some((enter, _)) = super::parts::exactly(ray, &cell) else { continue };
            let same = entered.iter().position(|(other, ..)| *other == enter);
            match same {
                Some(index) if keeps_last => entered[index] = (enter, first + octant as u32, cell),
                Some(_) => {}
                None => entered.push((enter, first + octant as u32, cell)),
            }
        }
        entered.sort_by(|p, q| p.0.total_cmp(&q.0));
        for (enter, node, cell) in entered {
            if best.is_none_or(|(_, t)| f64::from(t) * (1.0 + 1e-6) >= enter) {
                below(octree, node, &cell, (ray, hits, keeps_last), best);
            }
        }
    }
    let mut best = None;
    if !octree.nodes.is_empty() {
        below(octree, 0, &Cell::new(&octree.bounds), (ray, hits, keeps_last), &mut best);
    }
    best
}

/// The known mistakes at octants, each with whether it finds this hit.
pub(super) fn of_octree(octree: &Octree, ray: &Ray, hits: &[f32], found: Hit) -> Vec<(bool, &'static str)> {
    let gives = |keeps_last| one_of_equal_entries(octree, ray, hits, keeps_last) == found;
    vec![(
        gives(true) || gives(false),
        "trap A9: of octants that the ray enters at the same t you search only one",
    )]
}

/// The known mistakes of a search that goes through these cells, each with whether it finds this hit.
pub(super) fn in_cells(leaves: &[Leaf], ray: &Ray, hits: &[f32], found: Hit) -> Vec<(bool, &'static str)> {
    MISTAKES.map(|(wrong, text)| (wrong.search(leaves, hits, ray) == found, text)).into()
}

/// What the answer and the calls of a search prove without a known mistake. `listed` are the primitives of a node.
pub(super) fn facts<'a>(
    found: Hit,
    (tests, visits): (&[u32], &[u32]),
    (ray, hits): (&Ray, &[f32]),
    listed: impl Fn(u32) -> &'a [u32],
) -> Vec<(bool, &'static str)> {
    let expected = closest(hits, ray);
    let Some((best, best_t)) = expected else { return vec![out_of_range(found, ray)] };
    let is_tested = tests.contains(&best);
    let is_visited = visits.iter().any(|&node| listed(node).contains(&best));
    vec![
        out_of_range(found, ray),
        (
            found.is_some_and(|(_, t)| t == best_t),
            "of two hits at the same t the smaller primitive number wins",
        ),
        (
            found.is_some() && is_tested,
            "you keep the farther of two hits: you test the primitive with the nearer hit, but return another one",
        ),
        (
            found.is_none() && visits.is_empty(),
            "you visit no cell although the ray enters the structure's bounds",
        ),
        (found.is_none() && is_tested, "you find a hit and reject it: it counts wherever its cell ends"),
        (is_visited && !is_tested, "you visit a cell, but do not test all of its primitives"),
        (
            found.is_some() && !is_visited,
            "you stop before a cell with a nearer hit, or leave it out: you never visit a cell that lists the primitive",
        ),
        (
            found.is_none() && !is_visited,
            "you leave out a cell that the ray passes through: you never visit a cell that lists the primitive",
        ),
        (!is_visited, "you never visit a cell that lists the primitive with the nearest hit"),
    ]
}

fn out_of_range(found: Hit, ray: &Ray) -> (bool, &'static str) {
    (found.is_some_and(|(_, t)| !ray.contains(t)), "you return a hit outside the ray's range")
}
