//! `build_parallel`: the tree, and the work and the span that follow from the log of its forks.

use super::builds::{crowds, judge_tree};
use super::scenes::scenes;
use super::trees::{broken_by, fault, from_leaves, ranges};
use checks::prelude::*;
use oracle::splitmix::Random;
use raykata::bvh::DEEPEST_SPLIT;
use raykata::wide::{FlatNode, FlatTree, Fork, ForkKind, ForkedTree};
use std::collections::{HashMap, HashSet};

/// An even cloud of small boxes.
fn cloud(seed: u64, n: usize) -> Vec<Aabb> {
    let mut random = Random::new(seed, 22);
    (0..n).map(|_| random.in_cube()).map(|center| Aabb::new(center - 0.01, center + 0.01)).collect()
}

pub(super) fn build_parallel_gives_the_same_tree(trial: &Trial<'_>) -> CheckResult {
    let mut sets = vec![cloud(trial.seed, 6), Vec::new(), cloud(trial.seed, 1)];
    // So many, and in such an order, that each piece of a large node shows.
    let mut many = cloud(trial.seed, trial.varied(100_000, 90_000..110_000usize));
    many.sort_by(|p, q| p.min.x.total_cmp(&q.min.x));
    sets.push(many);
    sets.push(scenes().swap_remove(2).1);
    sets.extend(crowds(trial.varied(1.0, 0.25..8f32)));
    let alone = trial.kit.build_binned(&sets);
    let answers = trial.kit.build_parallel(&sets);
    let judge = |((boxes, alone), forked): ((&Vec<Aabb>, &FlatTree), &ForkedTree)| {
        let yours = &forked.tree;
        if yours == alone {
            // The same empty tree twice is no tree.
            return judge_tree(boxes, yours);
        }
        judge_tree(boxes, alone)?;
        // The nodes without the indices of children.
        let kinds = |tree: &FlatTree, of_leaves: bool| -> Vec<(Aabb, u32, u32)> {
            let first = |node: &FlatNode| if node.is_leaf() == of_leaves { node.first } else { 0 };
            tree.nodes.iter().map(|node| (node.bounds(), node.count, first(node))).collect()
        };
        let [only_indices, only_leaves] = [true, false].map(|of_leaves| {
            kinds(yours, of_leaves) == kinds(alone, of_leaves) && yours.order == alone.order
        });
        let n = yours.nodes.len().max(alone.nodes.len());
        let different = (0..n).find(|&i| yours.nodes.get(i) != alone.nodes.get(i));
        let of = |tree: &FlatTree| match different {
            Some(i) => format!("node {i} of {}: {:?}", tree.nodes.len(), tree.nodes.get(i)),
            None => format!("order {:?}…", &tree.order[..tree.order.len().min(10)]),
        };
        // The node whose first child differs, or its second one.
        let is_parent = |i: usize| {
            let first = alone.nodes[i].first as usize;
            !alone.nodes[i].is_leaf() && different.is_some_and(|i| i == first || i == first + 1)
        };
        let parent = (0..alone.nodes.len()).find(|&i| is_parent(i)).map(|i| ranges(alone)[i]);
        let is_in_pieces = forked.forks.iter().any(|fork| {
            matches!(fork.kind, ForkKind::Binning { .. }) && parent == Some((fork.first, fork.count))
        });
        let input = format!("build_parallel of {} boxes", boxes.len());
        Err(Broken::with_texts(input, of(yours), of(alone), "your build_binned").explained_by([
            (only_indices, "only the indices of children differ: they shift when the arrays of both sides are joined"),
            (only_leaves, "only `first` of leaves differs: it is a position in the order, and does not shift with the nodes"),
            "the trees differ only below DEEPEST_SPLIT: both sides of a fork are one level deeper"
                .when(different.is_some_and(|i| depths(alone).get(i).is_some_and(|depth| *depth > DEEPEST_SPLIT))),
            "the trees differ first below a node that is sorted in pieces: add up the counts and the boxes of all pieces"
                .when(is_in_pieces),
        ]))
    };
    all_hold(sets.iter().zip(&alone).zip(&answers).map(judge).collect())
}

