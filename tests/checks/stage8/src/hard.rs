//! Pitfalls of the formulas for solids.

use super::solid::Solid;
use super::solids::input;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use glam::{Vec3, vec3};
use oracle::splitmix::Random;
use raykata::kit::SolidQuery;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder};

pub(super) type Case<S> = (SolidQuery<S>, Option<f32>, &'static str);

/// Judges cases whose `t` needs few bits: any correct formula gives it up to one or two rounding errors.
pub(super) fn judge_cases<S: Solid>(trial: &Trial<'_>, cases: &[Case<S>]) -> CheckResult {
    let queries: Vec<SolidQuery<S>> = cases.iter().map(|(query, ..)| query.clone()).collect();
    compare(cases, S::ask(trial.kit, &queries), |(query, expected, diagnosis), yours| {
        let t = yours.map(|hit| hit.t);
        let right = match (t, expected) {
            (Some(t), Some(expected)) => (t - expected).abs() <= 1e-5 * expected.abs(),
            (None, None) => true,
            _ => false,
        };
        // No other check tests the normal of these hits, so test its length here.
        let sound = yours.is_none_or(|hit| (hit.normal.length() - 1.0).abs() <= 1e-5);
        if right && sound {
            return Ok(());
        }
        let diagnosis = if right { "the normal of your hit does not have unit length" } else { diagnosis };
        Err(Broken::with_texts(input(query), format!("{t:?}"), format!("{expected:?}"), "closed form")
            .looks_like(known(diagnosis)))
    })
    .into_iter()
    .collect()
}

pub(super) fn of<S: Clone>(solid: &S) -> impl Fn(Vec3, Vec3) -> SolidQuery<S> {
    move |origin, direction| SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
}

/// Rays from inside the solid to points of its surface, which must all hit it.
pub(super) fn judge_from_inside<S: Solid>(
    trial: &Trial<'_>,
    solid: &S,
    aims: impl Fn(&mut Random) -> Vec3,
    diagnosis: &'static str,
) -> CheckResult {
    let mut random = Random::new(trial.seed, 8);
    let queries: Vec<SolidQuery<S>> = (0..3000)
        .map(|_| {
            let origin = solid.inside(random.in_cube());
            // Scale the direction so that the hit is not at t = 1, where many hit points are exact.
            let direction = (1.0 + random.unit()) * (aims(&mut random) - origin);
            SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
        })
        .collect();
    // The aim is rounded, so the surface may be slightly nearer or farther, most of all at grazing angles.
    judge_leaving(trial, &queries, 0.499..1.001, diagnosis)
}

/// Judges rays that start inside and leave the solid at a `t` in the range `leave`.
pub(super) fn judge_leaving<S: Solid>(
    trial: &Trial<'_>,
    queries: &[SolidQuery<S>],
    leave: std::ops::Range<f32>,
    diagnosis: &'static str,
) -> CheckResult {
    compare(queries, S::ask(trial.kit, queries), |query, yours| match yours {
        Some(hit) if leave.contains(&hit.t) => Ok(()),
        _ => Err(Broken::with_texts(
            input(query),
            format!("{:?}", yours.map(|hit| hit.t)),
            format!("Some t between {} and {}", leave.start, leave.end),
            "the ray starts inside",
        )
        .looks_like(Some(diagnosis))),
    })
    .into_iter()
    .collect()
}

/// Rays from inside a solid around the y axis to points of its rim, at distance 5 from the axis. All coordinates have
/// few bits, so the rays pass exactly through the rim: a tie between two surfaces, which double precision alone does
/// not resolve.
pub(super) fn judge_ties_at_the_rim<S: Solid>(
    trial: &Trial<'_>,
    solid: &S,
    ends: [f32; 2],
    diagnosis: &'static str,
) -> CheckResult {
    let mut random = Random::new(trial.seed, 10);
    let mut short = |n: u64| random.below(2 * n + 1) as f32 - n as f32;
    let mut query = || {
        let (x, z) =
            [(3.0, 4.0), (4.0, -3.0), (-5.0, 0.0), (-3.0, 4.0), (0.0, 5.0)][(short(2) + 2.0) as usize];
        let rim = vec3(x, ends[(0.5 + 0.5 * short(1)) as usize], z);
        let origin = vec3(short(8), 8.0 + short(6), short(8)) / 8.0;
        // 1/123, 1/117 and 1/105 are rounded up by nearly half an ulp: t times a coordinate of direction is often
        // beyond the rim.
        let direction = [123.0, 117.0, 105.0][(short(1) + 1.0) as usize] * (rim - origin);
        SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
    };
    let queries: Vec<SolidQuery<S>> = (0..3000).map(|_| query()).collect();
    judge_leaving(trial, &queries, 0.008..0.0096, diagnosis)
}

/// Rays in the plane of a face, at edges and at flat boxes (traps B3, B4, B7; 38–43, 46).
pub(super) fn cuboid_seen_along_its_faces(trial: &Trial<'_>) -> CheckResult {
    let unit = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    let ask = of(&unit);
    let in_face =
        "the ray lies in the plane of a face: 0 · ∞ and 0/0 are NaN, and the face belongs to the box";
    let minus_zero = "a direction of -0.0 is 0: its sign must not matter";
    let flat = Cuboid { min: vec3(0.0, 2.0, 0.0), max: vec3(1.0, 2.0, 1.0) };
    let far = Cuboid { min: vec3(1e5, 1e5, 0.0), max: vec3(1e5 + 1.0, 1e5, 1.0) };
    let flat_lost = "a flat box is hit like any other box: compare with <= instead of <";
    judge_cases(
        trial,
        &[
            (ask(vec3(0.5, 0.5, -2.0), Vec3::Z), Some(2.0), ""),
            (ask(vec3(0.0, 0.5, -2.0), Vec3::Z), Some(2.0), in_face),
            (ask(vec3(1.0, 1.0, -2.0), Vec3::Z), Some(2.0), in_face),
            (ask(vec3(2.0, 0.5, 0.5), vec3(-1.0, -0.0, 0.0)), Some(1.0), minus_zero),
            (ask(vec3(0.5, 0.5, -2.0), vec3(-0.0, -0.0, 1.0)), Some(2.0), minus_zero),
            (ask(vec3(1.5, 0.5, -2.0), vec3(-0.0, -0.0, 1.0)), None, minus_zero),
            (ask(vec3(0.5, 0.5, 0.5), Vec3::X), Some(0.5), "from inside, the exit is the hit"),
            (
                ask(vec3(1.0, 0.5, 0.5), Vec3::X),
                None,
                "the ray starts on a face and leaves the box: a hit at t = 0 does not count",
            ),
            (
                ask(vec3(0.0, 0.5, 0.5), Vec3::X),
                Some(1.0),
                "the ray starts on a face and crosses the box: the exit is the hit",
            ),
            (of(&flat)(vec3(0.5, 5.0, 0.5), Vec3::NEG_Y), Some(3.0), flat_lost),
            (of(&far)(vec3(1e5 + 0.5, 1e5 + 4.0, 0.5), Vec3::NEG_Y), Some(4.0), flat_lost),
        ],
    )?;
    let lost = "you lose a ray at an edge: a rounded point on one face lies outside of its rectangle; \
        intersect the intervals of the axes";
    let edge = |random: &mut Random| vec3(1.0, 1.0, random.unit());
    judge_from_inside(trial, &unit, edge, lost)?;
    let leaning = Cuboid { min: vec3(0.1, 0.2, 0.3), max: vec3(1.3, 1.7, 1.1) };
    judge_from_inside(trial, &leaning, |random| vec3(1.3, 0.2, 0.3 + 0.8 * random.unit()), lost)
}

/// Rays parallel to the axis (traps C1; 29).
pub(super) fn cylinder_seen_along_its_axis(trial: &Trial<'_>) -> CheckResult {
    let can = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 1.0 };
    let ask = of(&can);
    let along = "the ray is parallel to the axis, so a = |d × A|² is 0 and 0/0 is NaN: it is in the infinite \
        cylinder for all t or for no t";
    let leaning = Cylinder { base: Vec3::ZERO, top: vec3(2.0, 2.0, 0.0), radius: 1.0 };
    judge_cases(
        trial,
        &[
            (ask(vec3(0.5, -3.0, 0.0), Vec3::Y), Some(3.0), along),
            (ask(vec3(0.5, 5.0, -0.0), vec3(-0.0, -1.0, 0.0)), Some(3.0), along),
            (ask(vec3(0.0, 5.0, 0.0), vec3(0.0, -2.0, -0.0)), Some(1.5), along),
            (ask(vec3(1.5, -3.0, 0.0), Vec3::Y), None, "the ray passes beside the cylinder"),
            (ask(vec3(0.5, 1.0, 0.0), Vec3::Y), Some(1.0), "from inside, the ray leaves through an end"),
            (of(&leaning)(vec3(-1.0, -1.0, 0.5), vec3(1.0, 1.0, 0.0)), Some(1.0), along),
            (ask(vec3(-3.0, 1.0, 0.0), Vec3::X), Some(2.0), ""),
            (ask(vec3(-3.0, 2.5, 0.0), Vec3::X), None, "the ray passes above the upper end"),
        ],
    )
}

