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

// <solution>
use crate::stage9_cells::{crossing, first_axis};
// </solution>

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
    // <solution>
    // Return one cell for an empty or an infinite box.
    let n_cells = f64::from(density) * n_primitives as f64;
    let size = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    if bounds.is_empty() || !size.is_finite() {
        return UVec3::ONE;
    }

    // Compute the side of a cube of which `n_cells` fill the box: over k axes, sideᵏ = product of
    // their sizes / n_cells. Drop the axes that are thinner than the side, and repeat. Without
    // primitives the side is infinite.
    let mut thick: Vec<usize> = (0..3).filter(|&axis| size[axis] > 0.0).collect();
    let side = loop {
        let volume: f64 = thick.iter().map(|&axis| size[axis]).product();
        let side = (volume / n_cells).powf(1.0 / thick.len() as f64);
        let n_before = thick.len();
        thick.retain(|&axis| size[axis] >= side);
        if thick.is_empty() {
            return UVec3::ONE;
        }
        if thick.len() == n_before {
            break side;
        }
    };
    // Divide each thick axis into cells of about this side.
    let along = |axis: usize| {
        if thick.contains(&axis) {
            (size[axis] / side).round().clamp(1.0, f64::from(MOST_CELLS_ALONG))
        } else {
            1.0
        }
    };
    DVec3::new(along(0), along(1), along(2)).as_uvec3()
    // <stub> todo!("find the side of a cube of which density · n fill the box; flat boxes have fewer axes")
    // </solution>
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
    // <solution>
    let boxes = padded_boxes(bounds);
    let resolution = resolution.max(UVec3::ONE);
    let n_cells: usize = resolution.to_array().into_iter().map(|n| n as usize).product();
    let mut grid =
        Grid { bounds: around(&boxes), resolution, starts: vec![0; n_cells + 1], items: Vec::new() };

    let each_cell = |grid: &Grid, one: &Aabb| -> Vec<u32> {
        let low = UVec3::from_array([0, 1, 2].map(|axis| index(grid, axis, f64::from(one.min[axis]))));
        let high = UVec3::from_array([0, 1, 2].map(|axis| index(grid, axis, f64::from(one.max[axis]))));
        let rows = (low.z..=high.z).flat_map(|z| (low.y..=high.y).map(move |y| (y, z)));
        rows.flat_map(|(y, z)| (low.x..=high.x).map(move |x| grid.number(UVec3::new(x, y, z)))).collect()
    };
    // Count the entries of each cell.
    for (_, one) in &boxes {
        each_cell(&grid, one).into_iter().for_each(|cell| grid.starts[cell as usize] += 1);
    }
    // Turn the counts into the ends of the lists.
    let mut sum = 0;
    for start in &mut grid.starts {
        sum += *start;
        *start = sum;
    }
    // Fill the lists from their ends.
    grid.items = vec![0; sum as usize];
    for (id, one) in boxes.iter().rev() {
        for cell in each_cell(&grid, one) {
            grid.starts[cell as usize] -= 1;
            let start = grid.starts[cell as usize];
            grid.items[start as usize] = *id;
        }
    }
    grid
    // <stub> todo!("for each box find the first and the last cell on each axis, and list it in all cells between")
    // </solution>
}

// <solution>
/// The index along `axis` of the cell that contains coordinate `at`, or of the nearest cell if it
/// is outside.
fn index(grid: &Grid, axis: usize, at: f64) -> u32 {
    let (first, last) = (grid.plane(axis, 0), grid.plane(axis, grid.resolution[axis]));
    let n = grid.resolution[axis];
    // Divide by the cell size. A flat grid divides by 0; NaN becomes 0.
    let mut index = (((at - first) / (last - first) * f64::from(n)) as u32).min(n - 1);
    // Correct the index by comparing with the planes, because the quotient is rounded.
    while index > 0 && at < grid.plane(axis, index) {
        index -= 1;
    }
    while index + 1 < n && at > grid.plane(axis, index + 1) {
        index += 1;
    }
    index
}
// </solution>

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
    // <solution>
    // Find the cell in which the ray enters the grid.
    let bounds = Cell::new(&grid.bounds);
    let (enter, leave) = span(ray, &bounds)?;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let start = (origin + enter * direction).clamp(bounds.min, bounds.max);
    let mut cell = UVec3::from_array([0, 1, 2].map(|axis| index(grid, axis, start[axis])));

    // Compute where the ray crosses the far plane of the cell on each axis. Compute t from the
    // index of the cell: a sum of steps accumulates rounding errors.
    let cross = |axis: usize, cell: UVec3| {
        let far = grid.plane(axis, cell[axis] + u32::from(direction[axis] > 0.0));
        crossing(origin[axis], direction[axis], far)
    };
    let mut exits = [0, 1, 2].map(|axis| cross(axis, cell));
    let mut ray = *ray;
    let mut best = None;
    loop {
        // Test the primitives of the cell.
        let number = grid.number(cell);
        probe.visit(number);
        test_cell(grid.primitives(number), probe, &mut ray, &mut best);

        // The ray leaves the cell through the first of the three planes. Stop at the end of the
        // grid or of the ray, or if the best hit lies before the exit.
        let axis = first_axis(exits);
        let exit = exits[axis];
        let at_the_end =
            if direction[axis] > 0.0 { cell[axis] + 1 == grid.resolution[axis] } else { cell[axis] == 0 };
        if exit.is_infinite() || exit > leave || at_the_end || may_stop_before(&best, exit) {
            return best;
        }
        // Step across the face. Only this axis gets another plane.
        if direction[axis] > 0.0 {
            cell[axis] += 1;
        } else {
            cell[axis] -= 1;
        }
        exits[axis] = cross(axis, cell);
    }
    // <stub> todo!("test the cell's primitives, find the nearest of its three far planes, and step across it")
    // </solution>
}
