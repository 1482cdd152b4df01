//! The two median splits, and boxes with which every split must work.

use super::divided::{Fault, boxes, divided, divided_by, is_as_given, is_cut_at, judge_splits, split_axes};
use super::slabs::UNIT_BOX;
use checks::prelude::*;
use checks::tree;
use raykata::bvh::PrimitiveRef;
use raykata::scene::Split;

/// `None` where a median split always returns a cut.
fn no_cut() -> Fault {
    (String::new(), "a cut: a median split always returns a cut".into(), vec![])
}

const ELSEWHERE: &str = "you cut at another part of the axis: cut in the middle of the box";
const BY_LOW: &str = "you take the low sides of the boxes: take the centroids";
const BY_HIGH: &str = "you take the high sides of the boxes: take the centroids";

/// No list of wrong rules.
fn none(_: &[PrimitiveRef], _: &[PrimitiveRef], _: usize) -> Vec<(bool, &'static str)> {
    Vec::new()
}

pub(super) fn object_median_makes_equal_halves(trial: &Trial<'_>) -> CheckResult {
    trial.forall(600, boxes(20), |sets| {
        let law = |_: &[PrimitiveRef], ordered: &[PrimitiveRef], middle: usize| {
            let n = ordered.len();
            if middle == 0 {
                return Some(no_cut());
            }
            let axes = split_axes(ordered);
            let equal = middle == n / 2 || middle == n.div_ceil(2);
            if equal && axes.iter().any(|&axis| divided(ordered, middle, axis)) {
                return None;
            }
            let mistakes = vec![
                (!equal, "the halves must hold equally many primitives"),
                "you sort along an axis that is not the longest axis"
                    .when((0..3).any(|axis| divided(ordered, middle, axis))),
            ];
            let yours = match equal {
                true => "the centroids of the halves overlap".into(),
                false => format!("{middle} and {}", n - middle),
            };
            let expected = format!("{} and {}, separated along axis {axes:?} by centroid", n / 2, n - n / 2);
            Some((yours, expected, mistakes))
        };
        let formulas = |given: &[PrimitiveRef], ordered: &[PrimitiveRef], middle: usize| {
            let all = tree::around_all(ordered);
            let shortest = |axis: usize| (all.max - all.min)[axis] <= (all.max - all.min).min_element();
            let along = |axis: usize| divided(ordered, middle, axis);
            let axes = split_axes(ordered);
            let by = |key: fn(&PrimitiveRef, usize) -> f32| {
                axes.iter().any(|&axis| divided_by(ordered, middle, &|p| key(p, axis)))
            };
            named![
                by(|p, axis| p.bounds.min[axis]) => BY_LOW,
                by(|p, axis| p.bounds.max[axis]) => BY_HIGH,
                by(|p, _| p.centroid.length()) => "you sort by the distance from the origin: sort by the centroid along the axis",
                by(|p, axis| (p.bounds.max - p.bounds.min)[axis]) => "you sort by the size of the boxes: sort by the centroid",
                is_as_given(given, ordered) => "the primitives are not sorted: you cut them as they come",
                along(0) => "you sort along x also where another axis is longer",
                along(1) => "you sort along y also where another axis is longer",
                along(2) => "you sort along z also where another axis is longer",
                (0..3).any(|axis| shortest(axis) && along(axis)) => "you sort along the shortest axis, not along the longest axis",
            ].to_vec()
        };
        judge_splits(trial, Split::ObjectMedian, sets, law, formulas)
    })
}

