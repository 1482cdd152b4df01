//! What a search for the place of a subtree may ask (stage 12, bonus).

use serde::{Deserialize, Serialize};

/// A node of a binary tree, as the search for the place of a subtree sees it. All areas are half the surface area of a box: the
/// area of three faces, in square world units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OpenedNode {
    /// The area of the node's box.
    pub area: f64,
    /// The area of the box around the node and the subtree, at least as large as both areas.
    pub united: f64,
    /// The two children of the node; `None` for a leaf.
    pub children: Option<[u32; 2]>,
}

/// The place of a subtree: beside a node, below a new inner node that has both as children.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SubtreePlace {
    /// The node that becomes the sibling of the subtree.
    pub node: u32,
    /// By how much the areas of all inner nodes together grow.
    pub increase: f64,
}

/// All that a search for the place of a subtree may ask. Each call is counted.
pub trait PlaceProbe {
    /// Opens a node: its area, the area of the box around it and the subtree, and its children.
    fn open(&mut self, node: u32) -> OpenedNode;
}