/// The depth of each node.
fn depths(tree: &FlatTree) -> Vec<usize> {
    let mut depths = vec![0; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
        let depth = depths[index] + 1;
        depths[node.first as usize..][..2].fill(depth);
    }
    depths
}

/// The work and the span of a build without faults that has logged these forks, in primitives.
pub fn work_and_span_of_log(tree: &FlatTree, forks: &[Fork]) -> (u64, u64) {
    let ranges = ranges(tree);
    let children = forked_ranges(forks);
    let pieces_of = |fork: &Fork| match fork.kind {
        ForkKind::Binning { pieces } => Some(((fork.first, fork.count), pieces)),
        ForkKind::Children => None,
    };
    let binning: HashMap<(u32, u32), u32> = forks.iter().filter_map(pieces_of).collect();
    let own = |index: usize| match binning.get(&ranges[index]) {
        Some(&pieces) => own_span(ranges[index].1, pieces),
        None => u64::from(ranges[index].1),
    };
    work_and_span_of(tree, &ranges, own, |index| children.contains(&ranges[index]))
}

/// The work and the span of a build that forks at the nodes for which `forks` returns true, in primitives.
fn work_and_span(tree: &FlatTree, ranges: &[(u32, u32)], forks: impl Fn(usize) -> bool) -> (u64, u64) {
    work_and_span_of(tree, ranges, |index| u64::from(ranges[index].1), forks)
}

/// The same, with the span of each node's own work.
fn work_and_span_of(
    tree: &FlatTree,
    ranges: &[(u32, u32)],
    own_span: impl Fn(usize) -> u64,
    forks: impl Fn(usize) -> bool,
) -> (u64, u64) {
    let own = |index: usize| (u64::from(ranges[index].1), own_span(index));
    let join = |index, left: (u64, u64), right: (u64, u64)| {
        let (work, span) = own(index);
        let below = if forks(index) { left.1.max(right.1) } else { left.1 + right.1 };
        (work + left.0 + right.0, span + below)
    };
    from_leaves(tree, |index, _| own(index), join).first().copied().unwrap_or_default()
}

/// A build of many boxes: the tree, the ranges of its nodes, and the nodes that are forked.
struct Forked {
    tree: FlatTree,
    ranges: Vec<(u32, u32)>,
    forks: Vec<Fork>,
}

/// The build of `n` boxes, or with a hidden seed of up to a tenth more.
fn build_many(trial: &Trial<'_>, n: usize) -> Result<Forked, Broken> {
    let n = trial.varied(n, n..n + n / 10);
    let boxes = cloud(trial.seed, n);
    let ForkedTree { tree, forks } = trial.kit.build_parallel(std::slice::from_ref(&boxes)).remove(0);
    if let Some(fault) = fault(&tree, &boxes) {
        return Err(broken_by(fault, format!("build_parallel of {n} boxes"), "the layout of FlatTree"));
    }
    Ok(Forked { ranges: ranges(&tree), tree, forks })
}

/// The nodes at which both sides are built in parallel, by their ranges.
fn forked_ranges(forks: &[Fork]) -> HashSet<(u32, u32)> {
    let children = forks.iter().filter(|fork| fork.kind == ForkKind::Children);
    children.map(|fork| (fork.first, fork.count)).collect()
}

pub(super) fn build_parallel_logs_the_nodes_that_it_forks(trial: &Trial<'_>) -> CheckResult {
    let Forked { tree, ranges, forks } = build_many(trial, 10_000)?;
    let inner: HashSet<(u32, u32)> = (0..tree.nodes.len())
        .filter(|&index| !tree.nodes[index].is_leaf())
        .map(|index| ranges[index])
        .collect();
    let mut seen = HashSet::new();
    let broken = |fork: Option<&Fork>, expected: &str, cause: &'static str| {
        let yours = fork.map_or("no fork".into(), |fork| format!("{fork:?}"));
        let input = format!("build_parallel of {} boxes", tree.order.len());
        Err(Broken::with_texts(input, yours, expected, "the finished tree")
            .explained_by([(!cause.is_empty(), cause)]))
    };
    if forks.is_empty() {
        return broken(
            None,
            "a fork at the root, at least",
            "nothing is forked: join both sides of a large node by `forks.join`",
        );
    }
    let counts: HashSet<u32> = inner.iter().map(|(_, count)| *count).collect();
    for fork in &forks {
        if !inner.contains(&(fork.first, fork.count)) {
            let is_shifted = forks.iter().all(|fork| counts.contains(&fork.count));
            let cause = if is_shifted {
                "`first` is the position in the order of the whole tree, not in that of one side"
            } else {
                ""
            };
            return broken(Some(fork), "the range of an inner node", cause);
        }
        if fork.kind == ForkKind::Children && !seen.insert((fork.first, fork.count)) {
            return broken(Some(fork), "each node once", "a node is logged twice");
        }
    }
    Ok(())
}

