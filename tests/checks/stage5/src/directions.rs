//! The directions of reflected and refracted rays.

use checks::prelude::*;

/// A direction, and a normal on the side that it comes from.
pub(super) fn arrival() -> impl Strategy<Value = (Vec3, Vec3)> + Clone {
    (nasty::unit(), nasty::unit()).prop_map(|(direction, normal)| {
        (direction, if normal.dot(direction) > 0.0 { -normal } else { normal })
    })
}

/// How far a direction is from the reflected one, in double precision.
fn off_reflection(direction: Vec3, normal: Vec3, yours: Vec3) -> f64 {
    let (d, n) = (direction.as_dvec3(), normal.as_dvec3());
    (yours.as_dvec3().normalize() - (d - 2.0 * d.dot(n) * n).normalize()).length()
}

pub(super) fn reflect_keeps_the_angle(trial: &Trial<'_>) -> CheckResult {
    trial.each(2000, arrival(), <dyn Kit>::reflect, judge_reflection)
}

const ADDED: &str = "you add 2 n (d·n): subtract it, d - 2 n (d·n)";
const SUBTRACTED_ONCE: &str = "you subtract n (d·n) once: subtract it twice";

fn judge_reflection(query: &(Vec3, Vec3), yours: Vec3) -> Judged {
    let (d, n) = (query.0.as_dvec3(), query.1.as_dvec3());
    let expected = (d - 2.0 * d.dot(n) * n).normalize();
    let near = |v: DVec3, limit: f64| (yours.as_dvec3() - v).length() < limit;
    let is = |v: DVec3| near(v, 1e-5);
    let (along, added) = (d - d.dot(n) * n, d + 2.0 * d.dot(n) * n);
    let broken = || Broken::new(query.call("reflect"), yours, expected.as_vec3(), "closed form");
    // The tolerance covers a few roundings of numbers up to 2.
    unless(near(expected, 1e-6), broken).formulas([
        (is(d), "you return the direction unchanged"),
        (is(-d), "you reverse the whole direction: reverse only its part along n"),
        (is(-expected), "your result is negated: it points into the surface"),
        (is(d - 3.0 * d.dot(n) * n), "you subtract n (d·n) three times: subtract it twice"),
        (is((d - 3.0 * d.dot(n) * n).normalize()), "you subtract n (d·n) three times: subtract it twice"),
        (is(added), ADDED),
        (is(added.normalize_or_zero()), ADDED),
        (is(along), SUBTRACTED_ONCE),
        (
            // The part along the surface of a ray close to the normal is small, and has a large rounding error.
            near(along.normalize_or_zero(), 1e-5 + 1e-6 / along.length().max(1e-7)) || along.length() < 1e-5,
            SUBTRACTED_ONCE,
        ),
    ])
}

