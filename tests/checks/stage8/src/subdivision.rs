//! Checks of `loop_subdivide`: the triangles and the positions of their vertices.

use super::quarters::triangles_are_quarters;
use checks::Trial;
use checks::broken::{Broken, CheckResult, all_hold};
use glam::{DVec3, Vec3, vec2, vec3};
use proptest::prelude::*;
use raykata::mesh::Mesh;

fn tetrahedron() -> Mesh {
    Mesh {
        positions: vec![
            vec3(1.0, 1.0, 1.0),
            vec3(-1.0, -1.0, 1.0),
            vec3(-1.0, 1.0, -1.0),
            vec3(1.0, -1.0, -1.0),
        ],
        triangles: vec![[0, 1, 3], [0, 2, 1], [0, 3, 2], [1, 2, 3]],
        ..Mesh::default()
    }
}

/// Six corners with four neighbours each.
fn octahedron() -> Mesh {
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    Mesh {
        positions: vec![x, y, z, -x, -y, -z],
        triangles: vec![
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ],
        ..Mesh::default()
    }
}

/// A sheet of `n` by `n` squares, bent up, with texture coordinates and two materials.
fn sheet(n: u32) -> Mesh {
    let side = n + 1;
    let at = |i: u32| vec2((i % side) as f32, (i / side) as f32);
    let square = |row: u32, column: u32| {
        let a = row * side + column;
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    };
    let triangles: Vec<[u32; 3]> =
        (0..n).flat_map(|row| (0..n).flat_map(move |column| square(row, column))).collect();
    Mesh {
        positions: (0..side * side).map(|i| vec3(at(i).x, at(i).y, at(i).x * at(i).y / 4.0)).collect(),
        uvs: (0..side * side).map(|i| at(i) / n as f32).collect(),
        face_materials: (0..triangles.len() as u32).map(|face| face % 2).collect(),
        material_names: vec!["warp".into(), "weft".into()],
        triangles,
        ..Mesh::default()
    }
}

/// Two pyramids of `n` sides on a common base: the apexes have `n` neighbours.
fn bipyramid(n: u32) -> Mesh {
    let corner = |i: u32| {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / n as f32).sin_cos();
        vec3(2.0 * cos, 0.25 * (i % 2) as f32, 2.0 * sin)
    };
    let sides = |i: u32| [[n, i, (i + 1) % n], [n + 1, (i + 1) % n, i]];
    Mesh {
        positions: (0..n).map(corner).chain([vec3(0.25, -2.0, 0.0), vec3(0.0, 2.0, 0.5)]).collect(),
        triangles: (0..n).flat_map(sides).collect(),
        ..Mesh::default()
    }
}

/// Two triangles whose edges lie upon each other, but which have no common vertex: both edges are borders.
fn seam() -> Mesh {
    let (a, b) = (vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0));
    Mesh {
        positions: vec![a, b, vec3(1.0, 2.0, 0.0), b, a, vec3(1.0, -2.0, 1.0)],
        triangles: vec![[0, 1, 2], [3, 4, 5]],
        ..Mesh::default()
    }
}

/// The meshes of the checks, with their names.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let round = octahedron();
    let round = Mesh { normals: round.positions.clone(), ..round };
    let mut lonely = tetrahedron();
    lonely.positions.push(vec3(5.0, 5.0, 5.0));
    vec![
        ("an octahedron with normals", round),
        ("a tetrahedron", tetrahedron()),
        ("a single triangle", Mesh { triangles: vec![[0, 1, 2]], face_materials: vec![1], ..sheet(1) }),
        ("a sheet of 3 by 3 squares", sheet(3)),
        ("a tetrahedron and a vertex of no triangle", lonely),
        ("two pyramids of 5 sides on a common base", bipyramid(5)),
        ("two pyramids of 7 sides on a common base", bipyramid(7)),
        ("two triangles that touch and have no common vertex", seam()),
    ]
}

/// The edges, the smaller end first: all pairs of vertices that belong to a common triangle.
fn edges(mesh: &Mesh) -> Vec<(u32, u32)> {
    let n = mesh.positions.len() as u32;
    let pairs = (0..n).flat_map(|q| (0..q).map(move |p| (p, q)));
    pairs.filter(|&edge| !opposite(mesh, edge).is_empty()).collect()
}

