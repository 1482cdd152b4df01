//! Ray-triangle intersection: each check for all three methods.

use super::method::{CHOICE, CRAMER, GRAM, TriangleFunction, aimed, describe};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{point, rough_point, triangle};
use checks::judge::compare;
use checks::paste::Arguments;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{TriangleHit, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;

macro_rules! for_all_methods {
    ($($cramer:ident $gram:ident $choice:ident $law:ident;)*) => {
        $(pub(super) fn $cramer(trial: &Trial<'_>) -> CheckResult {
            $law(trial, CRAMER)
        }
        pub(super) fn $gram(trial: &Trial<'_>) -> CheckResult {
            $law(trial, GRAM)
        }
        pub(super) fn $choice(trial: &Trial<'_>) -> CheckResult {
            $law(trial, CHOICE)
        })*
    };
}

for_all_methods! {
    triangle_cramer_agrees_with_double_precision
    triangle_gram_agrees_with_double_precision
    triangle_choice_agrees_with_double_precision
        triangle_agrees;
    triangle_cramer_knows_inside_from_outside
    triangle_gram_knows_inside_from_outside
    triangle_choice_knows_inside_from_outside
        triangle_regions;
    triangle_cramer_is_hit_from_either_side
    triangle_gram_is_hit_from_either_side
    triangle_choice_is_hit_from_either_side
        triangle_windings;
    triangle_cramer_respects_the_range
    triangle_gram_respects_the_range
    triangle_choice_respects_the_range
        triangle_in_range;
    triangle_cramer_owns_its_edges
    triangle_gram_owns_its_edges
    triangle_choice_owns_its_edges
        triangle_edges;
    triangle_cramer_has_no_smallest_size
    triangle_gram_has_no_smallest_size
    triangle_choice_has_no_smallest_size
        triangle_sizes;
    triangle_cramer_far_from_the_origin
    triangle_gram_far_from_the_origin
    triangle_choice_far_from_the_origin
        triangle_far;
    triangle_cramer_misses_degenerate_triangles
    triangle_gram_misses_degenerate_triangles
    triangle_choice_misses_degenerate_triangles
        triangle_missed;
}

pub(super) fn triangle_agrees(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    // First test a simple ray at a simple triangle, because its message is the easiest to read.
    let unit = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    let ray = Ray::new(vec3(0.125, 0.5, 2.0), vec3(0.0, 0.0, -0.5));
    let drawn = TriangleQuery { ray, triangle: unit };
    method.judge(trial, &[drawn]).into_iter().collect::<CheckResult>()?;
    trial.forall(6000, aimed(triangle(), point(8)), |queries| method.judge(trial, queries))
}

/// T1, T2, T7: the three regions beyond the sides and the three beyond the corners, for rays along an axis and for
/// slanted rays.
pub(super) fn triangle_regions(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let unit = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    let places = [
        (0.25, 0.25, true),
        (2.0, -1.5, false),
        (-1.5, 2.0, false),
        (-0.2, -0.2, false),
        (0.75, 0.75, false),
        (-0.25, 0.5, false),
        (0.5, -0.25, false),
        (1.5, 0.5, false),
    ];
    for direction in [Vec3::NEG_Z, vec3(1.0, 2.0, -4.0), vec3(-0.5, 0.25, -1.0)] {
        let queries = places.map(|(x, y, _)| TriangleQuery {
            ray: Ray::new(vec3(x, y, 0.0) - 2.0 * direction, direction),
            triangle: unit,
        });
        method.judge(trial, &queries).into_iter().collect::<CheckResult>()?;
    }
    // The slide's determinant is right for the rays along z above and wrong for this ray, whose t is 2.
    let slanted = TriangleQuery {
        ray: Ray::new(vec3(-2.5, -4.5, -6.25), vec3(1.0, 2.0, 3.0)),
        triangle: Triangle { a: Vec3::ZERO, b: vec3(-1.0, -1.0, 0.0), c: vec3(-1.0, -1.0, -1.0) },
    };
    method.judge(trial, &[slanted]).into_iter().collect()
}

pub(super) fn triangle_windings(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let unit = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    let sides = [1.0, -1.0].map(|way| TriangleQuery {
        ray: Ray::new(vec3(0.125, 0.5, 2.0 * way), vec3(0.0, 0.0, -way)),
        triangle: unit,
    });
    method.judge(trial, &sides).into_iter().collect::<CheckResult>()?;
    // All six orders of the corners must give the same verdict and the same t, from the front and from the back.
    trial.forall(1000, aimed(triangle(), point(8)), |queries| {
        let orders = |query: &TriangleQuery| {
            let Triangle { a, b, c } = query.triangle;
            [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]]
                .map(|[a, b, c]| TriangleQuery { triangle: Triangle { a, b, c }, ..*query })
        };
        let all: Vec<TriangleQuery> = queries.iter().flat_map(orders).collect();
        let outcomes = method.judge(trial, &all);
        outcomes.chunks(6).map(|six| six.iter().cloned().collect()).collect()
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
            (at(4.0, 0.0, infinite), hit(4.0), ""),
            (at(-4.0, 0.0, infinite), None, "the triangle is behind the ray: a negative t does not count"),
            (at(0.0, 0.0, infinite), None, "the ray starts in the triangle: t = 0 does not count"),
            (at(4.0, 5.0, infinite), None, "the hit lies before t_min"),
            (at(4.0, 0.0, 3.0), None, "the hit lies beyond t_max"),
            (at(4.0, 0.0, 4.0), None, "the range is open: a hit at t_max does not count"),
            (at(4.0, 3.0, 5.0), hit(4.0), ""),
        ],
    )
}

