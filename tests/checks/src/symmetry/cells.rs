//! Partitions of space under a symmetry. A grid and an octree number their cells along the axes, so their cells get other
//! numbers.

use super::Symmetry;
use glam::{UVec3, uvec3};
use raykata::partition::{Bsp, BspNode, CutPlane, Grid, KdNode, KdTree, Octree, OctreeNode};

/// A structure that is turned, and the number of each of its cells before: `numbers[new] = old`.
pub(super) trait Cells: Sized {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>);
}

/// The numbers of structures whose nodes keep theirs.
fn same(n: usize) -> Vec<u32> {
    (0..n as u32).collect()
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

impl Cells for Octree {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>) {
        let mut numbers = same(self.nodes.len());
        for node in &self.nodes {
            // A wrong tree may name octants that do not exist. The check judges it as it is.
            let OctreeNode::Inner { first } = *node else { continue };
            let octants = numbers.iter_mut().skip(first as usize).take(8).zip(0..);
            octants.for_each(|(number, octant)| *number = first + symmetry.octant_before(octant));
        }
        let node = |before: &u32| self.nodes.get(*before as usize).copied();
        let empty = OctreeNode::Leaf { first: 0, count: 0 };
        let nodes = numbers.iter().map(|before| node(before).unwrap_or(empty)).collect();
        (Octree { bounds: symmetry.bounds(&self.bounds), nodes, items: self.items.clone() }, numbers)
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
        let nodes: Vec<KdNode> = self.nodes.iter().map(turn).collect();
        let numbers = same(nodes.len());
        (KdTree { bounds: symmetry.bounds(&self.bounds), nodes, items: self.items.clone() }, numbers)
    }
}

impl Cells for Bsp {
    fn turned(&self, symmetry: &Symmetry) -> (Self, Vec<u32>) {
        let turn = |node: &BspNode| match *node {
            BspNode::Inner { plane: CutPlane { normal, offset }, back, front } => {
                let normal = symmetry.wide_direction(normal);
                let plane = CutPlane { normal, offset: f64::from(symmetry.scale) * offset };
                BspNode::Inner { plane, back, front }
            }
            node => node,
        };
        let nodes: Vec<BspNode> = self.nodes.iter().map(turn).collect();
        let numbers = same(nodes.len());
        (Bsp { nodes, items: self.items.clone() }, numbers)
    }
}
