//! Cosine-weighted directions and their density.

use checks::prelude::*;
use checks::statistics::{SAMPLES, columns, covers_each_part, is_other_power, pairs};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The largest random number, just below 1.
pub(super) const LARGEST: f32 = 1.0 - f32::EPSILON / 2.0;

/// A random number, which may be the smallest or the largest one.
pub(super) fn number() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![6 => (0..64u32).prop_map(|n| (n as f32 + 0.5) / 64.0), 1 => Just(0.0f32), 1 => Just(LARGEST)]
}

/// A pair of random numbers; some lie on the border of the unit square.
pub(super) fn numbers() -> impl Strategy<Value = Vec2> + Clone {
    (number(), number()).prop_map(|(x, y)| vec2(x, y))
}

pub(super) fn cosine_directions_stay_above_the_surface(trial: &Trial<'_>) -> CheckResult {
    trial.forall(1000, (nasty::unit(), numbers()), |queries| {
        let answers = trial.kit.cosine_direction(queries);
        // Only u.x = 0 leads to the normal.
        let is_normal = |(query, yours): (&(Vec3, Vec2), &Vec3)| query.0 == *yours;
        let constant = queries.len() > 1 && queries.iter().zip(&answers).all(is_normal);
        compare(queries, answers, |query, yours| {
            let (normal, direction) = (query.0.as_dvec3(), yours.as_dvec3());
            let above = direction.dot(normal);
            // A vector that was normalized in f32 is off by a few times 1e-7. The doc comment allows -1e-6.
            let unit = (direction.length() - 1.0).abs() < 1e-5;
            if unit && above >= -1e-6 && !constant {
                return Ok(());
            }
            let (input, expected) = (query.call("cosine_direction"), "a unit direction above the surface");
            Err(Broken::new(input, yours, expected, "the definition").explained_by(named![
                constant => "you return the normal for every u",
                yours.is_nan() => "you return NaN: your frame does not exist for this normal, or you normalize 0",
                !unit && !yours.is_nan() => "your direction does not have unit length",
                unit && above < 0.0 => "your direction goes below the surface",
            ]))
        })
    })
}

pub(super) fn cosine_directions_have_their_density(trial: &Trial<'_>) -> CheckResult {
    let (normals, u) = (nasty::directions(), pairs(trial.seed, SAMPLES));
    let directions = |normals: &[Vec3], u: &[Vec2]| {
        let query = |(index, u): (usize, &Vec2)| (normals[index % normals.len()], *u);
        let queries: Vec<(Vec3, Vec2)> = u.iter().enumerate().map(query).collect();
        let answers = trial.kit.cosine_direction(&queries);
        let judge = |(query, yours): (&(Vec3, Vec2), &Vec3)| {
            if (yours.as_dvec3().length() - 1.0).abs() < 1e-5 {
                return Ok(());
            }
            let input = query.call("cosine_direction");
            Err(Broken::new(input, yours, "a unit direction", "the definition"))
        };
        all_hold(queries.iter().zip(&answers).map(judge).collect())?;
        Ok((queries, answers))
    };
    let places = |(queries, answers): (Vec<(Vec3, Vec2)>, Vec<Vec3>)| {
        let of = |((normal, _), direction): (&(Vec3, Vec2), &Vec3)| place(*normal, *direction);
        queries.iter().zip(&answers).map(of).collect::<Vec<_>>()
    };
    let (queries, answers) = directions(&normals, &u)?;
    let cosine = |((normal, _), yours): (&(Vec3, Vec2), &Vec3)| normal.as_dvec3().dot(yours.as_dvec3());
    let cosines: Vec<f64> = queries.iter().zip(&answers).map(cosine).collect();
    let sines: Vec<f64> = cosines.iter().map(|cosine| (1.0 - cosine * cosine).max(0.0).sqrt()).collect();
    // Whether all cosines are those of a wrong formula of one random number.
    let is = |formula: fn(f64) -> f64| {
        let number = |u: &Vec2, which: usize| f64::from([u.x, u.y, 1.0 - u.x, 1.0 - u.y][which]);
        (0..4).any(|which| {
            u.iter().zip(&cosines).all(|(u, found)| (found - formula(number(u, which))).abs() < 1e-4)
        })
    };
    let mistakes = |counts: &[u64]| {
        vec![
            "your directions are uniform over the hemisphere: cos θ is the root of a uniform number"
                .when(is(|u| u)),
            (is(|u| (FRAC_PI_2 * u).cos()), "your θ is uniform: cos θ is the root of a uniform number"),
            (is(|u| 1.0 - 2.0 * u), "your directions fill the whole sphere"),
            "the radius on the disk is uniform: it is the root of a uniform number"
                .when(is(|u| (1.0 - u * u).sqrt())),
            (is(|u| u.powf(1.0 / 3.0)), "your density is proportional to cos² θ"),
            "cos θ or sin θ is another power of a random number than its root"
                .when(is_other_power(&u, &cosines, 0.5) || is_other_power(&u, &sines, 0.5)),
            // Of so many samples the lowest has a cosine of about 0.006, and above 0.018 less than once in a thousand times.
            "you never sample grazing directions: cos θ goes down to 0"
                .when(cosines.iter().all(|cosine| *cosine > 0.018)),
            (columns(counts)[7] == 0, "you never sample grazing directions"),
        ]
    };
    // The last normal is far from the axes, along which most frames are right by chance.
    let one = &normals[normals.len() - 1..];
    let places = |u: &[Vec2]| Ok(places(directions(one, u)?));
    covers_each_part("cosine_direction(normal, u)", AXES, trial.seed, None, places, mistakes)
}

