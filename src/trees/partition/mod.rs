//! Partitions of space as data: cells, each with the numbers of the primitives that overlap it. Building and
//! searching them are exercises of stage 9.
//!
//! `tree` (what all but the grid have in common) · `grid` · `octree` · `kd_tree` · `bsp` · `polygon_bsp` (with polygons in its nodes) · `planes` (of both BSP trees) ·
//! `list_growth` (the bound on references) · `limit` (enforces it)

pub mod bsp;
pub mod grid;
pub mod kd_tree;
pub(crate) mod limit;
pub mod list_growth;
pub mod octree;
pub mod planes;
pub mod polygon_bsp;
pub mod tree;

pub use bsp::{Bsp, BspNode};
pub use grid::{Grid, MOST_CELLS_ALONG};
pub use kd_tree::{KdHeuristics, KdNode, KdTree};
pub use list_growth::{ListGrowth, MOST_REFERENCES};
pub use octree::{Octree, OctreeNode};
pub use planes::{CutPlane, PlaneNode};
pub use polygon_bsp::{PolygonBsp, PolygonBspNode};
pub use tree::{CellTree, Tree, TreeNode};

use crate::aabb::Aabb;
use crate::ray::Ray;
use glam::{DVec3, Vec3};

/// All that a search of cells may ask about a scene. Each call is counted, so the cost of a search is known
/// exactly.
pub trait Cells {
    /// Records a visit of `node`. A search calls it once for each node or cell that it comes to. Counts a
    /// node visit.
    ///
    /// # Panics
    ///
    /// May panic if a search makes so many visits that it must be in an infinite loop.
    fn visit(&mut self, node: u32);

    /// The `t` at which `ray` hits `primitive`, or `None` if there is no hit with
    /// `ray.t_min < t < ray.t_max`. A search tests only primitives that a visited node lists. Counts a primitive
    /// test.
    ///
    /// # Panics
    ///
    /// May panic if there is no primitive with this number.
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32>;
}

/// A closed box of space in double precision, so that neighbouring cells have exactly the same face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The corner with the smallest coordinate on each axis, in world units.
    pub min: DVec3,
    /// The corner with the largest coordinate on each axis, in world units.
    pub max: DVec3,
}

impl Cell {
    /// The cell with the same corners as the box `bounds`, without rounding.
    pub fn new(bounds: &Aabb) -> Self {
        Cell { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3() }
    }

    /// The centre of the cell, in world units, where its octants meet.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// One of the eight octants, `0 <= octant < 8`: bit 0 of `octant` selects the upper half along x, bit 1
    /// along y, bit 2 along z. Higher bits are ignored.
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

    /// The parts below and above the plane at `at` (world units) across `axis`, 0 for x, 1 for y, 2 for z.
    /// The cell is closed, so both parts contain the plane. For an `at` outside of the cell one part is
    /// larger than the cell and the other is empty.
    ///
    /// # Panics
    ///
    /// If `axis` is above 2.
    pub fn cut(&self, axis: usize, at: f64) -> [Cell; 2] {
        let (mut below, mut above) = (*self, *self);
        below.max[axis] = at;
        above.min[axis] = at;
        [below, above]
    }

    /// Whether the box and the cell have a common point; both are closed, so a common face is enough. `false`
    /// for a box with NaN.
    pub fn touches(&self, bounds: &Aabb) -> bool {
        (0..3).all(|axis| {
            f64::from(bounds.min[axis]) <= self.max[axis] && self.min[axis] <= f64::from(bounds.max[axis])
        })
    }

    /// The cell rounded to single precision, for drawing.
    pub fn to_box(&self) -> Aabb {
        Aabb::new(self.min.as_vec3(), self.max.as_vec3())
    }
}

/// The eight corners of a box, which serve as the hull of a primitive that is not a polygon. Bit 0 of a
/// corner's index selects `max` along x, bit 1 along y, bit 2 along z.
pub fn corners(bounds: &Aabb) -> Vec<Vec3> {
    let pick = |corner: usize, axis: usize| match corner >> axis & 1 {
        0 => bounds.min[axis],
        _ => bounds.max[axis],
    };
    (0..8).map(|corner| Vec3::new(pick(corner, 0), pick(corner, 1), pick(corner, 2))).collect()
}

/// The twelve edges of a box.
pub fn edges(bounds: &Aabb) -> Vec<[Vec3; 2]> {
    let corners = corners(bounds);
    let from =
        |corner: usize| (0..3).filter(move |axis| corner >> axis & 1 == 0).map(move |axis| (corner, axis));
    (0..8).flat_map(from).map(|(corner, axis)| [corners[corner], corners[corner | 1 << axis]]).collect()
}