pub(super) fn spatial_median_cuts_in_the_middle(trial: &Trial<'_>) -> CheckResult {
    trial.forall(600, boxes(20), |sets| {
        let fits = |ordered: &[PrimitiveRef], middle: usize, bounds: &Aabb, axis: usize| {
            let cut = 0.5 * (bounds.min[axis] + bounds.max[axis]);
            is_cut_at(ordered, middle, axis, cut, bounds.max[axis] - bounds.min[axis])
        };
        let law = |_: &[PrimitiveRef], ordered: &[PrimitiveRef], middle: usize| {
            if middle == 0 {
                return Some(no_cut());
            }
            let all = tree::around_all(ordered);
            let some_cut = |bounds: &Aabb| {
                tree::longest_axes(bounds).into_iter().any(|axis| fits(ordered, middle, bounds, axis))
            };
            // If all centroids are on one side of the middle, any split is accepted.
            let divides = tree::longest_axes(&all).into_iter().all(|axis| {
                let cut = 0.5 * (all.min[axis] + all.max[axis]);
                ordered.iter().any(|p| p.centroid[axis] < cut)
                    && ordered.iter().any(|p| p.centroid[axis] > cut)
            });
            if !divides || some_cut(&all) || some_cut(&tree::around_centroids(ordered)) {
                return None;
            }
            let axes = tree::longest_axes(&all);
            let expected = format!("centroids below and above the middle of axis {axes:?}");
            let any = (0..3).any(|axis| fits(ordered, middle, &all, axis));
            let mistakes = vec![(any, "you cut an axis that is not the longest axis")];
            Some(("a cut elsewhere".into(), expected, mistakes))
        };
        let formulas = |given: &[PrimitiveRef], ordered: &[PrimitiveRef], middle: usize| {
            let all = tree::around_all(ordered);
            let (axes, n) = (tree::longest_axes(&all), ordered.len());
            let fits = |axis: usize| fits(ordered, middle, &all, axis);
            let at_the_mean = |axis: usize| {
                let mean = ordered.iter().map(|p| p.centroid[axis]).sum::<f32>() / n as f32;
                is_cut_at(ordered, middle, axis, mean, all.max[axis] - all.min[axis])
            };
            let halves = middle == n / 2 || middle == n.div_ceil(2);
            let is_counted_only = axes.iter().any(|&axis| {
                let cut = 0.5 * (all.min[axis] + all.max[axis]);
                let n_left = ordered.iter().filter(|p| p.centroid[axis] < cut).count();
                (is_as_given(given, ordered) && middle == n_left) || n_left == 0 || n_left == n
            });
            // A cut elsewhere, by the sides or the centroids of the boxes. If all are on one side of it, any split is right.
            let cut = |key: fn(&PrimitiveRef, usize) -> f32, cut: &dyn Fn(f32, f32) -> f32| {
                axes.iter().any(|&axis| {
                    let (low, size) = (all.min[axis], all.max[axis] - all.min[axis]);
                    let is_left = |p: &PrimitiveRef| key(p, axis) < cut(low, size);
                    let left = ordered[..middle].iter().filter(|p| is_left(p)).count();
                    let n_left = ordered.iter().filter(|p| is_left(p)).count();
                    n_left == 0 || n_left == n || (left, n_left) == (middle, middle)
                })
            };
            let centroid = |p: &PrimitiveRef, axis: usize| p.centroid[axis];
            let at = |part: f32| cut(centroid, &|low, size| low + part * size);
            vec![
                (cut(|p, axis| p.bounds.min[axis], &|low, size| low + 0.5 * size), BY_LOW),
                (cut(|p, axis| p.bounds.max[axis], &|low, size| low + 0.5 * size), BY_HIGH),
                "you cut at half of the size of the box: the middle is half of min + max"
                    .when(cut(centroid, &|_, size| 0.5 * size)),
                (is_counted_only, "you count the primitives below the cut, but leave them in their places: swap them to the front"),
                (at(1.0 / 3.0), ELSEWHERE),
                (at(2.0 / 3.0), ELSEWHERE),
                (at(0.25), ELSEWHERE),
                (at(0.75), ELSEWHERE),
                "you cut at the mean of the centroids, which is not in the middle of the box"
                    .when(axes.iter().any(|&axis| at_the_mean(axis))),
                "you put half of the primitives on each side: your cut is not in the middle of the box"
                    .when(halves && axes.iter().any(|&axis| divided(ordered, middle, axis))),
                (fits(0), "you always cut along x, not along the longest axis"),
                (fits(1), "you always cut along y, not along the longest axis"),
                (fits(2), "you always cut along z, not along the longest axis"),
            ]
        };
        judge_splits(trial, Split::SpatialMedian, sets, law, formulas)
    })
}

