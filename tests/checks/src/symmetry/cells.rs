//! Partitions of space under a symmetry. A grid and an octree number their cells along the axes, so their cells get other
//! numbers.

use super::Symmetry;
use glam::{UVec3, uvec3};
use raykata::partition::{
    Bsp, BspNode, CellTree, CutPlane, Grid, KdNode, KdTree, Octree, OctreeNode, PolygonBsp, PolygonBspNode,
    Tree,
};

/// A structure that is turned, and the number of each of its cells before: `numbers[new] = old`.
pub(super) trait Cells: Sized {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>);
}

impl Cells for Grid {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>) {
        let (bounds, resolution) = (symmetry.bounds(&self.bounds), symmetry.resolution(self.resolution));
        let mut grid = Grid { bounds, resolution, starts: vec![0], items: Vec::new() };
        let mut numbers = Vec::new();
        for number in 0..resolution.element_product() {
            let n = resolution;
            let cell = uvec3(number % n.x, number / n.x % n.y, number / (n.x * n.y));
            // Turn the number of the cell back, along axes that may have the other direction.
            let mut before = UVec3::ZERO;
            for axis in 0..3 {
                let is_mirrored = symmetry.signs[axis] < 0.0;
                before[symmetry.axes[axis]] = if is_mirrored { n[axis] - 1 - cell[axis] } else { cell[axis] };
            }
            let before = self.number(before);
            grid.items.extend(self.primitives(before));
            grid.starts.push(grid.items.len() as u32);
            numbers.push(before);
        }
        (grid, numbers)
    }
}

impl Symmetry {
    /// Numbers of cells along the axes.
    pub(super) fn resolution(&self, resolution: UVec3) -> UVec3 {
        UVec3::from_array(self.axes.map(|from| resolution[from]))
    }

    /// The number of the octant that becomes octant `octant`: bit `i` is the side of axis `i`.
    fn octant_before(&self, octant: u32) -> u32 {
        let bit = |axis: usize| octant >> axis & 1 ^ u32::from(self.signs[axis] < 0.0);
        (0..3).map(|axis| bit(axis) << self.axes[axis]).sum()
    }
}

/// A tree whose nodes are turned and keep their numbers.
fn turned_nodes<N>(tree: &Tree<N>, turn: impl Fn(&N) -> N) -> (Tree<N>, Vec<u32>) {
    let nodes = tree.nodes.iter().map(turn).collect();
    (Tree { nodes, items: tree.items.clone() }, (0..tree.nodes.len() as u32).collect())
}

impl Cells for Octree {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>) {
        let mut numbers: Vec<u32> = (0..self.nodes.len() as u32).collect();
        for node in &self.nodes {
            // A wrong tree may name octants that do not exist. The check judges it as it is.
            let OctreeNode::Inner { first } = *node else { continue };
            let octants = numbers.iter_mut().skip(first as usize).take(8).zip(0..);
            octants.for_each(|(number, octant)| *number = first + symmetry.octant_before(octant));
        }
        let node = |before: &u32| self.nodes.get(*before as usize).copied();
        let empty = OctreeNode::Leaf { first: 0, count: 0 };
        let nodes = numbers.iter().map(|before| node(before).unwrap_or(empty)).collect();
        let tree = Tree { nodes, items: self.items.clone() };
        (CellTree { bounds: symmetry.bounds(&self.bounds), tree }, numbers)
    }
}

impl Cells for KdTree {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>) {
        let turn = |node: &KdNode| match *node {
            KdNode::Inner { axis, at, left, right } if axis < 3 => {
                let axis = symmetry.axis(usize::from(axis));
                let sign = symmetry.signs[axis];
                let [left, right] = if sign < 0.0 { [right, left] } else { [left, right] };
                KdNode::Inner { axis: axis as u8, at: sign * symmetry.length(at), left, right }
            }
            node => node,
        };
        let (tree, numbers) = turned_nodes(self, turn);
        (CellTree { bounds: symmetry.bounds(&self.bounds), tree }, numbers)
    }
}

/// A plane under a symmetry.
fn turned_plane(plane: CutPlane, symmetry: &Symmetry) -> CutPlane {
    let normal = symmetry.wide_direction(plane.normal);
    CutPlane { normal, offset: f64::from(symmetry.scale) * plane.offset }
}

