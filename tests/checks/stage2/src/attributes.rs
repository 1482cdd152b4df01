//! Attributes of a triangle: interpolation and the face normal.

use checks::generate::{scaled, triangle};
use checks::prelude::*;

pub(super) fn interpolation_weighs_the_corners(trial: &Trial<'_>) -> CheckResult {
    let inputs = (0..=8i32, 0..=8i32, point(4), point(4), point(4), nasty::any_scale()).prop_map(
        |(beta, gamma, a, b, c, size)| {
            let (beta, gamma) = if beta + gamma > 8 { (8 - beta, 8 - gamma) } else { (beta, gamma) };
            let (beta, gamma) = (beta as f32 / 8.0, gamma as f32 / 8.0);
            let barycentric = vec3(1.0 - beta - gamma, beta, gamma);
            InterpolateQuery { barycentric, corners: [size * a, size * b, size * c] }
        },
    );
    let barycentric = vec3(0.5, 0.375, 0.125);
    let drawn =
        InterpolateQuery { barycentric, corners: [vec3(8.0, 0.0, 1.0), 16.0 * Vec3::Y, 32.0 * Vec3::Z] };
    trial.each_and(&[drawn], 1000, inputs, <dyn Kit>::interpolate, |query, yours| {
        let [a, b, c] = query.corners;
        let w = query.barycentric;
        // All numbers are multiples of 1/64 times a power of two, so the sums are exact in single precision.
        let sum = |[x, y, z]: [f32; 3]| x * a + y * b + z * c;
        let expected = sum([w.x, w.y, w.z]);
        let direction = |v: Vec3| v.as_dvec3().normalize_or_zero();
        let other_orders =
            [[w.y, w.z, w.x], [w.z, w.x, w.y], [w.x, w.z, w.y], [w.z, w.y, w.x], [w.y, w.x, w.z]];
        let input = || format!("interpolate({}, [{}, {}, {}])", w.paste(), a.paste(), b.paste(), c.paste());
        let mut mistakes = vec![(
            (yours.as_dvec3() - direction(expected)).length() < 1e-6,
            "your value is normalized: return the weighted sum as it is",
        )];
        mistakes.extend(
            other_orders
                .map(|order| (yours == sum(order), "multiply the corners a, b, c by α, β, γ in this order")),
        );
        mistakes.extend(named![
            yours == (a + b + c) / 3.0 => "you return the average of the corners without their coordinates",
            yours == expected.clamp(Vec3::ZERO, Vec3::ONE) =>
                "you limit the value to 0..1: not every value is a colour, so return the weighted sum as it is",
        ]);
        unless(yours == expected, || Broken::new(input(), yours, expected, "closed form")).formulas(mistakes)
    })
}

