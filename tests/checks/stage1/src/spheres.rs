//! Ray-sphere intersection: each check for both methods.

use crate::sphere_method::{Accepts, SphereFunction};
use checks::generate::{ray, sphere, unit};
use checks::prelude::*;

fn query(origin: (f32, f32, f32), direction: Vec3, radius: f32) -> SphereQuery {
    let ray = Ray::new(vec3(origin.0, origin.1, origin.2), direction);
    SphereQuery { ray, sphere: Sphere { center: Vec3::ZERO, radius } }
}

/// Rays with unit directions from outside and inside of spheres near the origin; half of them are aimed at the sphere,
/// because hardly any random ray hits it.
fn ordinary() -> impl Strategy<Value = SphereQuery> + Clone {
    (ray(), sphere(), any::<bool>()).prop_map(|(ray, sphere, aim)| {
        let to_center = sphere.center - ray.origin;
        let direction = if aim && to_center != Vec3::ZERO {
            (to_center.normalize() + 0.1 * ray.direction).normalize()
        } else {
            ray.direction
        };
        SphereQuery { ray: Ray::new(ray.origin, direction), sphere }
    })
}

/// The same scene with sizes times `size`, and a direction times `length`.
fn scaled(query: &SphereQuery, size: f32, length: f32) -> SphereQuery {
    let SphereQuery { ray, sphere } = *query;
    SphereQuery {
        ray: Ray { origin: size * ray.origin, direction: length * ray.direction, ..ray },
        sphere: Sphere { center: size * sphere.center, radius: size * sphere.radius },
    }
}

pub(super) fn sphere_agrees(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    // Begin with rays like the one on the slide: random rays that fail shrink to rays that start inside the sphere. The
    // second passes through the centre, and the third passes beside the sphere.
    let drawn = [
        query((-5.0, 1.0, 0.0), Vec3::X, 2.0),
        query((-5.0, 0.0, 0.0), Vec3::X, 2.0),
        query((-5.0, 3.0, 0.0), Vec3::X, 2.0),
        query((0.0, 5.0, 0.5), Vec3::NEG_Y, 0.75),
    ];
    let sized = (ordinary(), nasty::scale(-16..=16)).prop_map(|(query, size)| scaled(&query, size, 1.0));
    let inputs = prop_oneof![3 => ordinary(), 1 => sized];
    trial.forall_and(&drawn, 4000, inputs, |queries| method.judge(trial, queries, Accepts::TheFormula))
}

pub(super) fn sphere_from_inside(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    // From the centre to just inside the surface.
    let depth = prop_oneof![
        (0..=7i32).prop_map(|eighths| 0.9 * eighths as f32 / 8.0),
        (3..=10i32).prop_map(|halvings| 1.0 - 0.5f32.powi(halvings)),
    ];
    let inputs = (sphere(), nasty::unit(), unit(), depth, nasty::scale(-16..=16)).prop_map(
        |(sphere, direction, out, depth, size)| {
            let origin = sphere.center + depth * sphere.radius * out;
            scaled(&SphereQuery { ray: Ray::new(origin, direction), sphere }, size, 1.0)
        },
    );
    // The last one starts outside: a method that only tries the near root hits nothing else.
    let from = |x: f32, direction: Vec3| query((x, 0.0, 0.0), direction, 2.0);
    let drawn = [from(1.0, Vec3::X), from(1.0, Vec3::NEG_X), from(-5.0, Vec3::X)];
    trial.forall_and(&drawn, 2000, inputs, |queries| method.judge(trial, queries, Accepts::TheFormula))
}

pub(super) fn sphere_scaled(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let scales = (nasty::scale(-16..=16), nasty::scale(-16..=16));
    let inputs =
        (point(8), direction(), sphere(), scales).prop_map(|(origin, direction, sphere, (size, length))| {
            scaled(&SphereQuery { ray: Ray::new(origin, direction), sphere }, size, length)
        });
    let drawn = [
        query((-5.0, 1.0, 0.0), 2.0 * Vec3::X, 2.0),
        query((-5.0, 1.0, 0.0), 0.25 * Vec3::X, 2.0),
        query((1.0, 0.5, 0.0), 3.0 * Vec3::Y, 2.0),
    ];
    trial.forall_and(&drawn, 3000, inputs, |queries| method.judge(trial, queries, Accepts::TheFormula))
}

