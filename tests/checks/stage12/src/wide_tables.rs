//! Wide trees whose boxes and primitives are tables of answers, and searches of them.

use super::trees::shuffled;
use checks::prelude::*;
use checks::tree::move_apart;
use raykata::bvh::PrimitiveHit;
use raykata::wide::{BLOCK, Child, ChildContents, MAX_LEAF, NO_PRIMITIVE, WideTree};
use std::ops::Range;

/// What a table is made of.
struct Parts<'a> {
    /// The primitives of each leaf.
    leaves: &'a [Vec<u32>],
    hits: &'a [f32],
    t_min: f32,
    /// Numbers from which the shape of the tree and the entries follow.
    choices: std::iter::Cycle<std::slice::Iter<'a, u16>>,
    tree: WideTree,
    entries: Vec<[f32; 8]>,
}

impl Parts<'_> {
    fn choice(&mut self, n: usize) -> usize {
        usize::from(*self.choices.next().unwrap_or(&0)) % n
    }

    /// A child over these leaves, and the `t` at which it is entered; ∞ if it is missed.
    fn child(&mut self, leaves: Range<usize>) -> (Child, f32) {
        let slack = self.choice(5) as f32 / 4.0;
        let (child, within) = if leaves.len() == 1 {
            let ids = self.leaves[leaves.start].clone();
            let first = self.tree.blocks.len() as u32;
            for part in ids.chunks(BLOCK) {
                let mut block = [NO_PRIMITIVE; BLOCK];
                block[..part.len()].copy_from_slice(part);
                self.tree.blocks.push(block);
            }
            let nearest = ids.iter().map(|&id| self.hits[id as usize]).fold(f32::INFINITY, f32::min);
            // Some boxes are entered although nothing in them is hit.
            let passed = if self.choice(2) == 0 { self.choice(40) as f32 / 4.0 } else { f32::INFINITY };
            (Child::leaf(first, ids.len() as u32), if nearest.is_finite() { nearest } else { passed })
        } else {
            let (node, nearest) = self.node(leaves);
            (Child::inner(node), nearest)
        };
        (child, (within - slack).max(self.t_min))
    }

    /// Adds a node over these leaves; returns its index and the smallest entry of its children.
    fn node(&mut self, leaves: Range<usize>) -> (u32, f32) {
        let index = self.tree.nodes.len();
        self.tree.nodes.push(raykata::wide::WideNode::EMPTY);
        self.entries.push([f32::INFINITY; 8]);
        let n = leaves.len().min(1 + self.choice(8)).max(leaves.len().min(2));
        let mut nearest = f32::INFINITY;
        for place in 0..n {
            let at = |place: usize| leaves.start + place * leaves.len() / n;
            let (child, t) = self.child(at(place)..at(place + 1));
            self.tree.nodes[index].children[place] = child;
            self.entries[index][place] = t;
            nearest = nearest.min(t);
        }
        (index as u32, nearest)
    }
}

/// A search of a tree over primitives with these hits. The leaves have the sizes of `sizes`, and list the primitives in
/// an order that is not that of their numbers.
pub(super) fn query(hits: &[f32], sizes: &[usize], choices: &[u16], ray: Ray) -> WideQuery {
    let mut ids = shuffled(hits.len()).into_iter();
    let mut leaves = Vec::new();
    for size in sizes.iter().cycle() {
        let leaf: Vec<u32> = ids.by_ref().take((*size).clamp(1, MAX_LEAF)).collect();
        if leaf.is_empty() {
            break;
        }
        leaves.push(leaf);
    }
    let mut parts = Parts {
        leaves: &leaves,
        hits,
        t_min: ray.t_min,
        choices: choices.iter().cycle(),
        tree: WideTree::default(),
        entries: Vec::new(),
    };
    parts.node(0..leaves.len());
    WideQuery { tree: parts.tree, ray, entries: parts.entries, hits: hits.to_vec() }
}

/// Searches with up to `most` primitives. Their `t` are near whole quarters, and no two are equal.
pub(super) fn searches(most: usize) -> impl Strategy<Value = WideQuery> + Clone {
    let t = prop_oneof![2 => fractions(1..=40, 4.0), 1 => Just(f32::INFINITY)];
    let hits = prop::collection::vec(t, 1..=most);
    let sizes = prop::collection::vec(1..=9usize, 1..6);
    let choices = prop::collection::vec(any::<u16>(), 1..30);
    (hits, sizes, choices, 0..=6i32, 0..=12i32).prop_map(|(mut hits, sizes, choices, t_min, t_max)| {
        move_apart(&mut hits, 1.0 / 64.0);
        let t_max = if t_max < 4 { f32::INFINITY } else { t_max as f32 };
        // Half of the rays begin at 0.
        let t_min = (t_min - 3).max(0) as f32;
        query(&hits, &sizes, &choices, Ray::new(Vec3::ZERO, Vec3::X).with_range(t_min, t_max))
    })
}

/// A tree of two leaves with one primitive each, and the `t` at which they are entered and hit.
pub(super) fn two_leaves(entries: [f32; 2], hits: [f32; 2]) -> WideQuery {
    let mut two = query(&hits, &[1], &[0, 1], Ray::new(Vec3::ZERO, Vec3::X));
    two.entries[0][..2].copy_from_slice(&entries);
    two
}

