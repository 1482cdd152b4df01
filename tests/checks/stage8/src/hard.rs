//! Where the formulas of solids lie.

use super::solid::Solid;
use super::solids::input;
use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::{compare, known};
use glam::{Vec3, vec3};
use oracle::splitmix::Random;
use raykata::kit::SolidQuery;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder};

pub(super) type Case<S> = (SolidQuery<S>, Option<f32>, &'static str);

/// Cases whose `t` are short numbers: they come out to a rounding or two by any formula that is right there.
pub(super) fn judge_cases<S: Solid>(trial: &Trial<'_>, cases: &[Case<S>]) -> Outcome {
    let queries: Vec<SolidQuery<S>> = cases.iter().map(|(query, ..)| query.clone()).collect();
    compare(cases, S::ask(trial.kit, &queries), |(query, expected, diagnosis), yours| {
        let t = yours.map(|hit| hit.t);
        let right = match (t, expected) {
            (Some(t), Some(expected)) => (t - expected).abs() <= 1e-5 * expected.abs(),
            (None, None) => true,
            _ => false,
        };
        // A normal that is asked for nowhere else must still be one.
        let sound = yours.is_none_or(|hit| (hit.normal.length() - 1.0).abs() <= 1e-5);
        if right && sound {
            return Ok(());
        }
        let diagnosis = if right { "a hit whose normal is no unit vector" } else { diagnosis };
        Err(Broken::with_texts(input(query), format!("{t:?}"), format!("{expected:?}"), "closed form")
            .looks_like(known(diagnosis)))
    })
    .into_iter()
    .collect()
}

pub(super) fn of<S: Clone>(solid: &S) -> impl Fn(Vec3, Vec3) -> SolidQuery<S> {
    move |origin, direction| SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
}

/// Rays from inside at the same point of the surface, which must all meet it.
pub(super) fn judge_from_inside<S: Solid>(
    trial: &Trial<'_>,
    solid: &S,
    aims: impl Fn(&mut Random) -> Vec3,
    diagnosis: &'static str,
) -> Outcome {
    let mut random = Random::new(trial.seed, 8);
    let queries: Vec<SolidQuery<S>> = (0..3000)
        .map(|_| {
            let origin = solid.inside(random.in_cube());
            // Not 1 - o, whose sum with o is 1 again: at t = 1 many a point is exact that is rounded elsewhere.
            let direction = (1.0 + random.unit()) * (aims(&mut random) - origin);
            SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
        })
        .collect();
    // The aim is rounded: the surface may be a little nearer or farther, more so at a flat angle.
    judge_leaving(trial, &queries, 0.499..1.001, diagnosis)
}

/// Rays that start inside, and leave at a `t` of this range.
pub(super) fn judge_leaving<S: Solid>(
    trial: &Trial<'_>,
    queries: &[SolidQuery<S>],
    leave: std::ops::Range<f32>,
    diagnosis: &'static str,
) -> Outcome {
    compare(queries, S::ask(trial.kit, queries), |query, yours| match yours {
        Some(hit) if leave.contains(&hit.t) => Ok(()),
        _ => Err(Broken::with_texts(
            input(query),
            format!("{:?}", yours.map(|hit| hit.t)),
            format!("Some t between {} and {}", leave.start, leave.end),
            "it starts inside",
        )
        .looks_like(Some(diagnosis))),
    })
    .into_iter()
    .collect()
}

/// Rays from short numbers inside of a solid around the y axis to points of its rim, 5 from the axis, that are short numbers,
/// too: to pass exactly through the rim is a tie, at which double precision alone does not help.
pub(super) fn judge_ties_at_the_rim<S: Solid>(
    trial: &Trial<'_>,
    solid: &S,
    ends: [f32; 2],
    diagnosis: &'static str,
) -> Outcome {
    let mut random = Random::new(trial.seed, 10);
    let mut short = |n: u64| random.below(2 * n + 1) as f32 - n as f32;
    let mut query = || {
        let (x, z) =
            [(3.0, 4.0), (4.0, -3.0), (-5.0, 0.0), (-3.0, 4.0), (0.0, 5.0)][(short(2) + 2.0) as usize];
        let rim = vec3(x, ends[(0.5 + 0.5 * short(1)) as usize], z);
        let origin = vec3(short(8), 8.0 + short(6), short(8)) / 8.0;
        // 1/123, 1/117 and 1/105 are rounded up by nearly half a step: t times a coordinate of direction is often beyond the rim.
        let direction = [123.0, 117.0, 105.0][(short(1) + 1.0) as usize] * (rim - origin);
        SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
    };
    let queries: Vec<SolidQuery<S>> = (0..3000).map(|_| query()).collect();
    judge_leaving(trial, &queries, 0.008..0.0096, diagnosis)
}

/// B3, B4, B7; 38–43, 46.
pub(super) fn cuboid_seen_along_its_faces(trial: &Trial<'_>) -> Outcome {
    let unit = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    let ask = of(&unit);
    let in_face = "a ray within the plane of a face: 0 · ∞ and 0/0 are NaN, and the face belongs to the box";
    let minus_zero = "a direction of -0.0 is no direction to the other side";
    let flat = Cuboid { min: vec3(0.0, 2.0, 0.0), max: vec3(1.0, 2.0, 1.0) };
    let far = Cuboid { min: vec3(1e5, 1e5, 0.0), max: vec3(1e5 + 1.0, 1e5, 1.0) };
    let flat_lost = "a flat box is a box: compare with <= and not with <";
    judge_cases(
        trial,
        &[
            (ask(vec3(0.5, 0.5, -2.0), Vec3::Z), Some(2.0), ""),
            (ask(vec3(0.0, 0.5, -2.0), Vec3::Z), Some(2.0), in_face),
            (ask(vec3(1.0, 1.0, -2.0), Vec3::Z), Some(2.0), in_face),
            (ask(vec3(2.0, 0.5, 0.5), vec3(-1.0, -0.0, 0.0)), Some(1.0), minus_zero),
            (ask(vec3(0.5, 0.5, -2.0), vec3(-0.0, -0.0, 1.0)), Some(2.0), minus_zero),
            (ask(vec3(1.5, 0.5, -2.0), vec3(-0.0, -0.0, 1.0)), None, minus_zero),
            (ask(vec3(0.5, 0.5, 0.5), Vec3::X), Some(0.5), "from inside the way out is the hit"),
            (
                ask(vec3(1.0, 0.5, 0.5), Vec3::X),
                None,
                "it starts on the face and leaves: t = 0 does not count",
            ),
            (ask(vec3(0.0, 0.5, 0.5), Vec3::X), Some(1.0), "it starts on the face and crosses the box"),
            (of(&flat)(vec3(0.5, 5.0, 0.5), Vec3::NEG_Y), Some(3.0), flat_lost),
            (of(&far)(vec3(1e5 + 0.5, 1e5 + 4.0, 0.5), Vec3::NEG_Y), Some(4.0), flat_lost),
        ],
    )?;
    let lost = "an edge lost by rounding: a point on one face is not within the rectangle; cut the intervals of the axes";
    let edge = |random: &mut Random| vec3(1.0, 1.0, random.unit());
    judge_from_inside(trial, &unit, edge, lost)?;
    let leaning = Cuboid { min: vec3(0.1, 0.2, 0.3), max: vec3(1.3, 1.7, 1.1) };
    judge_from_inside(trial, &leaning, |random| vec3(1.3, 0.2, 0.3 + 0.8 * random.unit()), lost)
}

/// C1; 29.
pub(super) fn cylinder_seen_along_its_axis(trial: &Trial<'_>) -> Outcome {
    let can = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 1.0 };
    let ask = of(&can);
    let along = "along the axis a = |d × A|² is 0, and 0/0 is NaN: then the ray is inside the round all the way, or never";
    let leaning = Cylinder { base: Vec3::ZERO, top: vec3(2.0, 2.0, 0.0), radius: 1.0 };
    judge_cases(
        trial,
        &[
            (ask(vec3(0.5, -3.0, 0.0), Vec3::Y), Some(3.0), along),
            (ask(vec3(0.5, 5.0, -0.0), vec3(-0.0, -1.0, 0.0)), Some(3.0), along),
            (ask(vec3(0.0, 5.0, 0.0), vec3(0.0, -2.0, -0.0)), Some(1.5), along),
            (ask(vec3(1.5, -3.0, 0.0), Vec3::Y), None, "beside the cylinder"),
            (ask(vec3(0.5, 1.0, 0.0), Vec3::Y), Some(1.0), "from inside it leaves through an end"),
            (of(&leaning)(vec3(-1.0, -1.0, 0.5), vec3(1.0, 1.0, 0.0)), Some(1.0), along),
            (ask(vec3(-3.0, 1.0, 0.0), Vec3::X), Some(2.0), ""),
            (ask(vec3(-3.0, 2.5, 0.0), Vec3::X), None, "above the upper end"),
        ],
    )
}

