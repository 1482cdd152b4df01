//! Checks of the rule by which `loop_subdivide` places vertices. Every position is a sum of old positions with weights, and the
//! weights are measured: each old vertex is moved a little, and the answers are compared.

use super::subdivision::{edges, judge, opposite, unlike};
use checks::prelude::*;
use raykata::mesh::Mesh;

const BORDER: &str =
    "a border may depend only on its own vertices: otherwise a gap opens between two meshes that share it";
const FROM_BEFORE: &str =
    "your vertex depends on vertices that are not its neighbours: use only positions from before the step";

/// The distance by which a vertex is moved to measure its weights. It is shorter than any edge, so no two vertices meet.
const STEP: f32 = 0.25;

/// The tolerance of a weight: the difference of two sums of some numbers up to 9, each rounded to a few units of 1e-6,
/// divided by [`STEP`]. Weights of a vertex and of the next number of neighbours differ by at least 1/112.
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

/// The weights that each of the `n` neighbours of an inner old vertex may have: by Warren's rule, which the contract states, or
/// by Loop's own.
fn inner_shares(n: usize) -> [f64; 2] {
    match n {
        0 => [0.0; 2],
        3 => [0.1875; 2],
        n => {
            let cosine = (std::f64::consts::TAU / n as f64).cos();
            [3.0 / (8.0 * n as f64), (0.625 - (0.375 + 0.25 * cosine).powi(2)) / n as f64]
        }
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
    fn is_linear(&self) -> CheckResult {
        for (vertex, weights) in self.weights.iter().enumerate() {
            let parts = weights.iter().zip(&self.mesh.positions);
            let sum: DVec3 = parts.map(|(weight, old)| *weight * old.as_dvec3()).sum();
            let place = self.yours.positions[vertex];
            // Allow 16 weights with an error of 1e-5 each, from two rounded sums over STEP, times coordinates up to 5.
            if !((place.as_dvec3() - sum).length() <= 1e-3) {
                let expected = format!("{}, the sum of the old vertices times its weights", sum.as_vec3());
                return Err(unlike(format!("vertex {vertex} at {place}"), expected));
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

    /// Whether one of these old vertices has a neighbour that is not among them.
    fn reaches(&self, vertices: &[u32]) -> bool {
        vertices.iter().any(|vertex| self.neighbours(*vertex).0.iter().any(|other| !vertices.contains(other)))
    }

    /// An old vertex and its neighbours.
    fn ring(&self, vertex: u32) -> Vec<u32> {
        [vertex].into_iter().chain(self.neighbours(vertex).0).collect()
    }

    /// Whether the neighbours of an old vertex have neighbours that are not its own.
    fn reaches_others(&self) -> bool {
        (0..self.mesh.positions.len() as u32).any(|vertex| self.reaches(&self.ring(vertex)))
    }

    /// Whether an old vertex has a weight for a vertex that is not its neighbour.
    fn depends_on_others(&self) -> bool {
        let n_old = self.mesh.positions.len().min(self.yours.positions.len());
        (0..n_old as u32).any(|vertex| self.takes_of_others(vertex as usize, &self.ring(vertex)))
    }

    /// Judges an old vertex by its weights.
    fn judge_old(&self, vertex: u32, border: bool) -> CheckResult {
        let index = vertex as usize;
        let (around, along) = self.neighbours(vertex);
        let others = if border { &along } else { &around };
        let allowed = if border { [0.125; 2] } else { inner_shares(others.len()) };
        let [shares, loops_own] = allowed.map(|share| shared(vertex, others, share));
        if self.takes(index, &shares) || self.takes(index, &loops_own) {
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
        // A vertex whose neighbours have moved before it depends on their neighbours. Those may all be its own; then only
        // uneven weights tell.
        let is_uneven = others.iter().any(|other| (weight(other) - weight(&others[0])).abs() > NEAR_WEIGHT);
        let uses_moved = (is_uneven || self.takes_of_others(index, &self.ring(vertex)))
            && (self.depends_on_others() || !self.reaches_others());
        let adds_up = (sum - 1.0).abs() <= NEAR_WEIGHT;
        Err(unlike(self.describe(index), describe(&shares)).explained_by([
            (around.is_empty(), "you move a vertex that belongs to no triangle: it stays"),
            (!around.is_empty() && own_only, "you do not move the old vertices: they move, too"),
            (uses_moved, FROM_BEFORE),
            (border && !own_only && around.len() > 2 && is_even(&around), BORDER),
            BORDER.when(
                border
                    && inner_shares(around.len())
                        .iter()
                        .any(|share| self.takes(index, &shared(vertex, &around, *share))),
            ),
            "the weights on a border are 3/4 for the vertex and 1/8 for each of its two neighbours along the border"
                .when(border && !own_only && is_even(&along)),
            "your weights do not add up to 1: they are β for each of the n neighbours and 1 - n β for the vertex"
                .when(!adds_up && !around.is_empty() && is_even(others)),
            "your weights are wrong: β is 3/16 for n = 3 neighbours, and 3/(8 n) otherwise"
                .when(!border && adds_up && !own_only && is_even(&around)),
        ]))
    }

    /// Judges the new vertex of an edge: one of the new vertices must have the right weights.
    fn judge_edge(&self, (p, q): (u32, u32), border: bool) -> CheckResult {
        let third = opposite(self.mesh, (p, q));
        let ends = vec![(p, 0.5), (q, 0.5)];
        let shares = match (border, &third[..]) {
            (false, [r, s]) => vec![(p, 0.375), (q, 0.375), (*r, 0.125), (*s, 0.125)],
            _ => ends.clone(),
        };
        let fresh = self.mesh.positions.len()..self.yours.positions.len();
        if fresh.clone().any(|vertex| self.takes(vertex, &shares)) {
            return Ok(());
        }
        let around: Vec<u32> = third.iter().copied().chain([p, q]).collect();
        let has = |vertex: usize, old: &u32| self.weights[vertex][*old as usize].abs() > NEAR_WEIGHT;
        let has_all = |vertex: &usize| around.iter().all(|old| has(*vertex, old));
        // Whether the ends have different weights.
        let mixed = fresh.clone().filter(has_all).any(|vertex| {
            (self.weights[vertex][p as usize] - self.weights[vertex][q as usize]).abs() > NEAR_WEIGHT
        });
        // A new vertex that depends on both ends, on the third corners, and on no other vertex.
        let of_these = fresh.clone().filter(has_all).any(|vertex| !self.takes_of_others(vertex, &around));
        // Moved ends depend on their neighbours. If there are no other ones, any wrong weights may come from that.
        let from_moved = !self.reaches(&around)
            || fresh
                .clone()
                .any(|vertex| has(vertex, &p) && has(vertex, &q) && self.takes_of_others(vertex, &around));
        let (got, right) = (format!("no new vertex for the edge {p} {q}"), describe(&shares));
        Err(unlike(got, format!("one with {right}")).explained_by([
            (border && of_these, BORDER),
            (!border && !mixed && of_these, "the weights are 3/8 for each end and 1/8 for each third corner"),
            "you use the midpoint for an inner edge: there the two third corners have weights, too"
                .when(!border && fresh.clone().any(|vertex| self.takes(vertex, &ends))),
            (!border && from_moved, FROM_BEFORE),
        ]))
    }

    /// Judges the vertices on borders, or all others.
    fn judge(&self, border: bool) -> Vec<CheckResult> {
        let n_old = self.mesh.positions.len().min(self.yours.positions.len());
        let old = (0..n_old as u32).filter(|vertex| self.neighbours(*vertex).1.is_empty() != border);
        let mut judged: Vec<CheckResult> = old.map(|vertex| self.judge_old(vertex, border)).collect();
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
pub(super) fn judge_weights(trial: &Trial<'_>, border: bool) -> CheckResult {
    judge(trial, |mesh, yours| {
        let moved = trial.kit.loop_subdivide(&moved(mesh));
        Step::new(mesh, yours, &moved).judge(border)
    })
}