fn judge_face_normal(triangle: &Triangle, yours: Option<Vec3>) -> Judged {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);
    let (u, v) = (b - a, c - a);
    let cross = u.cross(v);
    let expected = cross.try_normalize().filter(|_| cross != DVec3::ZERO).map(|n| n.as_vec3());
    // Scaling the edges rounds, and the cross product of a thin triangle is a small difference of large products: allow
    // sixteen roundings of |u| |v|.
    let slack = (16.0 * U * u.length() * v.length() / cross.length()).max(1e-5);
    let unit = |normal: Vec3| (normal.length() - 1.0).abs() < 1e-5;
    // By the same roundings, collinear edges may have an area, unless they are parallel to an axis.
    let slanting = [u, v].iter().all(|edge| edge.to_array().iter().filter(|x| **x != 0.0).count() > 1);
    let right = match (yours, expected) {
        (Some(yours), Some(expected)) => unit(yours) && f64::from((yours - expected).length()) < slack,
        (Some(yours), None) => unit(yours) && slanting,
        (None, expected) => expected.is_none(),
    };
    let near = |n: Vec3| {
        yours.zip(expected).is_some_and(|(yours, expected)| {
            (yours.as_dvec3().normalize_or_zero() - n.dot(expected).signum() as f64 * expected.as_dvec3())
                .length()
                < 1e-3
        })
    };
    let backwards = yours.zip(expected).is_some_and(|(yours, expected)| (yours + expected).length() < 1e-4);
    let is_unnormalized =
        yours.is_some_and(|yours| (yours.as_dvec3() - cross).length() <= 1e-4 * cross.length());
    // The square of |u × v| is not a normal number in single precision.
    let underflows = cross.length_squared() < 1.2e-38 || cross.length_squared() > 3.4e38;
    let input = || call("face_normal", &[triangle]);
    let broken = || {
        Broken::new(input(), yours, expected, "double precision").explained_by([
            "a triangle without area has no normal: 0/0 is NaN, so return None"
                .when(yours.is_some() && expected.is_none()),
            (backwards, "your normal points the other way: compute u × v, not v × u"),
            "|u × v|² underflows for tiny edges and overflows for huge ones: scale u and v first".when(
                underflows
                    && (yours.is_none()
                        || near(yours.unwrap_or_default())
                        || yours.is_some_and(|n| n.is_nan() || n == Vec3::ZERO)),
            ),
            "your normal has the right direction, but not length 1: normalize it"
                .when(yours.is_some_and(|yours| near(yours) && !backwards && !unit(yours))),
        ])
    };
    // Edges that are divided by a coordinate of their own, which may be negative or 0.
    let divided = |by: fn(DVec3) -> f64| {
        let scale = by(u) * by(v);
        match (yours, expected) {
            (Some(yours), Some(expected)) if scale != 0.0 => {
                f64::from((yours - scale.signum() as f32 * expected).length()) < slack
            }
            (Some(yours), _) => yours.is_nan(),
            (None, expected) => scale == 0.0 || expected.is_none(),
        }
    };
    let limits = [1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2].map(|limit| {
        let (area, sine) = (cross.length(), cross.length() / (u.length() * v.length()));
        let is_small = [area, 0.5 * area, area * area, sine, sine * sine].map(|area| !(area >= limit));
        let text =
            "a triangle of a small area has no normal in your answer: only one without any area has none";
        is_small.map(|is_small| (if is_small { yours.is_none() } else { right }, text))
    });
    let one = |text: &'static str, gives: bool| (gives, text);
    let signed = "an edge is divided by its largest coordinate with its sign, which turns it round: divide by the largest absolute value";
    unless(right, broken).formulas(limits.into_iter().flatten().chain([
        one(signed, divided(|edge| edge.max_element())),
        one(signed, divided(|edge| edge.min_element())),
        one("an edge is divided by its x, which may be negative or 0: divide by the largest absolute value", divided(|edge| edge.x)),
        "you return u × v, which is not of length 1: normalize it"
            .when(is_unnormalized || (yours.is_none() && cross == DVec3::ZERO)),
    ]))
}

pub(super) fn face_normal_has_unit_length_at_any_size(trial: &Trial<'_>) -> CheckResult {
    // Three corners on a line, two corners in one point, three corners in one point; and triangles with an area.
    let corners = [
        (Vec3::X, Vec3::Y),
        (Vec3::X, 2.0 * Vec3::X),
        (Vec3::X, Vec3::ZERO),
        (Vec3::ZERO, Vec3::ZERO),
        (vec3(4.0, 0.0, 0.0), vec3(0.0, 0.0, 2.0)),
        (Vec3::X, vec3(0.5, 1e-4, 0.0)),
    ];
    let drawn = corners.map(|(b, c)| Triangle { a: Vec3::ZERO, b, c });
    // Corners that are multiples of 1/8, times a power of two, have exact edges.
    let sized = (triangle(), nasty::scale(-60..=60)).prop_map(|(triangle, size)| scaled(triangle, size));
    trial.each_and(&drawn, 2000, prop_oneof![triangle(), sized], <dyn Kit>::face_normal, judge_face_normal)
}
