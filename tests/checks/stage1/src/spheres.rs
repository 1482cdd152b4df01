//! Ray-sphere intersection: each check for both methods.

use super::sphere_method::{ALGEBRAIC, GEOMETRIC, SphereFunction};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{direction, magnitude, point, ray, rough_point, sphere, unit};
use checks::judge::{compare, known};
use checks::paste::{Arguments, call};
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::SphereQuery;
use raykata::ray::Ray;
use raykata::shape::Sphere;

macro_rules! for_both_methods {
    ($($algebraic:ident $geometric:ident $law:ident;)*) => {
        $(pub(super) fn $algebraic(trial: &Trial<'_>) -> CheckResult {
            $law(trial, ALGEBRAIC)
        }
        pub(super) fn $geometric(trial: &Trial<'_>) -> CheckResult {
            $law(trial, GEOMETRIC)
        })*
    };
}

for_both_methods! {
    sphere_algebraic_agrees_with_double_precision sphere_geometric_agrees_with_double_precision sphere_agrees;
    sphere_algebraic_starts_inside sphere_geometric_starts_inside sphere_from_inside;
    sphere_algebraic_counts_lengths_of_the_direction sphere_geometric_counts_lengths_of_the_direction sphere_scaled;
    sphere_algebraic_respects_the_range sphere_geometric_respects_the_range sphere_in_range;
    sphere_algebraic_far_away_and_tiny sphere_geometric_far_away_and_tiny sphere_far;
    sphere_algebraic_touches sphere_geometric_touches sphere_tangent;
    sphere_algebraic_leaves_the_surface sphere_geometric_leaves_the_surface sphere_on_surface;
    sphere_algebraic_survives_invalid_numbers sphere_geometric_survives_invalid_numbers sphere_invalid_numbers;
}

pub(super) fn sphere_agrees(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    // First test the ray that the slide draws. Random rays that fail shrink to rays that start inside the sphere.
    let drawn = SphereQuery {
        ray: Ray::new(Vec3::new(-5.0, 1.0, 0.0), Vec3::X),
        sphere: Sphere { center: Vec3::ZERO, radius: 2.0 },
    };
    method.judge(trial, &[drawn]).into_iter().collect::<CheckResult>()?;
    let inputs = (ray(), sphere(), any::<bool>()).prop_map(|(ray, sphere, aim)| {
        // Aim half of the rays at the sphere, because hardly any random ray hits it.
        let to_center = sphere.center - ray.origin;
        let direction = if aim && to_center != Vec3::ZERO {
            (to_center.normalize() + 0.1 * ray.direction).normalize()
        } else {
            ray.direction
        };
        SphereQuery { ray: Ray::new(ray.origin, direction), sphere }
    });
    trial.forall(4000, inputs, |queries| method.judge(trial, queries))
}

pub(super) fn sphere_from_inside(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let inputs = (sphere(), unit(), unit(), 0..=7i32).prop_map(|(sphere, direction, out, eighths)| {
        let origin = sphere.center + 0.9 * sphere.radius * eighths as f32 / 8.0 * out;
        SphereQuery { ray: Ray::new(origin, direction), sphere }
    });
    trial.forall(2000, inputs, |queries| method.judge(trial, queries))
}