impl Cells for PolygonBsp {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>) {
        let turn = |node: &PolygonBspNode| match *node {
            PolygonBspNode::Inner { plane, first, count, back, front } => {
                PolygonBspNode::Inner { plane: turned_plane(plane, symmetry), first, count, back, front }
            }
            node => node,
        };
        let (tree, numbers) = turned_nodes(self, turn);
        (PolygonBsp { tree, room: f64::from(symmetry.scale) * self.room }, numbers)
    }
}

impl Cells for Bsp {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>) {
        let turn = |node: &BspNode| match *node {
            BspNode::Inner { plane, back, front } => {
                BspNode::Inner { plane: turned_plane(plane, symmetry), back, front }
            }
            node => node,
        };
        turned_nodes(self, turn)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Symmetries;
    use super::*;
    use glam::Vec3;
    use proptest::strategy::{Strategy, ValueTree};
    use proptest::test_runner::TestRunner;
    use raykata::aabb::Aabb;
    use raykata::partition::Cell;

    /// Whether each cell is turned, keeps its primitives, and gets its number back.
    fn assert_turned<S: Cells + PartialEq + std::fmt::Debug>(
        structure: &S,
        cells: impl Fn(&S) -> Vec<(u32, Cell, Vec<u32>)>,
    ) {
        let mut runner = TestRunner::deterministic();
        for _ in 0..100 {
            let symmetry = Symmetries::Turned.strategy().new_tree(&mut runner).expect("a symmetry").current();
            let (turned, numbers) = structure.turned(&symmetry);
            let before = cells(structure);
            for (number, cell, ids) in cells(&turned) {
                let before = before.iter().find(|(other, ..)| *other == numbers[number as usize]);
                let (_, cell_before, ids_before) = before.expect("a cell with this number");
                assert_eq!((cell.to_box(), &ids), (symmetry.bounds(&cell_before.to_box()), ids_before));
            }
            assert_eq!(turned.turned(&symmetry.inverse()).0, *structure);
        }
    }

    const BOUNDS: Aabb = Aabb::new(Vec3::NEG_ONE, Vec3::new(2.0, 7.0, 1.0));

    #[test]
    fn cells_of_grids_are_turned() {
        let resolution = uvec3(3, 2, 4);
        let grid = Grid { bounds: BOUNDS, resolution, starts: (0..=24).collect(), items: (0..24).collect() };
        assert_turned(&grid, |grid| {
            let n = grid.resolution;
            let at = |i: u32| grid.cell(uvec3(i % n.x, i / n.x % n.y, i / (n.x * n.y)));
            (0..24).map(|i| (i, at(i), grid.primitives(i).to_vec())).collect()
        });
    }

    #[test]
    fn octants_are_turned() {
        let mut octree = Octree::new(BOUNDS);
        let first = octree.divide(0, 1, 2);
        let below = octree.divide(first + 3, 2, 2);
        (first..first + 8).filter(|node| *node != first + 3).for_each(|node| octree.set_leaf(node, &[node]));
        (below..below + 8).for_each(|node| octree.set_leaf(node, &[node]));
        assert_turned(&octree, |octree| {
            let mut cells = Vec::new();
            octree.walk(usize::MAX, |node, cell, _| {
                let ids = match octree.nodes[node as usize] {
                    OctreeNode::Leaf { first, count } => octree.primitives(first, count).to_vec(),
                    OctreeNode::Inner { .. } => Vec::new(),
                };
                cells.push((node, cell, ids));
            });
            cells
        });
    }

    #[test]
    fn sides_of_planes_are_turned() {
        let mut tree = KdTree::new(BOUNDS);
        let [root, left, right] = [0, 1, 1].map(|depth| tree.add_node(depth, 1));
        tree.set_leaf(left, &[7]);
        tree.set_leaf(right, &[8, 9]);
        tree.set_children(root, 1, 0.5, left, right);
        assert_turned(&tree, |tree| {
            let mut cells = Vec::new();
            tree.walk(usize::MAX, |node, cell, _| cells.push((node, cell, Vec::new())));
            cells
        });
    }
}
