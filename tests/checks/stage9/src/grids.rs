//! The laws of the uniform grid: which primitives each cell lists, and the search.

use super::lists::{Fault, fact, listing_fault, some_boxes};
use super::parts;
use super::scenes::{Scales, Scene, Thing, along, lattice, rays, scales, sphere, straight, wall};
use super::searches::{Described, GRID, grid_queries};
use super::structures::{around_loosely, filled};
use checks::prelude::*;
use glam::{UVec3, uvec3};
use raykata::partition::{Cell, Grid};

pub(super) fn grid_lists_what_reaches_into_cells(trial: &Trial<'_>) -> CheckResult {
    let inputs = (some_boxes(), 1..=6u32, 1..=5u32, 1..=4u32)
        .prop_map(|(bounds, x, y, z)| GridQuery { bounds, resolution: uvec3(x, y, z) });
    let none = GridQuery { bounds: Vec::new(), resolution: UVec3::splat(2) };
    let flat =
        GridQuery { bounds: vec![Aabb::new(Vec3::ZERO, vec3(4.0, 4.0, 0.0)); 3], resolution: uvec3(4, 4, 1) };
    trial.forall_and(&[none, flat], 140, inputs, |queries| judge_grids(trial, queries))
}

fn judge_grids(trial: &Trial<'_>, queries: &[GridQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.grid_build(queries), |query, yours| match grid_fault(query, &yours) {
        None => Ok(()),
        Some((yours, expected, mistakes)) => {
            let input = format!("build(&{}, {})", checks::paste::list(&query.bounds), query.resolution);
            Err(Broken::with_texts(input, yours, expected, "the definition of a grid").explained_by(mistakes))
        }
    })
}

fn grid_fault(query: &GridQuery, grid: &Grid) -> Option<Fault> {
    let n: u32 = query.resolution.element_product();
    let in_order = grid.starts.windows(2).all(|pair| pair[0] <= pair[1]);
    let ends = grid.starts.last().is_some_and(|last| *last as usize == grid.items.len());
    if grid.resolution != query.resolution || grid.starts.len() != n as usize + 1 || !in_order || !ends {
        let yours = format!("{} cells, starts {:?}", grid.resolution, grid.starts);
        let expected = format!("{n} cells, ascending starts, and the number of items as the last one");
        return Some((yours, expected, Vec::new()));
    }
    // The lists if cells are numbered along x first, or along z first.
    let fault = |z_first: bool| {
        let listed = |(number, at, cell): (u32, UVec3, Cell)| {
            let other = (at.x * grid.resolution.y + at.y) * grid.resolution.z + at.z;
            (at, cell, grid.primitives(if z_first { other } else { number }).to_vec())
        };
        listing_fault(
            "cell",
            &grid.bounds,
            &query.bounds,
            &parts::numbered(grid).map(listed).collect::<Vec<_>>(),
        )
    };
    let is_turned = |(yours, expected, mistakes): Fault| match fault(true) {
        None => fact(yours, expected, "the cells are numbered along z first: x counts fastest"),
        Some(_) => (yours, expected, mistakes),
    };
    fault(false).map(is_turned)
}

/// A large sphere of the first cell is hit in the third cell, and a small one in the second cell is nearer.
pub(super) fn grid_hit_beyond_its_cell_waits(trial: &Trial<'_>) -> CheckResult {
    let mut asked = Described::new();
    for axis in 0..3 {
        let turn = |v: Vec3| along(axis, v);
        let place = |center: Vec3, radius: f32| Thing::Sphere(Sphere { center: turn(center), radius });
        let scene = Scene::new(vec![
            place(vec3(5.0, 2.0, 0.0), 2.25),
            place(vec3(3.5, 0.0, 0.0), 0.25),
            place(vec3(0.0, 3.0, 0.0), 0.5),
        ]);
        // The large sphere is listed from the first cell on, as a longer primitive would be.
        let bounds = Aabb::new(turn(vec3(0.0, -4.0, -4.0)), turn(vec3(8.0, 4.5, 4.0)));
        let resolution = turn(vec3(4.0, 1.0, 1.0)).as_uvec3();
        let cells = filled(bounds, resolution, &[vec![2, 0], vec![1, 0], vec![0], vec![0]]);
        let ray = Ray::new(turn(vec3(-1.0, 0.0, 0.0)), turn(vec3(1.0, 0.01, 0.01)));
        asked.ask("grid of 4 cells in a row; all of them list primitive 0", &cells, &scene, ray);
        let control = filled(bounds, resolution, &[vec![0, 1, 2], vec![], vec![], vec![]]);
        asked.control("grid", control, ray, (1.0, 3.0));
    }
    asked.judge(trial.kit, &GRID)
}

