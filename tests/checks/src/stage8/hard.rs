//! Where the formulas of solids lie.

use super::solid::Solid;
use super::solids::input;
use crate::Trial;
use crate::broken::{Broken, Outcome};
use crate::judge::{compare, known};
use crate::splitmix::Random;
use glam::{Vec3, vec3};
use raykata::kit::SolidQuery;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Polygon};

type Case<S> = (SolidQuery<S>, Option<f32>, &'static str);

/// Cases whose `t` are short numbers: they come out to a rounding or two by any formula that is right there.
fn judge_cases<S: Solid>(trial: &Trial<'_>, cases: &[Case<S>]) -> Outcome {
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
        Err(Broken::told(input(query), format!("{t:?}"), format!("{expected:?}"), "closed form")
            .looks_like(known(diagnosis)))
    })
    .into_iter()
    .collect()
}

fn of<S: Clone>(solid: &S) -> impl Fn(Vec3, Vec3) -> SolidQuery<S> {
    move |origin, dir| SolidQuery { ray: Ray::new(origin, dir), solid: solid.clone() }
}

/// Rays from inside at the same point of the surface, which must all meet it.
fn judge_from_inside<S: Solid>(
    trial: &Trial<'_>,
    solid: &S,
    aims: impl Fn(&mut Random) -> Vec3,
    diagnosis: &'static str,
) -> Outcome {
    let mut random = Random::new(trial.seed, 8);
    let queries: Vec<SolidQuery<S>> = (0..3000)
        .map(|_| {
            let origin = solid.inside(random.in_cube());
            SolidQuery { ray: Ray::new(origin, aims(&mut random) - origin), solid: solid.clone() }
        })
        .collect();
    compare(&queries, S::ask(trial.kit, &queries), |query, yours| match yours {
        // The aim is at t = 1, but rounded: the surface may be a little nearer or farther, more so at a flat angle.
        Some(hit) if (hit.t - 1.0).abs() < 1e-3 => Ok(()),
        _ => Err(Broken::told(
            input(query),
            format!("{:?}", yours.map(|hit| hit.t)),
            "Some(1.0), or nearly",
            "it starts inside",
        )
        .looks_like(Some(diagnosis))),
    })
    .into_iter()
    .collect()
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
    judge_from_inside(
        trial,
        &can,
        rim,
        "lost between side and end: a point of the one is rounded beyond the other; cut their intervals instead",
    )?;
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
    judge_from_inside(
        trial,
        &leaning,
        rim,
        "lost between side and base: a point of the one is rounded beyond the other; cut their intervals instead",
    )
}

/// T8–T10, 35–37.
pub(super) fn polygon_at_edges_and_corners(trial: &Trial<'_>) -> Outcome {
    let square = Polygon {
        corners: vec![vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(2.0, 2.0, 0.0), vec3(0.0, 2.0, 0.0)],
    };
    let turned = Polygon { corners: square.corners.iter().rev().copied().collect() };
    let in_a_line = Polygon {
        corners: vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(1.0, 2.0, 0.0)],
    };
    let down = |polygon: &Polygon, x: f32, y: f32| of(polygon)(vec3(x, y, 3.0), Vec3::NEG_Z);
    let closed = "edges and corners belong to the polygon: to pass exactly through them is to hit";
    let diagonal = "the diagonals of the fan are inside";
    let winding = "corners in the other order are the same polygon from behind";
    judge_cases(
        trial,
        &[
            (down(&square, 0.5, 1.5), Some(3.0), ""),
            (down(&square, 1.0, 1.0), Some(3.0), diagonal),
            (down(&square, 0.0, 0.0), Some(3.0), closed),
            (down(&square, 2.0, 1.0), Some(3.0), closed),
            (down(&square, 2.25, 1.0), None, "outside"),
            (down(&turned, 0.5, 1.5), Some(3.0), winding),
            (down(&turned, 2.0, 2.0), Some(3.0), winding),
            (
                down(&in_a_line, 1.0, 0.5),
                Some(3.0),
                "three corners in a line: the normal of the first three is no normal",
            ),
            (down(&in_a_line, 1.0, 0.0), Some(3.0), closed),
            (down(&in_a_line, 1.75, 1.0), None, "outside"),
            (
                of(&square)(vec3(-1.0, 1.0, 0.0), Vec3::X),
                None,
                "a ray along the polygon meets it in no point",
            ),
        ],
    )?;
    // Two polygons share an edge far from the origin: no ray at it may pass between them.
    let place = vec3(1483.0, 12.0, -2234.0);
    let corners = [
        vec3(0.1, 0.2, 0.0),
        vec3(1.3, -0.4, 0.1),
        vec3(1.7, 1.1, 0.9),
        vec3(0.3, 1.6, 0.9),
        vec3(2.9, 0.1, 0.3),
    ]
    .map(|corner| place + corner);
    let [a, b, c, d, e] = corners;
    let (left, right) = (Polygon { corners: vec![a, b, c, d] }, Polygon { corners: vec![b, e, c] });
    let mut random = Random::new(trial.seed, 9);
    let rays: Vec<Ray> = (0..3000)
        .map(|_| {
            let origin = place + vec3(0.0, 0.0, 4.0) + random.in_cube();
            Ray::new(origin, b.lerp(c, 0.05 + 0.9 * random.unit()) - origin)
        })
        .collect();
    let queries = |polygon: &Polygon| -> Vec<SolidQuery<Polygon>> {
        rays.iter().map(|ray| SolidQuery { ray: *ray, solid: polygon.clone() }).collect()
    };
    let (left, right) = (queries(&left), queries(&right));
    let pairs: Vec<_> = trial.kit.polygon(&left).into_iter().zip(trial.kit.polygon(&right)).collect();
    compare(&left, pairs, |query, answers| match answers {
        (None, None) => Err(Broken::told(
            format!("{}\nand its neighbour across the edge", input(query)),
            "None, twice",
            "a hit of one of them at least",
            "they share the edge",
        )
        .looks_like(Some(
            "a point on the plane is rounded, and falls between the two: ask on which side of the edge the ray passes",
        ))),
        _ => Ok(()),
    })
    .into_iter()
    .collect()
}
