//! The laws of the uniform grid: which primitives each cell lists, and the search.

use super::lists::{bounds_fault, is_far_off, some_boxes};
use super::parts;
use super::scenes::{Scene, Thing, rays, sphere, wall};
use super::searches::{Searcher, agrees, grid_queries, judge, judge_visits};
use super::structures::{around_loosely, filled};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use checks::paste::Paste;
use glam::{UVec3, Vec3, uvec3, vec3};
use proptest::prelude::Strategy;
use raykata::aabb::Aabb;
use raykata::kit::{CellsQuery, GridQuery};
use raykata::partition::Grid;
use raykata::ray::Ray;
use raykata::shape::Sphere;

pub(super) fn grid_lists_what_reaches_into_cells(trial: &Trial<'_>) -> CheckResult {
    let inputs = (some_boxes(), 1..=6u32, 1..=5u32, 1..=4u32)
        .prop_map(|(bounds, x, y, z)| GridQuery { bounds, resolution: uvec3(x, y, z) });
    let none = GridQuery { bounds: Vec::new(), resolution: UVec3::splat(2) };
    let flat =
        GridQuery { bounds: vec![Aabb::new(Vec3::ZERO, vec3(4.0, 4.0, 0.0)); 3], resolution: uvec3(4, 4, 1) };
    judge_grids(trial, &[none, flat]).into_iter().collect::<CheckResult>()?;
    trial.forall(200, inputs, |queries| judge_grids(trial, queries))
}

fn judge_grids(trial: &Trial<'_>, queries: &[GridQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.grid_build(queries), |query, yours| match grid_fault(query, &yours) {
        None => Ok(()),
        Some((yours, expected, diagnosis)) => {
            let input = format!("build(&{}, {})", checks::paste::list(&query.bounds), query.resolution);
            Err(Broken::with_texts(input, yours, expected, "the definition of a grid")
                .looks_like(known(diagnosis)))
        }
    })
}

fn grid_fault(query: &GridQuery, grid: &Grid) -> Option<(String, String, &'static str)> {
    let n: u32 = query.resolution.element_product();
    let in_order = grid.starts.windows(2).all(|pair| pair[0] <= pair[1]);
    let ends = grid.starts.last().is_some_and(|last| *last as usize == grid.items.len());
    if grid.resolution != query.resolution || grid.starts.len() != n as usize + 1 || !in_order || !ends {
        let yours = format!("{} cells, starts {:?}", grid.resolution, grid.starts);
        return Some((
            yours,
            format!("{n} cells, ascending starts, and the number of items as the last one"),
            "",
        ));
    }
    if let Some((yours, expected)) = bounds_fault(&grid.bounds, &query.bounds) {
        return Some((yours, expected, "bounds must contain all boxes that are not empty"));
    }
    for number in 0..n {
        let at = uvec3(
            number % grid.resolution.x,
            number / grid.resolution.x % grid.resolution.y,
            number / (grid.resolution.x * grid.resolution.y),
        );
        let cell = grid.cell(at);
        let listed = grid.primitives(number);
        for (id, one) in query.bounds.iter().enumerate() {
            let times = listed.iter().filter(|&&other| other == id as u32).count();
            let describe = |times: usize| format!("primitive {id} is listed {times} times in cell {at}");
            if one.is_empty() && times > 0 {
                return Some((
                    describe(times),
                    describe(0),
                    "you list an empty box or one with NaN: leave it out",
                ));
            }
            // All cells of a grid over a single point are that point: one of them that lists the primitive is enough.
            let elsewhere = || (0..n).any(|other| grid.primitives(other).contains(&(id as u32)));
            let one_place = grid.bounds.min == grid.bounds.max;
            if !one.is_empty() && cell.touches(one) && times != 1 && !(times == 0 && one_place && elsewhere())
            {
                let middle = cell.touches(&Aabb::new(0.5 * (one.min + one.max), 0.5 * (one.min + one.max)));
                let diagnosis = match times {
                    0 if !middle => {
                        "you leave out a cell: all cells that a box overlaps or touches list it, not only the cell of its middle"
                    }
                    0 => "you leave out a primitive",
                    _ => "you list a primitive twice in one cell",
                };
                return Some((describe(times), describe(1), diagnosis));
            }
            if times > 0 && is_far_off(&grid.bounds, &cell.to_box(), one) {
                return Some((
                    describe(times),
                    describe(0),
                    "you list a primitive in a cell that it does not overlap",
                ));
            }
        }
    }
    None
}

pub(super) fn grid_search_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    agrees(trial, Searcher::Grid)
}