/// Rays from inside to the rim, and rays that touch the side (traps C1; 30, 31).
pub(super) fn cylinder_at_its_rim(trial: &Trial<'_>) -> CheckResult {
    let can = Cylinder { base: vec3(0.25, -0.5, 0.125), top: vec3(0.75, 1.5, 0.5), radius: 0.8 };
    let (x, y) = (can.top - can.base).normalize().any_orthonormal_pair();
    let rim = |random: &mut Random| {
        let (sin, cos) = (std::f32::consts::TAU * random.unit()).sin_cos();
        let end = if random.below(2) == 0 { can.base } else { can.top };
        end + can.radius * (cos * x + sin * y)
    };
    let lost = "you lose a ray between side and end: a rounded point of one lies beyond the other; intersect \
        their intervals";
    judge_from_inside(trial, &can, rim, lost)?;
    let wide = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 5.0 };
    judge_ties_at_the_rim(trial, &wide, [0.0, 2.0], lost)?;
    let upright = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 1.0 };
    let touches = "you lose a ray that touches the side: a discriminant of exactly 0 is a hit";
    judge_cases(trial, &[(of(&upright)(vec3(-3.0, 1.0, 1.0), Vec3::X), Some(3.0), touches)])
}

const HAT: Cone = Cone { base: Vec3::ZERO, apex: Vec3::Y, radius: 1.0 };

