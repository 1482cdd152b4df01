//! Ray-triangle intersection: each check for all three methods.

use super::method::{TriangleFunction, aimed};
use checks::double::{Tolerant, TriangleExpected};
use checks::generate::{self, scaled, triangle};
use checks::prelude::*;

/// A triangle in the plane z = 0 whose front is the side of +z.
pub(super) const UNIT: Triangle = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };

pub(super) fn triangle_agrees(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    // Begin with simple rays at a simple triangle, because their messages are the easiest to read.
    let drawn = [
        TriangleQuery { ray: Ray::new(vec3(0.125, 0.5, 2.0), vec3(0.0, 0.0, -0.5)), triangle: UNIT },
        TriangleQuery { ray: Ray::new(vec3(0.5, 0.125, -3.0), vec3(0.0, 0.0, 2.0)), triangle: UNIT },
        slanted(),
    ];
    // Rays within the plane are those of another check.
    let from_beside = |TriangleQuery { ray, triangle: Triangle { a, b, c } }: &TriangleQuery| {
        (*b - *a).cross(*c - *a).dot(ray.origin - *a) != 0.0
    };
    let inputs = aimed(triangle(), point(8)).prop_filter("within the plane", from_beside);
    trial.forall_and(&drawn, 6000, inputs, |queries| method.judge(trial, queries))
}

/// The slide's determinant is right for rays along z at [`UNIT`] and wrong for this ray, whose t is 2.
fn slanted() -> TriangleQuery {
    TriangleQuery {
        ray: Ray::new(vec3(-2.5, -4.5, -6.25), vec3(1.0, 2.0, 3.0)),
        triangle: Triangle { a: Vec3::ZERO, b: vec3(-1.0, -1.0, 0.0), c: vec3(-1.0, -1.0, -1.0) },
    }
}

/// The three regions beyond the sides and the three beyond the corners, for rays along an axis and for slanted rays. A test of
/// the sum β + γ alone, and areas without a sign, accept points of some of these regions.
pub(super) fn triangle_regions(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let places = [
        (0.25, 0.25),
        (2.0, -1.5),
        (-1.5, 2.0),
        (-0.2, -0.2),
        (0.75, 0.75),
        (-0.25, 0.5),
        (0.5, -0.25),
        (1.5, 0.5),
        (-0.5, 1.25),
        (1.25, -0.5),
    ];
    let mut queries: Vec<TriangleQuery> = Vec::new();
    for direction in [Vec3::NEG_Z, vec3(1.0, 2.0, -4.0), vec3(-0.5, 0.25, -1.0)] {
        queries.extend(places.map(|(x, y)| TriangleQuery {
            ray: Ray::new(vec3(x, y, 0.0) - 2.0 * direction, direction),
            triangle: UNIT,
        }));
    }
    queries.push(slanted());
    all_hold(method.judge(trial, &queries))
}

pub(super) fn triangle_windings(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let sides = [1.0, -1.0].map(|way| TriangleQuery {
        ray: Ray::new(vec3(0.125, 0.5, 2.0 * way), vec3(0.0, 0.0, -way)),
        triangle: UNIT,
    });
    // All six orders of the corners must give the same verdict and the same t, from the front and from the back.
    trial.forall_and(&sides, 1000, aimed(triangle(), point(8)), |queries| {
        let orders = |query: &TriangleQuery| {
            let Triangle { a, b, c } = query.triangle;
            [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]]
                .map(|[a, b, c]| TriangleQuery { triangle: Triangle { a, b, c }, ..*query })
        };
        let all: Vec<TriangleQuery> = queries.iter().flat_map(orders).collect();
        let outcomes = method.judge(trial, &all);
        outcomes.chunks(6).map(|six| all_hold(six.to_vec())).collect()
    })
}

pub(super) fn triangle_in_range(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let triangle = Triangle { a: vec3(-2.0, -2.0, 0.0), b: vec3(2.0, -2.0, 0.0), c: vec3(-2.0, 2.0, 0.0) };
    let hit = |t| Some(TriangleHit { t, beta: 0.25, gamma: 0.25 });
    let at = |z: f32, t_min: f32, t_max: f32| TriangleQuery {
        ray: Ray::new(vec3(-1.0, -1.0, z), Vec3::NEG_Z).with_range(t_min, t_max),
        triangle,
    };
    let infinite = f32::INFINITY;
    method.judge_exact(
        trial,
        &[
            (at(4.0, 0.0, infinite), hit(4.0)),
            (at(-4.0, 0.0, infinite), None),
            (at(0.0, 0.0, infinite), None),
            (at(4.0, 5.0, infinite), None),
            (at(4.0, 0.0, 3.0), None),
            (at(4.0, 0.0, 4.0), None),
            (at(4.0, 4.0, infinite), None),
            (at(4.0, 3.0, 5.0), hit(4.0)),
            (at(4.0, 4.0f32.next_down(), 4.0f32.next_up()), hit(4.0)),
            (at(2f32.powi(-20), 0.0, infinite), hit(2f32.powi(-20))),
        ],
    )?;
    trial.forall(400, aimed(generate::triangle(), point(8)), |queries| judge_ends(trial, method, queries))
}

/// Asks again with ranges that end exactly at the answer, one float before it and one float behind it.
fn judge_ends(trial: &Trial<'_>, method: TriangleFunction, queries: &[TriangleQuery]) -> Vec<CheckResult> {
    let judge = |(query, hit): (&TriangleQuery, Option<TriangleHit>)| {
        let Some(hit) = hit.filter(|hit| query.ray.contains(hit.t)) else { return Ok(()) };
        let cases = nasty::ranges(hit.t).map(|((t_min, t_max), counts)| {
            (TriangleQuery { ray: query.ray.with_range(t_min, t_max), ..*query }, counts.then_some(hit))
        });
        method.judge_exact(trial, &cases)
    };
    queries.iter().zip((method.ask)(trial.kit, queries)).map(judge).collect()
}

