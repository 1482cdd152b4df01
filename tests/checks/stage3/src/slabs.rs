//! Ray-box intersection: `slab`.

use super::boxes::aabb;
use super::slab_mistakes::{mistakes, observations};
use checks::double::{self, Tolerant, box_interval, compare_tolerant};
use checks::prelude::*;

pub(super) const UNIT_BOX: Aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);

/// What a slab test must return.
enum Slab {
    /// The entry and the exit within the range of the ray; a miss if the entry is larger.
    Interval(f64, f64),
    /// A hit or a miss, which is known exactly.
    Verdict(bool),
}

/// Allows for the roundings of a difference, a reciprocal and a product, and for methods that widen the box. A 0 that is
/// rounded outwards is still smaller than each normal number.
fn slack(t: f64) -> f64 {
    if t.is_finite() { 32.0 * double::U * t.abs() + f64::from(f32::MIN_POSITIVE) } else { 0.0 }
}

impl Tolerant<Option<(f32, f32)>> for Slab {
    fn accepts(&self, yours: Option<(f32, f32)>) -> bool {
        let same = |yours: f32, exact: f64| {
            f64::from(yours) == exact || (f64::from(yours) - exact).abs() <= slack(exact)
        };
        match (self, yours) {
            (Slab::Interval(near, far), Some((enter, leave))) => {
                *near <= far + slack(*near) + slack(*far) && same(enter, *near) && same(leave, *far)
            }
            (Slab::Interval(near, far), None) => !(*near <= far - slack(*near) - slack(*far)) || (near > far),
            (Slab::Verdict(is_hit), _) => {
                yours.is_some() == *is_hit && yours.is_none_or(|(enter, leave)| enter <= leave)
            }
        }
    }

    fn is_open(&self) -> bool {
        matches!(self, Slab::Interval(near, far) if (near - far).abs() <= slack(*near) + slack(*far))
    }

    fn words(&self) -> String {
        match self {
            Slab::Interval(near, far) if near <= far => format!("Some(({near}, {far}))"),
            Slab::Verdict(true) => "a hit".into(),
            _ => "None".into(),
        }
    }
}

fn judge_cases(trial: &Trial<'_>, cases: &[(SlabQuery, Slab)], source: &'static str) -> Vec<CheckResult> {
    let only_verdict = matches!(cases, [(_, Slab::Verdict(_)), ..]);
    let formulas = |query: &SlabQuery, yours, _| mistakes(query, yours, only_verdict);
    compare_tolerant(cases, ("slab", source), |queries| trial.kit.slab(queries), observations, formulas)
}

fn judge_slabs(trial: &Trial<'_>, queries: &[SlabQuery]) -> Vec<CheckResult> {
    let case = |query: &SlabQuery| {
        let (near, far) = box_interval(&query.ray, &query.bounds);
        let (near, far) = (near.max(f64::from(query.ray.t_min)), far.min(f64::from(query.ray.t_max)));
        (*query, Slab::Interval(near, far))
    };
    judge_cases(trial, &queries.iter().map(case).collect::<Vec<_>>(), "double precision")
}

fn judge_verdicts(trial: &Trial<'_>, cases: &[(Ray, Aabb, bool)]) -> Vec<CheckResult> {
    let case = |&(ray, bounds, is_hit): &_| (SlabQuery { ray, bounds }, Slab::Verdict(is_hit));
    judge_cases(trial, &cases.iter().map(case).collect::<Vec<_>>(), "exact arithmetic")
}

pub(super) fn slab_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let scales = (nasty::any_scale(), nasty::scale(-40..=40));
    let inputs = (point(8), direction(), aabb(), rough_point(1.0), scales).prop_map(
        |(origin, direction, bounds, at, (size, length))| {
            // Aim half of the rays at the box.
            let target = 0.5 * (bounds.min + bounds.max) + 0.5 * at * (bounds.max - bounds.min);
            let direction = if at.x > 0.0 && target != origin { target - origin } else { direction };
            let ray = Ray::new(size * origin, length * nasty::slanted(direction));
            SlabQuery { ray, bounds: Aabb::new(size * bounds.min, size * bounds.max) }
        },
    );
    // Begin with slanted rays that need each axis and each sign, because random rays shrink to rays along an axis.
    let drawn = [
        (vec3(-2.0, -1.5, -1.0), vec3(1.0, 1.0, 0.75)),
        (vec3(-2.0, -2.0, 2.0), vec3(1.0, 1.0, 0.25)),
        (vec3(-2.0, 2.0, -2.0), vec3(1.0, 0.25, 1.0)),
        (vec3(2.0, -2.0, -2.0), vec3(0.25, 1.0, 1.0)),
        (vec3(3.0, 2.5, 2.0), vec3(-1.0, -0.875, -0.75)),
        (vec3(-2.0, 0.5, 0.5), vec3(1.0, 0.125, -0.0625)),
    ]
    .map(|(origin, direction)| SlabQuery { ray: Ray::new(origin, direction), bounds: UNIT_BOX });
    trial.forall_and(&drawn, 6000, inputs, |queries| judge_slabs(trial, queries))
}

