//! The laws that the seven searches of cells share.

use super::parts::Structure;
use super::scenes::{Scene, Thing, closest, odd_scenes, scenes, sphere};
use super::search_mistakes::{FIRST_CELL_ONLY, facts, in_cells};
use super::structures;
use checks::Trial;
use checks::broken::{Broken, CheckResult, all_hold};
use checks::paste::Paste;
use glam::{UVec3, Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{CellsAnswer, CellsQuery, Kit};
use raykata::partition::Grid;
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// One of the student's seven searches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Searcher {
    Grid,
    OctreeByCells,
    OctreeByNeighbours,
    Octree,
    KdTree,
    Bsp,
    PolygonBsp,
}

impl Searcher {
    /// Its name in messages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Searcher::Grid => "grid",
            Searcher::OctreeByCells => "octree, cell by cell",
            Searcher::OctreeByNeighbours => "octree, by neighbours",
            Searcher::Octree => "octree",
            Searcher::KdTree => "kd-tree",
            Searcher::Bsp => "BSP tree",
            Searcher::PolygonBsp => "BSP tree with polygons in its nodes",
        }
    }

    /// The depth of a structure over a scene.
    fn depth(self) -> usize {
        match self {
            Searcher::Grid | Searcher::OctreeByCells | Searcher::OctreeByNeighbours | Searcher::Octree => 3,
            Searcher::KdTree => 7,
            Searcher::Bsp | Searcher::PolygonBsp => 6,
        }
    }

    /// Searches for the rays of each case, in a structure over its scene that the checks have built, and judges the answers.
    pub(super) fn judge(self, kit: &dyn Kit, cases: &[Searched<'_>]) -> Vec<CheckResult> {
        let octrees =
            || Described::over(self, cases, |scene, depth| structures::octree(&scene.boxes(), depth));
        match self {
            Searcher::Grid => {
                let mut asked = Described::new();
                for Searched { name, scene, rays, one_leaf } in cases {
                    let bounds = structures::around_loosely(&scene.boxes());
                    let resolution = if *one_leaf { UVec3::ONE } else { UVec3::new(5, 4, 3) };
                    for query in grid_queries(scene, rays, bounds, resolution) {
                        asked.add(format!("grid over {name}"), query);
                    }
                }
                asked.judge_each(|queries| kit.grid_search(queries))
            }
            Searcher::OctreeByCells => octrees().judge_each(|queries| kit.octree_by_cells(queries)),
            Searcher::OctreeByNeighbours => octrees().judge_each(|queries| kit.octree_by_neighbours(queries)),
            Searcher::Octree => octrees().judge_each(|queries| kit.octree_search(queries)),
            Searcher::KdTree => {
                Described::over(self, cases, |scene, depth| structures::kd_tree(&scene.boxes(), depth))
                    .judge_each(|queries| kit.kd_search(queries))
            }
            Searcher::Bsp => {
                Described::over(self, cases, |scene, depth| structures::bsp(&scene.hulls(), depth))
                    .judge_each(|queries| kit.bsp_search(queries))
            }
            Searcher::PolygonBsp => {
                Described::over(self, cases, |scene, depth| structures::polygon_bsp(&scene.hulls(), depth))
                    .judge_each(|queries| kit.polygon_bsp_search(queries))
            }
        }
    }
}

/// Rays at a scene, in a structure that is divided, or in one with one leaf.
pub(super) struct Searched<'a> {
    name: String,
    scene: &'a Scene,
    rays: &'a [Ray],
    one_leaf: bool,
}

impl<'a> Searched<'a> {
    pub(super) fn new(name: impl Into<String>, scene: &'a Scene, rays: &'a [Ray]) -> Self {
        Searched { name: name.into(), scene, rays, one_leaf: false }
    }
}

/// Queries to a search, each with the text for its message.
pub(super) struct Described<S> {
    what: Vec<String>,
    queries: Vec<CellsQuery<S>>,
}

impl<S: Structure + Clone> Described<S> {
    pub(super) fn new() -> Self {
        Described { what: Vec::new(), queries: Vec::new() }
    }

