//! Where mirrored and refracted rays go.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::generate::unit;
use checks::judge::{compare, known};
use checks::paste::call;
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::RefractQuery;

/// A direction and a normal on the side that it comes from.
pub(super) fn arrival() -> impl Strategy<Value = (Vec3, Vec3)> + Clone {
    (unit(), unit()).prop_map(|(direction, normal)| {
        (direction, if normal.dot(direction) > 0.0 { -normal } else { normal })
    })
}

pub(super) fn reflect_keeps_the_angle(trial: &Trial<'_>) -> Outcome {
    let judge = |queries: &[(Vec3, Vec3)]| {
        compare(queries, trial.kit.reflect(queries), |(direction, normal), yours| {
            let (d, n) = (direction.as_dvec3(), normal.as_dvec3());
            let expected = (d - 2.0 * d.dot(n) * n).normalize().as_vec3();
            let same = |v: Vec3| (yours - v).length() < 1e-6; // a few roundings of numbers up to 2
            let diagnosis = match () {
                () if same(*direction) => "the ray goes straight on",
                () if same(-*direction) => "the ray goes back the way it came",
                () if same(-expected) => "the mirrored ray points into the surface",
                () if same((d + 2.0 * d.dot(n) * n).normalize().as_vec3()) => {
                    "plus, where minus belongs: d - 2 n (d·n)"
                }
                () if (yours.normalize_or_zero()
                    - (*direction - direction.dot(*normal) * *normal).normalize_or_zero())
                .length()
                    < 1e-5 =>
                {
                    "only once the normal part is taken off: it must turn around, so twice"
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
    // First a slanted ray: on one along the normal or along the surface, several mistakes give one answer.
    judge(&[(vec3(0.6, -0.8, 0.0), Vec3::Y)]).into_iter().collect::<Outcome>()?;
    trial.forall(2000, arrival(), judge)
}

pub(super) fn reflect_stays_of_unit_length_in_a_corridor(trial: &Trial<'_>) -> Outcome {
    // R7: a thousand bounces between two mirrors that are not quite along an axis.
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
        "mirror, 1000 times",
        format!("|d| - 1 = {off:.1e}"),
        "less than 1e-6",
        "the definition",
    );
    Err(broken.looks_like(Some("each bounce rounds, and the roundings add up: normalise the result")))
}

/// Snell's law in double precision; `None` beyond the critical angle, and how far the answer is from that.
pub(super) fn snell(query: &RefractQuery) -> (Option<DVec3>, f64) {
    let (d, n) = (query.direction.as_dvec3(), query.normal.as_dvec3().normalize());
    let ratio = f64::from(query.n1) / f64::from(query.n2);
    let along = ratio * (d - d.dot(n) * n);
    let cos_squared = 1.0 - along.length_squared();
    ((cos_squared >= 0.0).then(|| (along - cos_squared.max(0.0).sqrt() * n).normalize()), cos_squared)
}

/// The direction behind the surface if the sine there were this one of `(sin θ1, n1 / n2)`.
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

pub(super) fn judge_refractions(trial: &Trial<'_>, queries: &[RefractQuery]) -> Vec<Outcome> {
    compare(queries, trial.kit.refract(queries), |query, yours| {
        let (expected, margin) = snell(query);
        // At the critical angle the direction turns with the root of the rounding, and either verdict will do.
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
                "NaN: the slide divides by sin θ1, or takes the root of a negative number"
            }
            Some(_) if expected.is_none() => {
                "beyond the critical angle there is no refracted ray: return None"
            }
            _ if near(swapped) => "n1 and n2 are exchanged: sin θ2 = n1 / n2 · sin θ1",
            Some(yours) if yours.dot(query.normal) > 0.0 => {
                "the refracted ray stays on the side it came from"
            }
            _ if near(expected.map(|v| -v)) => "the refracted ray points back",
            _ if near(turned(query, |sine, ratio| -ratio * sine)) => {
                "the part along the surface goes the other way: keep its sign"
            }
            _ if near(turned(query, |sine, ratio| (ratio * sine.min(1.0).asin()).sin())) => {
                "the sines go as n1 / n2, not the angles"
            }
            _ if near(turned(query, |sine, ratio| {
                // What normalising makes of √(1 - n1 / n2 sin² θ1).
                let (along, across) = (ratio * sine, (1.0 - ratio * sine * sine).sqrt());
                along / along.hypot(across)
            })) =>
            {
                "sin² θ2 is (n1 / n2)² sin² θ1: the ratio must be squared, too"
            }
            _ => "",
        };
        let expected = expected.map(|v| v.as_vec3());
        Err(Broken::new(paste(query), yours, expected, "Snell's law in double precision")
            .looks_like(known(diagnosis)))
    })
}

pub(super) fn refract_obeys_snell(trial: &Trial<'_>) -> Outcome {
    let indices = || (8..=24i32).prop_map(|eighths| eighths as f32 / 8.0);
    let inputs = (arrival(), indices(), indices()).prop_map(|((direction, normal), n1, n2)| RefractQuery {
        direction,
        normal,
        n1,
        n2,
    });
    let drawn = RefractQuery { direction: vec3(0.6, -0.8, 0.0), normal: Vec3::Y, n1: 1.0, n2: 1.25 };
    judge_refractions(trial, &[drawn]).into_iter().collect::<Outcome>()?;
    trial.forall(4000, inputs, |queries| judge_refractions(trial, queries))
}

pub(super) fn refract_goes_straight_where_it_must(trial: &Trial<'_>) -> Outcome {
    // R1: along the normal sin θ1 is 0; and equal indices bend nothing.
    let slanted = vec3(0.6, -0.8, 0.0);
    let cases = [(Vec3::NEG_Y, 1.0, 1.5), (Vec3::NEG_Y, 1.5, 1.0), (slanted, 1.0, 1.0), (slanted, 1.7, 1.7)];
    let queries = cases.map(|(direction, n1, n2)| RefractQuery { direction, normal: Vec3::Y, n1, n2 });
    for (query, yours) in queries.iter().zip(trial.kit.refract(&queries)) {
        if !yours.is_some_and(|yours| (yours - query.direction).length() < 1e-6) {
            let broken = Broken::new(paste(query), yours, Some(query.direction), "straight on");
            return Err(broken.looks_like(Some("0 / 0: do not divide by sin θ1")));
        }
    }
    Ok(())
}

pub(super) fn refract_beyond_the_critical_angle_is_nothing(trial: &Trial<'_>) -> Outcome {
    // R2: 60° inside of glass. Then the critical angle itself, one step of the sine to either side: no NaN there.
    let at_sine = |sine: f32| {
        let direction = vec3(sine, -(1.0 - f64::from(sine).powi(2)).sqrt() as f32, 0.0);
        RefractQuery { direction, normal: Vec3::Y, n1: 1.5, n2: 1.0 }
    };
    let critical = 1.0f32 / 1.5;
    let queries = [0.866_025_4, 0.75, critical.next_up(), critical, critical.next_down(), 0.6].map(at_sine);
    judge_refractions(trial, &queries).into_iter().collect()
}

pub(super) fn refract_survives_rounded_directions(trial: &Trial<'_>) -> Outcome {
    // R3: one unit vector in five has a length a little above 1, and the root of 1 - cos² is NaN near the normal.
    let inputs = (unit(), -40..=40i32, -40..=40i32, any::<bool>()).prop_map(|(normal, x, y, glass)| {
        let (u, v) = normal.any_orthonormal_pair();
        let direction = (-normal + 1e-5 * (x as f32 * u + y as f32 * v)).normalize();
        let direction = direction * (1.0 + f32::EPSILON); // a rounding too long
        let (n1, n2) = if glass { (1.0, 1.5) } else { (1.5, 1.0) };
        RefractQuery { direction, normal, n1, n2 }
    });
    trial.forall(2000, inputs, |queries| judge_refractions(trial, queries))
}
