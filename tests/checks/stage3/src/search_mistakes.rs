//! Searches with one mistake each, which go through the same tables as the searches of students.

use checks::prelude::*;
use raykata::bvh::Contents;
use raykata::count::Counts;

type Hit = Option<(u32, f32)>;

/// How a search goes through a tree.
#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    Nothing,
    /// Of two hits the farther one is kept; of hits at the same `t`, the first one, or that with the larger number.
    Farther,
    FartherOrLarger,
    /// Of two hits at the same `t` the later one, or the first one, is kept.
    TieToTheLast,
    TieToTheFirst,
    /// A leaf returns its first hit.
    LeafStops,
    /// Only the first primitive of a leaf is asked, or all but the last or the first.
    OneOfLeaf,
    LastOfLeafLeftOut,
    FirstOfLeafLeftOut,
    /// The second child is searched only if the first one has no hit. The nearer child is the first one, or the left one.
    LeftIfAny,
    NearIfAny,
    /// If one child has no hit, or one box is missed, nothing is found.
    NothingIfOneHasNone,
    NothingIfOneIsMissed,
    /// The right child is searched only if the left box is missed.
    LeftIfEntered,
    /// Only one child is searched.
    LeftOnly,
    RightOnly,
    NearOnly,
    /// All primitives of a leaf must be hit.
    AllOfLeaf,
    /// A box in which the ray begins is not entered, from this node on.
    InsideLeftOut(u32),
}

const INSIDE: &str = "a box in which the ray begins is left out: its entry is at t_min, which counts";

const MISTAKES: [(Wrong, &str); 19] = named![
    Wrong::AllOfLeaf => "a leaf counts only if all of its primitives are hit: one is enough",
    Wrong::InsideLeftOut(0) => INSIDE,
    Wrong::InsideLeftOut(1) => INSIDE,
    Wrong::TieToTheLast => "of two hits at the same t the smaller primitive number wins: you keep the later one",
    Wrong::TieToTheFirst => "of two hits at the same t the smaller primitive number wins: you keep the first one",
    Wrong::Farther => "the farther of two hits is kept",
    Wrong::FartherOrLarger => "the farther of two hits is kept, and of equal ones the one with the larger number",
    Wrong::OneOfLeaf => "you take the first primitive only: ask all of a leaf's primitives",
    Wrong::LeafStops => "you take the first hit of a leaf: ask all of a leaf's primitives",
    Wrong::LastOfLeafLeftOut => "part of a leaf was left out: its last primitive",
    Wrong::FirstOfLeafLeftOut => "part of a leaf was left out: its first primitive",
    Wrong::LeftIfAny => "boxes overlap: the search stopped before it had seen the nearer hit, which is in the right child",
    Wrong::NearIfAny => "boxes overlap: the search stopped before it had seen the nearer hit, which is in the farther child",
    Wrong::NothingIfOneHasNone => "a subtree was left out: if one child has no hit, the other may still have one",
    Wrong::NothingIfOneIsMissed => "a subtree was left out: if one box is missed, the other may still be met",
    Wrong::LeftIfEntered => "a subtree was left out: the right child, if the ray enters the left box as well",
    Wrong::LeftOnly => "a subtree was left out: the right child",
    Wrong::RightOnly => "a subtree was left out: the left child",
    Wrong::NearOnly => "a subtree was left out: the farther child",
];

struct Search<'a> {
    query: &'a SearchQuery,
    wrong: Wrong,
}