pub(super) fn spatial_median_never_leaves_a_side_empty(trial: &Trial<'_>) -> CheckResult {
    // Equal boxes, concentric boxes, and small boxes with a huge one.
    let equal = vec![UNIT_BOX; 8];
    let concentric: Vec<Aabb> =
        (1..=8).map(|i| Aabb::new(Vec3::splat(-i as f32), Vec3::splat(i as f32))).collect();
    let mut lopsided = vec![UNIT_BOX; 7];
    lopsided.push(Aabb::new(Vec3::ZERO, vec3(1000.0, 1.0, 1.0)));
    // And boxes that the middle divides.
    let row: Vec<Aabb> =
        (0..8).map(|i| Aabb::new(vec3(i as f32, 0.0, 0.0), vec3(i as f32 + 0.5, 1.0, 1.0))).collect();
    let sets = [row, equal, concentric, lopsided];
    let in_the_middle = (String::new(), "4 and 4 of the boxes in a row".to_owned(), vec![]);
    all_hold(judge_splits(
        trial,
        Split::SpatialMedian,
        &sets,
        |_, ordered, middle| {
            let is_row = ordered.iter().any(|p| p.bounds.min.x == 7.0);
            match middle {
                0 => Some(no_cut()),
                4 => None,
                _ => is_row.then(|| in_the_middle.clone()),
            }
        },
        none,
    ))
}

pub(super) fn surface_area_heuristic_survives_zero_area(trial: &Trial<'_>) -> CheckResult {
    // Boxes in a line and boxes in a point have no area. The NaN of 0/0 must not decide and must not panic.
    let line: Vec<Aabb> =
        (0..6).map(|i| Aabb::new(vec3(i as f32, 0.0, 0.0), vec3(i as f32 + 0.5, 0.0, 0.0))).collect();
    let points = vec![Aabb::new(Vec3::ONE, Vec3::ONE); 5];
    let sets = [line, points, vec![UNIT_BOX; 6]];
    match kit_error::catch(|| judge_splits(trial, Split::SurfaceArea, &sets, |_, _, _| None, none)) {
        Ok(outcomes) => all_hold(outcomes)?,
        Err(KitError::Panicked { message, place }) => {
            let input = "SurfaceArea of six boxes along a line, five in one point, six equal ones";
            let panic = format!("a panic at {place}: {message}");
            // The same code answers for boxes that have an area.
            let with_area: Vec<Aabb> =
                (0..6).map(|i| Aabb::new(vec3(i as f32, 0.0, 0.0), vec3(i as f32 + 0.5, 1.0, 1.0))).collect();
            let answers = kit_error::catch(|| {
                judge_splits(trial, Split::SurfaceArea, &[with_area], |_, _, _| None, none)
            });
            return Err(Broken::with_texts(input, panic, "an answer", "the definition").explained_by([(
                answers.is_ok() && message.contains("None"),
                "for boxes without area no cut is the best (0/0 makes every cost NaN): compare costs without dividing by A(P)",
            )]));
        }
        Err(error) => kit_error::unwind(error),
    }
    // A row of flat walls: each has an area, but no thickness. A cut is far cheaper than a leaf.
    let walls: Vec<Aabb> =
        (0..16).map(|i| Aabb::new(vec3(8.0 * i as f32, 0.0, 0.0), vec3(8.0 * i as f32, 1.0, 1.0))).collect();
    // The cheapest cut is in the middle, and the costs of its neighbours are close.
    all_hold(judge_splits(
        trial,
        Split::SurfaceArea,
        &[walls],
        |_, _, middle| {
            (!(4..=12).contains(&middle)).then(|| {
                (format!("{middle} on the left"), "a cut near the middle, cheaper than a leaf".into(), vec![])
            })
        },
        none,
    ))
}
