//! Stage 9 · the uniform grid: cells of equal size, and a search that steps along the ray from cell to cell.
//!
//! Slides: "Uniform Grid" (index primitives according to overlaps; trace rays through grid cells; "How choose suitable
//! grid resolution?").
//!
//! Given: [`Grid`] with `plane` (the coordinate at which a cell begins), `number` and `primitives`.

use crate::stage9_cells::{may_stop_before, padded_boxes, span, test_cell};
use glam::{DVec3, UVec3};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Grid, MOST_CELLS_ALONG};
use raykata::ray::Ray;

/// Chooses the number of cells along each axis, such that the grid has about `density · n_primitives` cells that are
/// nearly cubes.
///
/// An axis along which the box is thinner than a cell gets one cell. Every axis gets at least 1 and at most
/// [`MOST_CELLS_ALONG`] cells. An empty box, a single point and `n_primitives = 0` get one cell.
///
/// Pitfall: a flat box has no volume. Use the area of the two remaining axes, or the length of the one remaining axis.
///
/// Slide: "Uniform Grid" (How choose suitable grid resolution?).
pub fn resolution(bounds: &Aabb, n_primitives: usize, density: f32) -> UVec3 {
    todo!("find the side of a cube of which density · n fill the box; flat boxes have fewer axes")
}

/// Builds a grid of `resolution` cells over the box around all primitives: lists each primitive in all cells that its
/// box overlaps.
///
/// A box that touches a cell overlaps it. Each primitive is listed once per cell. Empty boxes and boxes with NaN are
/// left out. An axis with resolution 0 gets one cell.
///
/// Pitfall: the quotient that gives the index of a cell is rounded. Compare with [`Grid::plane`] after the division.
///
/// Slide: "Uniform Grid" (index primitives according to overlaps).
pub fn build(bounds: &[Aabb], resolution: UVec3) -> Grid {
    todo!("for each box find the first and the last cell on each axis, and list it in all cells between")
}

/// Finds the closest hit: visits the cells in the order in which the ray enters them, and stops when the best hit lies
/// before the next cell.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit, or if the ray misses the grid. Visit each cell at most once. At a corner, visit any
/// sequence of cells that share a face.
///
/// Pitfall: a primitive of a cell may be hit outside the cell, and a later cell may hold a nearer hit.
///
/// Pitfall: the quotient that gives the index of the first cell is rounded, as in [`build`].
///
/// Pitfall: `tMax += tDelta` accumulates rounding errors and visits wrong cells in a fine grid: compute `t` from the index of
/// the cell, in double precision.
///
/// Slide: "Uniform Grid" (trace rays through grid cells).
pub fn closest_hit(grid: &Grid, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("test the cell's primitives, find the nearest of its three far planes, and step across it")
}
