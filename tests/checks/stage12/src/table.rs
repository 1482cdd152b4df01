//! The table of stage 12: the bins, the split and the trees of sixteen boxes.

use super::bins::{grid_over, primitives};
use super::trees::drawn_tree;
use checks::golden::{Table, digits};
use checks::prelude::*;
use raykata::bvh::Bvh;
use raykata::wide::{ChildContents, FlatTree, WideTree};
use std::fmt::Write;

fn bins_and_split(kit: &dyn Kit, boxes: &[Aabb], text: &mut String) {
    let primitives = primitives(boxes);
    let n_bins = 6;
    let grid = grid_over(&primitives, n_bins);
    let bins = kit.fill_bins(&[BinsQuery { primitives: primitives.clone(), grid }]).remove(0);
    for (axis, bins) in bins.0.iter().enumerate() {
        let bin = |bin: &raykata::wide::Bin| match bin.count {
            0 => "-".into(),
            n => format!("{n}:{}..{}", digits(bin.bounds.low[axis], 2), digits(bin.bounds.high[axis], 2)),
        };
        let bins: Vec<String> = bins[..n_bins as usize].iter().map(bin).collect();
        let _ = writeln!(text, "bins of axis {axis}  {}", bins.join("  "));
    }
    let costs: Vec<String> = kit.block_cost(&[1, 8, 9, 16]).into_iter().map(|cost| digits(cost, 1)).collect();
    let _ = writeln!(text, "leaves of 1, 8, 9 and 16  {}", costs.join("  "));
    let Some(split) = kit.cheapest_split(&[BinSplitQuery { bins, n_bins }]).remove(0) else {
        text.push_str("no split\n");
        return;
    };
    let _ = writeln!(text, "split  axis {}  bin {}  cost {}", split.axis, split.bin, digits(split.cost, 2));
    let answer = kit.partition_bins(&[PartitionQuery { primitives, grid, split }]).remove(0);
    let mut sides = answer.order.clone();
    let middle = answer.middle.unwrap_or(0).min(sides.len());
    sides[..middle].sort_unstable();
    sides[middle..].sort_unstable();
    let _ = writeln!(text, "left {:?}  right {:?}", &sides[..middle], &sides[middle..]);
}

/// The nodes of a flat tree: a leaf by its primitives, an inner node by its first child.
fn flat(tree: &FlatTree, text: &mut String) {
    for (index, node) in tree.nodes.iter().enumerate() {
        let range = node.first as usize..node.first as usize + node.count as usize;
        let _ = match tree.order.get(range) {
            Some(ids) if node.is_leaf() => writeln!(text, "flat {index}  leaf {ids:?}"),
            _ => writeln!(text, "flat {index}  children from {}", node.first),
        };
    }
}

/// The primitives below each child of the root of a wide tree, sorted.
fn children_of_root(wide: &WideTree, text: &mut String) {
    let Some(root) = wide.nodes.first() else { return };
    let mut lines: Vec<String> = Vec::new();
    for place in 0..root.n_children() as usize {
        let (mut ids, mut waiting) = (Vec::new(), vec![root.children[place]]);
        // A tree has fewer nodes than this number of steps.
        for _ in 0..1000 {
            match waiting.pop().map(raykata::wide::Child::contents) {
                None => break,
                Some(ChildContents::Leaf { block, count }) => {
                    let blocks = wide.blocks.iter().skip(block as usize).flatten();
                    ids.extend(blocks.take(count as usize).copied());
                }
                Some(ChildContents::Inner(node)) => {
                    let Some(node) = wide.nodes.get(node as usize) else { continue };
                    waiting.extend_from_slice(&node.children[..node.n_children() as usize]);
                }
            }
        }
        ids.sort_unstable();
        let bounds = root.child_bounds(place);
        let (low, high) = (digits(bounds.min.x, 2), digits(bounds.max.x, 2));
        lines.push(format!("child of the root  {low} to {high}  {ids:?}"));
    }
    lines.sort_unstable();
    lines.iter().for_each(|line| _ = writeln!(text, "{line}"));
}

fn lines(kit: &dyn Kit, boxes: &[Aabb], bvh: &Bvh) -> String {
    let mut text = String::new();
    bins_and_split(kit, boxes, &mut text);
    flat(&kit.flatten(std::slice::from_ref(bvh))[0], &mut text);
    let tree = drawn_tree(boxes, 1, &[1, 4, 2, 7, 1]);
    children_of_root(&kit.collapse(&[(tree, 2.0)])[0], &mut text);
    text
}

pub(super) fn table_of_bins_and_trees(trial: &Trial<'_>) -> CheckResult {
    // Boxes in a row with gaps of different widths, and of different sizes, so that the cheapest split is the only one.
    let gaps = [2, 9, 3, 25, 4, 1, 13, 6, 31, 5, 8, 2, 17, 3, 11, 7];
    let sizes = [1, 4, 2, 7, 1, 5, 2, 3, 6, 2, 1, 4, 3, 8, 2, 5];
    let public = gaps.into_iter().zip(sizes).collect();
    let hidden = prop::collection::vec((1..=31i32, 1..=8i32), 16);
    let drawn = trial.composed(public, hidden);
    let mut x = 0.0;
    let boxes: Vec<Aabb> = drawn
        .iter()
        .zip(0..)
        .map(|((gap, size), i)| {
            x += *gap as f32 / 4.0;
            // No two have the same height or depth.
            let (size, i) = (*size as f32 / 4.0, i as f32);
            let low = Vec3::new(x, (i * 7.0) % 16.0 / 8.0, (i * 5.0) % 16.0 / 32.0);
            Aabb::new(low, low + Vec3::new(size, 1.0 + i / 64.0, 0.5 + size / 8.0))
        })
        .collect();
    let bvh = checks::tree::joined(&boxes, 2);
    let input = "sixteen boxes in a row";
    Table { name: "stage12_bins_and_trees", input }.check(trial, |kit| lines(kit, &boxes, &bvh))
}