impl Search<'_> {
    fn enter(&self, node: u32) -> Option<f32> {
        let (near, far) = self.query.table.boxes[node as usize];
        let near = near.max(self.query.ray.t_min);
        let from = if let Wrong::InsideLeftOut(from) = self.wrong { from } else { u32::MAX };
        let is_left_out = node >= from && near <= self.query.ray.t_min;
        (near <= far && near < self.query.ray.t_max && !is_left_out).then_some(near)
    }

    fn nearer(&self, first: Hit, second: Hit) -> Hit {
        let (Some(p), Some(q)) = (first, second) else { return first.or(second) };
        let takes_second = match self.wrong {
            Wrong::Farther => q.1 > p.1,
            Wrong::FartherOrLarger => (q.1, q.0) > (p.1, p.0),
            Wrong::TieToTheLast => q.1 <= p.1,
            Wrong::TieToTheFirst => q.1 < p.1,
            _ => (q.1, q.0) < (p.1, p.0),
        };
        Some(if takes_second { q } else { p })
    }

    fn leaf(&self, ids: &[u32]) -> Hit {
        let ids = match self.wrong {
            Wrong::OneOfLeaf => &ids[..1],
            Wrong::LastOfLeafLeftOut => &ids[..ids.len() - 1],
            Wrong::FirstOfLeafLeftOut => &ids[1..],
            _ => ids,
        };
        let hits = ids.iter().map(|&id| (id, self.query.table.primitives[id as usize]));
        let mut hits = hits.filter(|(_, t)| self.query.ray.contains(*t));
        if self.wrong == Wrong::AllOfLeaf && hits.clone().count() < ids.len() {
            return None;
        }
        if self.wrong == Wrong::LeafStops {
            return hits.next();
        }
        hits.fold(None, |closest, hit| self.nearer(closest, Some(hit)))
    }

    fn below(&self, node: u32) -> Hit {
        self.enter(node)?;
        let (left, right) = match self.query.bvh.nodes[node as usize].contents {
            Contents::Leaf { first, count } => return self.leaf(self.query.bvh.primitives(first, count)),
            Contents::Inner { left, right } => (left, right),
        };
        let both = (self.enter(left), self.enter(right));
        let right_is_nearer =
            matches!(both, (Some(l), Some(r)) if r < l) || (both.0.is_none() && both.1.is_some());
        let (near, far) = if right_is_nearer { (right, left) } else { (left, right) };
        match self.wrong {
            Wrong::LeftOnly => self.below(left),
            Wrong::RightOnly => self.below(right),
            Wrong::NearOnly => self.below(near),
            Wrong::LeftIfAny => self.below(left).or_else(|| self.below(right)),
            Wrong::NearIfAny => self.below(near).or_else(|| self.below(far)),
            Wrong::LeftIfEntered => self.below(if both.0.is_some() { left } else { right }),
            Wrong::NothingIfOneIsMissed if both.0.is_none() || both.1.is_none() => None,
            Wrong::NothingIfOneHasNone => {
                let (in_left, in_right) = (self.below(left), self.below(right));
                in_left.zip(in_right).and_then(|(p, q)| self.nearer(Some(p), Some(q)))
            }
            Wrong::TieToTheFirst => self.nearer(self.below(near), self.below(far)),
            _ => self.nearer(self.below(left), self.below(right)),
        }
    }
}

fn found_by(wrong: Wrong, query: &SearchQuery) -> Hit {
    Search { query, wrong }.below(query.bvh.root()?)
}

/// Mistakes that a wrong answer alone shows.
pub(super) fn observations(query: &SearchQuery, yours: Hit, counts: &Counts) -> [(bool, &'static str); 3] {
    let is_in_table = |(id, t): (u32, f32)| query.table.primitives.get(id as usize) == Some(&t);
    let nothing_is_opened = yours.is_none() && counts.node_visits == 0;
    [
        (yours.is_some_and(|(_, t)| !query.ray.contains(t)), "you return a hit outside the ray's range"),
        "the t of your hit is not that of its primitive: keep both together"
            .when(yours.is_some_and(|hit| !is_in_table(hit))),
        (nothing_is_opened, "you open no node, although the ray enters the box of the root"),
    ]
}

/// All known mistakes of a search for the closest hit, each with whether it gives this answer.
pub(super) fn mistakes(query: &SearchQuery, yours: Hit) -> Vec<(bool, &'static str)> {
    MISTAKES.map(|(wrong, text)| (yours == found_by(wrong, query), text)).into()
}

/// All known mistakes of a search for any hit, each with whether it gives this answer.
pub(super) fn any_mistakes(query: &SearchQuery, yours: bool) -> Vec<(bool, &'static str)> {
    let with_range = |t_min: f32, t_max: f32| {
        let ray = query.ray.with_range(t_min, t_max);
        found_by(Wrong::Nothing, &SearchQuery { ray, ..query.clone() }).is_some()
    };
    // A search that enters a leaf without asking its primitives.
    let mut all_hit = query.clone();
    all_hit.table.primitives.fill(query.ray.t_max.min(1e30).next_down());
    let enters_a_leaf = found_by(Wrong::Nothing, &all_hit).is_some();
    let is = |wrong: Wrong| yours == found_by(wrong, query).is_some();
    let right = found_by(Wrong::Nothing, query).is_some();
    let inside = |&(near, far): &(f32, f32)| near <= query.ray.t_min && query.ray.t_min <= far;
    let around_start = query.table.boxes.iter().any(inside);
    named![
        yours == enters_a_leaf => "you take a box for a hit: to enter a box is not yet a hit",
        yours == with_range(query.ray.t_min, f32::INFINITY) => "you count a hit beyond t_max",
        yours == with_range(0.0, query.ray.t_max) => "you count a hit before t_min",
        yours == with_range(0.0, f32::INFINITY) => "you count a hit before t_min or beyond t_max",
        is(Wrong::LeftOnly) => "a hit was overlooked: the right child is left out",
        is(Wrong::RightOnly) => "a hit was overlooked: the left child is left out",
        is(Wrong::OneOfLeaf) => "a hit was overlooked: ask all of a leaf's primitives",
        is(Wrong::LastOfLeafLeftOut) => "a hit was overlooked: the last primitive of a leaf is left out",
        is(Wrong::NearOnly) => "a hit was overlooked: the farther child is left out",
        is(Wrong::FirstOfLeafLeftOut) => "a hit was overlooked: the first primitive of a leaf is left out",
        is(Wrong::NothingIfOneIsMissed) => "a hit was overlooked: if one box is missed, the other may still be met",
        is(Wrong::LeftIfEntered) => "a hit was overlooked: the right child is left out if the ray enters the left box",
        is(Wrong::AllOfLeaf) => "a hit was overlooked: one primitive of a leaf is enough",
        is(Wrong::InsideLeftOut(0)) || is(Wrong::InsideLeftOut(1)) =>
            "a hit was overlooked: the ray begins in a box, whose entry is at t_min",
        yours == (right || around_start) => "you take a box around the start of the ray for a hit: ask its primitives",
        is(Wrong::NothingIfOneHasNone) => "a hit was overlooked: one child is enough",
    ].to_vec()
}

/// The nodes and primitives that a search with a mistake visits, if it goes to the nearer child first.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Order {
    /// The range of the ray never shrinks.
    NeverPrunes,
    /// The farther box is not compared with `t_max` again.
    NotAgain,
    /// The farther child first.
    FartherFirst,
    FartherFirstNotAgain,
    /// The left child first, and the right box is entered after the left child was searched.
    LeftFirst,
}

