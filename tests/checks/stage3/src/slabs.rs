//! Ray-box intersection: `slab`.

use super::boxes::aabb;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::{self, box_interval};
use checks::generate::{direction, point, rough_point};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::kit::SlabQuery;
use raykata::ray::Ray;

pub(super) fn judge_slabs(
    trial: &Trial<'_>,
    queries: &[SlabQuery],
    diagnosis: &'static str,
) -> Vec<CheckResult> {
    compare(queries, trial.kit.slab(queries), |query, yours| {
        let (near, far) = box_interval(&query.ray, &query.bounds);
        let (near, far) = (near.max(f64::from(query.ray.t_min)), far.min(f64::from(query.ray.t_max)));
        // Allow for the roundings of a difference, a reciprocal and a product, and for methods that widen the box.
        let slack = |t: f64| if t.is_finite() { 32.0 * double::U * t.abs() } else { 0.0 };
        let room = slack(near) + slack(far);
        let same = |yours: f32, exact: f64| {
            f64::from(yours) == exact || (f64::from(yours) - exact).abs() <= slack(exact)
        };
        let right = match yours {
            Some((enter, leave)) => near <= far + room && same(enter, near) && same(leave, far),
            None => !(near <= far - room) || (near > far),
        };
        if right {
            return Ok(());
        }
        let describe = match near <= far {
            true => format!("Some(({near}, {far}))"),
            false => "None".into(),
        };
        let broken =
            Broken::with_texts(query.call("slab"), format!("{yours:?}"), describe, "double precision");
        Err(broken.looks_like(known(slab_diagnosis(query, yours, diagnosis))))
    })
}

pub(super) fn slab_diagnosis(
    query: &SlabQuery,
    yours: Option<(f32, f32)>,
    otherwise: &'static str,
) -> &'static str {
    let inside = query.bounds.contains(query.ray.origin);
    let zero = query.ray.direction.to_array().contains(&0.0);
    let within_a_face = (0..3).any(|axis| {
        let planes = [query.bounds.min[axis], query.bounds.max[axis]];
        query.ray.direction[axis] == 0.0 && planes.contains(&query.ray.origin[axis])
    });
    match yours {
        Some((enter, leave)) if enter.is_nan() || leave.is_nan() => {
            "you return NaN: 0 · ∞ is NaN, so order the comparison so that it drops NaN"
        }
        Some(_) if otherwise.is_empty() && misses_by_one_axis(query) => {
            "is an axis left out? the ray must be between the planes of all three axes at once"
        }
        _ if within_a_face => {
            "the ray runs within the plane of a face: 0 · ∞ is NaN, and min or max may drop the wrong operand"
        }
        Some((enter, _)) if enter < query.ray.t_min => "your entry is before t_min: start with near = t_min",
        Some((_, leave)) if leave > query.ray.t_max => "your exit is beyond t_max: start with far = t_max",
        None if inside && !zero && otherwise.is_empty() => {
            "the ray starts inside: its entry is behind it (test the exit, not t_b⁻ ≥ 0)"
        }
        None if query.ray.direction.min_element() < 0.0 && !zero && otherwise.is_empty() => {
            "for a negative direction component the ray enters at max: swap the two planes"
        }
        _ => otherwise,
    }
}

/// Whether the ray misses the box, but would hit it if the box were infinite along some axis.
fn misses_by_one_axis(query: &SlabQuery) -> bool {
    let meets = |bounds: &Aabb| {
        let (near, far) = box_interval(&query.ray, bounds);
        near.max(0.0) <= far
    };
    let mut infinite = [query.bounds; 3];
    for (axis, bounds) in infinite.iter_mut().enumerate() {
        (bounds.min[axis], bounds.max[axis]) = (f32::MIN, f32::MAX);
    }
    !meets(&query.bounds) && infinite.iter().any(meets)
}

