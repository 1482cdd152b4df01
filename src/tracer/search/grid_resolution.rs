//! The number of cells of a grid in a frame: what the scene or the formula asks for, as far as the references to
//! primitives stay within a bound.

use crate::aabb::Aabb;
use crate::kit::StudentFunctions;
use crate::partition::{MOST_CELLS_ALONG, MOST_REFERENCES};
use crate::scene::Quality;
use glam::{DVec3, UVec3};

/// Cells per primitive, if the scene does not say how many (Wald et al., "Ray Tracing Animated Scenes Using Coherent
/// Grid Traversal", 2006, find 2 to 5 best).
const DENSITY: f32 = 4.0;

/// The references that a grid may have in any case if the formula gives its cells: as many as 64 primitives have that
/// are in all of their `4 · 64` cells. With so few primitives a bound saves nothing.
const SMALL: usize = 1 << 14;

/// The references that a grid may have in any case if the scene gives the number of its cells: 256 MB.
const LARGE: usize = 1 << 26;

/// Cells of a grid along each axis, over primitives with these boxes in the box `around`: as many along the
/// longest side as the scene says, and cubes; or what the formula gives.
///
/// If the cells would list more than [`MOST_REFERENCES`] references per primitive, and more than [`SMALL`] or
/// [`LARGE`] references, the result has fewer cells, and `notes` receives a sentence that says so. Code of a
/// student cannot exceed the bound, because the boxes and the number of cells determine the references.
pub fn grid_resolution<F: StudentFunctions>(
    bounds: &[Aabb],
    around: &Aabb,
    quality: &Quality,
    notes: &mut Vec<String>,
) -> UVec3 {
    let size = around.max - around.min;
    let longest = size.max_element();
    let (wanted, in_any_case) = match quality.grid_resolution {
        0 => (F::grid_resolution(around, bounds.len(), DENSITY), SMALL),
        n if longest > 0.0 && longest.is_finite() => ((n as f32 * (size / longest)).ceil().as_uvec3(), LARGE),
        _ => (UVec3::ONE, LARGE),
    };
    let wanted = wanted.clamp(UVec3::ONE, UVec3::splat(MOST_CELLS_ALONG));
    // Take three quarters of the cells along each axis until the bound holds. A single cell lists each primitive once.
    let most = (MOST_REFERENCES * bounds.len()).max(in_any_case);
    let mut resolution = wanted;
    while n_references(bounds, around, resolution) > most as f64 && resolution != UVec3::ONE {
        resolution = (resolution * 3 / 4).max(UVec3::ONE);
    }
    if resolution != wanted {
        notes.push(format!(
            "the grid has {} cells, and not {}, because primitives overlap: more cells would list them more than \
             {MOST_REFERENCES} times on average",
            along(resolution),
            along(wanted)
        ));
    }
    resolution
}

fn along(resolution: UVec3) -> String {
    format!("{} × {} × {}", resolution.x, resolution.y, resolution.z)
}

/// The number of references of a grid: for each box the number of cells that it touches.
fn n_references(bounds: &[Aabb], around: &Aabb, resolution: UVec3) -> f64 {
    let (min, max) = (around.min.as_dvec3(), around.max.as_dvec3());
    // Leave as much room around each box as builders do (`padded_boxes` of stage 9).
    let largest = min.abs().max(max.abs()).max_element();
    let room = ((max - min).max_element() * (-18f64).exp2()).max(largest * (-22f64).exp2());
    let (min, size) = (min - room, max - min + 2.0 * room);
    // A conversion of NaN, from an axis without extent, gives 0.
    let index = |at: DVec3| ((at - min) / size * resolution.as_dvec3()).as_uvec3().min(resolution - 1);
    let n_cells = |one: &Aabb| {
        let (low, high) = (index(one.min.as_dvec3() - room), index(one.max.as_dvec3() + room));
        (high - low + 1).as_dvec3().element_product()
    };
    bounds.iter().filter(|one| !one.is_empty()).map(n_cells).sum()
}
