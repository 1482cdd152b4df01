//! The laws that the five searches of cells share.

use super::scenes::{Scene, Thing, closest, odd_scenes, scenes, sphere};
use super::structures;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::known;
use checks::paste::Paste;
use glam::{UVec3, Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{CellsAnswer, CellsQuery, Kit};
use raykata::partition::Grid;
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// One of the student's five searches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Searcher {
    Grid,
    OctreeByCells,
    Octree,
    KdTree,
    Bsp,
}

impl Searcher {
    /// Its name in messages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Searcher::Grid => "grid",
            Searcher::OctreeByCells => "octree, cell by cell",
            Searcher::Octree => "octree",
            Searcher::KdTree => "kd-tree",
            Searcher::Bsp => "BSP tree",
        }
    }

    /// Searches for all rays at once, in a structure over `scene` that the checks have built.
    pub(super) fn ask(self, kit: &dyn Kit, scene: &Scene, rays: &[Ray]) -> Vec<CellsAnswer> {
        let depth = match self {
            Searcher::Grid | Searcher::OctreeByCells | Searcher::Octree => 3,
            Searcher::KdTree => 7,
            Searcher::Bsp => 6,
        };
        self.ask_to(depth, kit, scene, rays)
    }

    /// The same in a tree that is divided to this depth; 0 is one leaf.
    fn ask_to(self, depth: usize, kit: &dyn Kit, scene: &Scene, rays: &[Ray]) -> Vec<CellsAnswer> {
        let boxes = scene.boxes();
        match self {
            Searcher::Grid => {
                let bounds = structures::around_loosely(&boxes);
                kit.grid_search(&grid_queries(scene, rays, bounds, UVec3::new(5, 4, 3)))
            }
            Searcher::OctreeByCells => {
                kit.octree_by_cells(&queries(&structures::octree(&boxes, depth), scene, rays))
            }
            Searcher::Octree => kit.octree_search(&queries(&structures::octree(&boxes, depth), scene, rays)),
            Searcher::KdTree => kit.kd_search(&queries(&structures::kd_tree(&boxes, depth), scene, rays)),
            Searcher::Bsp => kit.bsp_search(&queries(&structures::bsp(&scene.hulls(), depth), scene, rays)),
        }
    }
}

/// One query per ray.
pub(super) fn queries<S: Clone>(cells: &S, scene: &Scene, rays: &[Ray]) -> Vec<CellsQuery<S>> {
    let query = |ray: &Ray| CellsQuery { cells: cells.clone(), ray: *ray, hits: scene.hits(ray) };
    rays.iter().map(query).collect()
}

/// One query per ray, each with its own grid.
pub(super) fn grid_queries(
    scene: &Scene,
    rays: &[Ray],
    bounds: (Aabb, f64),
    resolution: UVec3,
) -> Vec<CellsQuery<Grid>> {
    let query = |ray: &Ray| CellsQuery {
        cells: structures::grid_for(ray, scene, bounds, resolution),
        ray: *ray,
        hits: scene.hits(ray),
    };
    rays.iter().map(query).collect()
}

/// Small spheres at `places`, and rays at every `step`th of them from three points, one of which has the x coordinate
/// `x`.
pub(super) fn spheres_and_rays(places: &[Vec3], step: usize, x: f32) -> (Scene, Vec<Ray>) {
    let spheres = places.iter().map(|&center| Thing::Sphere(Sphere { center, radius: 0.3 }));
    let eyes = [vec3(-4.0, 1.1, 1.2), vec3(x, 6.0, 5.0), vec3(3.5, -6.0, 1.5)];
    let at =
        |eye: Vec3| places.iter().step_by(step).map(move |place| Ray::new(eye, (*place - eye).normalize()));
    (Scene::new(spheres.collect()), eyes.into_iter().flat_map(at).collect())
}

/// Compares the answer with that of brute force.
pub(super) fn judge(what: &str, ray: &Ray, hits: &[f32], yours: &CellsAnswer) -> CheckResult {
    let expected = closest(hits, ray);
    let found = yours.hit.map(|hit| (hit.primitive, hit.t));
    if found == expected {
        return Ok(());
    }
    let tested = expected.is_some_and(|(primitive, _)| yours.tests.contains(&primitive));
    let diagnosis = match (found, expected) {
        (Some((_, t)), _) if !ray.contains(t) => "you return a hit outside the ray's range",
        (Some((_, t)), Some((_, best))) if t == best => {
            "of two hits at the same t the smaller primitive number wins"
        }
        (Some(_), Some(_)) if tested => {
            "you keep the farther of two hits: keep the best hit so far, over all cells"
        }
        (Some(_), Some(_)) => "you stop before a cell with a nearer hit",
        (None, Some(_)) if tested => "you find a hit and reject it: it counts wherever its cell ends",
        (None, Some(_)) if yours.visits.is_empty() => {
            "you visit no cell although the ray enters the structure's bounds"
        }
        (None, Some(_)) => "you leave out a cell that the ray passes through",
        _ => "",
    };
    let hits: Vec<String> = hits
        .iter()
        .enumerate()
        .filter(|(_, t)| t.is_finite())
        .take(8)
        .map(|(i, t)| format!("{i} at t = {t}"))
        .collect();
    let input = format!("{what}\n{}\nhits: {}", ray.paste(), hits.join(", "));
    Err(Broken::new(input, found, expected, "brute force, (primitive, t)").looks_like(known(diagnosis)))
}

