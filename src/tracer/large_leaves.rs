//! A note for trees whose leaves hold far more primitives than the scene asks for.

use super::structure::Structure;
use crate::partition::{BspNode, KdNode, OctreeNode, PolygonBspNode};

/// A leaf is large if it has more than this many times `leaf_size` primitives. Smaller leaves are common around
/// the vertices of ordinary meshes, where up to 64 triangles meet.
const LARGE: usize = 16;

/// A sentence that says that dividing stopped early; `None` unless more than half of the references of a
/// partition of space are in large leaves. A hierarchy has no large leaves, because it lists each primitive once.
pub fn large_leaves(structure: &Structure, leaf_size: usize) -> Option<String> {
    let (name, counts): (&str, Vec<usize>) = match structure {
        Structure::Octree { tree, .. } => {
            let counts = tree.nodes.iter().map(|node| match node {
                OctreeNode::Leaf { count, .. } => *count as usize,
                OctreeNode::Inner { .. } => 0,
            });
            ("octree", counts.collect())
        }
        Structure::KdTree(tree) => {
            let counts = tree.nodes.iter().map(|node| match node {
                KdNode::Leaf { count, .. } => *count as usize,
                KdNode::Inner { .. } => 0,
            });
            ("kd-tree", counts.collect())
        }
        Structure::Bsp { tree, .. } => {
            let counts = tree.nodes.iter().map(|node| match node {
                BspNode::Leaf { count, .. } => *count as usize,
                BspNode::Inner { .. } => 0,
            });
            ("BSP tree", counts.collect())
        }
        Structure::PolygonBsp { tree, .. } => {
            let counts = tree.nodes.iter().map(|node| match node {
                PolygonBspNode::Leaf { count, .. } => *count as usize,
                PolygonBspNode::Inner { .. } => 0,
            });
            ("BSP tree of polygons", counts.collect())
        }
        _ => return None,
    };
    let in_large: usize = counts.iter().filter(|&&count| count > LARGE * leaf_size).sum();
    let largest = counts.iter().max()?;
    (2 * in_large > counts.iter().sum()).then(|| {
        format!(
            "the {name} has up to {largest} primitives per leaf (`leaf_size = {leaf_size}`), because primitives overlap \
             or are too close to each other: dividing stopped where it would mostly list the same ones again; \
             `accelerator = \"bvh\"` lists each one once"
        )
    })
}
