//! The cheapest cut of the surface area heuristic, and the diagnosis of a more expensive one.

use super::divided::{boxes, divided, judge_splits};
use checks::broken::CheckResult;
use checks::{Trial, tree};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveRef;
use raykata::scene::Split;

pub(super) fn surface_area_heuristic_finds_the_cheapest_cut(trial: &Trial<'_>) -> CheckResult {
    // First test two sets on which each mistake gives another cut: scattered boxes of all sizes, and a row with gaps.
    let cubes = |all: &[(f32, f32, f32, f32)]| -> Vec<Aabb> {
        all.iter()
            .map(|&(x, y, z, size)| Aabb::new(vec3(x, y, z), vec3(x, y, z) + Vec3::splat(size)))
            .collect()
    };
    let scattered = cubes(&[
        (3.0, 0.0, 5.0, 1.0),
        (1.0, 1.5, 7.0, 0.5),
        (6.0, 3.0, 1.0, 0.25),
        (0.0, 10.0, 2.0, 1.5),
        (5.0, 30.0, 4.0, 2.0),
        (2.0, 33.0, 0.0, 0.5),
        (4.0, 36.0, 3.0, 3.0),
    ]);
    let row = cubes(&[
        (0.0, 0.25, 0.5, 1.0),
        (30.0, 0.75, 0.0, 1.0),
        (40.0, 0.5, 0.75, 1.0),
        (41.5, 0.0, 0.25, 1.0),
        (43.0, 1.0, 1.25, 1.0),
        (44.5, 1.25, 1.0, 1.0),
    ]);
    let judge = |sets: &[Vec<Aabb>]| judge_splits(trial, Split::SurfaceArea, sets, cheapest);
    judge(&[scattered, row]).into_iter().collect::<CheckResult>()?;
    trial.forall(500, boxes(16), judge)
}

const AXES: [usize; 3] = [0, 1, 2];

/// The error of a cut, if it has one: yours, expected, and the diagnosis. A `middle` of 0 is a leaf.
fn cheapest(ordered: &[PrimitiveRef], middle: usize) -> Option<(String, String, &'static str)> {
    let best = tree::least_cost(ordered, &AXES, &tree::cut_cost);
    let leaf = tree::leaf_is_cheaper(ordered, best);
    if middle == 0 {
        let expected = format!("a cut of cost {best:.4}, cheaper than a leaf");
        let too_soon =
            "the leaf is taken too soon: compare C_t A(P) + C_i (A(L) n(L) + A(R) n(R)) with C_i A(P) n(P)";
        return (leaf == Some(false)).then(|| (String::new(), expected, too_soon));
    }
    if leaf == Some(true) {
        let yours = format!("a cut before {middle}");
        let left_out = "TRAVERSAL_COST is left out, so a cut always looks cheaper";
        return Some((yours, "None: a leaf is cheaper than any cut".into(), left_out));
    }
    let yours = tree::cut_cost(&ordered[..middle], &ordered[middle..]);
    // Equal centroids may be sorted in any order, which changes the cost of the cuts between them. So the check judges
    // the cost only if all centroids differ.
    (yours > best * 1.0001 + 1e-6 && centroids_differ(ordered)).then(|| {
        let describe = format!("cost {yours:.4} (cut before {middle})");
        (describe, format!("cost {best:.4}"), cut_diagnosis(ordered, middle))
    })
}

/// The mistake that makes this cut the best one.
fn cut_diagnosis(ordered: &[PrimitiveRef], middle: usize) -> &'static str {
    let area = |part: &[PrimitiveRef]| tree::half_area(&tree::around(part.iter().map(|p| &p.bounds)));
    let areas = |left: &[PrimitiveRef], right: &[PrimitiveRef]| area(left) + area(right);
    let counts = |left: &[PrimitiveRef], right: &[PrimitiveRef]| left.len().max(right.len()) as f64;
    let is_least = |axes: &[usize], cost: &dyn Fn(&[PrimitiveRef], &[PrimitiveRef]) -> f64| {
        cost(&ordered[..middle], &ordered[middle..]) <= tree::least_cost(ordered, axes, cost) * 1.0001
    };
    let best = tree::least_cost(ordered, &AXES, &tree::cut_cost);
    let is_best = |[left, right]: &[Vec<PrimitiveRef>; 2]| {
        left.len() == middle && tree::cut_cost(left, right) <= best * 1.0001
    };
    match () {
        () if !(0..3).any(|axis| divided(ordered, middle, axis)) => {
            "the primitives are not sorted along any axis"
        }
        () if (0..3).any(|axis| divided(ordered, middle, axis) && is_least(&[axis], &tree::cut_cost)) => {
            "only one axis is tried: the best cut is along another"
        }
        () if AXES.iter().any(|&axis| tree::cuts(ordered, axis).iter().any(is_best)) => {
            "sorted along another axis than that of the best cut: sort again along that axis"
        }
        () if is_least(&AXES, &areas) => "your cut is the best by areas alone: the counts are left out",
        () if ordered.len() > 3 && is_least(&AXES, &counts) => {
            "your cut is the best by counts alone: the areas are left out"
        }
        () => "a cheaper cut exists: not every cut is tried, or the cost has a wrong term",
    }
}

fn centroids_differ(primitives: &[PrimitiveRef]) -> bool {
    (0..3).all(|axis| {
        let mut at: Vec<f32> = primitives.iter().map(|p| p.centroid[axis]).collect();
        at.sort_by(f32::total_cmp);
        at.windows(2).all(|pair| pair[0] < pair[1])
    })
}