fn bare_grid(bounds: Aabb, resolution: UVec3) -> Grid {
    let n = resolution.element_product() as usize;
    Grid { bounds, resolution, starts: vec![0; n + 1], items: Vec::new() }
}

pub(super) fn grid_visits_cells_in_order_and_stops(trial: &Trial<'_>) -> CheckResult {
    // This ray crosses the edge x = 0, z = 0.5 between four cells.
    let at_edge = Ray::new(vec3(-7.0, 1.0, -6.5), vec3(1.0, 0.01, 1.0));
    let at_edge = (at_edge, Scales { size: 1.0, speed: 1.0 });
    trial.forall_and(&[at_edge], 200, (rays(), scales()), |rays| {
        let query = |(ray, scales): &(Ray, Scales)| {
            let bounds = Aabb::new(scales.size * Vec3::splat(-5.0), scales.size * vec3(5.0, 4.0, 6.0));
            let cells = bare_grid(bounds, uvec3(6, 5, 4));
            let ray = Ray { direction: nasty::slanted(ray.direction), ..*ray };
            CellsQuery { cells, ray: scales.of_ray(&ray), hits: Vec::new() }
        };
        let queries: Vec<CellsQuery<Grid>> = rays.iter().map(query).collect();
        compare(&queries, trial.kit.grid_search(&queries), |query, yours| judge_way(query, &yours.visits))
    })?;
    // A row of spheres of which the first is hit: the cells behind it must not be visited.
    let row = Scene::new((0..32).map(|i| sphere(i as f32, 0.0, 0.0, 0.25)).collect());
    let rays = [(-2.0, 1.0), (40.0, -1.0)].map(|(x, way)| Ray::new(vec3(x, 0.0, 0.0), vec3(way, 1e-3, 1e-3)));
    let queries = grid_queries(&row, &rays, around_loosely(&row.boxes()), uvec3(32, 1, 1));
    GRID.visits(trial.kit, "grid over a row of 32 spheres", &queries)
}

const FARTHEST_FACE: &str =
    "you step across the farthest of the three faces: step along the axis whose plane comes first";

/// The visits of a search that steps across the farthest of the three faces. It begins at the `t` of the entry, or earlier by
/// this share of it.
fn across_the_farthest(query: &CellsQuery<Grid>, earlier: f64) -> Vec<u32> {
    let (grid, ray) = (&query.cells, &query.ray);
    let bounds = Cell::new(&grid.bounds);
    let Some((enter, leave)) = parts::exactly(ray, &bounds) else { return Vec::new() };
    let enter = enter * (1.0 - earlier);
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let share =
        (origin + enter * direction - bounds.min) / (bounds.max - bounds.min) * grid.resolution.as_dvec3();
    let mut cell = share.max(DVec3::ZERO).as_uvec3().min(grid.resolution - 1);
    let mut visits = vec![grid.number(cell)];
    loop {
        let exit = |axis: usize| {
            let far = grid.plane(axis, cell[axis] + u32::from(direction[axis] > 0.0));
            (far - origin[axis]) / direction[axis]
        };
        let moving = (0..3).filter(|&axis| direction[axis] != 0.0);
        let Some(axis) = moving.reduce(|p, q| if exit(q) > exit(p) { q } else { p }) else { return visits };
        let at_the_end =
            if direction[axis] > 0.0 { cell[axis] + 1 == grid.resolution[axis] } else { cell[axis] == 0 };
        if exit(axis) > leave || at_the_end {
            return visits;
        }
        cell[axis] = if direction[axis] > 0.0 { cell[axis] + 1 } else { cell[axis] - 1 };
        visits.push(grid.number(cell));
    }
}

