//! The table of stage 9: maps of the cells that rays visit in a grid.

use super::scenes::{Scene, sphere};
use super::searches::queries;
use checks::golden::{Table, digits};
use checks::prelude::*;
use glam::uvec3;

const COLUMNS: u32 = 12;
const ROWS: u32 = 7;

/// Spheres in the plane z = 0, of which some are in the way of the rays.
fn scene(shift: f32) -> Scene {
    let center = |i: u8| {
        (f32::from(i % 4) * 3.1 + shift * f32::from(i % 3), f32::from(i / 4) * 2.9 + 0.35 * f32::from(i % 3))
    };
    let radius = |i: u8| if i % 5 == 2 { 0.7 } else { 0.45 };
    let one = |i: u8| sphere(center(i).0, center(i).1, 0.0, radius(i));
    Scene::new((0..12).map(one).collect())
}

/// Rays in the plane z = 0, which are steeper the larger `turn` is. Those that pass closely by a corner of a cell are left out, because a
/// search may take either way around it, and so are those that pass closely by a sphere.
fn fan(scene: &Scene, turn: f32) -> Vec<Ray> {
    let bounds = checks::tree::around(&scene.boxes());
    // Half of the rays come from the left, half from the right. Their other ends climb or fall.
    let ray = |i: u8| {
        let (share, width) = (f32::from(i) / 9.0, bounds.max.x - bounds.min.x);
        let (low, high) = (bounds.min.y, bounds.max.y);
        let [begin, end] = [low + share * (high - low), high - (0.9 * share + 0.05) * (high - low)];
        let begin = vec3(bounds.min.x - 1.0, begin, 0.0);
        let end = vec3(bounds.max.x + 1.0, end, 0.0) - vec3(turn * width, 0.0, 0.0);
        let (begin, end) = if i.is_multiple_of(2) { (begin, end) } else { (end, begin) };
        Ray::new(begin, (end - begin).normalize())
    };
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let size = (max - min) / DVec3::new(f64::from(COLUMNS), f64::from(ROWS), 1.0);
    let crossings = |ray: &Ray, axis: usize, count: u32| -> Vec<f64> {
        let plane = |i: u32| min[axis] + f64::from(i) * size[axis] - f64::from(ray.origin[axis]);
        (0..=count).map(|i| plane(i) / f64::from(ray.direction[axis])).collect()
    };
    // A thousandth of a cell is far more than rounding errors.
    let is_clear = |ray: &Ray| {
        let (x, y) = (crossings(ray, 0, COLUMNS), crossings(ray, 1, ROWS));
        let hits = scene.hits(ray);
        let nudged = Ray::new(ray.origin, ray.direction + vec3(0.0, 1e-3, 0.0));
        let also = scene.hits(&nudged);
        // No hit is near a face either, where the search may stop before or behind it.
        let ends = x.iter().chain(&y).all(|t| hits.iter().all(|hit| (t - f64::from(*hit)).abs() > 1e-3));
        x.iter().all(|x| y.iter().all(|y| (x - y).abs() > 1e-3 * size.x))
            && hits.iter().zip(&also).all(|(one, other)| one.is_finite() == other.is_finite())
            && ends
    };
    (0..10).map(ray).filter(is_clear).take(5).collect()
}

fn lines(kit: &dyn Kit, scene: &Scene, rays: &[Ray]) -> String {
    let resolution = uvec3(COLUMNS, ROWS, 1);
    let grid = kit.grid_build(&[GridQuery { bounds: scene.boxes(), resolution }]).remove(0);
    let mut lines = Vec::new();
    for (ray, answer) in rays.iter().zip(kit.grid_search(&queries(&grid, scene, rays))) {
        let hit =
            answer.hit.map_or("nothing".into(), |hit| format!("{} at {}", hit.primitive, digits(hit.t, 3)));
        let [x, y] = [ray.direction.x, ray.direction.y].map(|x| digits(x, 2));
        lines.push(format!("grid_search along {x} {y}: {hit}"));
        // The order of the visits, in letters; `#` is a cell that lists primitives and is not visited.
        for row in (0..ROWS).rev() {
            let letter = |column: u32| {
                let cell = grid.number(uvec3(column, row, 0));
                let is_filled = grid.starts.get(cell as usize) < grid.starts.get(cell as usize + 1);
                match answer.visits.iter().position(|visit| *visit == cell) {
                    Some(order) => char::from(b'a' + (order % 26) as u8),
                    None if is_filled => '#',
                    None => '.',
                }
            };
            lines.push((0..COLUMNS).map(letter).map(String::from).collect::<Vec<_>>().join(" "));
        }
    }
    lines.join("\n")
}

pub(super) fn map_of_the_cells_on_the_way(trial: &Trial<'_>) -> CheckResult {
    let (shift, turn) = trial.composed((0.0, 0.3), (-1.0..1f32, 0.0..0.6f32));
    let scene = scene(shift);
    let rays = fan(&scene, turn);
    let input = "rays in a grid of 12 × 7 cells; letters show the order of the visits";
    Table { name: "stage9_cells_on_the_way", input }.check(trial, |kit| lines(kit, &scene, &rays))
}
