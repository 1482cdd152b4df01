//! The picture of stage 9: a spiral staircase, searched in another structure in each sixth of the picture.

use super::scenes::{Scene, Thing};
use super::searches::queries;
use checks::picture::{self, Composed, SMALL};
use checks::prelude::*;
use raykata::partition::{KdHeuristics, Tree};
use std::f32::consts::TAU;

/// The steps of the staircase.
const STEPS: u8 = 26;

/// A staircase around the vertical axis: each step has two triangles. `turns` is the number of its turns.
fn staircase(turns: f32, radius: f32) -> Scene {
    let step = |i: u8| {
        let share = f32::from(i) / f32::from(STEPS);
        let along = |share: f32, distance: f32| {
            let (sin, cos) = (TAU * turns * share).sin_cos();
            vec3(distance * cos, 2.6 * share - 1.3, distance * sin)
        };
        let (begin, end) = (share, share + 0.8 / f32::from(STEPS));
        let [a, b] = [along(begin, 0.35), along(begin, radius)];
        let [c, d] = [along(end, radius), along(end, 0.35)].map(|p| vec3(p.x, a.y, p.z));
        [Thing::Tile(Triangle { a, b, c }), Thing::Tile(Triangle { a, b: c, c: d })]
    };
    // A hexagonal column in the middle, and the ground.
    let corner = |i: u8, y: f32| {
        let (sin, cos) = (TAU * f32::from(i % 6) / 6.0).sin_cos();
        vec3(0.33 * cos, y, 0.33 * sin)
    };
    let column = |i: u8| [corner(i, -1.35), corner(i + 1, -1.35), corner(i + 1, 1.35), corner(i, 1.35)];
    let ground =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| vec3(1.9 * x, -1.35, 1.9 * z));
    let squares = (0..6).map(column).chain([ground]);
    let squares = squares.flat_map(|[a, b, c, d]| {
        [Thing::Tile(Triangle { a, b, c }), Thing::Tile(Triangle { a, b: c, c: d })]
    });
    Scene::new((0..STEPS).flat_map(step).chain(squares).collect())
}

/// The most numbers of a structure over this scene; those of the reference have some hundred. Each query contains its
/// structure, so a larger one would fill the memory of a judge. It is not searched, and nothing is seen in it.
const MOST_NUMBERS: usize = 20_000;

/// The answers to the rays, which are in six groups. Each is searched in a structure that the same kit has built.
fn answers(kit: &dyn Kit, scene: &Scene, groups: &[Vec<Ray>; 6]) -> Vec<Vec<CellsAnswer>> {
    let (boxes, hulls) = (scene.boxes(), scene.hulls());
    let all = checks::tree::around(&boxes);
    let resolution = ResolutionQuery { bounds: all, n_primitives: boxes.len(), density: 3.0 };
    let resolution = kit.grid_resolution(&[resolution]).remove(0);
    let grid = kit.grid_build(&[GridQuery { bounds: boxes.clone(), resolution }]).remove(0);
    let octree = OctreeQuery { bounds: boxes.clone(), leaf_size: 4, max_depth: 4 };
    let octree = kit.octree_build(&[octree]).remove(0);
    let kd_tree = KdQuery { bounds: boxes, heuristics: KdHeuristics::default(), leaf_size: 4 };
    let kd_tree = kit.kd_build(&[kd_tree]).remove(0);
    let hulls = BspQuery { hulls, leaf_size: 4, max_depth: 6 };
    let bsp = kit.bsp_build(std::slice::from_ref(&hulls)).remove(0);
    let polygon_bsp = kit.polygon_bsp_build(&[hulls]).remove(0);
    let rays = |numbers: usize, group: usize| -> &[Ray] {
        if numbers > MOST_NUMBERS { &[] } else { &groups[group] }
    };
    vec![
        kit.grid_search(&queries(&grid, scene, rays(grid.starts.len() + grid.items.len(), 0))),
        kit.octree_by_cells(&queries(&octree, scene, rays(numbers(&octree), 1))),
        kit.octree_search(&queries(&octree, scene, rays(numbers(&octree), 2))),
        kit.kd_search(&queries(&kd_tree, scene, rays(numbers(&kd_tree), 3))),
        kit.bsp_search(&queries(&bsp, scene, rays(numbers(&bsp), 4))),
        kit.polygon_bsp_search(&queries(&polygon_bsp, scene, rays(numbers(&polygon_bsp), 5))),
    ]
}

fn numbers<N>(tree: &Tree<N>) -> usize {
    tree.nodes.len() + tree.items.len()
}

/// The colour of a hit: each step has another hue, and what is near the camera is bright.
fn color(answer: &CellsAnswer) -> Vec3 {
    let Some(hit) = answer.hit else { return Vec3::ZERO };
    let turn = TAU * 0.8 * (hit.primitive / 2) as f32 / f32::from(STEPS);
    let is_step = hit.primitive / 2 < u32::from(STEPS);
    let hue = if is_step {
        0.5 + 0.5 * vec3(turn.cos(), (turn - 2.1).cos(), (turn + 2.1).cos())
    } else {
        Vec3::splat(0.45)
    };
    ((6.4 - hit.t) / 3.6).clamp(0.05, 1.0) * (0.25 + 0.75 * hue)
}

pub(super) fn picture_searched_in_six_structures(trial: &Trial<'_>) -> CheckResult {
    let (turns, radius) = trial.composed((1.4, 1.5), (1.0..2f32, 1.2..1.7f32));
    let scene = staircase(turns, radius);
    let rays = picture::rays(trial, SMALL, vec3(0.6, 2.4, 3.9), vec3(0.0, -0.15, 0.0));
    // Six columns of the picture, from the left to the right.
    let band = |index: usize| 6 * picture::column(trial, SMALL, index) / SMALL.width as usize;
    let groups: [Vec<Ray>; 6] = std::array::from_fn(|group| {
        (0..rays.len()).filter(|&index| band(index) == group).map(|index| rays[index]).collect()
    });
    let colors = |kit: &dyn Kit| {
        let mut answers = answers(kit, &scene, &groups).into_iter().map(Vec::into_iter).collect::<Vec<_>>();
        (0..rays.len())
            .map(|index| answers[band(index)].next().map_or(Vec3::ZERO, |answer| color(&answer)))
            .collect()
    };
    // The answers come from a table, so no pixel may differ.
    let composed = Composed { name: "stage9_six_structures", size: SMALL, rays: &rays, may_differ: 0.0 };
    composed.check(trial, colors)
}
