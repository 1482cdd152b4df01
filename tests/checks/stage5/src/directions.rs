//! The directions of reflected and refracted rays.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::unit;
use checks::judge::{compare, known};
use checks::paste::call;
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::RefractQuery;

/// A direction, and a normal on the side that it comes from.
pub(super) fn arrival() -> impl Strategy<Value = (Vec3, Vec3)> + Clone {
    (unit(), unit()).prop_map(|(direction, normal)| {
        (direction, if normal.dot(direction) > 0.0 { -normal } else { normal })
    })
}

pub(super) fn reflect_keeps_the_angle(trial: &Trial<'_>) -> CheckResult {
    let judge = |queries: &[(Vec3, Vec3)]| {
        compare(queries, trial.kit.reflect(queries), |(direction, normal), yours| {
            let (d, n) = (direction.as_dvec3(), normal.as_dvec3());
            let expected = (d - 2.0 * d.dot(n) * n).normalize().as_vec3();
            let same = |v: Vec3| (yours - v).length() < 1e-6; // a few roundings of numbers up to 2
            let diagnosis = match () {
                () if same(*direction) => "you return the direction unchanged",
                () if same(-*direction) => "you reverse the whole direction: reverse only its part along n",
                () if same(-expected) => "your result is negated: it points into the surface",
                () if same((d + 2.0 * d.dot(n) * n).normalize().as_vec3()) => {
                    "you add 2 n (d·n): subtract it, d - 2 n (d·n)"
                }
                () if (yours.normalize_or_zero()
                    - (*direction - direction.dot(*normal) * *normal).normalize_or_zero())
                .length()
                    < 1e-5 =>
                {
                    "you subtract n (d·n) once: subtract it twice"
                }
                () => "",
            };
            let input = call("reflect", &[direction, normal]);
            if same(expected) {
                return Ok(());
            }
            Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
        })
    };
    // Begin with a slanted ray: along the normal or the surface, several mistakes give the same answer.
    judge(&[(vec3(0.6, -0.8, 0.0), Vec3::Y)]).into_iter().collect::<CheckResult>()?;
    trial.forall(2000, arrival(), judge)
}

pub(super) fn reflect_stays_of_unit_length_in_a_corridor(trial: &Trial<'_>) -> CheckResult {
    // R7: a thousand reflections on two mirrors that are not parallel to an axis.
    let normals = [vec3(0.6, 0.8, 0.0), vec3(-0.48, -0.64, 0.6)];
    let mut direction = vec3(0.3, -0.7, 0.2).normalize();
    for bounce in 0..1000 {
        let normal = normals[bounce % 2];
        direction =
            trial.kit.reflect(&[(direction, if normal.dot(direction) > 0.0 { -normal } else { normal })])[0];
    }
    let off = (direction.as_dvec3().length() - 1.0).abs();
    if off < 1e-6 {
        return Ok(());
    }
    let broken = Broken::with_texts(
        "reflect, 1000 times",
        format!("|d| - 1 = {off:.1e}"),
        "less than 1e-6",
        "the definition",
    );
    Err(broken.looks_like(Some("the rounding errors of the length add up: normalize the result")))
}

/// Snell's law in double precision, `None` beyond the critical angle; and cos² θ2, which is 0 at the critical angle.
pub(super) fn snell(query: &RefractQuery) -> (Option<DVec3>, f64) {
    let (d, n) = (query.direction.as_dvec3(), query.normal.as_dvec3().normalize());
    let ratio = f64::from(query.n1) / f64::from(query.n2);
    let along = ratio * (d - d.dot(n) * n);
    let cos_squared = 1.0 - along.length_squared();
    ((cos_squared >= 0.0).then(|| (along - cos_squared.max(0.0).sqrt() * n).normalize()), cos_squared)
}

/// The direction behind the surface for a wrong law: `sine` computes sin θ2 from `(sin θ1, n1 / n2)`.
fn turned(query: &RefractQuery, sine: impl Fn(f64, f64) -> f64) -> Option<DVec3> {
    let (d, n) = (query.direction.as_dvec3(), query.normal.as_dvec3().normalize());
    let ratio = f64::from(query.n1) / f64::from(query.n2);
    let along = d - d.dot(n) * n;
    let sine_1 = along.length();
    let sine_2 = sine(sine_1, ratio);
    (sine_2.abs() <= 1.0 && sine_1 > 0.0)
        .then(|| sine_2 / sine_1 * along - (1.0 - sine_2 * sine_2).sqrt() * n)
}

fn paste(query: &RefractQuery) -> String {
    call("refract", &[&query.direction, &query.normal, &query.n1, &query.n2])
}