pub(super) fn sphere_scaled(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let inputs = (point(8), direction(), sphere())
        .prop_map(|(origin, direction, sphere)| SphereQuery { ray: Ray::new(origin, direction), sphere });
    trial.forall(2000, inputs.clone(), |queries| method.judge(trial, queries))?;

    // A direction 1024 times as long makes t exactly 1024 times smaller, because powers of two change no rounding.
    trial.forall(500, inputs, |queries| {
        let longer = |query: &SphereQuery| SphereQuery {
            ray: Ray::new(query.ray.origin, 1024.0 * query.ray.direction),
            ..*query
        };
        let answers = (method.ask)(trial.kit, queries);
        let queries: Vec<SphereQuery> = queries.iter().map(longer).collect();
        let scaled = (method.ask)(trial.kit, &queries);
        let pairs: Vec<_> = answers.into_iter().zip(scaled).collect();
        compare(&queries, pairs, |query, (answer, scaled)| match answer.map(|t| t / 1024.0) == scaled {
            true => Ok(()),
            false => {
                let expected = answer.map(|t| t / 1024.0);
                let lost = scaled
                    .is_none()
                    .then_some("a fixed epsilon rejects this hit: t is small because direction is long");
                let source = "the t for direction / 1024, divided by 1024";
                Err(Broken::new(query.call(method.name), scaled, expected, source).looks_like(lost))
            }
        })
    })
}

pub(super) fn sphere_in_range(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let query = |t_min, t_max| SphereQuery {
        ray: Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::X).with_range(t_min, t_max),
        sphere: Sphere { center: Vec3::ZERO, radius: 1.0 },
    };
    let behind = SphereQuery { ray: Ray::new(Vec3::new(5.0, 0.0, 0.0), Vec3::X), ..query(0.0, 1.0) };
    method.judge_exact(
        trial,
        &[
            (behind, None, "the sphere is behind the ray: a negative t does not count"),
            (query(0.0, f32::INFINITY), Some(4.0), ""),
            (query(4.5, f32::INFINITY), Some(6.0), "the near root lies before t_min, but the far one counts"),
            (query(0.0, 3.5), None, "the hit lies beyond t_max"),
            (query(4.0, f32::INFINITY), Some(6.0), "the range is open: a hit at t_min does not count"),
            (query(0.0, 4.0), None, "the range is open: a hit at t_max does not count"),
            (query(4.5, 5.5), None, "both roots lie outside of the range"),
            (query(6.5, f32::INFINITY), None, "both roots lie before t_min"),
        ],
    )
}

/// S2, S4: spheres of radius 0.001 to 1 at distances of 10 to 100,000. Each ray is aimed at its sphere.
pub(super) fn sphere_far(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let inputs = (unit(), rough_point(0.55), magnitude(1.0, 5.0), magnitude(-3.0, 0.0)).prop_map(
        |(away, at, distance, radius)| {
            let origin = distance * away;
            SphereQuery {
                ray: Ray::new(origin, (radius * at - origin).normalize()),
                sphere: Sphere { center: Vec3::ZERO, radius },
            }
        },
    );
    trial.forall(4000, inputs, |queries| method.judge(trial, queries))?;
    // S6: the ground is a sphere of radius 100,000, about 100 below the origins. No formula in single precision keeps
    // all digits there, but the error must stay within the rounding of the inputs.
    let ground = (rough_point(100.0), unit()).prop_map(|(origin, direction)| {
        let origin = origin + Vec3::new(0.0, 110.0, 0.0);
        let direction = Vec3::new(direction.x, -direction.y.abs() - 0.2, direction.z).normalize();
        SphereQuery {
            ray: Ray::new(origin, direction),
            sphere: Sphere { center: Vec3::new(0.0, -1e5, 0.0), radius: 1e5 },
        }
    });
    trial.forall(1000, ground, |queries| method.judge(trial, queries))
}

pub(super) fn sphere_tangent(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let at_height = |y: f32| SphereQuery {
        ray: Ray::new(Vec3::new(-5.0, y, 0.0), Vec3::X),
        sphere: Sphere { center: Vec3::ZERO, radius: 1.0 },
    };
    method.judge_exact(
        trial,
        &[(at_height(1.0), Some(5.0), "the ray touches the sphere: a discriminant of exactly 0 is a hit")],
    )?;
    // One float higher the ray misses, one float lower it hits. Neither answer may be NaN.
    let (above, below) = (at_height(1.0f32.next_up()), at_height(1.0f32.next_down()));
    for (query, yours) in [above, below].iter().zip((method.ask)(trial.kit, &[above, below])) {
        // One float of height moves the root by sqrt(2u), which is 3.5e-4, to either side of 5.
        if yours.is_some_and(|t| !((t - 5.0).abs() < 1e-3)) {
            return Err(Broken::with_texts(
                query.call(method.name),
                format!("{yours:?}"),
                "None, or 5 ± 0.001",
                "closed form",
            ));
        }
    }
    Ok(())
}

