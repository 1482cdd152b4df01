//! Partitions of space as data: cells, and in each the numbers of the primitives that reach into it. Building and searching
//! them are exercises of stage 9.
//!
//! `grid` · `octree` · `kd_tree` · `bsp`

pub mod bsp;
pub mod grid;
pub mod kd_tree;
pub mod octree;

pub use bsp::{Bsp, BspNode, CutPlane};
pub use grid::{Grid, MOST_CELLS_ALONG};
pub use kd_tree::{KdHeuristics, KdNode, KdTree};
pub use octree::{Octree, OctreeNode};

use crate::aabb::Aabb;
use crate::ray::Ray;
use glam::{DVec3, Vec3};

/// Everything that a search of cells may ask. Each question is counted, so what a search costs is known exactly.
pub trait Cells {
    /// To be called once for each node or cell that the search comes to. Counts a node visit.
    fn visit(&mut self, node: u32);

    /// The `t` at which `ray` hits `primitive`, if it does for `t_min < t < t_max`. Counts a primitive test.
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32>;
}

/// A box of space in double precision: where cells meet, both have the very same face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Cell {
    /// The box as a cell.
    pub fn new(bounds: &Aabb) -> Self {
        Cell { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3() }
    }

    /// The middle, where octants meet.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// One of the eight octants: bit 0 of `octant` is 1 for the upper half along x, bit 1 along y, bit 2 along z.
    pub fn octant(&self, octant: usize) -> Cell {
        let middle = self.middle();
        let mut cell = *self;
        for axis in 0..3 {
            match octant >> axis & 1 {
                0 => cell.max[axis] = middle[axis],
                _ => cell.min[axis] = middle[axis],
            }
        }
        cell
    }

    /// The parts below and above `at` along `axis`.
    pub fn cut(&self, axis: usize, at: f64) -> [Cell; 2] {
        let (mut below, mut above) = (*self, *self);
        below.max[axis] = at;
        above.min[axis] = at;
        [below, above]
    }

    /// Whether the box and the cell share a point; to touch is to share. Never for a box that is not a number.
    pub fn touches(&self, bounds: &Aabb) -> bool {
        (0..3).all(|axis| {
            f64::from(bounds.min[axis]) <= self.max[axis] && self.min[axis] <= f64::from(bounds.max[axis])
        })
    }

    /// The cell in single precision, to be drawn.
    pub fn to_box(&self) -> Aabb {
        Aabb::new(self.min.as_vec3(), self.max.as_vec3())
    }
}

/// The corners of a box, as the hull of a primitive that is no polygon.
pub fn corners(bounds: &Aabb) -> Vec<Vec3> {
    let pick = |corner: usize, axis: usize| match corner >> axis & 1 {
        0 => bounds.min[axis],
        _ => bounds.max[axis],
    };
    (0..8).map(|corner| Vec3::new(pick(corner, 0), pick(corner, 1), pick(corner, 2))).collect()
}

/// Ends a recursion that would never end by itself.
#[track_caller]
fn check_depth(depth: usize, most: usize) {
    assert!(
        depth <= most,
        "a node at depth {depth} of a tree that may be {most} deep: does every division divide?"
    );
}

/// Goes down a tree to depth `most`, tells `each` about every node, its place and its depth, and returns how many levels
/// it came to. `root` is the place of node 0, if there is one; `below` gives the children of a node with their places.
fn walk<P>(
    root: Option<P>,
    most: usize,
    below: impl Fn(u32, &P) -> Vec<(u32, P)>,
    mut each: impl FnMut(u32, &P, usize),
) -> usize {
    let mut waiting: Vec<(u32, P, usize)> = root.into_iter().map(|place| (0, place, 0)).collect();
    let mut levels = 0;
    while let Some((node, place, depth)) = waiting.pop() {
        each(node, &place, depth);
        levels = levels.max(depth + 1);
        if depth < most {
            // The last one that waits is the first to be gone to.
            let children = below(node, &place).into_iter().rev();
            waiting.extend(children.map(|(child, place)| (child, place, depth + 1)));
        }
    }
    levels
}
