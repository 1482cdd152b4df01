//! The uniform grid as data.

use super::Cell;
use crate::aabb::Aabb;
use glam::{DVec3, UVec3};
use serde::{Deserialize, Serialize};

/// The most cells along an axis: 256³ cells take 64 MiB before anything is in them.
pub const MOST_CELLS_ALONG: u32 = 256;

/// Cells of one size. Cell `(x, y, z)` has the number `x + nx · (y + ny · z)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// What the cells divide: all that can be met lies within. Empty if there is nothing.
    pub bounds: Aabb,
    /// How many cells there are along x, y and z, at least 1 each.
    pub resolution: UVec3,
    /// The primitives of cell `i` are `items[starts[i]..starts[i + 1]]`; one more entry than there are cells.
    pub starts: Vec<u32>,
    /// Numbers of primitives, those of a cell side by side. A primitive stands in every cell that it reaches into.
    pub items: Vec<u32>,
}

impl Grid {
    /// The number of a cell.
    pub fn number(&self, cell: UVec3) -> u32 {
        cell.x + self.resolution.x * (cell.y + self.resolution.y * cell.z)
    }

    /// The primitives in a cell.
    pub fn primitives(&self, number: u32) -> &[u32] {
        let [first, end] = [number, number + 1].map(|at| self.starts[at as usize] as usize);
        &self.items[first..end]
    }

    /// Where along `axis` cell `index` begins and the one before ends, in double precision. Always the same number for
    /// the same face, and exactly the side of the grid at either end.
    pub fn plane(&self, axis: usize, index: u32) -> f64 {
        let [min, max] = [self.bounds.min[axis], self.bounds.max[axis]].map(f64::from);
        let n = self.resolution[axis];
        if index == n { max } else { min + (max - min) * f64::from(index) / f64::from(n) }
    }

    /// The space of a cell.
    pub fn cell(&self, at: UVec3) -> Cell {
        let corner = |at: UVec3| DVec3::new(self.plane(0, at.x), self.plane(1, at.y), self.plane(2, at.z));
        Cell { min: corner(at), max: corner(at + 1) }
    }

    /// How many cells there are.
    pub fn n_nodes(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// A grid has one level.
    pub fn depth(&self) -> usize {
        usize::from(self.n_nodes() > 0)
    }

    /// All cells as boxes, to be drawn; there is one level only.
    pub fn cells(&self, _depth: usize) -> Vec<Aabb> {
        let n = if self.n_nodes() > 0 { self.resolution } else { UVec3::ZERO };
        let all =
            (0..n.z).flat_map(|z| (0..n.y).flat_map(move |y| (0..n.x).map(move |x| UVec3::new(x, y, z))));
        all.map(|at| self.cell(at).to_box()).collect()
    }
}