pub(super) fn sphere_on_surface(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    // The origin is exactly on the sphere: a ray outwards misses, and a ray inwards hits the far side.
    let sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let from = |origin: Vec3, direction: Vec3| SphereQuery { ray: Ray::new(origin, direction), sphere };
    method.judge_exact(
        trial,
        &[
            (
                from(Vec3::X, Vec3::X),
                None,
                "the ray starts on the sphere and leaves it: t = 0 does not count",
            ),
            (
                from(Vec3::NEG_Y, Vec3::NEG_Y),
                None,
                "the ray starts on the sphere and leaves it: t = 0 does not count",
            ),
            (
                from(Vec3::X, Vec3::Y),
                None,
                "the ray starts on the sphere and runs along it: t = 0 does not count",
            ),
            (from(Vec3::X, Vec3::NEG_X), Some(2.0), "the ray starts on the sphere and hits its far side"),
            (from(Vec3::NEG_Z, Vec3::Z), Some(2.0), "the ray starts on the sphere and hits its far side"),
        ],
    )
}

pub(super) fn sphere_invalid_numbers(trial: &Trial<'_>, method: SphereFunction) -> CheckResult {
    let ray = Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::X);
    let unit = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let nothing =
        "radius 0, a zero direction, NaN or infinity: the sphere cannot be hit; compare so that NaN fails";
    method.judge_exact(
        trial,
        &[
            (SphereQuery { ray, sphere: Sphere { radius: 0.0, ..unit } }, None, nothing),
            (SphereQuery { ray, sphere: Sphere { radius: f32::NAN, ..unit } }, None, nothing),
            (SphereQuery { ray, sphere: Sphere { center: Vec3::NAN, ..unit } }, None, nothing),
            (SphereQuery { ray: Ray { direction: Vec3::NAN, ..ray }, sphere: unit }, None, nothing),
            (SphereQuery { ray: Ray { direction: Vec3::ZERO, ..ray }, sphere: unit }, None, nothing),
            (SphereQuery { ray: Ray { origin: Vec3::INFINITY, ..ray }, sphere: unit }, None, nothing),
        ],
    )
}

pub(super) fn sphere_normal_points_outwards(trial: &Trial<'_>) -> CheckResult {
    let inputs =
        (sphere(), unit()).prop_map(|(sphere, out)| (sphere, sphere.center + sphere.radius * out, out));
    trial.forall(1000, inputs, |cases| {
        let queries: Vec<_> = cases.iter().map(|(sphere, point, _)| (*sphere, *point)).collect();
        compare(cases, trial.kit.sphere_normal(&queries), |(sphere, point, out), yours| {
            // The point is rounded at the size of centre plus radius, and this error turns the normal.
            let tolerance = 8.0 * f32::EPSILON * (1.0 + sphere.center.length() / sphere.radius);
            let right = (yours - *out).length() <= tolerance
                && (yours.length() - 1.0).abs() <= 4.0 * f32::EPSILON + tolerance;
            let diagnosis = match () {
                () if (yours + *out).length() <= tolerance => "your normal points inwards",
                () if (yours - point.normalize_or_zero()).length() <= tolerance => {
                    "you return the direction from the world's origin: subtract the centre first"
                }
                () if (yours.normalize_or_zero() - *out).length() <= tolerance => {
                    "your normal is not of unit length"
                }
                () => "",
            };
            let input = call("sphere_normal", &[&sphere.center, point]);
            if right {
                Ok(())
            } else {
                Err(Broken::new(input, yours, out, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}