pub(super) fn slab_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let inputs =
        (point(8), direction(), aabb(), rough_point(1.0)).prop_map(|(origin, direction, bounds, at)| {
            // Aim half of the rays at the box.
            let target = 0.5 * (bounds.min + bounds.max) + 0.5 * at * (bounds.max - bounds.min);
            let direction = if at.x > 0.0 && target != origin { target - origin } else { direction };
            SlabQuery { ray: Ray::new(origin, direction), bounds }
        });
    // First test slanted rays that need each axis and each sign, because random rays shrink to rays along an axis.
    let drawn = [
        (vec3(-2.0, -1.5, -1.0), vec3(1.0, 1.0, 0.75)),
        (vec3(-2.0, -2.0, 2.0), vec3(1.0, 1.0, 0.25)),
        (vec3(-2.0, 2.0, -2.0), vec3(1.0, 0.25, 1.0)),
        (vec3(2.0, -2.0, -2.0), vec3(0.25, 1.0, 1.0)),
        (vec3(3.0, 2.5, 2.0), vec3(-1.0, -0.875, -0.75)),
    ]
    .map(|(origin, direction)| SlabQuery { ray: Ray::new(origin, direction), bounds: UNIT_BOX });
    judge_slabs(trial, &drawn, "").into_iter().collect::<CheckResult>()?;
    trial.forall(6000, inputs, |queries| judge_slabs(trial, queries, ""))
}

pub(super) fn slab_is_entered_at_once_from_inside(trial: &Trial<'_>) -> CheckResult {
    let middle = SlabQuery { ray: Ray::new(Vec3::splat(0.5), vec3(1.0, 0.5, -0.25)), bounds: UNIT_BOX };
    judge_slabs(trial, &[middle], "").into_iter().collect::<CheckResult>()?;
    let inputs =
        (aabb(), 0..=8i32, 0..=8i32, 0..=8i32, direction()).prop_map(|(bounds, x, y, z, direction)| {
            let at = vec3(x as f32, y as f32, z as f32) / 8.0;
            SlabQuery { ray: Ray::new(bounds.min + at * (bounds.max - bounds.min), direction), bounds }
        });
    trial.forall(2000, inputs, |queries| {
        judge_slabs(trial, queries, "the ray starts inside, or on a face: a closed box is entered at t_min")
    })
}

pub(super) const UNIT_BOX: Aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);

/// Judges rays whose verdict, a hit or a miss, is known exactly.
pub(super) fn judge_slabs_exactly(
    trial: &Trial<'_>,
    cases: &[(Ray, Aabb, bool)],
    diagnosis: &'static str,
) -> CheckResult {
    let queries: Vec<SlabQuery> = cases.iter().map(|&(ray, bounds, _)| SlabQuery { ray, bounds }).collect();
    for ((query, yours), (_, _, hit)) in queries.iter().zip(trial.kit.slab(&queries)).zip(cases) {
        let sound = yours.is_none_or(|(enter, leave)| enter <= leave);
        if yours.is_some() != *hit || !sound {
            let expected = if *hit { "a hit" } else { "None" };
            let broken =
                Broken::with_texts(query.call("slab"), format!("{yours:?}"), expected, "exact arithmetic");
            return Err(broken.looks_like(Some(diagnosis)));
        }
    }
    Ok(())
}

pub(super) fn slab_takes_zeros_of_either_sign(trial: &Trial<'_>) -> CheckResult {
    // B3: every sign of zero on the two axes along which the ray does not move, for rays that hit and rays that miss.
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
    // First test the rays without -0.0: a failure there has another cause than the sign of zero.
    let negative_zero = |case: &(Ray, Aabb, bool)| {
        case.0.direction.to_array().iter().any(|d| *d == 0.0 && d.is_sign_negative())
    };
    let (negative, positive): (Vec<_>, Vec<_>) = cases.into_iter().partition(negative_zero);
    judge_slabs_exactly(
        trial,
        &positive,
        "1/d is ∞ for d = 0, and ∞ - ∞ is NaN: subtract first, (b - o) · 1/d and not b/d - o/d",
    )?;
    judge_slabs_exactly(
        trial,
        &negative,
        "-0.0 ≥ 0 is true, but 1 / -0.0 is -∞: swap the two planes by the sign of 1/d",
    )?;
    // A direction component so small that 1/d overflows: the ray hits if it starts between the planes of that axis.
    let creep = vec3(1.0, 1e-40, -1e-40);
    let cases = [
        (Ray::new(vec3(-1.0, 0.5, 0.5), creep), UNIT_BOX, true),
        (Ray::new(vec3(-1.0, -0.5, 0.5), creep), UNIT_BOX, false),
    ];
    judge_slabs_exactly(trial, &cases, "1/d overflows to ∞ for a tiny d: treat d like 0")
}