/// The number of nodes that such a search opens.
pub(super) fn visits(order: Order, query: &SearchQuery) -> u64 {
    fn below(order: Order, query: &SearchQuery, node: u32, end: &mut f32, visits: &mut u64) {
        *visits += 1;
        let enter = |node: u32, end: f32| {
            let (near, far) = query.table.boxes[node as usize];
            let near = near.max(query.ray.t_min);
            (near <= far && near < end).then_some(near)
        };
        match query.bvh.nodes[node as usize].contents {
            Contents::Leaf { first, count } => {
                for &id in query.bvh.primitives(first, count) {
                    let t = query.table.primitives[id as usize];
                    if query.ray.contains(t) && order != Order::NeverPrunes {
                        *end = end.min(t.next_up());
                    }
                }
            }
            Contents::Inner { left, right } => {
                let (in_left, in_right) = (enter(left, *end), enter(right, *end));
                let farther_first = matches!(order, Order::FartherFirst | Order::FartherFirstNotAgain);
                let swap = match (in_left, in_right) {
                    (Some(l), Some(r)) => order != Order::LeftFirst && ((r < l) != farther_first),
                    _ => false,
                };
                let children = if swap {
                    [(right, in_right), (left, in_left)]
                } else {
                    [(left, in_left), (right, in_right)]
                };
                for (child, entered) in children {
                    let Some(t) = entered else { continue };
                    let again = !matches!(order, Order::NotAgain | Order::FartherFirstNotAgain);
                    if !again || t < *end {
                        below(order, query, child, end, visits);
                    }
                }
            }
        }
    }
    let (mut end, mut count) = (query.ray.t_max, 0);
    if let Some(root) = query.bvh.root()
        && (Search { query, wrong: Wrong::Nothing }).enter(root).is_some()
    {
        below(order, query, root, &mut end, &mut count);
    }
    count
}

/// The orders that open too many nodes, with whether they open exactly so many.
pub(super) fn order_mistakes(queries: &[SearchQuery], yours: u64) -> [(bool, &'static str); 5] {
    // Of children that are entered at the same t, either may come first.
    let is = |order: Order| {
        let count = queries.iter().map(|query| visits(order, query)).sum::<u64>();
        yours.abs_diff(count) <= count / 50
    };
    [
        "no node is skipped: let ray.t_max shrink with each hit, and enter the nearer child first"
            .when(is(Order::NeverPrunes)),
        (is(Order::NotAgain), "the farther box is not tested again after a nearer hit was found"),
        (is(Order::FartherFirst), "the farther child is searched first: enter the nearer child first"),
        "the farther child is searched first, and no box is tested again: enter the nearer child first"
            .when(is(Order::FartherFirstNotAgain)),
        (is(Order::LeftFirst), "the left child is always searched first: enter the nearer child first"),
    ]
}