pub(super) fn slab_is_entered_at_once_from_inside(trial: &Trial<'_>) -> CheckResult {
    let middle = SlabQuery { ray: Ray::new(Vec3::splat(0.5), vec3(1.0, 0.5, -0.25)), bounds: UNIT_BOX };
    let inputs =
        (aabb(), 0..=8i32, 0..=8i32, 0..=8i32, direction()).prop_map(|(bounds, x, y, z, direction)| {
            let at = vec3(x as f32, y as f32, z as f32) / 8.0;
            let origin = bounds.min + at * (bounds.max - bounds.min);
            SlabQuery { ray: Ray::new(origin, nasty::slanted(direction)), bounds }
        });
    trial.forall_and(&[middle], 2000, inputs, |queries| judge_slabs(trial, queries))
}

pub(super) fn slab_takes_zeros_of_either_sign(trial: &Trial<'_>) -> CheckResult {
    // Every sign of zero on the two axes along which the ray does not move, for rays that hit and rays that miss.
    let mut cases = Vec::new();
    for axis in 0..3 {
        for (first, second) in [(0.0, 0.0), (0.0, -0.0), (-0.0, 0.0), (-0.0, -0.0)] {
            for way in [1.0, -1.0] {
                let mut direction = Vec3::ZERO;
                direction[axis] = way;
                direction[(axis + 1) % 3] = first;
                direction[(axis + 2) % 3] = second;
                let mut origin = Vec3::splat(0.5);
                origin[axis] = 0.5 - 2.0 * way;
                cases.push((Ray::new(origin, direction), UNIT_BOX, true));
                for beside in [-0.5, 1.5] {
                    let mut origin = origin;
                    origin[(axis + 1) % 3] = beside;
                    cases.push((Ray::new(origin, direction), UNIT_BOX, false));
                }
            }
        }
    }
    // A direction component so small that 1/d overflows: the ray hits if it starts between the planes of that axis.
    let creep = vec3(1.0, 1e-40, -1e-40);
    cases.push((Ray::new(vec3(-1.0, 0.5, 0.5), creep), UNIT_BOX, true));
    cases.push((Ray::new(vec3(-1.0, -0.5, 0.5), creep), UNIT_BOX, false));
    all_hold(judge_verdicts(trial, &cases))
}

pub(super) fn slab_is_hit_by_rays_within_a_face(trial: &Trial<'_>) -> CheckResult {
    // The origin lies in the plane of a face and the ray stays there, so (b - o)/d is 0/0 on that axis.
    let mut cases = Vec::new();
    for axis in 0..3 {
        for plane in [0.0, 1.0] {
            for zero in [0.0, -0.0] {
                let mut origin = Vec3::splat(-2.0);
                let mut direction = Vec3::splat(1.0);
                origin[axis] = plane;
                direction[axis] = zero;
                cases.push((Ray::new(origin, direction), UNIT_BOX, true));
                cases.push((Ray::new(origin, -direction), UNIT_BOX, false));
                cases.push((Ray::new(origin + 5.0 * direction, -direction), UNIT_BOX, true));
                // Within the face, and beside it.
                let mut along = Vec3::ZERO;
                along[(axis + 1) % 3] = 1.0;
                along[axis] = zero;
                let mut origin = Vec3::splat(0.25);
                origin[axis] = plane;
                cases.push((Ray::new(origin, along), UNIT_BOX, true));
                origin[(axis + 2) % 3] = 1.25;
                cases.push((Ray::new(origin, along), UNIT_BOX, false));
            }
        }
    }
    all_hold(judge_verdicts(trial, &cases))?;
    let query = |&(ray, bounds, is_hit): &(Ray, Aabb, bool)| is_hit.then_some(SlabQuery { ray, bounds });
    let queries: Vec<SlabQuery> = cases.iter().filter_map(query).collect();
    all_hold(judge_slabs(trial, &queries))
}