pub(super) fn slab_is_hit_by_rays_within_a_face(trial: &Trial<'_>) -> CheckResult {
    // B4: the origin lies in the plane of a face and the ray stays there, so (b - o)/d is 0/0 on that axis.
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
            }
        }
    }
    let diagnosis =
        "0 · ∞ is NaN, and NaN takes part in a min or max: a ray within a face hits the closed box";
    judge_slabs_exactly(trial, &cases, diagnosis)
}

pub(super) fn slab_of_a_flat_box_is_hit(trial: &Trial<'_>) -> CheckResult {
    let mut cases = Vec::new();
    for axis in 0..3 {
        // B6: at 100,000 a fixed padding is rounded away, and the box is flat again.
        for height in [0.0, 0.25, -3.0, 1e5] {
            let mut flat = UNIT_BOX;
            flat.min[axis] = height;
            flat.max[axis] = height;
            let mut origin = Vec3::splat(0.5);
            let mut direction = Vec3::ZERO;
            origin[axis] = height + 2.0;
            direction[axis] = -1.0;
            cases.push((Ray::new(origin, direction), flat, true));
            cases.push((Ray::new(origin, -direction), flat, false));
        }
    }
    let point = Aabb::new(Vec3::splat(0.5), Vec3::splat(0.5));
    cases.push((Ray::new(Vec3::ZERO, Vec3::ONE), point, true));
    cases.push((Ray::new(vec3(0.5, 0.5, -1.0), Vec3::Z), point, true));
    cases.push((Ray::new(vec3(0.5, 0.25, -1.0), Vec3::Z), point, false));
    judge_slabs_exactly(
        trial,
        &cases,
        "entry equals exit in a flat box: ≤, not < (and no padding, which is rounded away far off)",
    )
}

pub(super) fn slab_respects_the_range(trial: &Trial<'_>) -> CheckResult {
    let ray = Ray::new(vec3(-2.0, 0.5, 0.5), Vec3::X);
    let cases = [
        (ray, UNIT_BOX, true),
        (ray.with_range(0.0, 1.0), UNIT_BOX, false),
        (ray.with_range(4.0, 9.0), UNIT_BOX, false),
        (ray.with_range(2.25, 2.5), UNIT_BOX, true),
        (Ray::new(vec3(3.0, 0.5, 0.5), Vec3::X), UNIT_BOX, false),
        (Ray::new(vec3(1.0, 0.5, 0.5), Vec3::X), UNIT_BOX, true),
        (Ray::new(vec3(0.5, 0.5, 0.5), Vec3::X), UNIT_BOX, true),
    ];
    judge_slabs_exactly(
        trial,
        &cases,
        "only the part within t_min..t_max counts, and the box is closed (exit at t_min is a hit)",
    )?;
    let inside = SlabQuery { ray: ray.with_range(2.25, 2.5), bounds: UNIT_BOX };
    judge_slabs(trial, &[inside], "return the part of the box's interval that lies within t_min..t_max")
        .into_iter()
        .collect()
}

pub(super) fn slab_hits_the_corners_it_is_aimed_at(trial: &Trial<'_>) -> CheckResult {
    // A10: all numbers are multiples of 1/8, so o + 1 d is exactly the corner. The closed box must be hit, without
    // tolerance.
    let inputs = (aabb(), point(8), 0..8usize).prop_map(|(bounds, origin, corner)| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        let direction = vec3(pick(0), pick(1), pick(2)) - origin;
        SlabQuery { ray: Ray::new(origin, if direction == Vec3::ZERO { Vec3::X } else { direction }), bounds }
    });
    trial.forall(3000, inputs, |queries| {
        compare(queries, trial.kit.slab(queries), |query, yours| match yours {
            Some(_) => Ok(()),
            None => Err(Broken::with_texts(query.call("slab"), "None", "a hit", "exact arithmetic")
                .looks_like(Some(
                    "1/d, the difference and the product are rounded, so far may be slightly below near: \
                     multiply far by 1 + 2 γ₃",
                ))),
        })
    })
}

pub(super) fn slab_misses_the_empty_box(trial: &Trial<'_>) -> CheckResult {
    let dirs = [Vec3::X, Vec3::NEG_X, Vec3::ONE, -Vec3::ONE, vec3(0.0, -0.0, 1.0)];
    let cases = dirs.map(|direction| (Ray::new(vec3(0.5, 0.5, 0.5), direction), Aabb::EMPTY, false));
    judge_slabs_exactly(
        trial,
        &cases,
        "the empty box (inf, -inf) has no point, but sorted planes make it infinite: test is_empty()",
    )
}