pub(super) fn sphere_in_range(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let ranged = |t_min, t_max| {
        let query = query((-5.0, 0.0, 0.0), Vec3::X, 1.0);
        SphereQuery { ray: query.ray.with_range(t_min, t_max), ..query }
    };
    let behind = query((5.0, 0.0, 0.0), Vec3::X, 1.0);
    let infinite = f32::INFINITY;
    method.judge_exact(
        trial,
        &[
            (behind, None),
            // A range may begin at a negative t.
            (SphereQuery { ray: behind.ray.with_range(-8.0, infinite), ..behind }, Some(-6.0)),
            (ranged(0.0, infinite), Some(4.0)),
            (ranged(4.5, infinite), Some(6.0)),
            (ranged(0.0, 3.5), None),
            (ranged(4.0, infinite), Some(6.0)),
            (ranged(0.0, 4.0), None),
            (ranged(4.5, 5.5), None),
            (ranged(6.5, infinite), None),
        ],
    )?;
    trial.forall(500, ordinary(), |queries| judge_ends(trial, method, queries))
}

/// Asks again with ranges that end exactly at the answer, one float before it and one float behind it.
fn judge_ends(trial: &Trial<'_>, method: SphereFunction, queries: &[SphereQuery]) -> Vec<CheckResult> {
    let answers = (method.ask)(trial.kit, queries);
    let mut outcomes = vec![Ok(()); queries.len()];
    let hits = queries.iter().zip(answers).enumerate().filter_map(|(i, (query, t))| Some((i, query, t?)));
    let cases: Vec<_> = hits
        .filter(|(_, query, t)| query.ray.contains(*t))
        .flat_map(|(i, query, t)| {
            nasty::ranges(t).map(|((t_min, t_max), counts)| {
                (i, SphereQuery { ray: query.ray.with_range(t_min, t_max), ..*query }, t, counts)
            })
        })
        .collect();
    let asked: Vec<SphereQuery> = cases.iter().map(|case| case.1).collect();
    for ((i, query, t, counts), yours) in cases.into_iter().zip((method.ask)(trial.kit, &asked)) {
        // A hit that does not count may be followed by the far root, but only before t_max.
        let right = match counts {
            true => yours == Some(t),
            false => yours.is_none_or(|far| far > t && query.ray.contains(far)),
        };
        if right {
            continue;
        }
        let expected =
            if counts { format!("Some({t:?})") } else { format!("not {t:?}, which is out of range") };
        let source = "the t for the infinite ray";
        let broken = Broken::with_texts(query.call(method.name), format!("{yours:?}"), expected, source);
        let given = yours == Some(t);
        outcomes[i] = outcomes[i].clone().and(Err(broken.explained_by([
            "the range is open: a hit at t_min or at t_max does not count (t = 0 for a ray that starts on the sphere)"
                .when(given && (t == query.ray.t_min || t == query.ray.t_max)),
            (given && t > query.ray.t_max, "you return a t beyond t_max: ask ray.contains(t)"),
            (given && t < query.ray.t_min, "you return a t before t_min: ask ray.contains(t)"),
        ])));
    }
    outcomes
}

/// Spheres of radius 0.001 to 1 at distances of 10 to 100,000. Each ray is aimed at its sphere.
fn distant() -> impl Strategy<Value = SphereQuery> + Clone {
    (unit(), rough_point(0.55), magnitude(1.0, 5.0), magnitude(-3.0, 0.0)).prop_map(
        |(away, at, distance, radius)| {
            let origin = distance * away;
            SphereQuery {
                ray: Ray::new(origin, (radius * at - origin).normalize()),
                sphere: Sphere { center: Vec3::ZERO, radius },
            }
        },
    )
}

/// The ground is a sphere of radius 100,000, about 100 below the origins. No formula in single precision keeps all digits
/// there, but the error must stay within the rounding of the inputs.
fn ground() -> impl Strategy<Value = SphereQuery> + Clone {
    (rough_point(100.0), unit()).prop_map(|(origin, direction)| {
        let origin = origin + Vec3::new(0.0, 110.0, 0.0);
        let direction = Vec3::new(direction.x, -direction.y.abs() - 0.2, direction.z).normalize();
        SphereQuery {
            ray: Ray::new(origin, direction),
            sphere: Sphere { center: Vec3::new(0.0, -1e5, 0.0), radius: 1e5 },
        }
    })
}

pub(super) fn sphere_far(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let inputs = prop_oneof![4 => distant(), 1 => ground(), 2 => ordinary()];
    trial.forall(6000, inputs, |queries| method.judge(trial, queries, Accepts::FewRoundings))
}