pub(super) fn slab_of_a_flat_box_is_hit(trial: &Trial<'_>) -> CheckResult {
    let mut cases = Vec::new();
    for axis in 0..3 {
        // At 100,000 a fixed padding is rounded away, and the box is flat again.
        for height in [0.0, 0.25, -3.0, 1e5] {
            let mut flat = UNIT_BOX;
            flat.min[axis] = height;
            flat.max[axis] = height;
            let mut origin = Vec3::splat(0.25);
            let mut direction = Vec3::splat(0.125);
            origin[axis] = height + 2.0;
            direction[axis] = -1.0;
            cases.push((Ray::new(origin, direction), flat, true));
            cases.push((Ray::new(origin, -direction), flat, false));
        }
    }
    let point = Aabb::new(Vec3::splat(0.5), Vec3::splat(0.5));
    cases.push((Ray::new(Vec3::ZERO, Vec3::ONE), point, true));
    cases.push((Ray::new(vec3(0.75, 0.25, -0.5), vec3(-0.25, 0.25, 1.0)), point, true));
    cases.push((Ray::new(vec3(0.75, 0.5, -0.5), vec3(-0.25, 0.25, 1.0)), point, false));
    all_hold(judge_verdicts(trial, &cases))
}

pub(super) fn slab_respects_the_range(trial: &Trial<'_>) -> CheckResult {
    let ray = Ray::new(vec3(-2.0, 0.5, 0.5), Vec3::X);
    let at_x = |x: f32| Ray::new(vec3(x, 0.5, 0.5), Vec3::X);
    let cases = [
        (ray, UNIT_BOX, true),
        (ray.with_range(0.0, 1.0), UNIT_BOX, false),
        (ray.with_range(4.0, 9.0), UNIT_BOX, false),
        (ray.with_range(2.25, 2.5), UNIT_BOX, true),
        // The entry is exactly at t_max, and one float behind it.
        (ray.with_range(0.0, 2.0), UNIT_BOX, true),
        (ray.with_range(0.0, 1.99), UNIT_BOX, false),
        (ray.with_range(3.0, 9.0), UNIT_BOX, true),
        (ray.with_range(3.01, 9.0), UNIT_BOX, false),
        (at_x(3.0), UNIT_BOX, false),
        (at_x(1.0), UNIT_BOX, true),
        (at_x(0.5), UNIT_BOX, true),
    ];
    all_hold(judge_verdicts(trial, &cases))?;
    let ranges = [(2.25, 2.5), (0.0, 2.5), (2.5, 9.0), (1.0, 9.0), (0.0, f32::INFINITY)];
    let queries =
        ranges.map(|(t_min, t_max)| SlabQuery { ray: ray.with_range(t_min, t_max), bounds: UNIT_BOX });
    all_hold(judge_slabs(trial, &queries))
}

pub(super) fn slab_hits_the_corners_it_is_aimed_at(trial: &Trial<'_>) -> CheckResult {
    // All numbers are multiples of 1/8, so o + t d is exactly the corner for t from 1 to 7. The closed box must be hit,
    // without tolerance.
    let inputs = (aabb(), point(8), 0..8usize, 1..=7i32).prop_map(|(bounds, origin, corner, t)| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        let corner = vec3(pick(0), pick(1), pick(2));
        let direction = nasty::slanted(corner - origin);
        SlabQuery { ray: Ray::new(corner - t as f32 * direction, direction), bounds }
    });
    trial.forall(3000, inputs, |queries| {
        judge_verdicts(
            trial,
            &queries.iter().map(|query| (query.ray, query.bounds, true)).collect::<Vec<_>>(),
        )
    })?;
    // Aimed beside the corner by a hundredth, the ray misses.
    let beside = |at: Vec3| (Ray::new(Vec3::splat(-1.0), at + Vec3::ONE), UNIT_BOX, false);
    all_hold(judge_verdicts(trial, &[beside(vec3(1.01, 0.0, -0.01)), beside(vec3(-0.01, 1.0, -0.01))]))
}

pub(super) fn slab_misses_the_empty_box(trial: &Trial<'_>) -> CheckResult {
    let dirs = [Vec3::X, Vec3::NEG_X, Vec3::ONE, -Vec3::ONE, vec3(0.0, -0.0, 1.0)];
    let middle = Vec3::splat(0.5);
    let empty = dirs.map(|direction| (Ray::new(middle, direction), Aabb::EMPTY, false));
    let unit = dirs.map(|direction| (Ray::new(middle, direction), UNIT_BOX, true));
    all_hold(judge_verdicts(trial, &[empty, unit].concat()))
}