/// C1; 30, 31.
pub(super) fn cylinder_at_its_rim(trial: &Trial<'_>) -> Outcome {
    let can = Cylinder { base: vec3(0.25, -0.5, 0.125), top: vec3(0.75, 1.5, 0.5), radius: 0.8 };
    let (x, y) = (can.top - can.base).normalize().any_orthonormal_pair();
    let rim = |random: &mut Random| {
        let (sin, cos) = (std::f32::consts::TAU * random.unit()).sin_cos();
        let end = if random.below(2) == 0 { can.base } else { can.top };
        end + can.radius * (cos * x + sin * y)
    };
    let lost = "lost between side and end: a point of the one is rounded beyond the other; cut their intervals instead";
    judge_from_inside(trial, &can, rim, lost)?;
    let wide = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 5.0 };
    judge_ties_at_the_rim(trial, &wide, [0.0, 2.0], lost)?;
    let upright = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 1.0 };
    let touches = "the ray touches the side: a discriminant of exactly 0 is a hit";
    judge_cases(trial, &[(of(&upright)(vec3(-3.0, 1.0, 1.0), Vec3::X), Some(3.0), touches)])
}

const HAT: Cone = Cone { base: Vec3::ZERO, apex: Vec3::Y, radius: 1.0 };

/// C2; 33.
pub(super) fn cone_is_not_its_mirror_image(trial: &Trial<'_>) -> Outcome {
    let ask = of(&HAT);
    let ghost = "above the tip the equation describes a second cone, upside down, which is not there";
    judge_cases(
        trial,
        &[
            (ask(vec3(-5.0, 2.0, 0.0), Vec3::X), None, ghost),
            (ask(vec3(-5.0, 1.5, 0.25), Vec3::X), None, ghost),
            (ask(vec3(0.125, 5.0, 0.0), Vec3::NEG_Y), Some(4.125), ghost),
            (ask(vec3(0.0, 3.0, 0.0), Vec3::X), None, ghost),
            (ask(vec3(-5.0, 0.5, 0.0), Vec3::X), Some(4.5), ""),
            (ask(vec3(-5.0, -0.5, 0.0), Vec3::X), None, "below the base the equation goes on"),
        ],
    )
}

