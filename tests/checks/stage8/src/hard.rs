//! Pitfalls of the formulas for solids.

use super::mistakes::agree;
use super::solid::{Solid, turned};
use super::solids::input;
use checks::prelude::*;
use oracle::splitmix::Random;
use raykata::shape::{Cone, Cuboid, Cylinder};

/// A ray, the expected `t`, and what students do who answer only rays of this kind wrongly. The text of an ordinary ray is
/// empty.
pub(super) type Case<S> = (SolidQuery<S>, Option<f32>, &'static str);

/// The same case for each order of the axes, and at a small size, whose `t` is the same if the direction is scaled, too.
fn variants<S: Solid>((query, expected, text): &Case<S>) -> Vec<Case<S>> {
    let turn = |SolidQuery { ray, solid }: &SolidQuery<S>| SolidQuery {
        ray: Ray { origin: turned(ray.origin), direction: turned(ray.direction), ..*ray },
        solid: solid.turned(),
    };
    let small = |SolidQuery { ray, solid }: &SolidQuery<S>| SolidQuery {
        ray: Ray { origin: SMALL * ray.origin, direction: SMALL * ray.direction, ..*ray },
        solid: solid.scaled(SMALL),
    };
    let once = turn(query);
    let twice = turn(&once);
    [query.clone(), small(&once), once, twice].map(|query| (query, *expected, *text)).to_vec()
}

/// A power of two.
const SMALL: f32 = 1.0 / 1024.0;

/// Judges cases whose `t` needs few bits: any correct formula gives it up to one or two rounding errors.
///
/// The message names the kind of ray that is answered wrongly, if all other kinds are answered rightly.
pub(super) fn judge_cases<S: Solid>(trial: &Trial<'_>, cases: &[Case<S>]) -> CheckResult {
    all_hold(judged_cases(trial, cases))
}

/// The result of each case.
fn judged_cases<S: Solid>(trial: &Trial<'_>, cases: &[Case<S>]) -> Vec<CheckResult> {
    let cases: Vec<Case<S>> = cases.iter().flat_map(variants).collect();
    let queries: Vec<SolidQuery<S>> = cases.iter().map(|(query, ..)| query.clone()).collect();
    let answers = S::ask(trial.kit, &queries);
    let is_sound = |hit: &SolidHit| (hit.normal.length() - 1.0).abs() <= 1e-5;
    let has_unsound = answers.iter().flatten().any(|hit| !is_sound(hit));
    // An ordinary ray that is answered rightly refutes a mistake that would answer it wrongly. A mistake in `t` does not
    // explain a wrong normal.
    let formulas = |(query, ..): &Case<S>, yours: &Option<SolidHit>| match has_unsound {
        true => Vec::new(),
        false => (S::MISTAKES)(query, yours.map(|hit| hit.t), 1.0),
    };
    let judge = |(query, expected, text): &Case<S>, yours: Option<SolidHit>| {
        let t = yours.map(|hit| hit.t);
        let right = agree(t, *expected, |t, expected| (t - expected).abs() <= 1e-5 * expected.abs());
        // No other check tests the normal of these hits, so test its length here.
        let sound = yours.is_none_or(|hit| is_sound(&hit));
        if right && sound {
            return Ok(());
        }
        let yours = match right {
            true => format!("{t:?}, normal {:?}", yours.map(|hit| hit.normal)),
            false => format!("{t:?}"),
        };
        Err(Broken::with_texts(input(query), yours, format!("{expected:?}"), "closed form").explained_by([
            (right, "the normal of your hit does not have unit length"),
            (!right && !text.is_empty(), *text),
        ]))
    };
    compare_formulas(&cases, answers, judge, formulas)
}

/// A random point of a circle around an axis.
fn on_circle(random: &mut Random, axis: Vec3, radius: f32) -> Vec3 {
    let (x, y) = axis.normalize().any_orthonormal_pair();
    let (sin, cos) = (std::f32::consts::TAU * random.unit()).sin_cos();
    radius * (cos * x + sin * y)
}

pub(super) fn of<S: Clone>(solid: &S) -> impl Fn(Vec3, Vec3) -> SolidQuery<S> {
    move |origin, direction| SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
}

/// Rays from inside the solid to points of its surface, which must all hit it, and rays in any direction.
pub(super) fn judge_from_inside<S: Solid>(
    trial: &Trial<'_>,
    solid: &S,
    aims: impl Fn(&mut Random) -> Vec3,
    lost: &'static str,
) -> Vec<CheckResult> {
    let mut random = Random::new(trial.seed, 8);
    let queries: Vec<SolidQuery<S>> = (0..3000)
        .map(|i| {
            let origin = solid.inside(random.in_cube());
            // Scale the direction so that the hit is not at t = 1, where many hit points are exact.
            let aimed = (1.0 + random.unit()) * (aims(&mut random) - origin);
            let direction = if i < N_ORDINARY { random.direction() } else { aimed };
            SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
        })
        .collect();
    // The aim is rounded, so the surface may be slightly nearer or farther, most of all at grazing angles.
    judge_leaving(trial, &queries, 0.499..1.001, lost)
}

/// The number of ordinary rays before those to an edge or a rim.
const N_ORDINARY: usize = 200;

/// Judges rays that start inside. The first [`N_ORDINARY`] leave the solid anywhere, the others at a `t` in the range `leave`.
/// `lost` says what students do who lose some of these others only.
fn judge_leaving<S: Solid>(
    trial: &Trial<'_>,
    queries: &[SolidQuery<S>],
    leave: std::ops::Range<f32>,
    lost: &'static str,
) -> Vec<CheckResult> {
    let numbered: Vec<(usize, &SolidQuery<S>)> = queries.iter().enumerate().collect();
    compare(&numbered, S::ask(trial.kit, queries), |(i, query), yours| {
        let ordinary = *i < N_ORDINARY;
        let range = if ordinary { 0.0..f32::INFINITY } else { leave.clone() };
        let t = yours.map(|hit| hit.t);
        if t.is_some_and(|t| range.contains(&t)) {
            return Ok(());
        }
        let expected = format!("Some t between {} and {}", range.start, range.end);
        let broken = Broken::with_texts(input(query), format!("{t:?}"), expected, "the ray starts inside");
        Err(broken.explained_by([
            (!ordinary && t.is_none(), lost),
            "you return None for a ray that starts inside: it hits the surface where it leaves"
                .when(t.is_none()),
        ]))
    })
}

/// Rays from inside a solid around the y axis to points of its rim, at distance 5 from the axis. All coordinates have
/// few bits, so the rays pass exactly through the rim: a tie between two surfaces, which double precision alone does
/// not resolve.
pub(super) fn judge_ties_at_the_rim<S: Solid>(
    trial: &Trial<'_>,
    solid: &S,
    ends: [f32; 2],
    lost: &'static str,
) -> Vec<CheckResult> {
    let mut random = Random::new(trial.seed, 10);
    let mut short = |n: u64| random.below(2 * n + 1) as f32 - n as f32;
    let mut query = |i: usize| {
        let (x, z) =
            [(3.0, 4.0), (4.0, -3.0), (-5.0, 0.0), (-3.0, 4.0), (0.0, 5.0)][(short(2) + 2.0) as usize];
        let rim = vec3(x, ends[(0.5 + 0.5 * short(1)) as usize], z);
        let origin = vec3(short(8), 8.0 + short(6), short(8)) / 8.0;
        // 1/123, 1/117 and 1/105 are rounded up by nearly half an ulp: t times a coordinate of direction is often
        // beyond the rim.
        let aimed = [123.0, 117.0, 105.0][(short(1) + 1.0) as usize] * (rim - origin);
        let direction = if i < N_ORDINARY { aimed + vec3(50.0, 20.0, 0.0) } else { aimed };
        SolidQuery { ray: Ray::new(origin, direction), solid: solid.clone() }
    };
    let queries: Vec<SolidQuery<S>> = (0..3000).map(&mut query).collect();
    judge_leaving(trial, &queries, 0.008..0.0096, lost)
}

const STARTS_ON_FACE: &str = "you are wrong for rays that start on a face: a hit at t = 0 does not count, and the exit is the \
    hit if the ray crosses the box";

/// Rays in the plane of a face, at edges and at flat boxes.
pub(super) fn cuboid_seen_along_its_faces(trial: &Trial<'_>) -> CheckResult {
    let unit = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    let ask = of(&unit);
    let in_face = "you lose rays in the plane of a face, which belongs to the box: look for < in place of <=, and for \
        0 · ∞ or 0/0, which are NaN";
    let minus_zero = "your answer depends on the sign of a 0 in the direction: -0.0 is 0";
    let from_inside = "you are wrong for rays along an axis from inside: the exit is the hit";
    let slow = "you take a short direction for 0: it may have any length, and only 0 is parallel to a face";
    let flat = Cuboid { min: vec3(0.0, 2.0, 0.0), max: vec3(1.0, 2.0, 1.0) };
    let far = Cuboid { min: vec3(1e5, 1e5, 0.0), max: vec3(1e5 + 1.0, 1e5, 1.0) };
    let flat_lost =
        "you lose flat boxes: a flat box is hit like any other box, so compare with <= instead of <";
    let mut judged = judged_cases(
        trial,
        &[
            (ask(vec3(0.5, 0.5, -2.0), Vec3::Z), Some(2.0), ""),
            (ask(vec3(0.5, 0.5, 3.0), vec3(0.0, 0.0, -2.0)), Some(1.0), ""),
            (ask(vec3(-1.0, -0.25, 0.5), vec3(2.0, 1.0, 0.0)), Some(0.5), ""),
            (
                ask(vec3(1.5, 0.5, -2.0), Vec3::Z),
                None,
                "you hit the box with rays that pass beside it along an axis",
            ),
            (ask(vec3(0.0, 0.5, -2.0), Vec3::Z), Some(2.0), in_face),
            (ask(vec3(1.0, 0.5, -2.0), Vec3::Z), Some(2.0), in_face),
            (ask(vec3(1.0, 1.0, -2.0), Vec3::Z), Some(2.0), in_face),
            (ask(vec3(0.0, 1.0, 3.0), Vec3::NEG_Z), Some(2.0), in_face),
            (ask(vec3(2.0, 0.5, 0.5), vec3(-1.0, -0.0, 0.0)), Some(1.0), minus_zero),
            (ask(vec3(0.5, 0.5, -2.0), vec3(-0.0, -0.0, 1.0)), Some(2.0), minus_zero),
            (ask(vec3(1.5, 0.5, -2.0), vec3(-0.0, -0.0, 1.0)), None, minus_zero),
            (ask(vec3(0.5, 0.5, 0.5), Vec3::X), Some(0.5), from_inside),
            (ask(vec3(-1.0, -0.25, 0.5), 2f32.powi(-40) * vec3(2.0, 1.0, 0.0)), Some(2f32.powi(39)), slow),
            (ask(vec3(1.0, 0.5, 0.5), Vec3::X), None, STARTS_ON_FACE),
            (ask(vec3(0.0, 0.5, 0.5), Vec3::X), Some(1.0), STARTS_ON_FACE),
            (of(&flat)(vec3(0.5, 5.0, 0.5), Vec3::NEG_Y), Some(3.0), flat_lost),
            (of(&far)(vec3(1e5 + 0.5, 1e5 + 4.0, 0.5), Vec3::NEG_Y), Some(4.0), flat_lost),
        ],
    );
    let lost = "you lose a ray at an edge: a rounded point on one face lies outside of its rectangle; \
        intersect the intervals of the axes";
    let edge = |random: &mut Random| vec3(1.0, 1.0, random.unit());
    judged.extend(judge_from_inside(trial, &unit, edge, lost));
    let leaning = Cuboid { min: vec3(0.1, 0.2, 0.3), max: vec3(1.3, 1.7, 1.1) };
    judged.extend(judge_from_inside(
        trial,
        &leaning,
        |random| vec3(1.3, 0.2, 0.3 + 0.8 * random.unit()),
        lost,
    ));
    all_hold(judged)
}

/// Rays parallel to the axis.
pub(super) fn cylinder_seen_along_its_axis(trial: &Trial<'_>) -> CheckResult {
    let can = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 1.0 };
    let ask = of(&can);
    let along = "you are wrong for rays parallel to the axis: a = |d × A|² is 0 and 0/0 is NaN there; such a ray is in \
        the infinite cylinder for all t or for no t";
    let leaning = Cylinder { base: Vec3::ZERO, top: vec3(2.0, 2.0, 0.0), radius: 1.0 };
    let cases = [
        (ask(vec3(0.5, -3.0, 0.0), Vec3::Y), Some(3.0), along),
        (ask(vec3(0.5, 5.0, -0.0), vec3(-0.0, -1.0, 0.0)), Some(3.0), along),
        (ask(vec3(0.0, 5.0, 0.0), vec3(0.0, -2.0, -0.0)), Some(1.5), along),
        (ask(vec3(1.5, -3.0, 0.0), Vec3::Y), None, BESIDE_CYLINDER),
        (ask(vec3(0.0, 3.0, -1.25), vec3(0.0, -1.0, -0.0)), None, BESIDE_CYLINDER),
        (ask(vec3(0.5, 1.0, 0.0), Vec3::Y), Some(1.0), along),
        (ask(vec3(0.5, 1.0, 0.0), Vec3::X), Some(0.5), ""),
        (of(&leaning)(vec3(-1.0, -1.0, 0.5), vec3(1.0, 1.0, 0.0)), Some(1.0), along),
        (ask(vec3(-3.0, 1.0, 0.0), Vec3::X), Some(2.0), ""),
        (ask(vec3(-3.0, 1.0, 0.25), vec3(2.0, 0.25, 0.0)), Some((3.0 - 0.9375f32.sqrt()) / 2.0), ""),
        (ask(vec3(0.0, 4.0, -1.0), vec3(0.0, -2.0, 1.0)), Some(1.0), ""),
        (ask(vec3(-3.0, 2.5, 0.0), Vec3::X), None, ""),
        (ask(vec3(-3.0, -0.5, 0.0), Vec3::X), None, ""),
    ];
    judge_cases(trial, &cases)?;
    // Judge rays in the surface alone, because other mistakes lose them as well.
    let cases = [
        (ask(vec3(1.0, -3.0, 0.0), Vec3::Y), Some(3.0), IN_THE_SIDE),
        (ask(vec3(0.0, 4.0, -1.0), vec3(0.0, -2.0, 0.0)), Some(1.0), IN_THE_SIDE),
        // Ends and radius are right.
        (ask(vec3(0.75, -3.0, 0.0), Vec3::Y), Some(3.0), ""),
    ];
    judge_cases(trial, &cases)
}