    /// The rays of each case in the structure over its scene.
    fn over(searcher: Searcher, cases: &[Searched<'_>], build: impl Fn(&Scene, usize) -> S) -> Self {
        let mut asked = Described::new();
        for Searched { name, scene, rays, one_leaf } in cases {
            let depth = if *one_leaf { 0 } else { searcher.depth() };
            for query in queries(&build(scene, depth), scene, rays) {
                asked.add(format!("{} over {name}", searcher.name()), query);
            }
        }
        asked
    }

    /// A ray in a structure whose first leaf on the way lists 0, 1 and 2, of which 1 is nearest. All three are hit between
    /// these two `t`, in this leaf. A right answer here refutes the mistakes in testing the list of a leaf.
    pub(super) fn control(&mut self, what: &str, cells: S, ray: Ray, (t, t_end): (f32, f32)) {
        let hits = [0.75, 0.25, 0.875].map(|share| t + share * (t_end - t)).to_vec();
        self.add(format!("{what}; the first leaf lists three primitives"), CellsQuery { cells, ray, hits });
    }

    pub(super) fn add(&mut self, what: impl Into<String>, query: CellsQuery<S>) {
        self.what.push(what.into());
        self.queries.push(query);
    }

    /// Asks for the hit of one ray with a scene.
    pub(super) fn ask(&mut self, what: impl Into<String>, cells: &S, scene: &Scene, ray: Ray) {
        self.add(what, CellsQuery { cells: cells.clone(), ray, hits: scene.hits(&ray) });
    }

    /// Judges the answers of a search. A mistake is named only if it explains all wrong answers.
    pub(super) fn judge(&self, search: impl Fn(&[CellsQuery<S>]) -> Vec<CellsAnswer>) -> CheckResult {
        all_hold(self.judge_each(search))
    }

    fn judge_each(&self, search: impl Fn(&[CellsQuery<S>]) -> Vec<CellsAnswer>) -> Vec<CheckResult> {
        let answers = search(&self.queries);
        let found = |answer: &CellsAnswer| answer.hit.map(|hit| (hit.primitive, hit.t));
        let is_right =
            |query: &CellsQuery<S>, answer: &CellsAnswer| found(answer) == closest(&query.hits, &query.ray);
        let pairs = || self.queries.iter().zip(&answers);
        if pairs().all(|(query, answer)| is_right(query, answer)) {
            return vec![Ok(()); answers.len()];
        }
        // A wrong search that gives another answer than a right one of the student is not the student's.
        let formulas = |query: &CellsQuery<S>, answer: &CellsAnswer| {
            let mut all = in_cells(&query.cells.leaves(&query.ray), &query.ray, &query.hits, found(answer));
            // A search that visits two leaves searches more than the first cell.
            let n_leaves = answer.visits.iter().filter(|node| !query.cells.listed(**node).is_empty()).count();
            all.iter_mut().for_each(|one| one.0 &= n_leaves < 2 || one.1 != FIRST_CELL_ONLY);
            all.extend(query.cells.mistakes(&query.ray, &query.hits, found(answer)));
            all
        };
        let mut possible: Vec<bool> = Vec::new();
        for (query, answer) in pairs().filter(|(query, answer)| is_right(query, answer)) {
            let given = formulas(query, answer);
            possible.resize(given.len(), true);
            possible.iter_mut().zip(&given).for_each(|(possible, (gives, _))| *possible &= gives);
        }
        let judge = |((query, answer), what): ((&CellsQuery<S>, &CellsAnswer), &String)| {
            if is_right(query, answer) {
                return Ok(());
            }
            let mut proven = formulas(query, answer);
            proven.iter_mut().zip(&possible).for_each(|(mistake, possible)| mistake.0 &= possible);
            let input = (&query.ray, &query.hits[..]);
            let calls = (&answer.tests[..], &answer.visits[..]);
            proven.extend(facts(found(answer), calls, input, |node| query.cells.listed(node)));
            let expected = closest(&query.hits, &query.ray);
            Err(Broken::new(describe(what, query), found(answer), expected, "brute force, (primitive, t)")
                .explained_by(proven))
        };
        pairs().zip(&self.what).map(judge).collect()
    }
}

fn describe<S>(what: &str, query: &CellsQuery<S>) -> String {
    let hits = query.hits.iter().enumerate().filter(|(_, t)| t.is_finite()).take(8);
    let hits: Vec<String> = hits.map(|(i, t)| format!("{i} at t = {t}")).collect();
    format!("{what}\n{}\nhits: {}", query.ray.paste(), hits.join(", "))
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

/// Compares a search with brute force, in random scenes and in degenerate ones.
pub(super) fn agrees(trial: &Trial<'_>, searcher: Searcher) -> CheckResult {
    // Three spheres in a row in one leaf, the nearest of them listed last; and a large sphere that overlaps many cells,
    // with a nearer small one before it.
    let row = Scene::new((0..3).map(|i| sphere(2.0 * i as f32, 0.0, 0.0, 0.5)).collect());
    let large = Thing::Sphere(Sphere { center: vec3(9.0, 4.0, 0.0), radius: 4.25 });
    let small = (0..8).map(|i| sphere(7.0, 0.8 * (i % 4) as f32, (i / 4) as f32, 0.25));
    let through = Scene::new([large].into_iter().chain(small).collect());
    let rays = [Ray::new(vec3(-3.0, 0.0, 0.0), Vec3::X), Ray::new(vec3(9.0, 0.0, 0.0), Vec3::NEG_X)];
    let in_a_row = Searched { one_leaf: true, ..Searched::new("three spheres in a row", &row, &rays) };
    let passing = Searched::new("a large sphere and eight small ones", &through, &rays[..1]);
    // And rays from all directions at both scenes, which refute or confirm a mistake that one answer suggests.
    let around = |at: Vec3| {
        let look = move |forward: Vec3| Ray::new(at - 20.0 * forward, forward);
        checks::nasty::directions().into_iter().map(look).collect::<Vec<Ray>>()
    };
    let (at_row, at_small) = (around(vec3(2.0, 0.1, 0.2)), around(vec3(7.0, 0.9, 0.4)));
    let others = [
        Searched::new("three spheres in a row", &row, &at_row),
        Searched::new("nine spheres", &through, &at_small),
    ];
    let cases: Vec<Searched<'_>> = [in_a_row, passing].into_iter().chain(others).collect();
    all_hold(searcher.judge(trial.kit, &cases))?;
    trial.forall(250, scenes(), |cases| {
        let name = |scene: &Scene| format!("{} primitives", scene.things.len());
        let case = |(scene, ray)| Searched::new(name(scene), scene, std::slice::from_ref(ray));
        searcher.judge(trial.kit, &cases.iter().map(|(scene, ray)| case((scene, ray))).collect::<Vec<_>>())
    })?;
    let odd = odd_scenes();
    odd.iter().try_for_each(|(name, scene, rays)| {
        all_hold(searcher.judge(trial.kit, &[Searched::new(*name, scene, rays)]))
    })
}

/// The interval of a ray in each node of a structure: `(node, entry, exit)`, in double precision.
pub(super) type Parts = Vec<(u32, f64, f64)>;

/// Judges the visits of a search that must find a hit: the ray must enter each visited node before its hit, and each tested
/// primitive must be listed in a visited node. `parts` are all nodes that the ray enters or touches.
pub(super) fn judge_visits<S: Structure>(
    what: &str,
    query: &CellsQuery<S>,
    parts: &Parts,
    yours: &CellsAnswer,
) -> CheckResult {
    let ray = &query.ray;
    let input = || format!("{what}\n{}", ray.paste());
    // A search that visits nothing is not a search.
    if yours.hit.is_none() || yours.visits.is_empty() {
        let found = yours.hit.map(|hit| (hit.primitive, hit.t));
        let expected = format!("{:?} after at least one visit", closest(&query.hits, ray));
        let yours = format!("{found:?} after {} visits", yours.visits.len());
        return Err(
            Broken::with_texts(input(), yours, expected, "brute force, (primitive, t)").explained_by([])
        );
    }
    let end = yours.hit.map_or(f64::INFINITY, |hit| f64::from(hit.t)).min(f64::from(ray.t_max));
    // Allow 2⁻¹⁴, which is far more than rounding errors and far less than a cell.
    let room = (-14f64).exp2();
    let enter = |visit: u32| parts.iter().find(|(node, ..)| *node == visit).map(|(_, enter, _)| *enter);
    let is_behind = |enter: f64| enter > end + room * end.abs();
    let again = |visit: u32| yours.visits.iter().filter(|other| **other == visit).count() > 1;
    let missed = yours.visits.iter().copied().find(|&visit| enter(visit).is_none());
    let behind =
        yours.visits.iter().find_map(|&visit| enter(visit).filter(|&t| is_behind(t)).map(|t| (visit, t)));
    let twice = yours.visits.iter().copied().find(|&visit| again(visit));
    let is_listed =
        |primitive: &u32| yours.visits.iter().any(|node| query.cells.listed(*node).contains(primitive));
    // A visit that the ray misses may be to a cell that does not exist.
    let mut tests = yours.tests.iter().copied().filter(|_| missed.is_none());
    let unlisted = tests.find(|primitive| !is_listed(primitive));
    let (yours, expected, source) = match (missed, behind, twice) {
        (Some(visit), ..) => (format!("a visit to {visit}"), "none".to_owned(), "the ray misses it"),
        (None, Some((visit, t)), _) => (
            format!("a visit to {visit}, which begins at t = {t:.4}"),
            format!("none beyond the hit at t = {end}"),
            "counted",
        ),
        (None, None, Some(visit)) => (format!("{visit} is visited again"), "once".to_owned(), "counted"),
        (None, None, None) => match unlisted {
            Some(primitive) => (
                format!("a test of primitive {primitive}"),
                "a visit to a cell that lists it".to_owned(),
                "counted",
            ),
            None => return Ok(()),
        },
    };
    Err(Broken::with_texts(input(), yours, expected, source).explained_by([
        (missed.is_some(), "you visit a cell that the ray does not enter"),
        (
            behind.is_some(),
            "the search goes on behind the best hit: visit the nearest cells first, and stop at a cell that begins behind the hit",
        ),
        (twice.is_some(), "you visit a cell several times"),
        (
            unlisted.is_some(),
            "you test a primitive that no visited cell lists: call `visit` for each cell that the search comes to",
        ),
    ]))
}