/// The primitive and the `t` of the closest hit by brute force; of equal ones the smaller number.
pub(super) fn closest(query: &WideQuery) -> Option<(u32, f32)> {
    checks::tree::closest_of(&query.hits, &query.ray)
}

/// All calls of a search.
pub fn n_calls(answer: &WideAnswer) -> usize {
    answer.nodes.len() + answer.blocks.len() + answer.primitives.len()
}

pub(super) fn describe(query: &WideQuery) -> String {
    let WideQuery { tree, hits, .. } = query;
    let [nodes, blocks] = [tree.nodes.len(), tree.blocks.len()];
    format!(
        "a tree of {nodes} nodes and {blocks} blocks over {} primitives\n{}",
        hits.len(),
        checks::tree::hits_of(&query.ray, hits)
    )
}

/// The nodes that the ray enters if nothing is skipped, the root included.
pub(super) fn overlapped(query: &WideQuery) -> Vec<u32> {
    let (mut overlapped, mut waiting) = (Vec::new(), vec![0u32]);
    while let Some(node) = waiting.pop() {
        overlapped.push(node);
        let children = &query.tree.nodes[node as usize].children;
        for (child, t) in children.iter().zip(query.entries[node as usize]) {
            if let (true, ChildContents::Inner(below)) =
                (t.is_finite() && t <= query.ray.t_max, child.contents())
            {
                waiting.push(below);
            }
        }
    }
    overlapped.sort_unstable();
    overlapped
}

/// The order in which a flawed search visits the children that it enters, and what else is wrong with it.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Flaw {
    /// In the order of their places.
    Unsorted,
    /// The farthest first.
    FarthestFirst,
    /// The nearest first, but nothing is skipped when it comes from the stack.
    NothingSkipped,
    /// As it should be, but a child that is entered at the best `t` is skipped.
    SkippedAtTheBest,
    /// As it should be, but of two hits at the same `t` the first one stays.
    FirstOfEqual,
    /// The ray keeps its range, so nothing is skipped.
    NotShortened,
    /// Each lane of a block is tested.
    EveryLane,
    /// Each lane of a block is tested, and nothing is skipped when it comes from the stack.
    Everything,
}

/// What a flawed search returns, and its number of calls. Other children than the nearest wait on the stack in order, or as the
/// reference pushes them.
pub(super) fn flawed_search(query: &WideQuery, flaw: Flaw, is_sorted: bool) -> (Option<(u32, f32)>, usize) {
    let mut ray = query.ray;
    let mut best: Option<PrimitiveHit> = None;
    let (mut n_calls, mut stack) = (0, vec![(Child::ROOT, ray.t_min)]);
    while let Some((child, t)) = stack.pop() {
        let limit =
            if flaw == Flaw::SkippedAtTheBest { best.map_or(ray.t_max, |best| best.t) } else { ray.t_max };
        if !matches!(flaw, Flaw::NothingSkipped | Flaw::Everything) && t >= limit {
            continue;
        }
        match child.contents() {
            ChildContents::Inner(node) => {
                n_calls += 1;
                let node = node as usize;
                let mut entered: Vec<(Child, f32)> =
                    query.tree.nodes[node].children.into_iter().zip(query.entries[node]).collect();
                entered.retain(|(_, t)| t.is_finite() && *t <= ray.t_max);
                match flaw {
                    Flaw::Unsorted => entered.reverse(),
                    Flaw::FarthestFirst => entered.sort_by_key(|(child, t)| child.key(*t)),
                    _ if is_sorted => entered.sort_by_key(|(child, t)| std::cmp::Reverse(child.key(*t))),
                    _ => {
                        for i in 1..entered.len() {
                            let [before, after] = [i - 1, i].map(|i| entered[i].0.key(entered[i].1));
                            if before < after {
                                entered.swap(i - 1, i);
                            }
                        }
                    }
                }
                stack.extend(entered);
            }
            ChildContents::Leaf { block, count } => {
                let lanes = query.tree.blocks[block as usize..].iter().flatten();
                let ids: Vec<u32> = lanes.copied().take(count as usize).collect();
                for lanes in ids.chunks(BLOCK) {
                    n_calls += 1;
                    // A hit in this block leaves its other candidates as they are.
                    let t_max = ray.t_max;
                    let candidates = lanes.iter().map(|&id| (id, query.hits[id as usize]));
                    let is_all = matches!(flaw, Flaw::EveryLane | Flaw::Everything);
                    for (id, t) in candidates.filter(|(_, t)| is_all || *t < t_max) {
                        n_calls += 1;
                        let wins = |best: PrimitiveHit| {
                            t < best.t || flaw != Flaw::FirstOfEqual && t == best.t && id < best.primitive
                        };
                        if ray.contains(t) && best.is_none_or(wins) {
                            best = Some(PrimitiveHit { t, primitive: id });
                            ray.t_max =
                                if flaw == Flaw::NotShortened { query.ray.t_max } else { t.next_up() };
                        }
                    }
                }
            }
        }
    }
    (best.map(|best| (best.primitive, best.t)), n_calls)
}
