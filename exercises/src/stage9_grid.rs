//! Stage 9 · the uniform grid: cells of equal size, and a search that steps along the ray from cell
//! to cell.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Grid`] with `plane` (the coordinate at which a cell begins), `number` and `primitives`.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the cell that lists its primitive. Without a hit,
//! or if the ray misses the grid, the result is `None`.

use crate::stage9_cells::{around, may_stop_before, padded_boxes, span, test_cell};
use glam::{DVec3, UVec3};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Grid, MOST_CELLS_ALONG};
use raykata::ray::Ray;

/// Coarse grids skip little, fine ones take many steps. A rule: about `density · n_primitives`
/// nearly cubic cells, `side = ∛(volume / (ρ n))`. What is the volume of a flat box?
///
/// Exactly:
///
/// 1. An axis along which the box is thinner than a cell gets one cell, the others share all.
/// 2. Every axis gets 1 to [`MOST_CELLS_ALONG`] cells.
/// 3. An empty box, a single point and `n_primitives = 0` get one cell.
///
/// Source: "Uniform Grid" (How choose suitable grid resolution?).
pub fn resolution(bounds: &Aabb, n_primitives: usize, density: f32) -> UVec3 {
    todo!("find the side of a cube of which density · n fill the box; flat boxes have fewer axes")
}

/// A grid of `resolution` cells over the box around all padded boxes ([`padded_boxes`]). Each
/// primitive is listed once in all cells that its box overlaps: per axis, from that of its lower to
/// that of its upper corner. What if the quotient that gives the index is rounded?
///
/// Exactly:
///
/// 1. A box that touches a cell overlaps it.
/// 2. Empty boxes are left out.
///
/// Source: "Uniform Grid" (index primitives according to overlaps).
pub fn build(bounds: &[Aabb], resolution: UVec3) -> Grid {
    todo!("for each box find the first and the last cell on each axis, and list it in all cells between")
}

/// Steps from cell to cell: the ray leaves a cell through the nearest of three planes. What error
/// has `tMax += tDelta` after 250 cells? What if a primitive is hit outside this cell?
///
/// Exactly:
///
/// 1. Visit the cells in the order in which the ray enters them, each at most once. At a corner,
///    visit any sequence of cells that share a face.
/// 2. Stop when the best hit lies before the next cell.
///
/// Source: "Uniform Grid" (trace rays through grid cells).
pub fn closest_hit(grid: &Grid, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("test the cell's primitives, find the nearest of its three far planes, and step across it")
}