const IN_THE_SIDE: &str =
    "you lose rays that run along the side, in the surface: the side belongs to the solid";

const BESIDE_CYLINDER: &str =
    "you hit the cylinder with rays that are parallel to its axis and pass beside the cylinder";

/// Rays from inside to the rim, and rays that touch the side.
pub(super) fn cylinder_at_its_rim(trial: &Trial<'_>) -> CheckResult {
    let can = Cylinder { base: vec3(0.25, -0.5, 0.125), top: vec3(0.75, 1.5, 0.5), radius: 0.8 };
    let rim = |random: &mut Random| {
        let around = on_circle(random, can.top - can.base, can.radius);
        let end = if random.below(2) == 0 { can.base } else { can.top };
        end + around
    };
    let lost = "you lose a ray between side and end: a rounded point of one lies beyond the other; intersect \
        their intervals";
    let mut judged = judge_from_inside(trial, &can, rim, lost);
    let wide = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 5.0 };
    judged.extend(judge_ties_at_the_rim(trial, &wide, [0.0, 2.0], lost));
    let upright = Cylinder { base: Vec3::ZERO, top: vec3(0.0, 2.0, 0.0), radius: 1.0 };
    let touches = "you lose a ray that touches the side: a discriminant of exactly 0 is a hit";
    judged.extend(judged_cases(
        trial,
        &[
            (of(&upright)(vec3(-3.0, 1.0, 1.0), Vec3::X), Some(3.0), touches),
            (of(&upright)(vec3(-1.0, 1.0, -3.0), vec3(0.0, 0.0, 2.0)), Some(1.5), touches),
            (of(&upright)(vec3(-3.0, 1.0, 0.0), Vec3::X), Some(2.0), ""),
        ],
    ));
    all_hold(judged)
}

