//! What all trees of cells have in common: their nodes in one list, and the primitives of their leaves in another.

use super::{Cell, limit};
use crate::aabb::Aabb;
use crate::message;
use std::ops::{Deref, DerefMut};

/// A node of a [`Tree`]: a leaf, or something that divides the region of the node among its children.
pub trait TreeNode: Copy {
    /// A part of space.
    type Region;

    /// A leaf with the primitives `items[first..first + count]` of its tree.
    fn leaf(first: u32, count: u32) -> Self;

    /// The range of the primitives that the node lists, as `first` and `count`; `None` if it lists none.
    fn range(&self) -> Option<(u32, u32)>;

    /// The indices of the children; none for a leaf.
    fn children(&self) -> impl Iterator<Item = u32>;

    /// Whether the node has no children.
    fn is_leaf(&self) -> bool {
        self.children().next().is_none()
    }

    /// The parts of `region` that belong to the children, in their order.
    fn divide(&self, region: &Self::Region) -> Vec<Self::Region>;
}

/// The nodes and leaves of a tree. Node 0 is the root. A tree over no primitives has no nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree<N> {
    /// All nodes. A parent has a smaller index than its children.
    pub nodes: Vec<N>,
    /// The numbers of primitives, those of a node adjacent. A primitive is listed in every leaf that it overlaps.
    pub items: Vec<u32>,
}

message! { Tree<N> { nodes, items } }

impl<N> Default for Tree<N> {
    fn default() -> Self {
        Tree { nodes: Vec::new(), items: Vec::new() }
    }
}

impl<N: TreeNode> Tree<N> {
    /// Adds a node at `depth` (the root has depth 0) and returns its index. It is a leaf without primitives until
    /// `set_leaf` or `set_children` changes it.
    ///
    /// # Panics
    ///
    /// If `depth` is above `max_depth`. Then the recursion would never end.
    #[track_caller]
    pub fn add_node(&mut self, depth: usize, max_depth: usize) -> u32 {
        self.add_nodes(1, depth, max_depth)
    }

    /// Adds `n` nodes, as [`Tree::add_node`] does, and returns the index of the first.
    #[track_caller]
    pub(super) fn add_nodes(&mut self, n: usize, depth: usize, max_depth: usize) -> u32 {
        assert!(
            depth <= max_depth,
            "a node at depth {depth} of a tree with at most depth {max_depth}: does the recursion end?"
        );
        let first = self.nodes.len();
        self.nodes.resize(first + n, N::leaf(0, 0));
        first as u32
    }

    /// Makes `node` a leaf with `primitives`: appends their numbers to `items`. Call it once per leaf.
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`. In frames and checks also if all nodes list more than
    /// [`MOST_REFERENCES`](super::MOST_REFERENCES) references per primitive.
    #[track_caller]
    pub fn set_leaf(&mut self, node: u32, primitives: &[u32]) {
        let (first, count) = self.append(primitives);
        self.nodes[node as usize] = N::leaf(first, count);
    }

    /// Appends the numbers of primitives that one node lists, and returns their range.
    #[track_caller]
    pub(super) fn append(&mut self, primitives: &[u32]) -> (u32, u32) {
        limit::count(primitives.len());
        let first = self.items.len() as u32;
        self.items.extend(primitives);
        (first, primitives.len() as u32)
    }

    /// The numbers of the primitives of a leaf, `items[first..first + count]`.
    ///
    /// # Panics
    ///
    /// If the range does not lie in `items`.
    pub fn primitives(&self, first: u32, count: u32) -> &[u32] {
        &self.items[first as usize..(first + count) as usize]
    }

    /// The numbers of the primitives that `node` lists.
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`, or if its range does not lie in `items`.
    pub fn listed(&self, node: u32) -> &[u32] {
        self.nodes[node as usize].range().map_or(&[], |(first, count)| self.primitives(first, count))
    }

    /// The number of nodes on the longest path from the root to a leaf, both counted; 0 if there are no nodes.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn depth(&self) -> usize {
        let below = |node: &N, (): &()| vec![(); node.children().count()];
        self.visit((), usize::MAX, below, |_, (), _| {})
    }

    /// Calls `each` for all nodes down to depth `most` in depth-first order, with the index of the node, its region and
    /// its depth, and returns the number of levels that it reached. `root` is the region of the root.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub(super) fn walk_from(
        &self,
        root: N::Region,
        most: usize,
        each: impl FnMut(u32, &N::Region, usize),
    ) -> usize {
        self.visit(root, most, N::divide, each)
    }

    fn visit<R>(
        &self,
        root: R,
        most: usize,
        divide: impl Fn(&N, &R) -> Vec<R>,
        mut each: impl FnMut(u32, &R, usize),
    ) -> usize {
        let mut waiting = if self.nodes.is_empty() { Vec::new() } else { vec![(0, root, 0)] };
        let mut levels = 0;
        while let Some((index, region, depth)) = waiting.pop() {
            each(index, &region, depth);
            levels = levels.max(depth + 1);
            if depth < most {
                // Reverse the children, because the last entry is visited first.
                let (node, first) = (&self.nodes[index as usize], waiting.len());
                let children = node.children().zip(divide(node, &region));
                waiting.extend(children.map(|(child, region)| (child, region, depth + 1)));
                waiting[first..].reverse();
            }
        }
        levels
    }
}

/// A tree whose nodes are cells.
#[derive(Clone, Debug, PartialEq)]
pub struct CellTree<N> {
    /// The cell of the root, in world units; it contains all primitives that can be hit.
    pub bounds: Aabb,
    /// The nodes and the primitives in their leaves.
    pub tree: Tree<N>,
}

message! { CellTree<N> { bounds, tree } }

impl<N: TreeNode<Region = Cell>> CellTree<N> {
    /// The cells at `depth` (the root has depth 0), and the leaves above it, as boxes for drawing.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range, or an axis is above 2.
    pub fn cells(&self, depth: usize) -> Vec<Aabb> {
        let mut cells = Vec::new();
        self.walk(depth, |node, cell, at| {
            let is_leaf = self.nodes[node as usize].is_leaf();
            cells.extend((at == depth || is_leaf).then(|| cell.to_box()));
        });
        cells
    }

    /// Calls `each` for all nodes down to depth `most` in depth-first order, with the index of the node, its cell and its
    /// depth, and returns the number of levels that it reached.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range, or an axis is above 2.
    pub fn walk(&self, most: usize, mut each: impl FnMut(u32, Cell, usize)) -> usize {
        self.walk_from(Cell::new(&self.bounds), most, |node, cell, depth| each(node, *cell, depth))
    }
}

impl<N> Deref for CellTree<N> {
    type Target = Tree<N>;

    fn deref(&self) -> &Tree<N> {
        &self.tree
    }
}

impl<N> DerefMut for CellTree<N> {
    fn deref_mut(&mut self) -> &mut Tree<N> {
        &mut self.tree
    }
}