pub(super) fn triangle_edges(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    // The sides are powers of two and the ray runs along an axis, so every method computes β and γ exactly. Two places
    // are outside by less than a thousandth, and two clearly. The sizes are ordinary: limits of size are another check's matter.
    let beside = -(2f32.powi(-10));
    let places = [
        (1.0, 1.0),
        (2.0, 0.0),
        (0.0, 1.0),
        (3.0, 1.0),
        (0.0, 0.0),
        (4.0, 0.0),
        (0.0, 4.0),
        (2.0, beside),
        (beside, 1.0),
        (2.0, -1.0),
        (-1.0, 1.0),
    ];
    let mut cases = Vec::new();
    for (axis, factor) in [(0, 1.0), (1, 1.0), (2, 1.0), (0, 2f32.powi(-3)), (1, 2f32.powi(12))] {
        let place = |x: f32, y: f32, z: f32| {
            let mut place = [x, y, z];
            place.rotate_right(axis);
            factor * Vec3::from_array(place)
        };
        let triangle = Triangle { a: Vec3::ZERO, b: place(4.0, 0.0, 0.0), c: place(0.0, 4.0, 0.0) };
        for (x, y) in places {
            let mut direction = Vec3::ZERO;
            direction[(2 + axis) % 3] = -1.0;
            let ray = Ray::new(place(x, y, 2.0), direction);
            let hit = TriangleHit { t: 2.0 * factor, beta: x / 4.0, gamma: y / 4.0 };
            cases.push((TriangleQuery { ray, triangle }, (x >= 0.0 && y >= 0.0).then_some(hit)));
        }
    }
    method.judge_exact(trial, &cases)
}

/// A scene a million times smaller or larger gives the same verdict, the same β and γ, and `t` times the factor.
pub(super) fn triangle_sizes(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let factors = (nasty::scale(-24..=24), nasty::scale(-16..=16));
    let inputs = (aimed(triangle(), point(8)), factors).prop_map(|(query, (size, length))| {
        let TriangleQuery { ray, triangle } = query;
        let ray = Ray { origin: size * ray.origin, direction: length * ray.direction, ..ray };
        TriangleQuery { ray, triangle: scaled(triangle, size) }
    });
    trial.forall(3000, inputs, |queries| method.judge(trial, queries))
}

/// Small triangles at (148376, 1234, -223423), with the ray's origin near them.
pub(super) fn triangle_far(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let place = vec3(148_376.0, 1_234.0, -223_423.0);
    let triangles = (rough_point(4.0), rough_point(4.0), rough_point(4.0))
        .prop_map(move |(a, b, c)| Triangle { a: place + a, b: place + b, c: place + c });
    let origins = rough_point(8.0).prop_map(move |offset| place + offset);
    trial.forall(3000, aimed(triangles, origins), |queries| method.judge(trial, queries))
}

pub(super) fn triangle_missed(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let down = Ray::new(vec3(0.25, 0.25, 1.0), Vec3::NEG_Z);
    let along = |origin| TriangleQuery { ray: Ray::new(origin, Vec3::X), triangle: UNIT };
    let with = |a, b, c| TriangleQuery { ray: down, triangle: Triangle { a, b, c } };
    let p = vec3(0.25, 0.25, 0.0);
    // The sliver of pbrt's tests, https://github.com/mmp/pbrt-v4/blob/master/src/pbrt/shapes_test.cpp: x and z are
    // constant, so it has no area.
    let sliver = TriangleQuery {
        ray: Ray::new(vec3(-1_081.479_2, 99.999_954, 87.770_11), vec3(-32.107_3, -183.355_87, -144.607_64))
            .with_range(0.0, 0.9999),
        triangle: Triangle {
            a: vec3(-1_113.454_6, -79.049_614, -56.243_19),
            b: vec3(-1_113.454_6, -87.092_27, -56.243_19),
            c: vec3(-1_113.454_6, -79.209_015, -56.243_19),
        },
    };
    let hit = TriangleHit { t: 1.0, beta: 0.25, gamma: 0.25 };
    method.judge_exact(
        trial,
        &[
            (TriangleQuery { ray: down, triangle: UNIT }, Some(hit)),
            (along(vec3(-1.0, 0.25, 0.0)), None),
            (along(vec3(-1.0, 0.25, 1.0)), None),
            (with(p, p, p), None),
            (with(p, p, Vec3::X), None),
            (with(Vec3::ZERO, 0.5 * p, 2.0 * p), None),
            (TriangleQuery { ray: Ray { direction: Vec3::ZERO, ..down }, triangle: UNIT }, None),
            (sliver, None),
        ],
    )?;
    // For sizes that overflow single precision both a hit and a miss are accepted, but a hit must not contain NaN.
    let huge = [with(-1e20 * Vec3::ONE, 1e20 * Vec3::X, 1e20 * Vec3::Y)];
    all_hold(compare(&huge, (method.ask)(trial.kit, &huge), |query, yours| {
        if yours.is_none_or(|hit| hit.t.is_finite() && hit.beta.is_finite() && hit.gamma.is_finite()) {
            return Ok(());
        }
        let (yours, finite) = (TriangleExpected::words_of(yours), "None, or finite numbers");
        Err(Broken::with_texts(query.call(method.name), yours, finite, "the definition")
            .because("NaN is never a hit: compare so that NaN fails"))
    }))
}