pub(super) fn triangle_edges(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    // The sides are powers of two and the ray runs along an axis, so every method computes β and γ exactly.
    let triangle = Triangle { a: Vec3::ZERO, b: vec3(4.0, 0.0, 0.0), c: vec3(0.0, 4.0, 0.0) };
    let at = |x: f32, y: f32| {
        let ray = Ray::new(vec3(x, y, 2.0), Vec3::NEG_Z);
        let hit = TriangleHit { t: 2.0, beta: x / 4.0, gamma: y / 4.0 };
        (
            TriangleQuery { ray, triangle },
            Some(hit),
            "points on an edge belong to the triangle: ≥ and ≤, not > and <",
        )
    };
    let on_the_rim = [(2.0, 0.0), (0.0, 1.0), (3.0, 1.0), (0.0, 0.0), (4.0, 0.0), (0.0, 4.0)];
    method.judge_exact(trial, &on_the_rim.map(|(x, y)| at(x, y)))
}

/// T11: a scene a million times smaller or larger gives the same verdict, the same β and γ, and `t` times the factor.
pub(super) fn triangle_sizes(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    trial.forall(1000, aimed(triangle(), point(8)), |queries| {
        let answers = (method.ask)(trial.kit, queries);
        let mut outcomes = vec![Ok(()); queries.len()];
        for factor in [2f32.powi(-20), 2f32.powi(20)] {
            let scaled: Vec<TriangleQuery> = queries
                .iter()
                .map(|query| TriangleQuery {
                    ray: Ray { origin: factor * query.ray.origin, ..query.ray },
                    triangle: Triangle {
                        a: factor * query.triangle.a,
                        b: factor * query.triangle.b,
                        c: factor * query.triangle.c,
                    },
                })
                .collect();
            let scaled_answers = (method.ask)(trial.kit, &scaled);
            let pairs = answers.iter().zip(scaled_answers).collect();
            let judged = compare(&scaled, pairs, |query, (answer, yours)| {
                let expected = answer.map(|hit| TriangleHit { t: factor * hit.t, ..hit });
                if yours == expected {
                    return Ok(());
                }
                let broken = Broken::with_texts(
                    query.call(method.name),
                    describe(yours),
                    describe(expected),
                    "the answer at scale 1",
                );
                let diagnosis =
                    yours.is_none().then_some("a fixed limit such as |det| < 1e-6 rejects small triangles");
                Err(broken.looks_like(diagnosis))
            });
            outcomes = outcomes.into_iter().zip(judged).map(|(one, other)| one.and(other)).collect();
        }
        outcomes
    })
}

/// T4: small triangles at (148376, 1234, -223423), with the ray's origin near them.
pub(super) fn triangle_far(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let place = vec3(148_376.0, 1_234.0, -223_423.0);
    let triangles = (rough_point(4.0), rough_point(4.0), rough_point(4.0))
        .prop_map(move |(a, b, c)| Triangle { a: place + a, b: place + b, c: place + c });
    let origins = rough_point(8.0).prop_map(move |offset| place + offset);
    trial.forall(3000, aimed(triangles, origins), |queries| {
        method
            .judge(trial, queries)
            .into_iter()
            .map(|outcome| {
                outcome.map_err(|broken| match broken.diagnosis {
                    None => broken.looks_like(Some(
                        "far from the origin, o + t d is rounded too coarsely: subtract o first",
                    )),
                    Some(_) => broken,
                })
            })
            .collect()
    })
}

pub(super) fn triangle_missed(trial: &Trial<'_>, method: TriangleFunction) -> CheckResult {
    let unit = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    let down = Ray::new(vec3(0.25, 0.25, 1.0), Vec3::NEG_Z);
    let along = |origin| TriangleQuery { ray: Ray::new(origin, Vec3::X), triangle: unit };
    let with = |a, b, c| TriangleQuery { ray: down, triangle: Triangle { a, b, c } };
    let p = vec3(0.25, 0.25, 0.0);
    let flat = "a triangle without area, or a ray along its plane, divides by 0: that is a miss";
    let nan = "NaN is never a hit: compare so that NaN fails";
    method.judge_exact(
        trial,
        &[
            (along(vec3(-1.0, 0.25, 0.0)), None, flat),
            (along(vec3(-1.0, 0.25, 1.0)), None, flat),
            (with(p, p, p), None, flat),
            (with(p, p, Vec3::X), None, flat),
            (with(Vec3::ZERO, 0.5 * p, 2.0 * p), None, flat),
            (with(Vec3::NAN, Vec3::X, Vec3::Y), None, nan),
            (with(Vec3::ZERO, Vec3::NAN, Vec3::Y), None, nan),
            (TriangleQuery { ray: Ray { direction: Vec3::NAN, ..down }, triangle: unit }, None, nan),
            (TriangleQuery { ray: Ray { direction: Vec3::ZERO, ..down }, triangle: unit }, None, flat),
            (TriangleQuery { ray: Ray { origin: Vec3::NAN, ..down }, triangle: unit }, None, nan),
        ],
    )?;
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
    method.judge_exact(trial, &[(sliver, None, flat)])?;
    // For sizes that overflow single precision both a hit and a miss are accepted, but a hit must not contain NaN.
    let huge = with(-1e20 * Vec3::ONE, 1e20 * Vec3::X, 1e20 * Vec3::Y);
    for yours in (method.ask)(trial.kit, &[huge]).into_iter().flatten() {
        if !(yours.t.is_finite() && yours.beta.is_finite() && yours.gamma.is_finite()) {
            return Err(Broken::with_texts(
                huge.call(method.name),
                describe(Some(yours)),
                "None, or finite numbers",
                "the definition",
            )
            .looks_like(Some(nan)));
        }
    }
    Ok(())
}