const HAT: Cone = Cone { base: Vec3::ZERO, apex: Vec3::Y, radius: 1.0 };

/// Rays above the apex, where the equation describes a second cone.
pub(super) fn cone_is_not_its_mirror_image(trial: &Trial<'_>) -> CheckResult {
    let ask = of(&HAT);
    let mirrored =
        "you are wrong above the apex, where the equation has a second cone: it is not part of the solid";
    let cases = [
        (ask(vec3(-5.0, 2.0, 0.0), Vec3::X), None, mirrored),
        (ask(vec3(-5.0, 1.5, 0.25), Vec3::X), None, mirrored),
        (ask(vec3(0.125, 5.0, 0.0), Vec3::NEG_Y), Some(4.125), mirrored),
        (ask(vec3(0.0, 3.0, 0.0), Vec3::X), None, mirrored),
        (ask(vec3(-5.0, 0.5, 0.0), Vec3::X), Some(4.5), ""),
        (ask(vec3(-5.0, -0.5, 0.0), Vec3::X), None, ""),
        (ask(vec3(2.0, -1.0, 0.0), vec3(-2.0, 1.0, 0.0)), Some(1.0), ""),
    ];
    judge_cases(trial, &cases)
}

/// Rays parallel to the side, and steeper rays.
pub(super) fn cone_seen_along_its_side(trial: &Trial<'_>) -> CheckResult {
    let ask = of(&HAT);
    let linear = "you are wrong for rays parallel to the side: a is 0 there, so solve 2 b t + c = 0";
    let steep = "you are wrong for rays that are steeper than the side: a is negative, so a ray is inside beyond a root, \
        not between the two";
    let cases = [
        (ask(vec3(-1.0, 1.5, 0.0), vec3(1.0, -1.0, 0.0)), Some(0.75), linear),
        (ask(vec3(0.0, 1.5, -1.0), vec3(0.0, -0.5, 0.5)), Some(1.5), linear),
        (ask(vec3(-0.5, 0.25, 0.0), vec3(1.0, 1.0, 0.0)), Some(0.625), linear),
        (ask(vec3(-0.75, -0.5, 0.0), vec3(1.0, 1.0, 0.0)), Some(0.5), linear),
        (ask(vec3(0.5, 3.0, 0.0), Vec3::NEG_Y), Some(2.5), steep),
        (ask(vec3(0.5, -1.0, 0.0), Vec3::Y), Some(1.0), steep),
        (ask(vec3(0.25, 0.25, 0.0), Vec3::Y), Some(0.5), steep),
        (ask(vec3(0.25, 0.25, 0.0), Vec3::NEG_Y), Some(0.25), steep),
        (ask(vec3(2.5, 3.0, 0.0), Vec3::NEG_Y), None, steep),
        (ask(vec3(-5.0, 0.5, 0.0), Vec3::X), Some(4.5), ""),
        (ask(vec3(3.0, 0.25, 0.0), Vec3::NEG_X), Some(2.25), ""),
    ];
    judge_cases(trial, &cases)?;
    // Judge rays in the surface alone, because other mistakes lose them as well.
    let cases = [
        (ask(vec3(2.0, -1.0, 0.0), vec3(-1.0, 1.0, 0.0)), Some(1.0), IN_THE_SIDE),
        (ask(vec3(0.0, 2.0, -1.0), vec3(0.0, -2.0, 2.0)), Some(0.5), IN_THE_SIDE),
        (ask(vec3(2.0, -1.0, 0.5), vec3(-1.0, 1.0, 0.0)), None, ""),
    ];
    judge_cases(trial, &cases)
}

