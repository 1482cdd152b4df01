//! The picture of stage 12: a winding ramp of triangles, found by a wide tree.

use super::trees::drawn_tree;
use checks::picture::{self, Composed, SMALL};
use checks::prelude::*;
use oracle::exact::{Body, meet};
use raykata::wide::{BLOCK, Filtered, FlatTree, NO_PRIMITIVE, TriangleBlock, WIDE_NODE_COST, WideTree};
use std::f32::consts::TAU;

const TARGET: Vec3 = vec3(0.0, 1.0, 0.0);

/// A winding ramp of triangles: two turns for `pitch` 1.
fn ramp(pitch: f32, width: f32) -> Vec<Triangle> {
    let at = |i: u8, radius: f32| {
        let turns = f32::from(i) / 14.0;
        let (sin, cos) = (TAU * turns * pitch).sin_cos();
        vec3(radius * cos, 1.1 * turns, radius * sin)
    };
    let step = |i: u8| {
        let [a, b, c, d] = [at(i, 0.4), at(i, 0.4 + width), at(i + 1, 0.4 + width), at(i + 1, 0.4)];
        [Triangle { a, b, c }, Triangle { a, b: c, c: d }]
    };
    (0..28).flat_map(step).collect()
}

/// The exact `t` of the hit, rounded once; ∞ for a miss.
fn t_of(ray: &Ray, triangle: &Triangle) -> f32 {
    meet(ray, Body::Triangle(*triangle)).and_then(|hit| hit.t).unwrap_or(f32::INFINITY)
}

/// Whether each lane and each child of the tree exists, so that a table can be made for it.
fn is_usable(wide: &WideTree, n: usize) -> bool {
    let lanes = wide.blocks.iter().flatten();
    let children = wide.nodes.iter().flat_map(|node| &node.children);
    lanes.copied().all(|id| id == NO_PRIMITIVE || (id as usize) < n)
        && wide.nodes.len() <= 2 * n
        && children.copied().all(|child| match child.contents() {
            raykata::wide::ChildContents::Inner(node) => (node as usize) < wide.nodes.len(),
            raykata::wide::ChildContents::Leaf { block, count } => {
                block as usize + (count as usize).div_ceil(BLOCK) <= wide.blocks.len()
            }
        })
}

/// The depth of each pixel: white is near, black is the background.
fn depths(kit: &dyn Kit, tree: &FlatTree, triangles: &[Triangle], rays: &[Ray]) -> Vec<Vec3> {
    let wide = kit.collapse(&[(tree.clone(), WIDE_NODE_COST)]).remove(0);
    if wide.nodes.is_empty() || !is_usable(&wide, triangles.len()) {
        return vec![Vec3::ZERO; rays.len()];
    }
    let blocks: Vec<TriangleBlock> = wide
        .blocks
        .iter()
        .map(|ids| TriangleBlock::new(*ids, |id| triangles.get(id as usize).copied()))
        .collect();
    let boxes = |ray: &Ray| {
        wide.nodes.iter().map(|node| WideBoxesQuery { node: Box::new(*node), ray: *ray }).collect::<Vec<_>>()
    };
    let lanes = |ray: &Ray| {
        blocks.iter().map(|block| BlockQuery { block: Box::new(*block), ray: *ray }).collect::<Vec<_>>()
    };
    let entered = kit.enter_boxes(&rays.iter().flat_map(boxes).collect::<Vec<_>>());
    let kept = kit.may_hit(&rays.iter().flat_map(lanes).collect::<Vec<_>>());
    let query = |((ray, entered), kept): ((&Ray, &[raykata::wide::Entered]), &[Filtered])| {
        let entries = entered
            .iter()
            .map(|one| std::array::from_fn(|i| if one.mask >> i & 1 == 1 { one.t[i] } else { f32::INFINITY }))
            .collect();
        let mut hits = vec![f32::INFINITY; triangles.len()];
        for (ids, kept) in wide.blocks.iter().zip(kept) {
            for lane in (0..BLOCK).filter(|&lane| kept.possible >> lane & 1 == 1 && ids[lane] != NO_PRIMITIVE)
            {
                hits[ids[lane] as usize] = t_of(ray, &triangles[ids[lane] as usize]);
            }
        }
        WideQuery { tree: wide.clone(), ray: *ray, entries, hits }
    };
    let queries: Vec<WideQuery> =
        rays.iter().zip(entered.chunks(wide.nodes.len())).zip(kept.chunks(blocks.len())).map(query).collect();
    let depth = |answer: raykata::kit::WideAnswer| {
        answer.hit.map_or(0.0, |hit| ((5.5 - hit.t) / 4.0).clamp(0.05, 1.0))
    };
    kit.wide_closest_hit(&queries).into_iter().map(depth).map(Vec3::splat).collect()
}

pub(super) fn picture_of_a_winding_ramp(trial: &Trial<'_>) -> CheckResult {
    let (pitch, width) = trial.composed((1.0, 1.0), (0.7..1.3f32, 0.7..1.2f32));
    let triangles = ramp(pitch, width);
    let boxes: Vec<Aabb> = triangles
        .iter()
        .map(|Triangle { a, b, c }| Aabb::new(a.min(*b).min(*c), a.max(*b).max(*c)))
        .collect();
    let tree = drawn_tree(&boxes, 6, &[28, 13, 14, 7, 6, 4, 5, 2]);
    let rays = picture::rays(trial, SMALL, vec3(2.4, 2.9, 2.4), TARGET);
    // All hits are exact, so no pixel may differ.
    let composed = Composed { name: "stage12_winding_ramp", size: SMALL, rays: &rays, may_differ: 0.0 };
    composed.check(trial, |kit| depths(kit, &tree, &triangles, &rays))
}