/// Rays above the apex, where the equation describes a second cone (traps C2; 33).
pub(super) fn cone_is_not_its_mirror_image(trial: &Trial<'_>) -> CheckResult {
    let ask = of(&HAT);
    let ghost =
        "above the apex the equation describes a second cone, upside down, which is not part of the solid";
    judge_cases(
        trial,
        &[
            (ask(vec3(-5.0, 2.0, 0.0), Vec3::X), None, ghost),
            (ask(vec3(-5.0, 1.5, 0.25), Vec3::X), None, ghost),
            (ask(vec3(0.125, 5.0, 0.0), Vec3::NEG_Y), Some(4.125), ghost),
            (ask(vec3(0.0, 3.0, 0.0), Vec3::X), None, ghost),
            (ask(vec3(-5.0, 0.5, 0.0), Vec3::X), Some(4.5), ""),
            (
                ask(vec3(-5.0, -0.5, 0.0), Vec3::X),
                None,
                "the ray passes below the base, where the equation still has solutions",
            ),
        ],
    )
}

/// Rays parallel to the side, and steeper rays (traps C2; 34).
pub(super) fn cone_seen_along_its_side(trial: &Trial<'_>) -> CheckResult {
    let ask = of(&HAT);
    let linear = "the ray is parallel to the side, so a is 0: solve 2 b t + c = 0";
    let steep =
        "the ray is steeper than the side, so a is negative: it is inside beyond a root, not between the two";
    judge_cases(
        trial,
        &[
            (ask(vec3(-1.0, 1.5, 0.0), vec3(1.0, -1.0, 0.0)), Some(0.75), linear),
            (ask(vec3(-0.5, 0.25, 0.0), vec3(1.0, 1.0, 0.0)), Some(0.625), linear),
            (ask(vec3(0.5, 3.0, 0.0), Vec3::NEG_Y), Some(2.5), steep),
            (ask(vec3(0.5, -1.0, 0.0), Vec3::Y), Some(1.0), steep),
            (ask(vec3(0.25, 0.25, 0.0), Vec3::Y), Some(0.5), steep),
            (ask(vec3(0.25, 0.25, 0.0), Vec3::NEG_Y), Some(0.25), steep),
            (ask(vec3(2.5, 3.0, 0.0), Vec3::NEG_Y), None, "the ray passes beside the cone"),
        ],
    )
}

/// Rays to the apex and to the rim (traps C2; 32).
pub(super) fn cone_at_its_tip_and_rim(trial: &Trial<'_>) -> CheckResult {
    let lost = "you lose a ray at the apex: a rounded point lies above the apex; intersect intervals instead \
        of testing points";
    judge_cases(
        trial,
        &[
            (of(&HAT)(vec3(0.0, 3.0, 0.0), Vec3::NEG_Y), Some(2.0), lost),
            (of(&HAT)(vec3(0.0, 0.25, 0.0), Vec3::Y), Some(0.75), lost),
        ],
    )?;
    let leaning = Cone { base: vec3(0.25, -0.5, 0.125), apex: vec3(0.75, 1.5, 0.5), radius: 0.8 };
    judge_from_inside(trial, &leaning, |_| leaning.apex, lost)?;
    let (x, y) = (leaning.apex - leaning.base).normalize().any_orthonormal_pair();
    let rim = |random: &mut Random| {
        let (sin, cos) = (std::f32::consts::TAU * random.unit()).sin_cos();
        leaning.base + leaning.radius * (cos * x + sin * y)
    };
    let lost = "you lose a ray between side and base: a rounded point of one lies beyond the other; \
        intersect their intervals";
    judge_from_inside(trial, &leaning, rim, lost)?;
    let wide = Cone { base: Vec3::ZERO, apex: vec3(0.0, 3.0, 0.0), radius: 5.0 };
    judge_ties_at_the_rim(trial, &wide, [0.0, 0.0], lost)
}
