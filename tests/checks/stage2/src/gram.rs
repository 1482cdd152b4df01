//! The four scalars of the Gram method.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::{self};
use checks::generate::{direction, point, triangle};
use checks::judge::compare;
use checks::paste::call;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::shape::Triangle;

pub(super) fn gram_scalars_of_thin_triangles_keep_their_sign(trial: &Trial<'_>) -> CheckResult {
    let thin = (point(2), direction(), 1..=40i32).prop_map(|(a, u, thinness)| {
        let beside = u.any_orthogonal_vector() * 2f32.powi(-thinness);
        Triangle { a, b: a + u, c: a + (u + beside) }
    });
    // T3: the formula UV² - UU·VV gives 0 for the first triangle and +9.5e-7 for the second.
    let slide_cases = [
        Triangle { a: Vec3::ZERO, b: Vec3::X, c: vec3(2.0, 1e-4, 0.0) },
        Triangle { a: Vec3::ZERO, b: Vec3::ONE, c: vec3(1.0, 1.0, 1.0001) },
    ];
    let judge = |triangles: &[Triangle]| {
        compare(triangles, trial.kit.gram_scalars(triangles), |triangle, yours| {
            let (u, v) = (triangle.b - triangle.a, triangle.c - triangle.a);
            let exact = |p: Vec3, q: Vec3| p.as_dvec3().dot(q.as_dvec3());
            let scalars = [
                ("uv", yours.uv, exact(u, v), u.length() * v.length()),
                ("vv", yours.vv, exact(v, v), v.dot(v)),
                ("uu", yours.uu, exact(u, u), u.dot(u)),
            ];
            let input = call("gram_scalars", &[triangle]);
            for (name, yours, exact, size) in scalars {
                // A dot product has three products and two sums.
                if (f64::from(yours) - exact).abs() > 8.0 * double::U * f64::from(size) {
                    let (describe, expected) = (format!("{name} = {yours}"), format!("{name} = {exact}"));
                    let other = scalars.iter().find(|(_, _, other, _)| {
                        (f64::from(yours) - other).abs() <= 1e-6 * other.abs() && *other != exact
                    });
                    let swapped = other.map(|(other, ..)| format!("{name} and {other} look swapped"));
                    return Err(
                        Broken::with_texts(input, describe, expected, "double precision").looks_like(swapped)
                    );
                }
            }
            let d = -u.as_dvec3().cross(v.as_dvec3()).length_squared();
            // The cross product has an error of about |u| |v| roundings, and D is its square.
            let slack = 16.0 * double::U * f64::from(u.length() * v.length());
            let tolerance = 2.0 * slack * d.abs().sqrt() + slack * slack;
            if yours.d <= 0.0 && (f64::from(yours.d) - d).abs() <= tolerance {
                return Ok(());
            }
            let broken = Broken::with_texts(
                input,
                format!("D = {:?}", yours.d),
                format!("D = {d:e}"),
                "double precision",
            );
            if (f64::from(yours.d) + d).abs() <= tolerance {
                return Err(broken.looks_like(Some("the sign of D is wrong: it is UV² - UU·VV = -|u × v|²")));
            }
            Err(broken.looks_like(Some("UV² - UU·VV cancels for a thin triangle: compute D as -|u × v|²")))
        })
    };
    judge(&slide_cases).into_iter().collect::<CheckResult>()?;
    trial.forall(1000, triangle(), judge)?;
    trial.forall(1000, thin, judge)
}