/// Trap A8: a large sphere of the first cell is hit in the third cell, and a small one in the second cell is nearer.
pub(super) fn grid_hit_beyond_its_cell_waits(trial: &Trial<'_>) -> CheckResult {
    let large = Thing::Sphere(Sphere { center: vec3(5.0, 2.0, 0.0), radius: 2.25 });
    let scene = Scene::new(vec![large, sphere(3.5, 0.0, 0.0, 0.25), sphere(0.0, 3.0, 0.0, 0.5)]);
    let [ray] = [Ray::new(vec3(-1.0, 0.0, 0.0), Vec3::X)];
    // The large sphere is listed from the first cell on, as a longer primitive would be.
    let bounds = Aabb::new(vec3(0.0, -4.0, -4.0), vec3(8.0, 4.5, 4.0));
    let cells = filled(bounds, uvec3(4, 1, 1), &[vec![2, 0], vec![1, 0], vec![0], vec![0]]);
    let hits = scene.hits(&ray);
    let yours = trial.kit.grid_search(&[CellsQuery { cells, ray, hits: hits.clone() }]).remove(0);
    judge("grid of 4 cells along x; all of them list primitive 0", &ray, &hits, &yours).map_err(|broken| {
        broken.looks_like(Some(
            "trap A8: the first hit lies beyond its cell, and a later cell has a nearer one: go on until the next cell begins behind the best hit",
        ))
    })
}

fn bare_grid(bounds: Aabb, resolution: UVec3) -> Grid {
    let n = resolution.element_product() as usize;
    Grid { bounds, resolution, starts: vec![0; n + 1], items: Vec::new() }
}

pub(super) fn grid_visits_cells_in_order_and_stops(trial: &Trial<'_>) -> CheckResult {
    trial.forall(300, rays(), |rays| {
        let grid = bare_grid(Aabb::new(Vec3::splat(-5.0), vec3(5.0, 4.0, 6.0)), uvec3(6, 5, 4));
        let query = |ray: &Ray| CellsQuery { cells: grid.clone(), ray: *ray, hits: Vec::new() };
        let queries: Vec<CellsQuery<Grid>> = rays.iter().map(query).collect();
        compare(&queries, trial.kit.grid_search(&queries), |query, yours| judge_way(query, &yours.visits))
    })?;
    // A row of spheres of which the first is hit: the cells behind it must not be visited.
    let row = Scene::new((0..32).map(|i| sphere(i as f32, 0.0, 0.0, 0.25)).collect());
    let rays = [Ray::new(vec3(-2.0, 0.0, 0.0), Vec3::X), Ray::new(vec3(40.0, 0.0, 0.0), Vec3::NEG_X)];
    for query in grid_queries(&row, &rays, around_loosely(&row.boxes()), uvec3(32, 1, 1)) {
        let ray = query.ray;
        let yours = trial.kit.grid_search(std::slice::from_ref(&query)).remove(0);
        judge_visits(
            "grid over a row of 32 spheres",
            &ray,
            &parts::of_grid(&query.cells, &ray),
            &yours,
            true,
        )?;
    }
    Ok(())
}

/// Whether the visits to empty cells are those of the ray.
fn judge_way(query: &CellsQuery<Grid>, visits: &[u32]) -> CheckResult {
    let parts = parts::of_grid(&query.cells, &query.ray);
    let fault = |yours: String, expected: String, diagnosis: &'static str| {
        let input =
            format!("grid of {} cells without primitives\n{}", query.cells.resolution, query.ray.paste());
        Err(Broken::with_texts(input, yours, expected, "every cell tested in double precision")
            .looks_like(known(diagnosis)))
    };
    // The search must visit each cell through whose inside the ray passes, and may visit cells that the ray touches.
    if let Some((cell, near, far)) =
        parts::inside_grid(&query.cells, &query.ray).iter().find(|(cell, ..)| !visits.contains(cell))
    {
        let expected = format!("a visit to {cell}, in which the ray is from t = {near:.3} to {far:.3}");
        let reaches = query.ray.t_max.is_finite();
        let diagnosis = match visits.is_empty() {
            true => "you do not find the first cell: clip the ray to the grid's bounds, and start there",
            false if reaches => "you leave out a cell within the ray's range",
            false => "you leave out a cell: step along the axis whose plane comes first",
        };
        return fault(format!("visits to {visits:?}"), expected, diagnosis);
    }
    let mut last = f64::NEG_INFINITY;
    for (index, visit) in visits.iter().enumerate() {
        let Some((_, near, _)) = parts.iter().find(|(cell, ..)| cell == visit) else {
            return fault(
                format!("a visit to {visit}"),
                "none".into(),
                "you visit a cell that the ray does not enter",
            );
        };
        if visits[..index].contains(visit) {
            return fault(format!("{visit} is visited twice"), "once".into(), "you visit a cell twice");
        }
        if *near < last - 1e-2 {
            return fault(
                format!("visits to {visits:?}"),
                "cells in the order in which the ray enters them".into(),
                "you do not visit the cells in the order of t",
            );
        }
        last = last.max(*near);
    }
    Ok(())
}

