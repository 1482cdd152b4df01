//! The uniform grid as data.

use super::Cell;
use crate::aabb::Aabb;
use crate::message;
use glam::{DVec3, UVec3};

/// The most cells along an axis when the resolution follows from the number of primitives: 256³ cells take 64
/// MiB before any primitive is in them.
pub const MOST_CELLS_ALONG: u32 = 256;

/// A uniform grid of cells of equal size. Cell `(x, y, z)` has the number `x + nx · (y + ny · z)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The box that the cells divide, in world units; it contains all primitives that can be hit. It is empty
    /// if there are none.
    pub bounds: Aabb,
    /// The number of cells along x, y and z, at least 1 each.
    pub resolution: UVec3,
    /// The primitives of cell `i` are `items[starts[i]..starts[i + 1]]`. There is one entry more than there
    /// are cells.
    pub starts: Vec<u32>,
    /// The numbers of primitives, those of a cell adjacent. A primitive is listed in every cell that it
    /// overlaps.
    pub items: Vec<u32>,
}

message! { Grid { bounds, resolution, starts, items } }

impl Grid {
    /// The number of the cell with the coordinates `cell`, each `0 <= cell < resolution`, which is not
    /// checked.
    pub fn number(&self, cell: UVec3) -> u32 {
        cell.x + self.resolution.x * (cell.y + self.resolution.y * cell.z)
    }

    /// The numbers of the primitives in the cell with this number.
    ///
    /// # Panics
    ///
    /// If there is no cell with this number.
    pub fn primitives(&self, number: u32) -> &[u32] {
        let [first, end] = [number, number + 1].map(|at| self.starts[at as usize] as usize);
        &self.items[first..end]
    }

    /// The coordinate along `axis` (0, 1, 2 for x, y, z) at which cell `index` begins and the cell before it
    /// ends, in world units and double precision, `0 <= index <= resolution[axis]`. The result is always the
    /// same number for the same face, and exactly the side of the grid at both ends.
    ///
    /// # Panics
    ///
    /// If `axis` is above 2.
    pub fn plane(&self, axis: usize, index: u32) -> f64 {
        let [min, max] = [self.bounds.min[axis], self.bounds.max[axis]].map(f64::from);
        let n = self.resolution[axis];
        if index == n { max } else { min + (max - min) * f64::from(index) / f64::from(n) }
    }

    /// The box of the cell with the coordinates `at`, in world units.
    pub fn cell(&self, at: UVec3) -> Cell {
        let corner = |at: UVec3| DVec3::new(self.plane(0, at.x), self.plane(1, at.y), self.plane(2, at.z));
        Cell { min: corner(at), max: corner(at + 1) }
    }

    /// The number of cells; 0 for a grid without `starts`.
    pub fn n_nodes(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The number of levels: 1 for a grid with cells, 0 without.
    pub fn depth(&self) -> usize {
        usize::from(self.n_nodes() > 0)
    }

    /// All cells as boxes, for drawing. A grid has one level only, so `depth` is ignored.
    pub fn cells(&self, _depth: usize) -> Vec<Aabb> {
        let n = if self.n_nodes() > 0 { self.resolution } else { UVec3::ZERO };
        let all =
            (0..n.z).flat_map(|z| (0..n.y).flat_map(move |y| (0..n.x).map(move |x| UVec3::new(x, y, z))));
        all.map(|at| self.cell(at).to_box()).collect()
    }
}