/// Whether the visits to empty cells are those of the ray.
fn judge_way(query: &CellsQuery<Grid>, visits: &[u32]) -> CheckResult {
    let parts = parts::of_grid(&query.cells, &query.ray, parts::touching);
    let is_entered = |visit: u32| parts.iter().any(|(cell, ..)| *cell == visit);
    // The search must visit each cell through whose inside the ray passes, and may visit cells that the ray touches.
    let inside = parts::of_grid(&query.cells, &query.ray, parts::well_inside);
    let left_out = inside.iter().find(|(cell, ..)| !visits.contains(cell));
    let missed = visits.iter().find(|&&visit| !is_entered(visit));
    let twice = (0..visits.len()).find(|&index| visits[..index].contains(&visits[index]));
    let near = |visit: &u32| parts.iter().find(|(cell, ..)| cell == visit).map(|(_, near, _)| *near);
    let nears: Vec<f64> = visits.iter().filter_map(near).collect();
    // Allow the `t` of a 256th of the shortest side of a cell.
    let sides = (query.cells.bounds.max - query.cells.bounds.min) / query.cells.resolution.as_vec3();
    let room = f64::from(sides.min_element() / query.ray.direction.length()) / 256.0;
    let backwards = nears.windows(2).any(|pair| pair[1] < pair[0] - room);
    let at =
        |visit: u32| parts::numbered(&query.cells).find(|(cell, ..)| *cell == visit).map(|(_, at, _)| at);
    let is_apart = |p: UVec3, q: UVec3| (p.as_dvec3() - q.as_dvec3()).abs().element_sum() > 1.0;
    let apart =
        visits.windows(2).any(|pair| at(pair[0]).zip(at(pair[1])).is_some_and(|(p, q)| is_apart(p, q)));
    let (yours, expected) = match (left_out, missed, twice) {
        (Some((cell, near, far)), ..) => (
            format!("visits to {visits:?}"),
            format!("a visit to {cell}, in which the ray is from t = {near:.3} to {far:.3}"),
        ),
        (_, Some(visit), _) => (format!("a visit to {visit}"), "none".into()),
        (.., Some(index)) => (format!("{} is visited twice", visits[index]), "once".into()),
        _ if backwards => {
            (format!("visits to {visits:?}"), "cells in the order in which the ray enters them".into())
        }
        _ if apart => (format!("visits to {visits:?}"), "each cell shares a face with the next one".into()),
        _ => return Ok(()),
    };
    let input = format!("grid of {} cells without primitives\n{}", query.cells.resolution, query.ray.paste());
    Err(Broken::with_texts(input, yours, expected, "every cell tested in double precision").explained_by([
        "you do not find the first cell: clip the ray to the grid's bounds, and start there"
            .when(left_out.is_some() && visits.is_empty()),
        (visits == across_the_farthest(query, 0.0), FARTHEST_FACE),
        (visits == across_the_farthest(query, 1e-6), FARTHEST_FACE),
        (missed.is_some(), "you visit a cell that the ray does not enter"),
        (twice.is_some(), "you visit a cell twice"),
        (backwards, "you do not visit the cells in the order of t"),
        (apart, "you step across an edge: at a corner, step along one axis after the other"),
    ]))
}

const ADDED_UP: &str = "tMax += tDelta accumulates one rounding error per step: compute t from the index of the cell, in double precision";

const IN_SINGLE: &str = "you compute the t of a plane in single precision, which cannot tell these corners apart: use double precision";

