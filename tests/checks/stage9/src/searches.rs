//! The laws that the seven searches of cells share.

use super::octant_mistakes::of_octree;
use super::parts::{self, Leaf, Parts};
use super::plane_mistakes::{Planes, at_planes};
use super::scenes::{Scene, Thing, odd_scenes, scenes, sphere};
use super::search_mistakes::{FIRST_CELL_ONLY, Hit, Mistakes, facts, in_cells};
use super::structures;
use checks::prelude::*;
use checks::tree::closest_of;
use glam::UVec3;
use raykata::partition::{Bsp, CutPlane, Grid, KdNode, KdTree, Octree, PlaneNode, PolygonBsp};

/// A search of a student, in structures of the type `S`: cells with numbers, or trees with numbered nodes.
pub(super) struct Search<S> {
    /// Its name in messages.
    name: &'static str,
    /// The queries for the rays of a case, in a structure over its scene that the checks have built.
    queries: fn(&Searched<'_>) -> Vec<CellsQuery<S>>,
    /// Calls the student's function.
    pub ask: fn(&dyn Kit, &[CellsQuery<S>]) -> Vec<CellsAnswer>,
    /// The leaves that the ray enters, in their order.
    leaves: fn(&S, &Ray) -> Vec<Leaf>,
    /// The interval of the ray in each node that it enters or touches.
    pub parts: fn(&S, &Ray) -> Parts,
    /// The primitives that a cell or a node lists; none for an inner node, unless polygons lie on its plane.
    pub listed: fn(&S, u32) -> &[u32],
    /// The known mistakes of searches in this structure, each with whether it finds this hit.
    mistakes: fn(&S, &Ray, &[f32], Hit) -> Mistakes,
}

pub(super) const GRID: Search<Grid> = Search {
    name: "grid",
    queries: |Searched { scene, rays, one_leaf, .. }| {
        let resolution = if *one_leaf { UVec3::ONE } else { UVec3::new(5, 4, 3) };
        grid_queries(scene, rays, structures::around_loosely(&scene.boxes()), resolution)
    },
    ask: |kit, queries| kit.grid_search(queries),
    leaves: parts::leaves_of_grid,
    parts: |grid, ray| parts::of_grid(grid, ray, parts::touching),
    listed: Grid::primitives,
    mistakes: |_, _, _, _| Vec::new(),
};

pub(super) const OCTREE: Search<Octree> = Search {
    name: "octree",
    queries: |case| case.queries(&structures::octree(&case.scene.boxes(), case.depth(3))),
    ask: |kit, queries| kit.octree_search(queries),
    leaves: parts::leaves_of_cells,
    parts: parts::of_cells,
    listed: |octree, node| octree.listed(node),
    mistakes: of_octree,
};

pub(super) const OCTREE_BY_CELLS: Search<Octree> =
    Search { name: "octree, cell by cell", ask: |kit, queries| kit.octree_by_cells(queries), ..OCTREE };

pub(super) const OCTREE_BY_NEIGHBOURS: Search<Octree> =
    Search { name: "octree, by neighbours", ask: |kit, queries| kit.octree_by_neighbours(queries), ..OCTREE };

pub(super) const KD_TREE: Search<KdTree> = Search {
    name: "kd-tree",
    queries: |case| case.queries(&structures::kd_tree(&case.scene.boxes(), case.depth(7))),
    ask: |kit, queries| kit.kd_search(queries),
    leaves: parts::leaves_of_cells,
    parts: parts::of_cells,
    listed: |tree, node| tree.listed(node),
    mistakes: |tree, ray, hits, found| {
        let plane = |node: &KdNode| match *node {
            KdNode::Inner { axis, at, .. } => Some(CutPlane::across(usize::from(axis), f64::from(at))),
            KdNode::Leaf { .. } => None,
        };
        at_planes(&Planes { tree, plane, room: 0.0 }, ray, hits, found)
    },
};

pub(super) const BSP: Search<Bsp> = Search {
    name: "BSP tree",
    queries: |case| case.queries(&structures::bsp(&case.scene.hulls(), case.depth(6))),
    ask: |kit, queries| kit.bsp_search(queries),
    leaves: |tree, ray| parts::leaves_of_planes(tree, 0.0, ray),
    parts: parts::of_planes,
    listed: Bsp::listed,
    mistakes: |tree, ray, hits, found| {
        at_planes(&Planes { tree, plane: PlaneNode::plane, room: 0.0 }, ray, hits, found)
    },
};

pub(super) const POLYGON_BSP: Search<PolygonBsp> = Search {
    name: "BSP tree with polygons in its nodes",
    queries: |case| case.queries(&structures::polygon_bsp(&case.scene.hulls(), case.depth(6))),
    ask: |kit, queries| kit.polygon_bsp_search(queries),
    leaves: |bsp, ray| parts::leaves_of_planes(bsp, bsp.room, ray),
    parts: |bsp, ray| parts::of_planes(bsp, ray),
    listed: |bsp, node| bsp.listed(node),
    mistakes: |bsp, ray, hits, found| {
        at_planes(&Planes { tree: bsp, plane: PlaneNode::plane, room: bsp.room }, ray, hits, found)
    },
};

impl<S: Clone> Search<S> {
    /// Searches for the rays of each case, and judges the answers.
    pub(super) fn judge(&self, kit: &dyn Kit, cases: &[Searched<'_>]) -> Vec<CheckResult> {
        let mut asked = Described::new();
        for case in cases {
            let what = self.over(&case.name);
            (self.queries)(case).into_iter().for_each(|query| asked.add(&what, query));
        }
        asked.judge_each(kit, self)
    }

    /// The words for a search over a scene of this name.
    pub(super) fn over(&self, scene: &str) -> String {
        format!("{} over {scene}", self.name)
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

    fn depth(&self, divided: usize) -> usize {
        if self.one_leaf { 0 } else { divided }
    }

    fn queries<S: Clone>(&self, cells: &S) -> Vec<CellsQuery<S>> {
        queries(cells, self.scene, self.rays)
    }
}

/// Queries to a search, each with the text for its message.
pub(super) struct Described<S> {
    what: Vec<String>,
    queries: Vec<CellsQuery<S>>,
}

impl<S: Clone> Described<S> {
    pub(super) fn new() -> Self {
        Described { what: Vec::new(), queries: Vec::new() }
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

    /// Asks the same for each of these rays.
    pub(super) fn ask_all(
        &mut self,
        what: &str,
        cells: &S,
        scene: &Scene,
        rays: impl IntoIterator<Item = Ray>,
    ) {
        rays.into_iter().for_each(|ray| self.ask(what, cells, scene, ray));
    }

    /// Judges the answers of a search. A mistake is named only if it explains all wrong answers.
    pub(super) fn judge(&self, kit: &dyn Kit, search: &Search<S>) -> CheckResult {
        all_hold(self.judge_each(kit, search))
    }

    fn judge_each(&self, kit: &dyn Kit, search: &Search<S>) -> Vec<CheckResult> {
        let answers = (search.ask)(kit, &self.queries);
        let found = |answer: &CellsAnswer| answer.hit.map(|hit| (hit.primitive, hit.t));
        let expected = |query: &CellsQuery<S>| closest_of(&query.hits, &query.ray);
        // The wrong searches, which go through each structure once per mistake, are needed for wrong answers only.
        if self.queries.iter().zip(&answers).all(|(query, answer)| found(answer) == expected(query)) {
            return vec![Ok(()); answers.len()];
        }
        let judge = |(query, what): &(&CellsQuery<S>, &String), answer: CellsAnswer| {
            let (found, expected) = (found(&answer), expected(query));
            if found == expected {
                return Ok(());
            }
            let listed = |node| (search.listed)(&query.cells, node);
            let facts = facts(found, (&answer.tests, &answer.visits), (&query.ray, &query.hits), listed);
            Err(Broken::new(describe(what, query), found, expected, "brute force, (primitive, t)")
                .explained_by(facts))
        };
        let formulas = |(query, _): &(&CellsQuery<S>, &String), answer: &CellsAnswer| {
            let CellsQuery { cells, ray, hits } = *query;
            let mut all = in_cells(&(search.leaves)(cells, ray), ray, hits, found(answer));
            // A search that visits two leaves searches more than the first cell.
            let n_leaves =
                answer.visits.iter().filter(|node| !(search.listed)(cells, **node).is_empty()).count();
            all.iter_mut().for_each(|one| one.0 &= n_leaves < 2 || one.1 != FIRST_CELL_ONLY);
            all.extend((search.mistakes)(cells, ray, hits, found(answer)));
            all
        };
        let queries: Vec<_> = self.queries.iter().zip(&self.what).collect();
        compare_formulas(&queries, answers, judge, formulas)
    }
}

fn describe<S>(what: &str, query: &CellsQuery<S>) -> String {
    format!("{what}\n{}", checks::tree::hits_of(&query.ray, &query.hits))
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

/// The place of sphere `i` in rows of this length: four rows side by side, and so on in layers of this height.
pub(super) fn place(i: usize, length: usize, height: f32) -> Vec3 {
    vec3((i % length) as f32, (i / length % 4) as f32, (i / (4 * length)) as f32 * height)
}

/// `n` small spheres in rows, and rays at every `step`th of them from three points.
pub(super) fn spheres_and_rays(n: usize, step: usize, (length, height): (usize, f32)) -> (Scene, Vec<Ray>) {
    let places: Vec<Vec3> = (0..n).map(|i| place(i, length, height)).collect();
    let spheres = places.iter().map(|&center| Thing::Sphere(Sphere { center, radius: 0.3 }));
    let eyes = [vec3(-4.0, 1.1, 1.2), vec3(length as f32 + 4.0, 6.0, 5.0), vec3(3.5, -6.0, 1.5)];
    let at =
        |eye: Vec3| places.iter().step_by(step).map(move |place| Ray::new(eye, (*place - eye).normalize()));
    (Scene::new(spheres.collect()), eyes.into_iter().flat_map(at).collect())
}

/// Compares a search with brute force, in random scenes and in degenerate ones.
pub(super) fn agrees<S: Clone>(trial: &Trial<'_>, search: &Search<S>) -> CheckResult {
    // Three spheres in a row in one leaf, the nearest of them listed last; and a large sphere that overlaps many cells,
    // with a nearer small one before it.
    let row = Scene::new((0..3).map(|i| sphere(2.0 * i as f32, 0.0, 0.0, 0.5)).collect());
    let large = Thing::Sphere(Sphere { center: vec3(9.0, 4.0, 0.0), radius: 4.25 });
    let small = (0..8).map(|i| sphere(7.0, 0.8 * (i % 4) as f32, (i / 4) as f32, 0.25));
    let through = Scene::new([large].into_iter().chain(small).collect());
    let rays = [(-3.0, 1.0), (9.0, -1.0)].map(|(x, way)| Ray::new(vec3(x, 0.0, 0.0), vec3(way, 0.01, 0.01)));
    let in_a_row = Searched { one_leaf: true, ..Searched::new("three spheres in a row", &row, &rays) };
    let passing = Searched::new("a large sphere and eight small ones", &through, &rays[..1]);
    // And rays from all directions at both scenes, which refute or confirm a mistake that one answer suggests.
    let around = |at: Vec3| {
        let look = move |forward: Vec3| Ray::new(at - 20.0 * forward, forward);
        checks::nasty::directions().into_iter().map(checks::nasty::slanted).map(look).collect::<Vec<Ray>>()
    };
    let (at_row, at_small) = (around(vec3(2.0, 0.1, 0.2)), around(vec3(7.0, 0.9, 0.4)));
    // Directions whose length is 2^-40, so that the planes are crossed at very large t.
    let slow: Vec<Ray> =
        at_row.iter().map(|ray| Ray::new(ray.origin, (-40f32).exp2() * ray.direction)).collect();
    let others = [
        Searched::new("three spheres in a row", &row, &at_row),
        Searched::new("three spheres in a row, by very short directions", &row, &slow),
        Searched::new("nine spheres", &through, &at_small),
    ];
    let cases: Vec<Searched<'_>> = [in_a_row, passing].into_iter().chain(others).collect();
    all_hold(search.judge(trial.kit, &cases))?;
    trial.forall(250, scenes(), |cases| {
        let name = |scene: &Scene| format!("{} primitives", scene.things.len());
        let case = |(scene, ray)| Searched::new(name(scene), scene, std::slice::from_ref(ray));
        search.judge(trial.kit, &cases.iter().map(|(scene, ray)| case((scene, ray))).collect::<Vec<_>>())
    })?;
    let odd = odd_scenes();
    odd.iter().try_for_each(|(name, scene, rays)| {
        all_hold(search.judge(trial.kit, &[Searched::new(*name, scene, rays)]))
    })
}
