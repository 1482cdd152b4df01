//! The two median splits, and boxes with which every split must work.

use super::divided::{boxes, divided, judge_splits, split_axes};
use super::slabs::UNIT_BOX;
use checks::broken::{Broken, CheckResult};
use checks::{Trial, tree};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{KitError, kit_error};
use raykata::scene::Split;

pub(super) fn object_median_makes_equal_halves(trial: &Trial<'_>) -> CheckResult {
    trial.forall(600, boxes(20), |sets| {
        judge_splits(trial, Split::ObjectMedian, sets, |ordered, middle| {
            let n = ordered.len();
            if middle == 0 {
                return Some((String::new(), "a cut: a median split always returns one".into(), ""));
            }
            if middle != n / 2 && middle != n.div_ceil(2) {
                return Some((
                    format!("{middle} and {}", n - middle),
                    format!("{} and {}", n / 2, n - n / 2),
                    "the halves must hold equally many primitives",
                ));
            }
            let axes = split_axes(ordered);
            (!axes.iter().any(|&axis| divided(ordered, middle, axis))).then(|| {
                (
                    "the centroids of the halves overlap".into(),
                    format!("halves separated along axis {axes:?} by centroid"),
                    "the primitives are not sorted, or not along the longest axis",
                )
            })
        })
    })
}

pub(super) fn spatial_median_cuts_in_the_middle(trial: &Trial<'_>) -> CheckResult {
    trial.forall(600, boxes(20), |sets| {
        judge_splits(trial, Split::SpatialMedian, sets, |ordered, middle| {
            if middle == 0 {
                return Some((String::new(), "a cut: a median split always returns one".into(), ""));
            }
            let all = tree::around(ordered.iter().map(|p| &p.bounds));
            let centroids: Vec<Aabb> = ordered.iter().map(|p| Aabb::new(p.centroid, p.centroid)).collect();
            let fits = |bounds: &Aabb, axis: usize| {
                let cut = 0.5 * (bounds.min[axis] + bounds.max[axis]);
                // A centroid that is on the cut, up to a rounding, may go to either side.
                let slack = 1e-5 * (bounds.max[axis] - bounds.min[axis]);
                let left = ordered[..middle].iter().all(|p| p.centroid[axis] <= cut + slack);
                let right = ordered[middle..].iter().all(|p| p.centroid[axis] >= cut - slack);
                left && right
            };
            let some_cut =
                |bounds: &Aabb| tree::longest_axes(bounds).into_iter().any(|axis| fits(bounds, axis));
            // If all centroids are on one side of the middle, any split is accepted.
            let divides = tree::longest_axes(&all).into_iter().all(|axis| {
                let cut = 0.5 * (all.min[axis] + all.max[axis]);
                ordered.iter().any(|p| p.centroid[axis] < cut)
                    && ordered.iter().any(|p| p.centroid[axis] > cut)
            });
            let right = !divides || some_cut(&all) || some_cut(&tree::around(&centroids));
            (!right).then(|| {
                let axes = tree::longest_axes(&all);
                (
                    "a cut elsewhere".into(),
                    format!("centroids below and above the middle of axis {axes:?}"),
                    "your cut is not in the middle of the longest axis",
                )
            })
        })
    })
}

pub(super) fn spatial_median_never_leaves_a_side_empty(trial: &Trial<'_>) -> CheckResult {
    // A2: equal boxes, concentric boxes, and small boxes with a huge one.
    let equal = vec![UNIT_BOX; 8];
    let concentric: Vec<Aabb> =
        (1..=8).map(|i| Aabb::new(Vec3::splat(-i as f32), Vec3::splat(i as f32))).collect();
    let mut lopsided = vec![UNIT_BOX; 7];
    lopsided.push(Aabb::new(Vec3::ZERO, vec3(1000.0, 1.0, 1.0)));
    judge_splits(trial, Split::SpatialMedian, &[equal, concentric, lopsided], |_, middle| {
        (middle == 0).then(|| (String::new(), "a cut: a median split always returns one".into(), ""))
    })
    .into_iter()
    .collect()
}

pub(super) fn surface_area_heuristic_survives_zero_area(trial: &Trial<'_>) -> CheckResult {
    // A3: boxes in a line and boxes in a point have no area. The NaN of 0/0 must not decide and must not panic.
    let line: Vec<Aabb> =
        (0..6).map(|i| Aabb::new(vec3(i as f32, 0.0, 0.0), vec3(i as f32 + 0.5, 0.0, 0.0))).collect();
    let points = vec![Aabb::new(Vec3::ONE, Vec3::ONE); 5];
    let sets = [line, points, vec![UNIT_BOX; 6]];
    match kit_error::catch(|| judge_splits(trial, Split::SurfaceArea, &sets, |_, _| None)) {
        Ok(outcomes) => outcomes.into_iter().collect(),
        Err(KitError::Panicked { message, place }) => {
            let input = "SurfaceArea of six boxes along a line, five in one point, six equal ones";
            let panic = format!("a panic at {place}: {message}");
            Err(Broken::with_texts(input, panic, "an answer", "the definition").looks_like(Some(
                "0/0 makes every cost NaN, so no cut is the best: compare costs without dividing by A(P)",
            )))
        }
        Err(error) => kit_error::unwind(error),
    }
}