/// C2; 34.
pub(super) fn cone_seen_along_its_side(trial: &Trial<'_>) -> Outcome {
    let ask = of(&HAT);
    let linear = "along the side a is 0, and the equation is 2 b t + c = 0";
    let steep =
        "steeper than the side a is negative: the ray is inside beyond a root, and not between the two";
    judge_cases(
        trial,
        &[
            (ask(vec3(-1.0, 1.5, 0.0), vec3(1.0, -1.0, 0.0)), Some(0.75), linear),
            (ask(vec3(-0.5, 0.25, 0.0), vec3(1.0, 1.0, 0.0)), Some(0.625), linear),
            (ask(vec3(0.5, 3.0, 0.0), Vec3::NEG_Y), Some(2.5), steep),
            (ask(vec3(0.5, -1.0, 0.0), Vec3::Y), Some(1.0), steep),
            (ask(vec3(0.25, 0.25, 0.0), Vec3::Y), Some(0.5), steep),
            (ask(vec3(0.25, 0.25, 0.0), Vec3::NEG_Y), Some(0.25), steep),
            (ask(vec3(2.5, 3.0, 0.0), Vec3::NEG_Y), None, "beside the cone"),
        ],
    )
}

/// C2; 32.
pub(super) fn cone_at_its_tip_and_rim(trial: &Trial<'_>) -> Outcome {
    let lost = "lost at the tip: a point there is rounded above it; cut intervals and test no point";
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
    let lost = "lost between side and base: a point of the one is rounded beyond the other; cut their intervals instead";
    judge_from_inside(trial, &leaning, rim, lost)?;
    let wide = Cone { base: Vec3::ZERO, apex: vec3(0.0, 3.0, 0.0), radius: 5.0 };
    judge_ties_at_the_rim(trial, &wide, [0.0, 0.0], lost)
}