/// Judges whether the span of a build of `n` boxes is at most the work divided by `share`.
pub(super) fn judge_span(trial: &Trial<'_>, n: usize, share: u64) -> CheckResult {
    let Forked { tree, ranges, forks } = build_many(trial, n)?;
    let known = forked_ranges(&forks);
    let (work, span) = work_and_span(&tree, &ranges, |index| known.contains(&ranges[index]));
    if share * span <= work {
        return Ok(());
    }
    let at = |index: usize| ranges[index].1 > 2000;
    let is_node = |fork: &Fork| ranges.contains(&(fork.first, fork.count));
    let (_, possible) = work_and_span(&tree, &ranges, at);
    let yours = format!("work {work}, span {span}: a ratio of {:.2}", work as f64 / span as f64);
    let input = format!("build_parallel of {} boxes, with {} forks", tree.order.len(), forks.len());
    Err(Broken::with_texts(
        input,
        yours,
        format!("a span of at most {}", work / share),
        "the tree and the log of forks",
    )
    .explained_by([
        (forks.is_empty(), "nothing is forked: join both sides of a large node by `forks.join`"),
        "too few nodes are forked: with forks at all nodes above 2,000 primitives the span is short enough"
            .when(share * possible <= work && forks.iter().all(is_node)),
    ]))
}

/// The smallest number of primitives of a piece: smaller pieces take longer to hand over than to sort.
const LEAST_PIECE: u32 = 1000;

/// The span of the own work of a node that sorts its primitives into bins in pieces: half of it is sorting.
fn own_span(count: u32, pieces: u32) -> u64 {
    let (half, pieces) = (u64::from(count) / 2, u64::from(pieces.max(1)));
    u64::from(count) - half + half.div_ceil(pieces)
}

pub(super) fn build_parallel_has_an_eighth_of_the_span(trial: &Trial<'_>) -> CheckResult {
    let Forked { tree, ranges, forks } = build_many(trial, 100_000)?;
    let children = forked_ranges(&forks);
    let mut binning = HashSet::new();
    let input = format!("build_parallel of {} boxes, with {} forks", tree.order.len(), forks.len());
    for fork in &forks {
        let ForkKind::Binning { pieces } = fork.kind else { continue };
        let most = fork.count / LEAST_PIECE;
        if pieces > most || !binning.insert((fork.first, fork.count)) {
            let (yours, expected) = (format!("{fork:?}"), format!("once per node, at most {most} pieces"));
            return Err(Broken::with_texts(input, yours, expected, "the log of forks").explained_by([
                (pieces > most, "a piece has fewer than 1,000 primitives"),
                (pieces <= most, "a node is logged twice"),
            ]));
        }
    }
    let (work, span) = work_and_span_of_log(&tree, &forks);
    if 8 * span <= work {
        return Ok(());
    }
    let yours = format!("work {work}, span {span}: a ratio of {:.2}", work as f64 / span as f64);
    let expected = format!("a span of at most {}", work / 8);
    // Would the span be short enough with these forks of children, and all large nodes sorted in pieces?
    let forked = |index: usize| children.contains(&ranges[index]);
    let in_pieces = |index: usize| own_span(ranges[index].1, (ranges[index].1 / 2 / LEAST_PIECE).min(8));
    let possible = 8 * work_and_span_of(&tree, &ranges, in_pieces, forked).1 <= work;
    Err(Broken::with_texts(input, yours, expected, "the tree and the log of forks").explained_by(named![
        binning.is_empty() && possible =>
            "no node sorts its primitives into bins in pieces: use `forks.each` at large nodes",
        !binning.is_empty() && possible => "too few nodes sort their primitives in pieces, or in too few pieces",
    ]))
}