/// Rays over 250 cells along an axis: rounding errors of the steps must not add up.
pub(super) fn grid_steps_do_not_add_up_roundings(trial: &Trial<'_>) -> CheckResult {
    // The cell sides are not powers of two, so that each step is rounded. Cells are twice as long along the second axis, so
    // that one axis takes twice as many steps as the other.
    let query = |(axes, off): ([usize; 2], f32)| {
        let turn = |x: f32, y: f32, z: f32| along(axes[0], vec3(x, y, z));
        let bounds = Aabb::new(turn(1.1, 2.3, -3.7), turn(2.4, 3.6, -2.4));
        let cells = bare_grid(bounds, turn(250.0, 125.0, 1.0).as_uvec3());
        // Aim just beside corners: the distances that decide the next cell are small, but far above the error of an f64.
        let ray = Ray::new(turn(1.1 - 0.5, 2.3 - 0.5 + off, -3.0), turn(1.0, 1.0, 0.0));
        (CellsQuery { cells, ray, hits: Vec::new() }, axes)
    };
    let pairs = [[0, 1], [1, 2], [2, 0]];
    let offs = [7e-7f32, -7e-7, 1.2e-6, -1.2e-6];
    let asked: Vec<_> = pairs.into_iter().flat_map(|axes| offs.map(|off| (axes, off))).map(query).collect();
    let queries: Vec<CellsQuery<Grid>> = asked.iter().map(|(query, _)| query.clone()).collect();
    all_hold(compare(&asked, trial.kit.grid_search(&queries), |(query, axes), yours| {
        let axes = *axes;
        let expected = in_double(query, axes);
        let Some(at) = (0..expected.len()).find(|&i| yours.visits.get(i) != Some(&expected[i])) else {
            return Ok(());
        };
        let describe = |cells: &[u32]| {
            format!("{at} cells, then {:?}", &cells[at.min(cells.len())..cells.len().min(at + 3)])
        };
        let input = format!("a ray beside the diagonal of a grid of 250 × 125 cells\n{}", query.ray.paste());
        let yours = yours.visits;
        let adds_up = |rounded_once, tie| yours == added_up(query, axes, rounded_once, tie);
        let texts = (describe(&yours), describe(&expected));
        Err(Broken::with_texts(input, texts.0, texts.1, "planes in double precision").explained_by([
            (adds_up(true, Tie::Smaller), ADDED_UP),
            (adds_up(true, Tie::Larger), ADDED_UP),
            (adds_up(false, Tie::Smaller), ADDED_UP),
            (adds_up(false, Tie::Larger), ADDED_UP),
            (yours == in_single(query, axes, Tie::Smaller), IN_SINGLE),
            (yours == in_single(query, axes, Tie::Larger), IN_SINGLE),
        ]))
    }))
}

/// The axis along which a search steps if it computes the same `t` for both: that with the smaller number, or the larger one.
#[derive(Clone, Copy, PartialEq)]
enum Tie {
    Smaller,
    Larger,
}

/// The visits of a ray whose direction is positive along two axes. `t` is that of the plane with an index across one of them.
fn visits_by(
    query: &CellsQuery<Grid>,
    axes: [usize; 2],
    tie: Tie,
    t: impl Fn(usize, u32) -> f64,
) -> Vec<u32> {
    let is_first_at_ties = (axes[0] < axes[1]) == (tie == Tie::Smaller);
    let grid = &query.cells;
    let mut cell = UVec3::ZERO;
    let mut visits = vec![grid.number(cell)];
    loop {
        let [p, q] = axes.map(|axis| t(axis, cell[axis] + 1));
        let axis = if p < q || (p == q && is_first_at_ties) { axes[0] } else { axes[1] };
        if cell[axis] + 1 == grid.resolution[axis] {
            return visits;
        }
        cell[axis] += 1;
        visits.push(grid.number(cell));
    }
}

/// The visits of a search that adds up tDelta in single precision. The first `t` and the step are rounded once, or computed in
/// single precision.
fn added_up(query: &CellsQuery<Grid>, axes: [usize; 2], rounded_once: bool, tie: Tie) -> Vec<u32> {
    let (grid, ray) = (&query.cells, &query.ray);
    let sums = [0, 1, 2].map(|axis| {
        let (low, high) = (grid.bounds.min[axis], grid.bounds.max[axis]);
        let n = grid.resolution[axis];
        let (first, delta) = if rounded_once {
            let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
            let size = (f64::from(high) - f64::from(low)) / f64::from(n);
            (((grid.plane(axis, 1) - o) / d) as f32, (size / d) as f32)
        } else {
            let size = (high - low) / n as f32;
            ((low + size - ray.origin[axis]) / ray.direction[axis], size / ray.direction[axis])
        };
        let mut sums = vec![f32::NAN, first];
        (1..n as usize).for_each(|i| sums.push(sums[i] + delta));
        sums
    });
    visits_by(query, axes, tie, |axis, index| f64::from(sums[axis][index as usize]))
}

/// The visits of a search that computes the `t` of each plane in single precision.
fn in_single(query: &CellsQuery<Grid>, axes: [usize; 2], tie: Tie) -> Vec<u32> {
    let (grid, ray) = (&query.cells, &query.ray);
    visits_by(query, axes, tie, |axis, index| {
        f64::from((grid.plane(axis, index) as f32 - ray.origin[axis]) / ray.direction[axis])
    })
}

/// The visits of a search that computes the `t` of each plane in double precision, in which no two planes have the same.
fn in_double(query: &CellsQuery<Grid>, axes: [usize; 2]) -> Vec<u32> {
    let (grid, ray) = (&query.cells, &query.ray);
    visits_by(query, axes, Tie::Smaller, |axis, index| {
        (grid.plane(axis, index) - f64::from(ray.origin[axis])) / f64::from(ray.direction[axis])
    })
}

