//! Searches with one mistake each, which go through the same structures and hits as the searches of students. A mistake is
//! named only if its search gives exactly the student's answer.

use super::parts::Leaf;
use checks::prelude::*;
use checks::tree::closest_of;

pub(super) type Hit = Option<(u32, f32)>;

/// Mistakes, each with whether it is proven.
pub(super) type Mistakes = Vec<(bool, &'static str)>;

/// The room that a search leaves between the best hit and the entry of a cell, relative to `t`: some roundings in single
/// precision, because the `t` of a hit is rounded and that of a cell is not.
pub(super) const ROOM: f64 = 1e-6;

/// How a search goes through the cells that the ray enters, in the order of their entries.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Wrong {
    /// No mistake.
    Right,
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
    pub(super) fn keep(self, best: &mut Hit, hit: Hit) {
        if let Some(hit) = hit
            && best.is_none_or(|best| self.takes(best, hit))
        {
            *best = Some(hit);
        }
    }

    /// The hit that the search finds in a cell with these primitives.
    pub(super) fn of_cell(self, ids: &[u32], hits: &[f32], ray: &Ray) -> Hit {
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
                _ if behind(ROOM) => break,
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

const MISTAKES: [(Wrong, &str); 11] = named![
    Wrong::TieToTheFirst => "of two hits at the same t the smaller primitive number wins: you keep the first one",
    Wrong::TieToTheLast => "of two hits at the same t the smaller primitive number wins: you keep the last one",
    Wrong::FirstOfCell => "you take the first hit in the list of a cell: keep the nearest of all",
    Wrong::LastOfCell => "you take the last hit in the list of a cell: keep the nearest of all",
    Wrong::Farthest => "you keep the farther of two hits",
    Wrong::BeforeTheEnd =>
        "`hit.distance < t'` loses a hit on the far face of its cell, and behind it: a hit counts wherever its cell ends",
    Wrong::BeforeTheEndOrAt => "`hit.distance <= t'` loses a hit behind the end of its cell: a hit counts wherever its cell ends",
    Wrong::FirstCellWithAHit =>
        "`Some hit → Some hit` stops at the first cell with a hit, and a later cell has a nearer hit: go on until the next cell begins behind the best hit",
    Wrong::FirstCellOnly => FIRST_CELL_ONLY,
    Wrong::NoRoom =>
        "t of a hit and t of a cell are rounded differently; stop only if the hit is before the cell by more than the rounding error",
    Wrong::NoRoomOrAt => "you stop at a cell that begins exactly at the best hit, but another primitive there may have the same t",
];

/// The known mistakes of a search that goes through these cells, each with whether it finds this hit. If the right search of
/// these cells does not find the hit, for a rounding error, no wrong answer proves a mistake.
pub(super) fn in_cells(leaves: &[Leaf], ray: &Ray, hits: &[f32], found: Hit) -> Mistakes {
    let expected = closest_of(hits, ray);
    let finds_it = Wrong::Right.search(leaves, hits, ray) == expected;
    let gives = |wrong: Wrong| if finds_it { wrong.search(leaves, hits, ray) } else { expected };
    MISTAKES.map(|(wrong, text)| (gives(wrong) == found, text)).into()
}

/// What the answer and the calls of a search prove without a known mistake. `listed` are the primitives of a node.
pub(super) fn facts<'a>(
    found: Hit,
    (tests, visits): (&[u32], &[u32]),
    (ray, hits): (&Ray, &[f32]),
    listed: impl Fn(u32) -> &'a [u32],
) -> Mistakes {
    let expected = closest_of(hits, ray);
    let Some((best, _)) = expected else { return vec![out_of_range(found, ray)] };
    let is_tested = tests.contains(&best);
    let is_visited = visits.iter().any(|&node| listed(node).contains(&best));
    vec![
        out_of_range(found, ray),
        "you keep the farther of two hits: you test the primitive with the nearer hit, but return another one"
            .when(found.is_some() && is_tested),
        "you visit no cell although the ray enters the structure's bounds"
            .when(found.is_none() && visits.is_empty()),
        (found.is_none() && is_tested, "you find a hit and reject it: it counts wherever its cell ends"),
        (is_visited && !is_tested, "you visit a cell, but do not test all of its primitives"),
        "you stop before a cell with a nearer hit, or leave it out: you never visit a cell that lists the primitive"
            .when(found.is_some() && !is_visited),
        "you leave out a cell that the ray passes through: you never visit a cell that lists the primitive"
            .when(found.is_none() && !is_visited),
        (!is_visited, "you never visit a cell that lists the primitive with the nearest hit"),
    ]
}

fn out_of_range(found: Hit, ray: &Ray) -> (bool, &'static str) {
    (found.is_some_and(|(_, t)| !ray.contains(t)), "you return a hit outside the ray's range")
}
