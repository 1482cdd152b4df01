//! The scene graph as data for a search: nodes that contain primitives and child nodes. Searching it is an
//! exercise of stage 8.

use crate::message;
use glam::Affine3A;
use serde::{Deserialize, Serialize};

/// A node of a scene graph: its own primitives, and its child nodes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GraphNode {
    /// The indices of the child nodes in [`Graph::nodes`].
    pub children: Vec<u32>,
    /// The numbers of the primitives of this node's own shape.
    pub primitives: Vec<u32>,
}

message! { GraphNode { children, primitives } }

/// A scene graph unfolded into a tree: a node with several parents appears once per parent. Node 0 is the
/// root; a graph over nothing has no nodes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// All nodes. A parent has a smaller index than its children.
    pub nodes: Vec<GraphNode>,
}

message! { Graph { nodes } }

impl Graph {
    /// The number of nodes on the longest path from the root to a leaf, both counted; 0 if there are no
    /// nodes.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn depth(&self) -> usize {
        let mut levels = vec![1; self.nodes.len()];
        // Children have larger indices than their parents, so go through the nodes backwards.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let below = node.children.iter().map(|&child| levels[child as usize]).max();
            levels[index] = 1 + below.unwrap_or(0);
        }
        levels.first().copied().unwrap_or(0)
    }
}

/// The transforms of a node from its own space to the world and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The transform from the space of the node to the world.
    pub to_world: Affine3A,
    /// The inverse transform, from the world to the space of the node.
    pub to_object: Affine3A,
}

message! { Placement { to_world, to_object } }

/// The three optimisations of a search of a scene graph (lecture "Bounding Volumes", "Ray-Scene
/// Intersection"). Each can be switched off, to measure what it saves; the default has all three. The hit is
/// the same for all combinations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GraphOptimisations {
    /// Test the bounding volume of a node first, and skip a node whose volume the ray misses.
    pub volumes: bool,
    /// Skip a node whose volume the ray enters beyond the closest hit so far.
    pub skip: bool,
    /// Visit the children in the order in which the ray enters their volumes.
    pub sort: bool,
}

message! { GraphOptimisations { volumes, skip, sort } }

impl Default for GraphOptimisations {
    fn default() -> Self {
        GraphOptimisations { volumes: true, skip: true, sort: true }
    }
}

/// For each node of a scene graph the child in which the previous ray had its closest hit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChildCache {
    /// The entries, by node. A node beyond the end has none.
    pub children: Vec<Option<u32>>,
}

message! { ChildCache { children } }

impl ChildCache {
    /// The child that is stored for `node`; `None` if there is none.
    pub fn get(&self, node: u32) -> Option<u32> {
        self.children.get(node as usize).copied().flatten()
    }

    /// Stores `child` for `node`.
    pub fn set(&mut self, node: u32, child: u32) {
        if self.children.len() <= node as usize {
            self.children.resize(node as usize + 1, None);
        }
        self.children[node as usize] = Some(child);
    }
}
