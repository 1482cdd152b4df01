//! The laws of the five heuristics of the kd-tree: each is tested alone, switched on and switched off.

use super::lists::below;
use checks::prelude::*;
use raykata::partition::{KdHeuristics, KdNode, KdTree};

const NONE: KdHeuristics = KdHeuristics::NONE;

/// The axis and the coordinate of a cut, and the numbers of primitives on the left, on the right and on both sides.
type Cut = (usize, f32, [usize; 3]);

/// A student's tree over some boxes, and its first cut.
struct Built {
    what: String,
    tree: KdTree,
    cut: Option<Cut>,
}

/// Builds a tree with leaves of two primitives. `what` names the boxes and the heuristics.
fn build(trial: &Trial<'_>, what: impl Into<String>, bounds: &[Aabb], heuristics: KdHeuristics) -> Built {
    let query = KdQuery { bounds: bounds.to_vec(), heuristics, leaf_size: 2 };
    let tree = trial.kit.kd_build(&[query]).remove(0);
    let cut = first_cut(&tree);
    Built { what: what.into(), tree, cut }
}

fn first_cut(tree: &KdTree) -> Option<Cut> {
    let Some(KdNode::Inner { axis, at, left, right }) = tree.nodes.first().copied() else { return None };
    let [left, right] = [left, right].map(|side| below(tree, side));
    let both = left.iter().filter(|id| right.contains(id)).count();
    Some((usize::from(axis), at, [left.len(), right.len(), both]))
}

