//! The four scalars of the Gram method.

use checks::generate::{scaled, triangle};
use checks::prelude::*;

/// The scalars and their largest rounding errors.
struct Exact {
    uv: f64,
    vv: f64,
    uu: f64,
    d: f64,
    /// A dot product has three products and two sums.
    slack: [f64; 3],
    d_slack: f64,
}

fn exact(triangle: &Triangle) -> Exact {
    let (u, v) = ((triangle.b - triangle.a).as_dvec3(), (triangle.c - triangle.a).as_dvec3());
    let d = -u.cross(v).length_squared();
    // The cross product has an error of about |u| |v| roundings, and D is its square.
    let of_cross = 16.0 * U * u.length() * v.length();
    Exact {
        uv: u.dot(v),
        vv: v.dot(v),
        uu: u.dot(u),
        d,
        slack: [u.length() * v.length(), v.dot(v), u.dot(u)].map(|size| 8.0 * U * size),
        d_slack: 2.0 * of_cross * d.abs().sqrt() + of_cross * of_cross,
    }
}

const SWAPPED_WITH_UV: &str = "u·v and another product look swapped";

fn judge(triangle: &Triangle, yours: GramScalars) -> Judged {
    let exact = exact(triangle);
    let near = |yours: f32, exact: f64, slack: f64| (f64::from(yours) - exact).abs() <= slack;
    let [uv_slack, vv_slack, uu_slack] = exact.slack;
    let products = |uv: f64, vv: f64, uu: f64| {
        near(yours.uv, uv, uv_slack)
            && near(yours.vv, vv, vv_slack.max(uu_slack))
            && near(yours.uu, uu, uu_slack.max(vv_slack))
    };
    let products_are_right = near(yours.uv, exact.uv, uv_slack)
        && near(yours.vv, exact.vv, vv_slack)
        && near(yours.uu, exact.uu, uu_slack);
    let d_is_right = yours.d <= 0.0 && near(yours.d, exact.d, exact.d_slack);
    let describe =
        |uv: f64, vv: f64, uu: f64, d: f64| format!("u·v = {uv:?}, v·v = {vv:?}, u·u = {uu:?}, D = {d:e}");
    let broken = || {
        let [uv, vv, uu, d] = [yours.uv, yours.vv, yours.uu, yours.d].map(f64::from);
        let expected = describe(exact.uv, exact.vv, exact.uu, exact.d);
        let yours = describe(uv, vv, uu, d);
        Broken::with_texts(call("gram_scalars", &[triangle]), yours, expected, "double precision")
    };
    // UV² and UU·VV are rounded before they are subtracted.
    let cancels = near(yours.d, exact.d, 16.0 * U * (exact.uv * exact.uv + exact.uu * exact.vv));
    let root = exact.d.abs().sqrt();
    unless(products_are_right && d_is_right, broken).formulas(named![
        products(exact.uv, exact.uu, exact.vv) => "u·u and v·v look swapped",
        products(exact.uv - exact.uu, exact.vv - 2.0 * exact.uv + exact.uu, exact.uu) =>
            "v is the edge from a to c: you take the one from b to c",
        products(exact.uv - exact.vv, exact.vv, exact.uu - 2.0 * exact.uv + exact.vv) =>
            "u is the edge from a to b: you take the one from c to b",
        products(exact.uu, exact.vv, exact.uv) => SWAPPED_WITH_UV,
        products(exact.vv, exact.uv, exact.uu) => SWAPPED_WITH_UV,
        products_are_right && near(yours.d, -exact.d, exact.d_slack) && yours.d >= 0.0 =>
            "the sign of D is wrong: it is UV² - UU·VV = -|u × v|²",
        products_are_right && near(yours.d, -root, 16.0 * U * root + exact.d_slack.sqrt()) =>
            "D is -|u × v|², not squared in your answer",
        products_are_right && cancels => "UV² - UU·VV cancels for a thin triangle: compute D as -|u × v|²",
    ])
}

/// Whether the student's own scalars of all triangles are right, which another check judges.
pub(super) fn own_scalars_are_right(trial: &Trial<'_>, triangles: &[Triangle]) -> bool {
    let answers = trial.kit.gram_scalars(triangles);
    compare(triangles, answers, judge).iter().all(Result::is_ok)
}

pub(super) fn gram_scalars_of_thin_triangles_keep_their_sign(trial: &Trial<'_>) -> CheckResult {
    let thin = (point(2), direction(), 1..=40i32).prop_map(|(a, u, thinness)| {
        let beside = u.any_orthogonal_vector() * 2f32.powi(-thinness);
        Triangle { a, b: a + u, c: a + (u + beside) }
    });
    // The formula UV² - UU·VV gives 0 for the first triangle and +9.5e-7 for the second.
    let drawn = [
        Triangle { a: Vec3::ONE, b: vec3(3.0, 1.0, 1.0), c: vec3(2.0, 4.0, 1.0) },
        Triangle { a: Vec3::ZERO, b: Vec3::X, c: vec3(2.0, 1e-4, 0.0) },
        Triangle { a: Vec3::ZERO, b: Vec3::ONE, c: vec3(1.0, 1.0, 1.0001) },
    ];
    // D grows with the fourth power of the size, which must stay a normal number.
    let sized = (prop_oneof![triangle(), thin], nasty::scale(-12..=24))
        .prop_map(|(triangle, size)| scaled(triangle, size));
    trial.each_and(&drawn, 2000, sized, <dyn Kit>::gram_scalars, judge)
}
