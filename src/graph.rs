//! The scene graph as a search sees it: nodes with a volume around each, and primitives that hang from them. Searching it
//! is an exercise of stage 8.

use glam::Affine3A;
use serde::{Deserialize, Serialize};

/// A node: what it holds itself, and what lies below.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct GraphNode {
    /// Numbers of the nodes below.
    pub children: Vec<u32>,
    /// Numbers of the primitives of this node's own shape.
    pub primitives: Vec<u32>,
}

/// A scene graph unfolded into a tree: a node that has several parents is there once for each. Node 0 is the root; a
/// graph over nothing has no nodes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Graph {
    /// All nodes, a parent before its children.
    pub nodes: Vec<GraphNode>,
}

impl Graph {
    /// Nodes on the longest way down, the root counted; 0 when there is nothing.
    pub fn depth(&self) -> usize {
        let mut levels = vec![1; self.nodes.len()];
        // Children have higher numbers than their parents.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let below = node.children.iter().map(|&child| levels[child as usize]).max();
            levels[index] = 1 + below.unwrap_or(0);
        }
        levels.first().copied().unwrap_or(0)
    }
}

/// Where a node stands: its way to the world and back.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placement {
    /// From the space of the node to the world.
    pub to_world: Affine3A,
    /// Back.
    pub to_object: Affine3A,
}

/// What a search of a scene graph may save (lecture "Bounding Volumes", "Ray-Scene Intersection"). Each can be left out, to
/// count what it is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Savings {
    /// Ask for the volume around a node first, and leave out a node whose volume the ray misses.
    pub volumes: bool,
    /// Leave out what begins beyond the closest hit so far.
    pub skip: bool,
    /// Look into the nearest child first.
    pub sort: bool,
}

impl Default for Savings {
    fn default() -> Self {
        Savings { volumes: true, skip: true, sort: true }
    }
}