/// The third corners of the triangles to which both vertices belong.
fn opposite(mesh: &Mesh, (p, q): (u32, u32)) -> Vec<u32> {
    let both = mesh.triangles.iter().filter(|triangle| triangle.contains(&p) && triangle.contains(&q));
    both.flat_map(|triangle| triangle.iter().copied().filter(|&vertex| vertex != p && vertex != q)).collect()
}

/// The answer, the expected answer, and the known mistakes, each with whether it explains this answer.
pub(super) struct Unlike {
    got: String,
    expected: String,
    mistakes: Vec<(bool, &'static str)>,
}

impl Unlike {
    pub(super) fn new(
        got: impl Into<String>,
        expected: impl Into<String>,
        mistakes: Vec<(bool, &'static str)>,
    ) -> Unlike {
        Unlike { got: got.into(), expected: expected.into(), mistakes }
    }
}

/// An answer that one mistake explains.
pub(super) fn unlike(got: impl Into<String>, expected: impl Into<String>, mistake: &'static str) -> Unlike {
    Unlike::new(got, expected, vec![(true, mistake)])
}

/// Judges some laws for every mesh.
fn judge(trial: &Trial<'_>, laws: impl Fn(&Mesh, &Mesh) -> Vec<Result<(), Unlike>>) -> CheckResult {
    let meshes = meshes();
    judge_meshes(trial, &meshes, &laws)?;
    // The same meshes with other numbers of their vertices.
    let orders: Vec<_> = meshes.iter().map(|(_, mesh)| (0..mesh.positions.len()).collect()).collect();
    let orders = orders.into_iter().map(|order: Vec<usize>| Just(order).prop_shuffle());
    trial.forall(1, orders.collect::<Vec<_>>(), |drawn| {
        let judge_orders = |orders: &Vec<Vec<usize>>| {
            let meshes = meshes.iter().zip(orders);
            let renumbered = meshes.map(|((name, mesh), order)| (*name, renumbered(mesh, order)));
            judge_meshes(trial, &renumbered.collect::<Vec<_>>(), &laws)
        };
        drawn.iter().map(judge_orders).collect()
    })
}

/// The same mesh, in which vertex `i` has the number `order[i]`.
fn renumbered(mesh: &Mesh, order: &[usize]) -> Mesh {
    fn placed<T: Copy + Default>(values: &[T], order: &[usize]) -> Vec<T> {
        let mut placed = vec![T::default(); values.len()];
        values.iter().zip(order).for_each(|(value, place)| placed[*place] = *value);
        placed
    }
    let triangle = |triangle: &[u32; 3]| triangle.map(|vertex| order[vertex as usize] as u32);
    Mesh {
        positions: placed(&mesh.positions, order),
        normals: placed(&mesh.normals, order),
        uvs: placed(&mesh.uvs, order),
        triangles: mesh.triangles.iter().map(triangle).collect(),
        ..mesh.clone()
    }
}

fn judge_meshes(
    trial: &Trial<'_>,
    meshes: &[(&'static str, Mesh)],
    laws: &impl Fn(&Mesh, &Mesh) -> Vec<Result<(), Unlike>>,
) -> CheckResult {
    let queries: Vec<Mesh> = meshes.iter().map(|(_, mesh)| mesh.clone()).collect();
    let pairs = meshes.iter().zip(trial.kit.loop_subdivide(&queries));
    let judge_mesh = |((name, mesh), yours): (&(&str, Mesh), Mesh)| -> Vec<CheckResult> {
        let judged = laws(mesh, &yours).into_iter();
        let broken = |unlike: Unlike| {
            Broken::with_texts(format!("loop_subdivide of {name}"), unlike.got, unlike.expected, "the rule")
                .explained_by(unlike.mistakes)
        };
        judged.map(|law| law.map_err(broken)).collect()
    };
    all_hold(pairs.flat_map(judge_mesh).collect())
}

pub(super) fn loop_makes_four_triangles_of_each(trial: &Trial<'_>) -> CheckResult {
    judge(trial, |mesh, yours| {
        vec![judge_counts(mesh, yours).and_then(|()| triangles_are_quarters(mesh, yours))]
    })
}

/// Judges the numbers of vertices, triangles, normals, texture coordinates and materials.
fn judge_counts(mesh: &Mesh, yours: &Mesh) -> Result<(), Unlike> {
    let (n_old, n_edges) = (mesh.positions.len(), edges(mesh).len());
    let describe =
        |mesh: &Mesh| format!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
    let (vertices, triangles) = (n_old + n_edges, 4 * mesh.triangles.len());
    let (n, n_triangles) = (yours.positions.len(), yours.triangles.len());
    if (n, n_triangles) != (vertices, triangles) {
        let mistakes = vec![
            (
                n == n_old + 3 * mesh.triangles.len() && n > vertices,
                "you make more than one new vertex per edge: the triangles on both sides share it",
            ),
            (
                n_triangles != triangles,
                "you do not make four triangles of each: three at its corners and one in the middle",
            ),
            (n < vertices, "you make too few new vertices: there is one per edge, after the old ones"),
        ];
        return Err(Unlike::new(
            describe(yours),
            format!("{vertices} vertices, {triangles} triangles"),
            mistakes,
        ));
    }
    if !yours.normals.is_empty() {
        let describe = format!("{} normals", yours.normals.len());
        return Err(unlike(describe, "none", "normals are dropped, because the surface changes"));
    }
    let lengths = [
        (
            mesh.uvs.len(),
            yours.uvs.len(),
            vertices,
            "texture coordinates",
            "texture coordinates: there is one pair per vertex, or none if the mesh has none",
        ),
        (
            mesh.face_materials.len(),
            yours.face_materials.len(),
            triangles,
            "materials",
            "the four triangles take the material of the old triangle; a mesh without materials gets none",
        ),
    ];
    for (before, yours, each, what, mistake) in lengths {
        let right = if before == 0 { 0 } else { each };
        if yours != right {
            return Err(unlike(format!("{yours} {what}"), format!("{right}"), mistake));
        }
    }
    yours.validate().map_err(|message| Unlike::new(message, "a valid mesh", Vec::new()))
}

const BORDER: &str =
    "a border may depend only on its own vertices: otherwise a gap opens between two meshes that share it";
const FROM_BEFORE: &str =
    "your vertex depends on vertices that are not its neighbours: use only positions from before the step";

/// The distance by which a vertex is moved to measure its weights. It is shorter than any edge, so no two vertices meet.
const STEP: f32 = 0.25;

/// The tolerance of a weight: the difference of two sums of some numbers up to 9, each rounded to a few units of 1e-6,
/// divided by [`STEP`]. Any two weights of the rule differ by at least 1/32.
const NEAR_WEIGHT: f64 = 1e-3;

/// A mesh, the subdivided mesh, and the weights of the old vertices in the new positions.
struct Step<'a> {
    mesh: &'a Mesh,
    yours: &'a Mesh,
    /// For each vertex of the answer its weight for each old vertex: the distance it moves per distance of the old
    /// vertex.
    weights: Vec<Vec<f64>>,
}

/// One mesh per vertex, in which this vertex is moved by [`STEP`] along x.
fn moved(mesh: &Mesh) -> Vec<Mesh> {
    let with = |vertex: usize| {
        let mut moved = mesh.clone();
        moved.positions[vertex].x += STEP;
        moved
    };
    (0..mesh.positions.len()).map(with).collect()
}

/// The weight of each of the `n` neighbours of an inner old vertex. Recorded from the rule for the vertices of these
/// meshes: 3/16 for 3 neighbours, and 3/(8n) otherwise.
fn inner_share(n: usize) -> f64 {
    match n {
        0 => 0.0,
        2 | 3 => 0.1875,
        4 => 0.093_75,
        5 => 0.075,
        6 => 0.0625,
        7 => 0.053_571_428,
        _ => f64::NAN,
    }
}

/// The weights of some old vertices in a position. All other weights are 0.
type Shares = Vec<(u32, f64)>;

/// The weights of a vertex: `share` for each of the others, and the rest for itself.
fn shared(vertex: u32, others: &[u32], share: f64) -> Shares {
    let own = (vertex, 1.0 - share * others.len() as f64);
    [own].into_iter().chain(others.iter().map(|&other| (other, share))).collect()
}

fn describe(shares: &Shares) -> String {
    let one = |(old, share): &(u32, f64)| format!("{share} of vertex {old}");
    shares.iter().map(one).collect::<Vec<String>>().join(", ")
}

impl<'a> Step<'a> {
    /// `moved` holds the answers for the meshes of [`moved`].
    fn new(mesh: &'a Mesh, yours: &'a Mesh, moved: &[Mesh]) -> Step<'a> {
        let weight = |vertex: usize, moved: &Mesh| {
            let place = moved.positions.get(vertex).map_or(f64::NAN, |place| f64::from(place.x));
            (place - f64::from(yours.positions[vertex].x)) / f64::from(STEP)
        };
        let weights = |vertex| moved.iter().map(|moved| weight(vertex, moved)).collect();
        Step { mesh, yours, weights: (0..yours.positions.len()).map(weights).collect() }
    }

    /// Whether a vertex has these weights, and the weight 0 for all other old vertices.
    fn takes(&self, vertex: usize, shares: &Shares) -> bool {
        let right =
            |old: usize| shares.iter().find(|(other, _)| *other as usize == old).map_or(0.0, |one| one.1);
        self.weights[vertex].iter().enumerate().all(|(old, yours)| (yours - right(old)).abs() <= NEAR_WEIGHT)
    }

    /// Whether a vertex has a weight other than 0 for an old vertex that is not among these.
    fn takes_of_others(&self, vertex: usize, than: &[u32]) -> bool {
        let mut weights = self.weights[vertex].iter().enumerate();
        weights.any(|(old, weight)| weight.abs() > NEAR_WEIGHT && !than.contains(&(old as u32)))
    }

    /// Checks that every vertex is the sum of the old vertices times its weights.
    fn is_linear(&self) -> Result<(), Unlike> {
        for (vertex, weights) in self.weights.iter().enumerate() {
            let parts = weights.iter().zip(&self.mesh.positions);
            let sum: DVec3 = parts.map(|(weight, old)| *weight * old.as_dvec3()).sum();
            let place = self.yours.positions[vertex];
            // Allow 16 weights with an error of 1e-5 each, from two rounded sums over STEP, times coordinates up to 5.
            if !((place.as_dvec3() - sum).length() <= 1e-3) {
                let expected = format!("{}, the sum of the old vertices times its weights", sum.as_vec3());
                return Err(Unlike::new(format!("vertex {vertex} at {place}"), expected, Vec::new()));
            }
        }
        Ok(())
    }

    /// The position of a vertex and its weights.
    fn describe(&self, vertex: usize) -> String {
        let weights = self.weights[vertex].iter().enumerate();
        // Round to four digits.
        let rounded = weights.map(|(old, weight)| (old as u32, (1e4 * weight).round() / 1e4));
        let shares: Shares = rounded.filter(|(_, weight)| *weight != 0.0).collect();
        format!("vertex {vertex} at {}: {}", self.yours.positions[vertex], describe(&shares))
    }

    /// The neighbours of an old vertex: all of them, and those along a border.
    fn neighbours(&self, vertex: u32) -> (Vec<u32>, Vec<u32>) {
        let others = (0..self.mesh.positions.len() as u32).filter(|&other| other != vertex);
        let joined: Vec<(u32, usize)> = others
            .map(|other| (other, opposite(self.mesh, (vertex, other)).len()))
            .filter(|(_, triangles)| *triangles > 0)
            .collect();
        let border = joined.iter().filter(|(_, triangles)| *triangles == 1);
        (joined.iter().map(|(other, _)| *other).collect(), border.map(|(other, _)| *other).collect())
    }

    /// Judges an old vertex by its weights.
    fn judge_old(&self, vertex: u32, border: bool) -> Result<(), Unlike> {
        let index = vertex as usize;
        let (around, along) = self.neighbours(vertex);
        let others = if border { &along } else { &around };
        let shares = shared(vertex, others, if border { 0.125 } else { inner_share(others.len()) });
        if self.takes(index, &shares) {
            return Ok(());
        }
        let sum: f64 = self.weights[index].iter().sum();
        let weight = |other: &u32| self.weights[index][*other as usize];
        let own_only = self.takes(index, &vec![(vertex, 1.0)]);
        // Whether all of some neighbours have the same weight, and no other vertex has one.
        let is_even = |among: &[u32]| {
            let rest = [among, &[vertex]].concat();
            among.iter().all(|other| (weight(other) - weight(&among[0])).abs() <= NEAR_WEIGHT)
                && !self.takes_of_others(index, &rest)
        };
        // If all other vertices are neighbours, uneven weights are the only sign of positions from after the step.
        let has_others = around.len() + 1 < self.mesh.positions.len();
        let from_before = match has_others {
            true => self.takes_of_others(index, &[&around[..], &[vertex]].concat()),
            false => !border && !is_even(&around),
        };
        let adds_up = (sum - 1.0).abs() <= NEAR_WEIGHT;
        let mistakes = vec![
            (around.is_empty(), "you move a vertex that belongs to no triangle: it stays"),
            (!around.is_empty() && own_only, "you do not move the old vertices: they move, too"),
            (from_before, FROM_BEFORE),
            (border && self.takes(index, &shared(vertex, &around, inner_share(around.len()))), BORDER),
            (
                border && !own_only && is_even(&along),
                "the weights on a border are 3/4 for the vertex and 1/8 for each of its two neighbours along \
                 the border",
            ),
            (
                !adds_up && !around.is_empty() && is_even(others),
                "your weights do not add up to 1: they are β for each of the n neighbours and 1 - n β for \
                 the vertex",
            ),
            (
                !border && adds_up && !own_only && is_even(&around),
                "your weights are wrong: β is 3/16 for n = 3 neighbours, and 3/(8 n) otherwise",
            ),
        ];
        Err(Unlike::new(self.describe(index), describe(&shares), mistakes))
    }

    /// Judges the new vertex of an edge: one of the new vertices must have the right weights.
    fn judge_edge(&self, (p, q): (u32, u32), border: bool) -> Result<(), Unlike> {
        let third = opposite(self.mesh, (p, q));
        let ends = vec![(p, 0.5), (q, 0.5)];
        let shares = match (border, &third[..]) {
            (false, [r, s]) => vec![(p, 0.375), (q, 0.375), (*r, 0.125), (*s, 0.125)],
            _ => ends.clone(),
        };
        let mut fresh = self.mesh.positions.len()..self.yours.positions.len();
        if fresh.clone().any(|vertex| self.takes(vertex, &shares)) {
            return Ok(());
        }
        let around: Vec<u32> = third.iter().copied().chain([p, q]).collect();
        let has = |vertex: usize, old: &u32| self.weights[vertex][*old as usize].abs() > NEAR_WEIGHT;
        // Whether the ends have different weights.
        let mixed = fresh.clone().any(|vertex| {
            around.iter().all(|old| has(vertex, old))
                && (self.weights[vertex][p as usize] - self.weights[vertex][q as usize]).abs() > NEAR_WEIGHT
        });
        // A new vertex that depends on both ends, on the third corners, and on no other vertex.
        let of_these = fresh.clone().any(|vertex| {
            around.iter().all(|old| has(vertex, old)) && !self.takes_of_others(vertex, &around)
        });
        let mistakes = vec![
            (border && of_these, BORDER),
            (!border && !mixed && of_these, "the weights are 3/8 for each end and 1/8 for each third corner"),
            (
                !border && fresh.clone().any(|vertex| self.takes(vertex, &ends)),
                "you use the midpoint for an inner edge: there the two third corners have weights, too",
            ),
            (
                !border
                    && (around.len() == self.mesh.positions.len()
                        || fresh.any(|vertex| {
                            has(vertex, &p) && has(vertex, &q) && self.takes_of_others(vertex, &around)
                        })),
                FROM_BEFORE,
            ),
        ];
        Err(Unlike::new(
            format!("no new vertex for the edge {p} {q}"),
            format!("one with {}", describe(&shares)),
            mistakes,
        ))
    }

    /// Judges the vertices on borders, or all others.
    fn judge(&self, border: bool) -> Vec<Result<(), Unlike>> {
        let n_old = self.mesh.positions.len().min(self.yours.positions.len());
        let old = (0..n_old as u32).filter(|vertex| self.neighbours(*vertex).1.is_empty() != border);
        let mut judged: Vec<Result<(), Unlike>> = old.map(|vertex| self.judge_old(vertex, border)).collect();
        let is_border = |edge: &(u32, u32)| opposite(self.mesh, *edge).len() == 1;
        let edges = edges(self.mesh).into_iter().filter(|edge| is_border(edge) == border);
        judged.extend(edges.map(|edge| self.judge_edge(edge, border)));
        // Weights are meaningless if the positions are not their sums, so judge that last.
        if !border && judged.iter().all(Result::is_ok) {
            judged.push(self.is_linear());
        }
        judged
    }
}

/// Measures the weights: moves each old vertex a little and compares the answers.
fn judge_weights(trial: &Trial<'_>, border: bool) -> CheckResult {
    judge(trial, |mesh, yours| {
        let moved = trial.kit.loop_subdivide(&moved(mesh));
        Step::new(mesh, yours, &moved).judge(border)
    })
}

pub(super) fn loop_places_vertices_by_the_rule(trial: &Trial<'_>) -> CheckResult {
    judge_weights(trial, false)
}

pub(super) fn loop_borders_depend_on_borders(trial: &Trial<'_>) -> CheckResult {
    judge_weights(trial, true)
}