pub(super) fn sphere_tangent(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let at_height = |y: f32| query((-5.0, y, 0.0), Vec3::X, 1.0);
    // Rays along each axis, at coordinates whose squares are exact.
    method.judge_exact(
        trial,
        &[
            (at_height(1.0), Some(5.0)),
            (at_height(-1.0), Some(5.0)),
            (query((0.0, -5.0, 2.0), Vec3::Y, 2.0), Some(5.0)),
            (query((0.5, 0.0, 8.0), Vec3::NEG_Z, 0.5), Some(8.0)),
            (at_height(0.0), Some(4.0)),
            (at_height(1.5), None),
            (query((-0.5, 0.0, 0.0), Vec3::X, 2.0), Some(2.5)),
        ],
    )?;
    // One float higher the ray misses, one float lower it hits. Neither answer may be NaN.
    let queries = [at_height(1.0f32.next_up()), at_height(1.0f32.next_down())];
    all_hold(compare(&queries, (method.ask)(trial.kit, &queries), |query, yours| {
        // One float of height moves the root by sqrt(2u), which is 3.5e-4, to either side of 5.
        if yours.is_none_or(|t| (t - 5.0).abs() < 1e-3) {
            return Ok(());
        }
        let yours_in_words = format!("{yours:?}");
        Err(Broken::with_texts(query.call(method.name), yours_in_words, "None, or 5 ± 0.001", "closed form")
            .explained_by([(yours.is_some_and(f32::is_nan), "you return NaN: compare so that NaN fails")]))
    }))
}

pub(super) fn sphere_on_surface(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    // The origin is exactly on the sphere: a ray outwards misses, and a ray inwards hits the far side.
    let from = |origin: Vec3, direction: Vec3| query(origin.into(), direction, 1.0);
    method.judge_exact(
        trial,
        &[
            (from(Vec3::X, Vec3::X), None),
            (from(Vec3::NEG_Y, Vec3::NEG_Y), None),
            (from(Vec3::X, Vec3::Y), None),
            (from(Vec3::X, Vec3::NEG_X), Some(2.0)),
            (from(Vec3::NEG_Z, Vec3::Z), Some(2.0)),
            // An ordinary ray, which no mistake about the surface loses.
            (from(5.0 * Vec3::X, Vec3::NEG_X), Some(4.0)),
        ],
    )
}

pub(super) fn sphere_normal_points_outwards(trial: &Trial<'_>) -> CheckResult {
    // All sizes together times 2⁻¹⁶ to 2¹⁶, and centres that are far away in comparison with the radius.
    let inputs = (sphere(), nasty::unit(), nasty::scale(-16..=16), nasty::scale(-8..=0)).prop_map(
        |(sphere, out, size, small)| {
            let radius = small * sphere.radius;
            let point = sphere.center + radius * out;
            (Sphere { center: size * sphere.center, radius: size * radius }, size * point)
        },
    );
    let at_the_origin = (Sphere { center: Vec3::ZERO, radius: 2.0 }, vec3(0.0, 2.0, 0.0));
    let beside = (Sphere { center: vec3(1.0, 2.0, 3.0), radius: 2.0 }, vec3(1.0, 2.0, 1.0));
    trial.each_and(
        &[beside, at_the_origin],
        1500,
        inputs,
        <dyn Kit>::sphere_normal,
        |(sphere, point), yours| {
            let outwards = point.as_dvec3() - sphere.center.as_dvec3();
            let near = |exact: DVec3| {
                // The difference of both points is rounded, and so are its length and the quotient.
                (yours.as_dvec3() - exact).length() <= 8.0 * f64::from(f32::EPSILON) * exact.length()
            };
            let expected = outwards.normalize_or_zero();
            // Every unit vector is right at the centre.
            let anywhere = outwards == DVec3::ZERO && (yours.length() - 1.0).abs() < 1e-6;
            let broken = || {
                let input = call("sphere_normal", &[&sphere.center, point]);
                Broken::new(input, yours, expected.as_vec3(), "double precision").explained_by([
                    (near(-expected), "your normal points inwards"),
                    (near(outwards), "your normal is not of unit length"),
                ])
            };
            unless(near(expected) || anywhere, broken)
                .formulas(["you return the direction from the world's origin: subtract the centre first"
                    .when(near(point.as_dvec3().normalize_or_zero()))])
        },
    )
}