pub(super) fn reflect_stays_of_unit_length_in_a_corridor(trial: &Trial<'_>) -> CheckResult {
    // A thousand reflections on two mirrors that are not parallel to an axis.
    let normals = [vec3(0.6, 0.8, 0.0), vec3(-0.48, -0.64, 0.6)];
    let mut direction = vec3(0.3, -0.7, 0.2).normalize();
    for bounce in 0..1000 {
        let normal = normals[bounce % 2];
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let reflected = trial.kit.reflect(&[(direction, normal)])[0];
        // Another check judges the direction. Here it must only be a reflection.
        if !(off_reflection(direction, normal, reflected) < 1e-3) {
            let (input, expected) = (call("reflect", &[&direction, &normal]), "the reflected direction");
            return Err(Broken::new(input, reflected, expected, "closed form"));
        }
        direction = reflected;
    }
    let off = (direction.as_dvec3().length() - 1.0).abs();
    if off < 1e-6 {
        return Ok(());
    }
    let input = "reflect, 1000 times";
    let broken =
        Broken::with_texts(input, format!("|d| - 1 = {off:.1e}"), "less than 1e-6", "the definition");
    // A thousand roundings of 1e-7 add up to 1e-4.
    Err(broken.explained_by([(off < 1e-3, "the rounding errors of the length add up: normalize the result")]))
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

/// The error of a refracted direction by a careful formula: a few roundings.
const CAREFUL: f64 = 4e-6;

/// The error by the formula of the slide, whose `sin θ1` comes from the cosine.
const SLIDE: f64 = 4e-5;

const ANGLE: &str = "you multiply the angle by n1 / n2: multiply its sine";
const RATIO_NOT_SQUARED: &str = "you do not square the ratio: sin² θ2 = (n1 / n2)² sin² θ1";

/// Mistakes that show near the normal: a sine from the rounded cosine, and a division by the sine.
fn mistakes_near_normal(query: &RefractQuery, yours: Option<Vec3>) -> [(bool, &'static str); 2] {
    let RefractQuery { direction, normal, n1, n2 } = *query;
    let (is_nan, cosine) = (yours.is_some_and(Vec3::is_nan), direction.dot(normal));
    let sine_squared = 1.0 - cosine * cosine;
    let is_along = sine_squared == 0.0 || direction - cosine * normal == Vec3::ZERO;
    let sine_2 = yours.map_or(0.0, |yours| yours.reject_from(normal).length());
    let by_cosine = (sine_2 - n1 / n2 * sine_squared.sqrt()).abs() < 1e-5;
    let is_from_cosine = yours.is_some() && sine_squared < 1e-3 && by_cosine;
    [
        "you compute sin θ1 as √(1 - cos² θ1): near the normal that is inexact, or NaN where cos² θ1 is rounded up"
            .when(is_from_cosine || (is_nan && sine_squared < 0.0)),
        (is_nan && is_along, "you return NaN along the normal: do not divide by sin θ1, which gives 0 / 0"),
    ]
}

fn judge_refraction(query: &RefractQuery, yours: Option<Vec3>, error: f64) -> CheckResult {
    let (expected, margin) = snell(query);
    // Near the critical angle the error grows with the root of the rounding, and both `None` and a direction pass.
    let right = match (yours, expected) {
        (None, None) => true,
        (Some(yours), Some(expected)) => {
            (yours.as_dvec3() - expected).length() < error / margin.sqrt().max(1e-3)
        }
        (Some(yours), None) => margin.abs() < 1e-5 && yours.is_finite(),
        (None, Some(_)) => margin.abs() < 1e-5,
    };
    if right {
        return Ok(());
    }
    let expected = expected.map(|v| v.as_vec3());
    let is_nan = yours.is_some_and(Vec3::is_nan);
    Err(Broken::new(query.call("refract"), yours, expected, "Snell's law in double precision")
        .explained_by(named![
            is_nan && expected.is_none() => "you return NaN beyond the critical angle: return None",
            yours.is_some_and(|yours| off_reflection(query.direction, query.normal, yours) < 1e-4) =>
                "you return the reflected direction",
            expected.is_none() && margin < 0.0 && yours.is_some() => "you return a ray beyond the critical angle: return None",
            yours.is_some_and(|yours| yours.dot(query.normal) > 1e-3) => "your refracted ray stays on the side that it came from",
        ])
        .explained_by(mistakes_near_normal(query, yours)))
}

/// Wrong formulas, each with whether it gives this answer.
fn refractions(query: &RefractQuery, yours: &Option<Vec3>) -> Vec<(bool, &'static str)> {
    let (expected, margin) = snell(query);
    let swapped = snell(&RefractQuery { n1: query.n2, n2: query.n1, ..*query }).0;
    // A mistake gives this answer: the same direction, or also none.
    let gives_within = |v: Option<DVec3>, limit: f64| match (*yours, v) {
        (Some(yours), Some(v)) => (yours.as_dvec3() - v).length() < limit,
        (None, None) => true,
        _ => margin.abs() < 1e-5,
    };
    let gives = |v: Option<DVec3>| gives_within(v, 1e-4);
    // Near a right angle the arc sine enlarges a rounding error of 1e-7 to 4e-4. Near the normal each law gives the same.
    let by_angle = if query.direction.reject_from(query.normal).length() < 0.01 { 2e-6 } else { 5e-3 };
    // The direction after a cosine that does not belong to the sine, normalized.
    let across = |cosine: &dyn Fn(f64, f64) -> f64| {
        gives(turned(query, |sine, ratio| ratio * sine / (ratio * sine).hypot(cosine(sine, ratio))))
    };
    let bounded = |sine: f64, ratio: f64| match ratio * sine.min(1.0).asin() {
        angle if angle > std::f64::consts::FRAC_PI_2 => f64::INFINITY,
        angle => angle.sin(),
    };
    named![
        gives(swapped) => "you exchange n1 and n2: sin θ2 = n1 / n2 · sin θ1",
        gives(Some(query.direction.as_dvec3())) => "you return the direction unchanged",
        gives(expected.map(|v| -v)) => "your refracted ray is negated",
        gives(turned(query, |sine, ratio| -ratio * sine)) => "you negate the part along the surface: keep its sign",
        gives_within(turned(query, bounded), by_angle) => ANGLE,
        gives_within(turned(query, |sine, ratio| (ratio * sine.min(1.0).asin()).sin()), by_angle) => ANGLE,
        across(&|sine, ratio| (1.0 - ratio * sine * sine).sqrt()) => RATIO_NOT_SQUARED,
        gives(turned(query, |sine, ratio| ratio.sqrt() * sine)) => RATIO_NOT_SQUARED,
        across(&|sine, ratio| (1.0 - ratio * sine).sqrt()) =>
            "sin θ2 stands where its square belongs: cos θ2 = √(1 - sin² θ2)",
    ]
    .to_vec()
}

fn judge_refractions(trial: &Trial<'_>, queries: &[RefractQuery], error: f64) -> Vec<CheckResult> {
    let judge = |query: &RefractQuery, yours| judge_refraction(query, yours, error);
    compare_formulas(queries, trial.kit.refract(queries), judge, refractions)
}

/// Indices of refraction from 1/2 to 3, and pairs that are equal or almost equal.
fn indices() -> impl Strategy<Value = (f32, f32)> + Clone {
    let index = || fractions(4..=24, 8.0);
    prop_oneof![
        6 => (index(), index()),
        1 => index().prop_map(|index| (index, index)),
        1 => (index(), any::<bool>()).prop_map(|(index, above)| (index, if above { 1.001 } else { 0.999 } * index)),
    ]
}

fn arrivals() -> impl Strategy<Value = RefractQuery> + Clone {
    (arrival(), indices()).prop_map(|((direction, normal), (n1, n2))| RefractQuery {
        direction,
        normal,
        n1,
        n2,
    })
}

pub(super) fn refract_obeys_snell(trial: &Trial<'_>) -> CheckResult {
    let chosen = [RefractQuery { direction: vec3(0.6, -0.8, 0.0), normal: Vec3::Y, n1: 1.0, n2: 1.25 }];
    // Other checks ask for rays along the normal, and beyond the critical angle.
    let bent = arrivals().prop_filter("a slanted ray below the critical angle", |query| {
        snell(query).1 > 1e-4 && query.direction.cross(query.normal).length() > 0.1
    });
    trial.forall_and(&chosen, 1500, bent, |queries| judge_refractions(trial, queries, SLIDE))
}

pub(super) fn refract_goes_straight_where_it_must(trial: &Trial<'_>) -> CheckResult {
    // Along the normal sin θ1 is 0. With equal indices the direction does not change.
    let straight = (arrival(), indices(), any::<bool>()).prop_map(
        |((direction, normal), (n1, n2), along)| match along {
            true => RefractQuery { direction: -normal, normal, n1, n2 },
            false => RefractQuery { direction, normal, n1, n2: n1 },
        },
    );
    let straight =
        straight.prop_filter("not along the surface", |query| query.direction.dot(query.normal).abs() > 1e-2);
    let slanted = RefractQuery { direction: vec3(0.6, -0.8, 0.0), normal: Vec3::Y, n1: 1.0, n2: 1.5 };
    // The last one is bent.
    let chosen = [
        RefractQuery { direction: Vec3::NEG_Y, ..slanted },
        RefractQuery { direction: Vec3::NEG_Y, n1: 1.5, n2: 1.0, ..slanted },
        RefractQuery { n1: 1.5, ..slanted },
        slanted,
    ];
    trial.each_and(&chosen, 300, straight, <dyn Kit>::refract, |query, yours| {
        if *query == slanted {
            // Another check judges the angle. Here the ray must only be bent to the normal.
            let bent = |yours: Vec3| yours.dot(query.normal) < query.direction.dot(query.normal) - 1e-3;
            return match yours {
                Some(yours) if bent(yours) || yours.is_nan() => Ok(()),
                _ => judge_refraction(query, yours, SLIDE),
            };
        }
        // The tolerance covers the error of the slide's formula, which the root of 1 - sin² θ2 enlarges along the surface.
        let slack = SLIDE as f32 / query.direction.dot(query.normal).abs();
        if yours.is_some_and(|yours| (yours - query.direction).length() < slack) {
            return Ok(());
        }
        let broken = Broken::new(query.call("refract"), yours, Some(query.direction), "unchanged");
        let along = query.direction == -query.normal;
        let broken = broken.explained_by(named![
            along => "a ray along the normal keeps its direction, and sin θ1 is 0 there",
            query.n1 == query.n2 && !along && yours.is_none() => "with equal indices every ray goes straight on",
        ]);
        Err(broken.explained_by(mistakes_near_normal(query, yours)))
    })
}

pub(super) fn refract_beyond_the_critical_angle_is_none(trial: &Trial<'_>) -> CheckResult {
    // 60° inside glass; then the critical angle, and one float of the sine to either side, where NaN is wrong.
    let at_sine = |sine: f32| {
        let direction = vec3(sine, -(1.0 - f64::from(sine).powi(2)).sqrt() as f32, 0.0);
        RefractQuery { direction, normal: Vec3::Y, n1: 1.5, n2: 1.0 }
    };
    let critical = 1.0f32 / 1.5;
    let chosen = [0.866_025_4, 0.75, critical.next_up(), critical, critical.next_down(), 0.6].map(at_sine);
    // Half of these are beyond the critical angle.
    let inputs = (arrivals(), any::<bool>()).prop_filter_map("on either side", |(query, beyond)| {
        let query = RefractQuery { n1: query.n1.max(query.n2), n2: query.n1.min(query.n2), ..query };
        let margin = snell(&query).1;
        // Another check asks for rays along the normal.
        let slanted = query.direction.cross(query.normal).length() > 0.1;
        (slanted && if beyond { margin < -1e-3 } else { margin > 1e-3 }).then_some(query)
    });
    let judge = |query: &RefractQuery, yours: Option<Vec3>| {
        let beyond = snell(query).0.is_none();
        // Another check judges the angle. Here a ray below the critical angle must only be refracted.
        if !beyond && yours.is_some_and(|yours| yours.is_finite() && yours.dot(query.normal) < 1e-3) {
            return Ok(());
        }
        judge_refraction(query, yours, SLIDE)
    };
    trial.forall_and(&chosen, 400, inputs, |queries| {
        compare_formulas(queries, trial.kit.refract(queries), judge, refractions)
    })
}

pub(super) fn refract_survives_rounded_directions(trial: &Trial<'_>) -> CheckResult {
    // One unit vector in five is slightly longer than 1, and the root of 1 - cos² is NaN near the normal.
    let inputs =
        (nasty::unit(), -40..=40i32, -40..=40i32, any::<bool>()).prop_map(|(normal, x, y, glass)| {
            let (u, v) = normal.any_orthonormal_pair();
            let direction = (-normal + 1e-5 * (x as f32 * u + y as f32 * v)).normalize();
            let direction = direction * (1.0 + f32::EPSILON); // one rounding error too long
            let (n1, n2) = if glass { (1.0, 1.5) } else { (1.5, 1.0) };
            RefractQuery { direction, normal, n1, n2 }
        });
    trial.forall(2000, inputs, |queries| judge_refractions(trial, queries, CAREFUL))
}