/// Rays to the apex and to the rim.
pub(super) fn cone_at_its_tip_and_rim(trial: &Trial<'_>) -> CheckResult {
    let lost = "you lose a ray at the apex: a rounded point lies above the apex; intersect intervals instead \
        of testing points";
    let touches = "you lose a ray that touches the cone only in its apex: the apex belongs to the cone";
    let mut judged = judged_cases(
        trial,
        &[
            (of(&HAT)(vec3(0.0, 3.0, 0.0), Vec3::NEG_Y), Some(2.0), lost),
            (of(&HAT)(vec3(0.0, 0.25, 0.0), Vec3::Y), Some(0.75), lost),
            (of(&HAT)(vec3(-5.0, 1.0, 0.0), Vec3::X), Some(5.0), touches),
            (of(&HAT)(vec3(-5.0, 0.5, 0.0), Vec3::X), Some(4.5), ""),
        ],
    );
    let leaning = Cone { base: vec3(0.25, -0.5, 0.125), apex: vec3(0.75, 1.5, 0.5), radius: 0.8 };
    judged.extend(judge_from_inside(trial, &leaning, |_| leaning.apex, lost));
    let rim =
        |random: &mut Random| leaning.base + on_circle(random, leaning.apex - leaning.base, leaning.radius);
    all_hold(judged)?;
    let lost = "you lose a ray between side and base: a rounded point of one lies beyond the other; \
        intersect their intervals";
    let mut judged = judge_from_inside(trial, &leaning, rim, lost);
    let wide = Cone { base: Vec3::ZERO, apex: vec3(0.0, 3.0, 0.0), radius: 5.0 };
    judged.extend(judge_ties_at_the_rim(trial, &wide, [0.0, 0.0], lost));
    all_hold(judged)
}