pub(super) const AXES: [&str; 2] = ["sin² θ", "the angle around the normal"];

/// `sin² θ` of a direction, which is uniform in 0..1, and its angle around the normal as a fraction of a full turn. Directions
/// below the surface have no place.
pub(super) fn place(normal: Vec3, direction: Vec3) -> (f64, f64) {
    let (normal, direction) = (normal.as_dvec3().normalize(), direction.as_dvec3());
    let (x, y) = normal.any_orthonormal_pair();
    let sine_squared = direction.cross(normal).length_squared();
    let turn = direction.dot(y).atan2(direction.dot(x)) / TAU + 0.5;
    // At the rim a rounding decides on which side of the surface a direction is.
    if direction.dot(normal) < -1e-6 { (f64::INFINITY, turn) } else { (sine_squared, turn) }
}

pub(super) fn cosine_pdf_is_the_cosine_over_pi(trial: &Trial<'_>) -> CheckResult {
    let queries = (nasty::unit(), nasty::tilt())
        .prop_map(|(normal, (angle, turn))| (normal, nasty::tilted(normal, angle, turn)));
    let exact = |(normal, direction): &(Vec3, Vec3)| normal.as_dvec3().dot(direction.as_dvec3());
    // Roundings of the three products, each at most 1.
    let near = |yours: f32, expected: f64| (f64::from(yours) - expected).abs() <= 1e-6 * (1.0 + expected);
    trial.each(500, queries, <dyn Kit>::cosine_pdf, |query, yours| {
        let cosine = exact(query);
        let input = || query.call("cosine_pdf");
        let broken = || Broken::new(input(), yours, cosine / PI, "the definition");
        unless(near(yours, (cosine / PI).max(0.0)), broken).formulas([
            (near(yours, cosine), "you return the cosine: divide it by π"),
            (near(yours, 1.0 / TAU), "you return the density of the uniform hemisphere, 1 / 2π"),
            (near(yours, 1.0 / PI), "you return 1 / π: multiply it by the cosine"),
            (near(yours, cosine / TAU), "you divide by 2π: the integral of the cosine is π"),
            (near(yours, 0.25 / PI), "you return the density of the whole sphere, 1 / 4π"),
            (near(yours, cosine * cosine / PI), "you multiply by the cosine twice"),
            (near(yours, 2.0 * cosine / PI), "twice too much: the integral of the cosine is π"),
        ])
    })
}

pub(super) fn cosine_pdf_below_the_surface_is_zero(trial: &Trial<'_>) -> CheckResult {
    // Every fourth direction is above the surface.
    let queries = (nasty::unit(), 0..=12i32, 0..=15i32, 0..4i32).prop_map(|(normal, angle, turn, which)| {
        // At an angle of at least 0.1 to the surface, so that no rounding decides.
        let direction = nasty::tilted(normal, f64::from(angle) / 8.5, f64::from(turn) / 16.0 + 0.01);
        (normal, if which == 3 { direction } else { -direction })
    });
    trial.each(300, queries, <dyn Kit>::cosine_pdf, |query, yours| {
        let cosine = query.0.as_dvec3().dot(query.1.as_dvec3());
        if if cosine > 0.0 { yours > 0.0 } else { yours == 0.0 } {
            return Ok(());
        }
        let expected = if cosine > 0.0 { "above 0" } else { "0.0" };
        let input = query.call("cosine_pdf");
        Err(Broken::with_texts(input, format!("{yours:?}"), expected, "the definition").explained_by([
            (cosine < 0.0 && yours < 0.0, "your density is negative: return 0 below the surface"),
            "you take the absolute value of the cosine: return 0 below the surface"
                .when(cosine < 0.0 && (f64::from(yours) + cosine / PI).abs() < 1e-5),
            "your density is that of the other side: the cosine has the wrong sign"
                .when((f64::from(yours) - (-cosine / PI).max(0.0)).abs() < 1e-5),
        ]))
    })
}