impl Built {
    /// An error unless the cut is right.
    fn must(&self, is_right: bool, expected: &str, mistake: (bool, &'static str)) -> CheckResult {
        if is_right {
            return Ok(());
        }
        let yours = match self.cut {
            None => "no cut at the root".into(),
            Some((axis, at, [left, right, both])) => {
                let axis = ["x", "y", "z"][axis];
                format!("a cut across {axis} at {at:.3}: {left} left, {right} right, {both} on both sides")
            }
        };
        self.refuse(yours, expected, mistake)
    }

    fn refuse(&self, yours: String, expected: &str, mistake: (bool, &'static str)) -> CheckResult {
        let input = format!("build of {}, leaf_size 2", self.what);
        Err(Broken::with_texts(input, yours, expected, "the heuristic").explained_by([mistake]))
    }
}

fn cubes(places: impl Iterator<Item = Vec3>) -> Vec<Aabb> {
    places.map(|p| Aabb::new(p, p + 0.5)).collect()
}

const OTHER_AXIS: &str = "you cut across an axis that is not the longest side of the cell";
const UNBALANCED: &str = "your cut leaves counts that are not balanced";

pub(super) fn kd_cuts_across_the_longest_side(trial: &Trial<'_>) -> CheckResult {
    for axis in 0..3 {
        let row = cubes((0..16).map(|i| {
            let mut p = vec3((i % 2) as f32, (i % 2) as f32, (i % 2) as f32);
            p[axis] = i as f32;
            p
        }));
        let what = format!("16 boxes along {}", ["x", "y", "z"][axis]);
        let alone = KdHeuristics { longest_axis: true, ..NONE };
        let on = build(trial, format!("{what}, longest_axis alone"), &row, alone);
        on.must(
            on.cut.is_some_and(|(yours, ..)| yours == axis),
            "a cut across that axis",
            (on.cut.is_some(), OTHER_AXIS),
        )?;
        let off = build(trial, format!("{what}, no heuristic"), &row, NONE);
        let says = "you cut across the longest axis although longest_axis is switched off";
        off.must(
            off.cut.is_some_and(|(yours, ..)| yours == 0),
            "a cut across x: axes in turn, x first",
            (off.cut.is_some_and(|(yours, ..)| yours == axis), says),
        )?;
    }
    // A wall of 8 boxes along y stands at one end of a cell of 20 × 9, which is left of the first cut.
    let wall = cubes((0..8).map(|i| vec3(0.0, 1.25 * i as f32, 0.0)).chain([vec3(40.0, 0.0, 0.0)]));
    let alone = KdHeuristics { longest_axis: true, ..NONE };
    let on = build(trial, "8 boxes along y and one at x = 40, longest_axis alone", &wall, alone);
    let mut other = None;
    on.tree.walk(64, |node, cell, _| {
        let size = cell.max - cell.min;
        // No two sides of these cells are as close as a hundredth.
        if let KdNode::Inner { axis, .. } = on.tree.nodes[node as usize]
            && size[usize::from(axis)] < 0.99 * size.max_element()
        {
            other = Some(format!("a cut across axis {axis} of a cell with the sides {size:.2}"));
        }
    });
    if let Some(yours) = other {
        return on.refuse(yours, "cuts across the longest side", (true, OTHER_AXIS));
    }
    // Axes in turn: x at the root, y and z below it.
    let block = cubes((0..64).map(|i| vec3((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32)));
    let Built { what, tree, .. } = build(trial, "4 × 4 × 4 boxes, no heuristic", &block, NONE);
    let mut axes = vec![None; 3];
    tree.walk(2, |node, _, depth| {
        if let KdNode::Inner { axis, .. } = tree.nodes[node as usize] {
            axes[depth] = axes[depth].or(Some(axis));
        }
    });
    if axes != [Some(0), Some(1), Some(2)] {
        let input = format!("build of {what}, leaf_size 2");
        return Err(Broken::new(input, axes, "axes 0, 1, 2 at depths 0, 1, 2", "axes in turn")
            .because("you do not take the axes in turn: the axis is the depth modulo 3"));
    }
    Ok(())
}

pub(super) fn kd_balances_counts(trial: &Trial<'_>) -> CheckResult {
    let crowd = cubes((0..40).map(|i| vec3(i as f32, 0.0, 0.0)).chain([vec3(400.0, 0.0, 0.0)]));
    let what = "40 boxes side by side from x = 0 and one at 400";
    let is_balanced =
        |built: &Built| built.cut.is_some_and(|(_, _, [left, right, _])| left.abs_diff(right) <= 2);
    // No cut between two boxes has straddlers, so with both heuristics the counts decide.
    for others in [NONE, KdHeuristics { few_straddlers: true, ..NONE }] {
        let with = if others == NONE { " alone" } else { " and few_straddlers" };
        let what = format!("{what}, balanced_counts{with}");
        let on = build(trial, what, &crowd, KdHeuristics { balanced_counts: true, ..others });
        on.must(is_balanced(&on), "about 20 on each side", (on.cut.is_some(), UNBALANCED))?;
    }
    // A plane before the planks has 5 and 7 beside it. One through the centre of the planks has 5 and none.
    let planks = (0..7).map(|i| Aabb::new(vec3(6.0, i as f32, 0.0), vec3(20.0, i as f32 + 0.5, 0.5)));
    let long: Vec<Aabb> = cubes((0..5).map(|i| vec3(i as f32, 0.0, 0.0))).into_iter().chain(planks).collect();
    let alone = KdHeuristics { balanced_counts: true, ..NONE };
    let on = build(trial, "5 small boxes and 7 planks from x = 6 to 20, balanced_counts alone", &long, alone);
    on.must(is_balanced(&on), "a difference of at most 2", (on.cut.is_some(), UNBALANCED))?;
    // A plane through the 4 planks has 10 and 9 beside it. One before them has 6 and 9, so its fuller side is less full.
    let few = (0..4).map(|i| Aabb::new(vec3(7.0, i as f32, 0.0), vec3(14.0, i as f32 + 0.5, 0.5)));
    let ends = cubes((0..6).chain(15..20).map(|i| vec3(i as f32, 0.0, 0.0)));
    let planks = "6 small boxes, 4 planks from x = 7 to 14 and 5 more small boxes, balanced_counts alone";
    let on = build(trial, planks, &few.chain(ends).collect::<Vec<_>>(), alone);
    let Some((_, at, [left, right, _])) = on.cut else { return on.must(false, "a cut", (false, UNBALANCED)) };
    let says = "you minimise the number on the fuller side: minimise the difference of both counts";
    on.must(
        left.abs_diff(right) <= 1,
        "a difference of at most 1",
        (left.max(right) == 9 && at <= 7.0, says),
    )?;
    let off = build(trial, format!("{what}, no heuristic"), &crowd, NONE);
    off.must(
        off.cut.is_some_and(|(_, at, _)| (at - 200.25).abs() <= 1.0),
        "a cut in the middle, at 200.25",
        (off.cut.is_some(), "your cut is not in the middle of the cell although no heuristic is on"),
    )?;
    // Below the root, too, where the boxes fill a part of their cell.
    let alone = KdHeuristics { longest_axis: true, ..NONE };
    let below = build(trial, format!("{what}, longest_axis alone"), &crowd, alone);
    let mut other = None;
    below.tree.walk(64, |node, cell, _| {
        if let KdNode::Inner { axis, at, .. } = below.tree.nodes[node as usize] {
            let (low, high) = (cell.min[usize::from(axis)], cell.max[usize::from(axis)]);
            if (f64::from(at) - 0.5 * (low + high)).abs() > 0.01 * (high - low) {
                other = Some(format!("a cut of {low:.2}..{high:.2} at {at:.2}"));
            }
        }
    });
    let says =
        "your cut is not in the middle of the cell: without balanced_counts and few_straddlers, cut it there";
    let middle = "cuts in the middle of their cells";
    other.map_or(Ok(()), |yours| below.refuse(yours, middle, (true, says)))
}

pub(super) fn kd_avoids_straddlers(trial: &Trial<'_>) -> CheckResult {
    // 12 planks lie across the middle, side by side along y. 4 small boxes lie left of a gap between x = 2 and 3.
    let planks = (0..12).map(|i| Aabb::new(vec3(3.0, i as f32, 0.0), vec3(10.0, i as f32 + 0.5, 0.5)));
    let small =
        (0..4).map(|i| Aabb::new(vec3(0.0, 3.0 * i as f32, 0.0), vec3(2.0, 3.0 * i as f32 + 0.5, 0.5)));
    let all: Vec<Aabb> = planks.chain(small).collect();
    let what = "12 planks from x = 3 to 10 and 4 from 0 to 2";
    for others in [NONE, KdHeuristics { balanced_counts: true, ..NONE }] {
        let with = if others == NONE { " alone" } else { " and balanced_counts" };
        let what = format!("{what}, few_straddlers{with}");
        let on = build(trial, what, &all, KdHeuristics { few_straddlers: true, ..others });
        let has_many = on.cut.is_some_and(|(.., [.., both])| both > 0);
        on.must(
            !has_many && on.cut.is_some_and(|(axis, at, _)| axis == 0 && (1.9..=3.1).contains(&at)),
            "a cut across x between 2 and 3, with none on both sides",
            (has_many, "you choose a plane with many on both sides"),
        )?;
    }
    let off = build(trial, format!("{what}, no heuristic"), &all, NONE);
    let on = build(trial, what, &all, KdHeuristics { few_straddlers: true, ..NONE });
    off.must(
        off.cut.is_some_and(|(_, _, [.., both])| both >= 12),
        "a cut in the middle, with 12 on both sides",
        (off.cut == on.cut, "you avoid straddlers although few_straddlers is switched off"),
    )
}

/// The fraction of the volume that is in empty leaves down to this depth.
fn empty_share(tree: &KdTree, most_depth: usize) -> f64 {
    let volume = |size: glam::DVec3| size.x * size.y * size.z;
    let (mut empty, mut all) = (0.0, 1.0);
    tree.walk(most_depth, |node, cell, depth| {
        let here = volume(cell.max - cell.min);
        if depth == 0 {
            all = here;
        }
        if matches!(tree.nodes[node as usize], KdNode::Leaf { count: 0, .. }) {
            empty += here;
        }
    });
    empty / all
}

pub(super) fn kd_cuts_off_empty_space(trial: &Trial<'_>) -> CheckResult {
    // Two groups in opposite corners of a cube: one cut separates them, and three more per group cut off its empty
    // space.
    let crowd = |corner: f32| {
        (0..27).map(move |i| {
            Vec3::splat(corner) + 0.75 * vec3((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32)
        })
    };
    let all = cubes(crowd(0.0).chain(crowd(18.0)));
    let what = "two groups of 27 boxes in opposite corners of a cube of side 20";
    let describe =
        |share: f64| format!("{:.0} % of the volume in empty leaves at depths 0 to 4", 100.0 * share);
    let alone = KdHeuristics { cut_off_empty_space: true, ..NONE };
    let [on, off] = [alone, NONE].map(|heuristics| build(trial, what, &all, heuristics).tree);
    let share = empty_share(&on, 4);
    // 99.8 % of the cube is empty, and four cuts are enough to cut most of it off.
    if share < 0.9 {
        let input = format!("build of {what}, cut_off_empty_space alone, leaf_size 2");
        let broken = Broken::with_texts(input, describe(share), "at least 90 %", "the heuristic");
        return Err(broken
            .explained_by(["empty margins of a cell are not cut off: do it before any other cut"
                .when(share == empty_share(&off, 4))]));
    }
    // The first cut is at x = 20. The boxes to its left leave margins of 9 and 9.5 %, or 15 and 15.5 %, of their cell along y.
    let text = "you cut off a margin that is no more than a tenth of the cell";
    let too_late = "you leave a margin that is more than a tenth of the cell";
    for (low, height, is_wide, says) in [(1.8, 4.0, false, text), (3.0, 3.4, true, too_late)] {
        let step = height + 0.1;
        let left = (0..4).map(|i| low + step * i as f32);
        let left = left.map(|y| Aabb::new(vec3(0.0, y, 0.0), vec3(19.5, y + height, 20.0)));
        let right = (0..4).map(|i| 5.0 * i as f32);
        let right = right.map(|y| Aabb::new(vec3(20.5, y, 0.0), vec3(40.0, y + 5.0, 20.0)));
        let what = format!("two stacks of 4 boxes of height {height} and 5, cut_off_empty_space alone");
        let built = build(trial, what, &left.chain(right).collect::<Vec<_>>(), alone);
        let mut below_the_first = None;
        built.tree.walk(1, |node, cell, depth| {
            if let KdNode::Inner { axis, at, .. } = built.tree.nodes[node as usize]
                && depth == 1
                && cell.max.x < 21.0
            {
                below_the_first = Some((axis, at));
            }
        });
        let across_y =
            below_the_first.filter(|(axis, _)| *axis == 1).map(|(_, at)| (3.1..16.9).contains(&at));
        if across_y != Some(!is_wide) {
            let yours = format!("a cut (axis, at) = {below_the_first:?} left of the first one");
            let expected =
                if is_wide { "a cut across y at a margin" } else { "a cut across y in the middle" };
            return built.refuse(yours, expected, (across_y == Some(is_wide), says));
        }
    }
    // Cuts in the middle leave less of the volume in empty leaves at depth 2.
    let [early, off] = [on, off].map(|tree| empty_share(&tree, 2));
    if off >= early {
        let input = format!("build of {what}, with cut_off_empty_space and without, leaf_size 2");
        let yours = format!("with {:.0} %, without {:.0} % empty at depth 2", 100.0 * early, 100.0 * off);
        return Err(Broken::with_texts(input, yours, "more with it than without", "the heuristic")
            .explained_by([
                "you cut off the margins although cut_off_empty_space is switched off".when(off == early)
            ]));
    }
    Ok(())
}

pub(super) fn kd_stops_at_overlap(trial: &Trial<'_>) -> CheckResult {
    // Planks lie across the middle: a plane across x that divides the boxes has most of the planks on both sides.
    let planks = |n_across: usize, n_small: usize| -> Vec<Aabb> {
        let across =
            (0..n_across).map(|i| Aabb::new(vec3(0.0, 0.0, i as f32), vec3(64.0, 1.0, i as f32 + 1.0)));
        let small =
            (0..n_small).map(|i| Aabb::new(vec3(40.0 + i as f32, 0.0, 0.0), vec3(40.5 + i as f32, 1.0, 1.0)));
        across.chain(small).collect()
    };
    let stop = KdHeuristics { stop_at_overlap: true, ..NONE };
    // On the left are 8 planks, on the right 8 planks and 12 small boxes: 8 of 8 on the left are also on the right.
    let what = "8 planks from x = 0 to 64 and 12 small boxes right of x = 40";
    let on = build(trial, format!("{what}, stop_at_overlap alone"), &planks(8, 12), stop);
    let says =
        "you divide although 60 % of those on one side are on both: compare with the count of each side";
    let n = on.tree.nodes.len();
    on.must(n == 1, "a leaf: all 8 on the left are also on the right", (n > 1, says))?;
    // On the left are 3 planks and 2 small boxes: exactly 60 % of them are also on the right.
    let two = cubes((0..2).map(|i| vec3(1.0 + i as f32, 0.0, 0.0)));
    let few =
        "3 planks from x = 0 to 64, 2 small boxes at x = 1 and 12 right of x = 40, stop_at_overlap alone";
    let exactly = build(trial, few, &[planks(3, 12), two].concat(), stop);
    let says = "you divide where exactly 60 % of one side are on both: at least 60 % make a leaf";
    let n = exactly.tree.nodes.len();
    exactly.must(n == 1, "a leaf: 3 of 5 on the left are also on the right", (n > 1, says))?;
    let off = build(trial, format!("{what}, no heuristic"), &planks(8, 12), NONE);
    let says = "you make a leaf because of overlap although stop_at_overlap is switched off";
    off.must(off.tree.nodes.len() != 1, "a cut in the middle", (true, says))?;
    // 4 planks across the middle, 4 small boxes on the left and 4 on the right: half of each side, which is below 60 %.
    let small = |x: f32| {
        (0..4).map(move |i| {
            Aabb::new(vec3(x + 2.0 * i as f32, 0.0, 0.0), vec3(x + 2.0 * i as f32 + 1.0, 1.0, 1.0))
        })
    };
    let few: Vec<Aabb> = planks(4, 0).into_iter().chain(small(1.0)).chain(small(50.0)).collect();
    let what = "4 planks from x = 0 to 64 and 4 small boxes at either end, stop_at_overlap alone";
    let divided = build(trial, what, &few, stop);
    divided.must(
        divided.tree.nodes.len() != 1,
        "a cut in the middle: half of each side is on the other, which is below 60 %",
        (true, "you make a leaf although less than 60 % of each side are on both"),
    )?;
    // 8 small boxes near x = 0 and one at 100: the second cut has all of its primitives on one side.
    let row: Vec<Aabb> = cubes((0..8).map(|i| vec3(i as f32, 0.0, 0.0)).chain([vec3(100.0, 0.0, 0.0)]));
    let what = "8 boxes from x = 0 to 8 and one at 100, longest_axis and stop_at_overlap";
    let divided = build(trial, what, &row, KdHeuristics { longest_axis: true, ..stop });
    let is_full = |node: &KdNode| matches!(node, KdNode::Leaf { count, .. } if *count >= 8);
    let says = "you make a leaf where one side has no primitives: then no primitive is on both sides";
    let is_cut = divided.tree.nodes.len() > 1;
    divided.must(!divided.tree.nodes.iter().any(is_full), "the 8 boxes in several leaves", (is_cut, says))
}