pub(super) fn judge_refractions(trial: &Trial<'_>, queries: &[RefractQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.refract(queries), |query, yours| {
        let (expected, margin) = snell(query);
        // Near the critical angle the error grows with the root of the rounding, and both `None` and a direction pass.
        let right = match (yours, expected) {
            (None, None) => true,
            (Some(yours), Some(expected)) => {
                (yours.as_dvec3() - expected).length() < 4e-6 / margin.sqrt().max(1e-3)
            }
            (Some(yours), None) => margin.abs() < 1e-5 && yours.is_finite(),
            (None, Some(_)) => margin.abs() < 1e-5,
        };
        if right {
            return Ok(());
        }
        let swapped = snell(&RefractQuery { n1: query.n2, n2: query.n1, ..*query }).0;
        let near =
            |v: Option<DVec3>| yours.zip(v).is_some_and(|(yours, v)| (yours.as_dvec3() - v).length() < 1e-4);
        let diagnosis = match yours {
            Some(yours) if yours.is_nan() => {
                "you return NaN: do not divide by sin θ1, and take no root of a negative number"
            }
            Some(_) if expected.is_none() => "you return a ray beyond the critical angle: return None",
            _ if near(swapped) => "you exchange n1 and n2: sin θ2 = n1 / n2 · sin θ1",
            Some(yours) if yours.dot(query.normal) > 0.0 => {
                "your refracted ray stays on the side that it came from"
            }
            _ if near(expected.map(|v| -v)) => "your refracted ray is negated",
            _ if near(turned(query, |sine, ratio| -ratio * sine)) => {
                "you negate the part along the surface: keep its sign"
            }
            _ if near(turned(query, |sine, ratio| (ratio * sine.min(1.0).asin()).sin())) => {
                "you multiply the angle by n1 / n2: multiply its sine"
            }
            _ if near(turned(query, |sine, ratio| {
                // The sine after normalizing a direction with the cosine √(1 - n1 / n2 sin² θ1).
                let (along, across) = (ratio * sine, (1.0 - ratio * sine * sine).sqrt());
                along / along.hypot(across)
            })) =>
            {
                "you do not square the ratio: sin² θ2 = (n1 / n2)² sin² θ1"
            }
            _ => "",
        };
        let expected = expected.map(|v| v.as_vec3());
        Err(Broken::new(paste(query), yours, expected, "Snell's law in double precision")
            .looks_like(known(diagnosis)))
    })
}

pub(super) fn refract_obeys_snell(trial: &Trial<'_>) -> CheckResult {
    let indices = || (8..=24i32).prop_map(|eighths| eighths as f32 / 8.0);
    let inputs = (arrival(), indices(), indices()).prop_map(|((direction, normal), n1, n2)| RefractQuery {
        direction,
        normal,
        n1,
        n2,
    });
    let drawn = RefractQuery { direction: vec3(0.6, -0.8, 0.0), normal: Vec3::Y, n1: 1.0, n2: 1.25 };
    judge_refractions(trial, &[drawn]).into_iter().collect::<CheckResult>()?;
    trial.forall(4000, inputs, |queries| judge_refractions(trial, queries))
}

pub(super) fn refract_goes_straight_where_it_must(trial: &Trial<'_>) -> CheckResult {
    // R1: along the normal sin θ1 is 0. With equal indices the direction does not change.
    let slanted = vec3(0.6, -0.8, 0.0);
    let cases = [(Vec3::NEG_Y, 1.0, 1.5), (Vec3::NEG_Y, 1.5, 1.0), (slanted, 1.0, 1.0), (slanted, 1.7, 1.7)];
    let queries = cases.map(|(direction, n1, n2)| RefractQuery { direction, normal: Vec3::Y, n1, n2 });
    for (query, yours) in queries.iter().zip(trial.kit.refract(&queries)) {
        if !yours.is_some_and(|yours| (yours - query.direction).length() < 1e-6) {
            let broken = Broken::new(paste(query), yours, Some(query.direction), "unchanged");
            return Err(broken.looks_like(Some(
                "this ray keeps its direction: do not divide by sin θ1, which gives 0 / 0",
            )));
        }
    }
    Ok(())
}

pub(super) fn refract_beyond_the_critical_angle_is_none(trial: &Trial<'_>) -> CheckResult {
    // R2: 60° inside glass; then the critical angle, and one float of the sine to either side, where NaN is wrong.
    let at_sine = |sine: f32| {
        let direction = vec3(sine, -(1.0 - f64::from(sine).powi(2)).sqrt() as f32, 0.0);
        RefractQuery { direction, normal: Vec3::Y, n1: 1.5, n2: 1.0 }
    };
    let critical = 1.0f32 / 1.5;
    let queries = [0.866_025_4, 0.75, critical.next_up(), critical, critical.next_down(), 0.6].map(at_sine);
    judge_refractions(trial, &queries).into_iter().collect()
}

pub(super) fn refract_survives_rounded_directions(trial: &Trial<'_>) -> CheckResult {
    // R3: one unit vector in five is slightly longer than 1, and the root of 1 - cos² is NaN near the normal.
    let inputs = (unit(), -40..=40i32, -40..=40i32, any::<bool>()).prop_map(|(normal, x, y, glass)| {
        let (u, v) = normal.any_orthonormal_pair();
        let direction = (-normal + 1e-5 * (x as f32 * u + y as f32 * v)).normalize();
        let direction = direction * (1.0 + f32::EPSILON); // one rounding error too long
        let (n1, n2) = if glass { (1.0, 1.5) } else { (1.5, 1.0) };
        RefractQuery { direction, normal, n1, n2 }
    });
    trial.forall(2000, inputs, |queries| judge_refractions(trial, queries))
}