/// Rays through corners of cells, from faces, along faces and in a flat grid.
pub(super) fn grid_takes_rays_through_corners_and_faces(trial: &Trial<'_>) -> CheckResult {
    let walls: Vec<Thing> =
        (0..3).flat_map(|axis| [wall(axis, -2.0, 2.0), wall(axis, 2.0, 2.0)]).flatten().collect();
    let flat: Vec<Thing> = [1.0, 2.0, 3.0].into_iter().flat_map(|size| wall(2, 0.0, size)).collect();
    let starts =
        [vec3(-3.0, -3.0, -3.0), Vec3::ZERO, vec3(2.0, 2.0, 2.0), vec3(-2.0, 0.0, 1.0), vec3(1.0, 1.0, -4.0)];
    let rays: Vec<Ray> =
        straight().flat_map(|direction| starts.map(|start| Ray::new(start, direction))).collect();
    for (name, things, resolution) in [
        ("27 spheres", lattice(2.0), uvec3(4, 4, 4)),
        ("a room", walls, uvec3(4, 4, 4)),
        ("flat tiles", flat, uvec3(6, 6, 1)),
    ] {
        let scene = Scene::new(things);
        // Leave no room around the boxes, so that walls lie exactly in the faces of the grid.
        let boxes = scene.boxes();
        let all = checks::tree::around(&boxes);
        let mut asked = Described::new();
        for query in grid_queries(&scene, &rays, (all, around_loosely(&boxes).1), resolution) {
            asked.add(format!("grid of {resolution} cells over {name}"), query);
        }
        // A hit on the far face of a cell that is not the last one: it shows why a hit on the last face is lost.
        let bounds = Aabb::new(Vec3::NEG_ONE, vec3(3.0, 1.0, 1.0));
        let cells = filled(bounds, uvec3(2, 1, 1), &[vec![0], vec![]]);
        let ray = Ray::new(vec3(-2.0, 0.0, 0.0), Vec3::X);
        asked.add(
            "grid of 2 cells in a row, and a hit on the face between them",
            CellsQuery { cells, ray, hits: vec![3.0] },
        );
        asked.judge(trial.kit, &GRID)?;
    }
    beside_faces(trial)
}

/// Rays along a face between two cells, at a distance from it that is lost when the index of the cell is computed by a
/// division; and rays whose range begins one float before a face.
fn beside_faces(trial: &Trial<'_>) -> CheckResult {
    let mut asked = Described::new();
    for axis in 0..3 {
        let turn = |v: Vec3| along(axis, v);
        // Each cell has the side 1, and the face between the first two cells is at 0. Only the cell of the ray lists the
        // primitive. The quotient for cell 1 is rounded to 1 of 3 cells, and below 1 of 49 cells.
        for (n, at) in [(3, -1e-20), (3, 1e-20), (49, -1e-20), (49, 1e-20)] {
            let bounds = Aabb::new(turn(Vec3::NEG_ONE), turn(vec3(n as f32 - 1.0, 1.0, 1.0)));
            let mut lists = vec![vec![]; n];
            lists[usize::from(at > 0.0)] = vec![0];
            let cells = filled(bounds, turn(vec3(n as f32, 1.0, 1.0)).as_uvec3(), &lists);
            let ray = Ray::new(turn(vec3(at, -3.0, 0.0)), turn(Vec3::Y));
            let what = format!("grid of {n} cells in a row, and a ray beside the face between two of them");
            asked.add(what, CellsQuery { cells, ray, hits: vec![3.0] });
        }
        let bounds = Aabb::new(turn(Vec3::NEG_ONE), turn(vec3(3.0, 1.0, 1.0)));
        let cells = filled(bounds, turn(vec3(2.0, 1.0, 1.0)).as_uvec3(), &[vec![0], vec![]]);
        let hit = 3f32.next_down();
        let ray =
            Ray::new(turn(vec3(-2.0, 0.0, 0.0)), turn(Vec3::X)).with_range(hit.next_down(), f32::INFINITY);
        let what =
            "grid of 2 cells in a row, and a ray whose range begins one float before a hit in the first cell";
        asked.add(what, CellsQuery { cells, ray, hits: vec![hit] });
    }
    asked.judge(trial.kit, &GRID)
}
