//! Stage 9 · the uniform grid: cells of one size, and rays that go from one to the next.
//!
//! Slides: "Uniform Grid" (index primitives according to overlaps; trace rays through grid cells; "How choose suitable grid
//! resolution?").
//!
//! Given: [`Grid`] with `plane` (where a cell begins), `number` and `primitives`.

use crate::stage9_cells::{look_into, settled, span, widened};
use glam::{DVec3, UVec3};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Grid, MOST_CELLS_ALONG};
use raykata::ray::Ray;

/// How many cells along each axis make about `density · n_primitives` cells that are nearly cubes. An axis along which the
/// box is thinner than a cell gets one; no axis gets more than [`MOST_CELLS_ALONG`]. An empty box, or nothing in it, is
/// one cell.
pub fn resolution(bounds: &Aabb, n_primitives: usize, density: f32) -> UVec3 {
    todo!("find the side of a cube of which density · n fill the box; flat boxes have fewer axes")
}

/// Puts each primitive into all cells that its box reaches into, touching included.
pub fn build(bounds: &[Aabb], resolution: UVec3) -> Grid {
    todo!("for each box find the first and the last cell on each axis, and list it in all between")
}

/// The closest hit: from the cell that the ray enters first to the next one, until the best hit lies before the cell.
///
/// Where the formula lies: the hit of a cell need not be in it, and a later cell may hold a nearer one; `tMax += tDelta`
/// adds up roundings, so that in a fine grid wrong cells are visited: work out `t` from the number of the cell.
pub fn closest_hit(grid: &Grid, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("look into the cell, find the nearest of its three far planes, and step across it")
}