/// Compares a search with brute force, in random scenes and in degenerate ones.
pub(super) fn agrees(trial: &Trial<'_>, searcher: Searcher) -> CheckResult {
    // Three spheres in a row in one leaf, the nearest of them listed last; and a large sphere that overlaps many cells,
    // with a nearer small one before it.
    let row = Scene::new((0..3).map(|i| sphere(2.0 * i as f32, 0.0, 0.0, 0.5)).collect());
    let large = Thing::Sphere(Sphere { center: vec3(9.0, 4.0, 0.0), radius: 4.25 });
    let small = (0..8).map(|i| sphere(7.0, 0.8 * (i % 4) as f32, (i / 4) as f32, 0.25));
    let through = Scene::new([large].into_iter().chain(small).collect());
    let ray = Ray::new(vec3(-3.0, 0.0, 0.0), Vec3::X);
    let in_a_row = searcher.ask_to(0, trial.kit, &row, &[ray]);
    let passing = searcher.ask(trial.kit, &through, &[ray]);
    for (name, scene, yours) in
        [("three spheres in a row", row, in_a_row), ("a large sphere and eight small ones", through, passing)]
    {
        let [yours] = &yours[..] else { continue };
        judge(&format!("{} over {name}", searcher.name()), &ray, &scene.hits(&ray), yours)?;
    }
    trial.forall(500, scenes(), |cases| {
        let one = |(scene, ray): &(Scene, Ray)| {
            let answer = searcher.ask(trial.kit, scene, std::slice::from_ref(ray)).remove(0);
            let what = format!("{} over {} primitives", searcher.name(), scene.things.len());
            judge(&what, ray, &scene.hits(ray), &answer)
        };
        cases.iter().map(one).collect()
    })?;
    for (name, scene, rays) in odd_scenes() {
        let answers = searcher.ask(trial.kit, &scene, &rays);
        for (ray, answer) in rays.iter().zip(&answers) {
            judge(&format!("{} over {name}", searcher.name()), ray, &scene.hits(ray), answer)?;
        }
    }
    Ok(())
}

/// The interval of a ray in each node of a structure: `(node, entry, exit)`, in double precision.
pub(super) type Parts = Vec<(u32, f64, f64)>;

/// Judges the visits of a search: the ray must enter each visited node before its hit. `parts` are all nodes that the
/// ray enters or touches.
pub(super) fn judge_visits(
    what: &str,
    ray: &Ray,
    parts: &Parts,
    yours: &CellsAnswer,
    fewest: bool,
) -> CheckResult {
    let end = yours.hit.map_or(f64::INFINITY, |hit| f64::from(hit.t)).min(f64::from(ray.t_max));
    // Allow 2⁻¹⁴, which is far more than rounding errors and far less than a cell.
    let room = (-14f64).exp2();
    let input = || format!("{what}\n{}", ray.paste());
    for visit in &yours.visits {
        let Some((_, enter, _)) = parts.iter().find(|(node, ..)| node == visit) else {
            let broken =
                Broken::with_texts(input(), format!("a visit to {visit}"), "none", "the ray misses it");
            return Err(broken.looks_like(Some("you visit a cell that the ray does not enter")));
        };
        if *enter > end + room * end.abs() {
            let yours = format!("a visit to {visit}, which begins at t = {enter:.4}");
            let expected = format!("none beyond the hit at t = {end}");
            let broken = Broken::with_texts(input(), yours, expected, "counted");
            return Err(broken.looks_like(Some(
                "the search goes on behind the best hit: visit the nearest cells first, and stop at a cell that begins behind the hit",
            )));
        }
        if fewest && yours.visits.iter().filter(|other| *other == visit).count() > 1 {
            let broken = Broken::with_texts(input(), format!("{visit} is visited again"), "once", "counted");
            return Err(broken.looks_like(Some("you visit a cell several times")));
        }
    }
    Ok(())
}