/// Trap A8, second part: 250 cells along an axis.
pub(super) fn grid_steps_do_not_add_up_roundings(trial: &Trial<'_>) -> CheckResult {
    // The cell sides are not powers of two, so that each step is rounded. Cells are twice as long along y, so that one
    // axis takes twice as many steps as the other.
    let bounds = Aabb::new(vec3(1.1, 2.3, -3.7), vec3(2.4, 3.6, -2.4));
    let grid = bare_grid(bounds, uvec3(250, 125, 1));
    // Aim just beside corners: the distances that decide the next cell are small, but far above the error of an f64.
    for off in [7e-7f32, -7e-7, 1.2e-6, -1.2e-6] {
        let origin = vec3(1.1 - 0.5, 2.3 - 0.5 + off, -3.0);
        let query =
            CellsQuery { cells: grid.clone(), ray: Ray::new(origin, vec3(1.0, 1.0, 0.0)), hits: Vec::new() };
        let yours = trial.kit.grid_search(std::slice::from_ref(&query)).remove(0);
        let expected = diagonal(&query);
        if let Some(at) = (0..expected.len()).find(|&i| yours.visits.get(i) != Some(&expected[i])) {
            let describe = |cells: &[u32]| {
                format!("{at} cells, then {:?}", &cells[at.min(cells.len())..cells.len().min(at + 3)])
            };
            let input =
                format!("a ray beside the diagonal of a grid of 250 × 125 cells\n{}", query.ray.paste());
            let broken = Broken::with_texts(
                input,
                describe(&yours.visits),
                describe(&expected),
                "planes in double precision",
            );
            return Err(broken.looks_like(Some(
                "trap A8: tMax += tDelta accumulates one rounding error per step: compute t from the index of the cell, in double precision",
            )));
        }
    }
    Ok(())
}

/// The cells along a ray whose direction has positive x and y, from the sorted planes.
fn diagonal(query: &CellsQuery<Grid>) -> Vec<u32> {
    let (grid, ray) = (&query.cells, &query.ray);
    let t = |axis: usize, i: u32| {
        (grid.plane(axis, i) - f64::from(ray.origin[axis])) / f64::from(ray.direction[axis])
    };
    let begin = t(0, 0).max(t(1, 0));
    let inner = |axis: usize| (1..grid.resolution[axis]).map(move |i| (axis, i));
    let mut cell = UVec3::ZERO;
    let mut crossings: Vec<(f64, usize)> =
        inner(0).chain(inner(1)).map(|(axis, i)| (t(axis, i), axis)).filter(|(t, _)| *t > begin).collect();
    crossings.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut visits = vec![grid.number(cell)];
    for (t_crossing, axis) in crossings {
        if t_crossing < t(0, grid.resolution.x).min(t(1, grid.resolution.y)) {
            cell[axis] += 1;
            visits.push(grid.number(cell));
        }
    }
    visits
}

/// Rays through corners of cells, from faces, along faces and in a flat grid.
pub(super) fn grid_takes_rays_through_corners_and_faces(trial: &Trial<'_>) -> CheckResult {
    let lattice: Vec<Thing> = (0..27)
        .map(|i| sphere((i % 3) as f32 * 2.0, (i / 3 % 3) as f32 * 2.0, (i / 9) as f32 * 2.0, 0.5))
        .collect();
    let walls: Vec<Thing> =
        (0..3).flat_map(|axis| [wall(axis, -2.0, 2.0), wall(axis, 2.0, 2.0)]).flatten().collect();
    let flat: Vec<Thing> = [1.0, 2.0, 3.0].into_iter().flat_map(|size| wall(2, 0.0, size)).collect();
    let starts =
        [vec3(-3.0, -3.0, -3.0), Vec3::ZERO, vec3(2.0, 2.0, 2.0), vec3(-2.0, 0.0, 1.0), vec3(1.0, 1.0, -4.0)];
    let zeros = [0.0, -0.0];
    let steps = [-1.0, 0.0, -0.0, 1.0];
    let dirs = steps.iter().flat_map(|&x| steps.iter().flat_map(move |&y| steps.map(|z| vec3(x, y, z))));
    let rays: Vec<Ray> = dirs
        .filter(|direction| !direction.to_array().iter().all(|x| zeros.contains(x)))
        .flat_map(|direction| starts.map(|start| Ray::new(start, direction)))
        .collect();
    for (name, things, resolution) in [
        ("27 spheres", lattice, uvec3(4, 4, 4)),
        ("a room", walls, uvec3(4, 4, 4)),
        ("flat tiles", flat, uvec3(6, 6, 1)),
    ] {
        let scene = Scene::new(things);
        // Leave no room around the boxes, so that walls lie exactly in the faces of the grid.
        let boxes = scene.boxes();
        let all = checks::tree::around(&boxes);
        let queries = grid_queries(&scene, &rays, (all, around_loosely(&boxes).1), resolution);
        for (query, yours) in queries.iter().zip(trial.kit.grid_search(&queries)) {
            judge(&format!("grid of {resolution} cells over {name}"), &query.ray, &query.hits, &yours)?;
        }
    }
    Ok(())
}
