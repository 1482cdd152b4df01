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
    // <solution>
    let n_cells = f64::from(density) * n_primitives as f64;
    let size = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    if bounds.is_empty() || !size.is_finite() || !(n_cells > 1.0) {
        return UVec3::ONE;
    }

    // The side of a cube of which n fill the box: sⁿ = extents / n over the axes that are not thinner than that.
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

/// Puts each primitive into all cells that its box reaches into, touching included.
pub fn build(bounds: &[Aabb], resolution: UVec3) -> Grid {
    // <solution>
    let widened = widened(bounds);
    let resolution = resolution.max(UVec3::ONE);
    let n_cells: usize = resolution.to_array().into_iter().map(|n| n as usize).product();
    let mut grid =
        Grid { bounds: widened.around, resolution, starts: vec![0; n_cells + 1], items: Vec::new() };

    // Count, add up, and fill from the end of each cell to its beginning: then starts are where they should be.
    let each_cell = |grid: &Grid, one: &Aabb| -> Vec<u32> {
        let low = UVec3::from_array([0, 1, 2].map(|axis| index(grid, axis, f64::from(one.min[axis]))));
        let high = UVec3::from_array([0, 1, 2].map(|axis| index(grid, axis, f64::from(one.max[axis]))));
        let rows = (low.z..=high.z).flat_map(|z| (low.y..=high.y).map(move |y| (y, z)));
        rows.flat_map(|(y, z)| (low.x..=high.x).map(move |x| grid.number(UVec3::new(x, y, z)))).collect()
    };
    for (_, one) in &widened.boxes {
        each_cell(&grid, one).into_iter().for_each(|cell| grid.starts[cell as usize] += 1);
    }
    let mut sum = 0;
    for start in &mut grid.starts {
        sum += *start;
        *start = sum;
    }
    grid.items = vec![0; sum as usize];
    for (id, one) in widened.boxes.iter().rev() {
        for cell in each_cell(&grid, one) {
            grid.starts[cell as usize] -= 1;
            let start = grid.starts[cell as usize];
            grid.items[start as usize] = *id;
        }
    }
    grid
    // <stub> todo!("for each box find the first and the last cell on each axis, and list it in all between")
    // </solution>
}

// <solution>
/// The cell along `axis` that holds coordinate `at`; the nearest one if none does.
fn index(grid: &Grid, axis: usize, at: f64) -> u32 {
    let (first, last) = (grid.plane(axis, 0), grid.plane(axis, grid.resolution[axis]));
    let n = grid.resolution[axis];
    // A flat grid divides by 0, and NaN becomes 0.
    let mut index = (((at - first) / (last - first) * f64::from(n)) as u32).min(n - 1);
    // The quotient is rounded; the planes decide.
    while index > 0 && at < grid.plane(axis, index) {
        index -= 1;
    }
    while index + 1 < n && at > grid.plane(axis, index + 1) {
        index += 1;
    }
    index
}
// </solution>

/// The closest hit: from the cell that the ray enters first to the next one, until the best hit lies before the cell.
///
/// Where the formula lies: the hit of a cell need not be in it, and a later cell may hold a nearer one; `tMax += tDelta`
/// adds up roundings, so that in a fine grid wrong cells are visited: work out `t` from the number of the cell.
pub fn closest_hit(grid: &Grid, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    let bounds = Cell::new(&grid.bounds);
    let (enter, leave) = span(ray, &bounds)?;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let start = (origin + enter * direction).clamp(bounds.min, bounds.max);
    let mut cell = UVec3::from_array([0, 1, 2].map(|axis| index(grid, axis, start[axis])));

    let mut ray = *ray;
    let mut best = None;
    loop {
        let number = grid.number(cell);
        probe.visit(number);
        look_into(grid.primitives(number), probe, &mut ray, &mut best);

        // The axis along which the ray leaves the cell first, and when.
        let (mut axis, mut exit) = (0, f64::INFINITY);
        for candidate in 0..3 {
            let plane = grid.plane(candidate, cell[candidate] + u32::from(direction[candidate] > 0.0));
            let t = (plane - origin[candidate]) / direction[candidate];
            if direction[candidate] != 0.0 && t < exit {
                (axis, exit) = (candidate, t);
            }
        }
        let at_the_end =
            if direction[axis] > 0.0 { cell[axis] + 1 == grid.resolution[axis] } else { cell[axis] == 0 };
        if exit.is_infinite() || exit > leave || at_the_end || settled(&best, exit) {
            return best;
        }
        if direction[axis] > 0.0 {
            cell[axis] += 1;
        } else {
            cell[axis] -= 1;
        }
    }
    // <stub> todo!("look into the cell, find the nearest of its three far planes, and step across it")
    // </solution>
}
