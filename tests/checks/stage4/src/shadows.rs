//! Shadow rays.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{magnitude, point, rough_point, unit};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{LightSample, ShadowQuery, Surface};

/// A point of a surface, and a light in direction `direction` at distance `distance`.
pub(super) fn shadow(point: Vec3, normal: Vec3, direction: Vec3, distance: f32, error: f32) -> ShadowQuery {
    let surface =
        Surface { point, error: Vec3::splat(error), geometric_normal: normal, shading_normal: normal };
    ShadowQuery { surface, light: LightSample { direction, distance, radiance: Vec3::ONE } }
}

/// Points with coordinates of these sizes (powers of ten), on surfaces in any orientation, with lights well above the
/// horizon.
pub(super) fn lit(sizes: std::ops::Range<f32>) -> impl Strategy<Value = ShadowQuery> + Clone {
    (unit(), unit(), rough_point(1.0), magnitude(sizes.start, sizes.end), 1..=64i32).prop_map(
        |(normal, lean, at, size, distance)| {
            let direction = (normal + 0.8 * lean).normalize();
            // An error bound of seven roundings per coordinate, as for a point of a triangle of this size.
            shadow(size * at, normal, direction, size * distance as f32 / 4.0, 4e-7 * size)
        },
    )
}

pub(super) fn judge_shadow_rays(
    trial: &Trial<'_>,
    queries: &[ShadowQuery],
    law: impl Fn(&ShadowQuery, &raykata::ray::Ray) -> Option<(String, String, &'static str)>,
) -> Vec<CheckResult> {
    compare(queries, trial.kit.shadow_ray(queries), |query, yours| match yours {
        None => Err(Broken::with_texts(
            query.call("shadow_ray"),
            "None",
            "a ray: the light is in front of the surface",
            "the definition",
        )),
        Some(ray) => match law(query, &ray) {
            None => Ok(()),
            Some((yours, expected, diagnosis)) => {
                Err(Broken::with_texts(query.call("shadow_ray"), yours, expected, "closed form")
                    .looks_like(known(diagnosis)))
            }
        },
    })
}

pub(super) fn shadow_ray_reaches_just_short_of_the_light(trial: &Trial<'_>) -> CheckResult {
    trial.forall(1000, lit(-1.0..2.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let light = &query.light;
            let length = ray.direction.length();
            if (ray.direction / length - light.direction).length() > 1e-4 {
                return Some((
                    format!("direction {}", ray.direction),
                    format!("direction {}", light.direction),
                    if (ray.direction / length + light.direction).length() < 1e-4 {
                        "your ray goes away from the light: use light.direction"
                    } else {
                        ""
                    },
                ));
            }
            let reach = ray.t_max * length;
            let describe = || (format!("ends after {reach}"), format!("just below {}", light.distance));
            // L2: the surface of the light itself must not occlude it. An object close to the light must.
            match () {
                () if (length - 1.0).abs() > 1e-3
                    && reach > light.distance
                    && ray.t_max <= light.distance =>
                {
                    Some((
                        describe().0,
                        describe().1,
                        "t counts lengths of the direction: if the direction ends at the light, t is 1 there",
                    ))
                }
                () if reach == f32::INFINITY => Some((
                    describe().0,
                    describe().1,
                    "your ray goes on behind the light, where no object can occlude the light: set t_max",
                )),
                () if !(reach < light.distance) => Some((
                    describe().0,
                    describe().1,
                    "your ray reaches the light, so the light would occlude itself: end slightly before it",
                )),
                () if reach < 0.99 * light.distance => Some((
                    describe().0,
                    describe().1,
                    "your ray ends too early: it misses objects just in front of the light",
                )),
                () => None,
            }
        })
    })?;
    let sun = shadow(Vec3::ZERO, Vec3::Y, vec3(0.6, 0.8, 0.0), f32::INFINITY, 1e-7);
    judge_shadow_rays(trial, &[sun], |_, ray| {
        (ray.t_max != f32::INFINITY).then(|| {
            (format!("t_max = {}", ray.t_max), "t_max = inf".into(), "the sun is infinitely far away")
        })
    })
    .into_iter()
    .collect()
}

/// The height of the ray's start above the point, and the bound on the point's error, both along the normal.
pub(super) fn start_height(query: &ShadowQuery, ray: &raykata::ray::Ray) -> (f64, f64) {
    let normal = query.surface.geometric_normal.as_dvec3();
    let start = ray.origin.as_dvec3() + f64::from(ray.t_min) * ray.direction.as_dvec3();
    ((start - query.surface.point.as_dvec3()).dot(normal), query.surface.error.as_dvec3().dot(normal.abs()))
}

/// Whether the origin was moved along the ray instead of along the normal.
fn goes_along_the_light(query: &ShadowQuery, ray: &raykata::ray::Ray) -> bool {
    let moved = (ray.origin - query.surface.point).normalize_or_zero();
    let (normal, to_light) = (query.surface.geometric_normal, query.light.direction);
    moved.dot(to_light) > 0.99 && moved.dot(normal) < 0.9
}

pub(super) fn shadow_ray_leaves_its_own_surface_at_any_scale(trial: &Trial<'_>) -> CheckResult {
    // R6: the true surface is up to `error` above the point. Coordinates range from a thousandth to a hundred thousand.
    trial.forall(3000, lit(-3.0..5.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let (height, bound) = start_height(query, ray);
            let diagnosis = match () {
                () if height == 0.0 => {
                    "your ray starts on the rounded point, so it may hit its own surface (shadow acne)"
                }
                () if height < 0.0 => "your ray starts below the surface: move to the viewer's side",
                () if goes_along_the_light(query, ray) => {
                    "you move the origin along the ray: move it along the geometric normal"
                }
                () => "your offset is too small: move by error·|n|, then each coordinate one float outwards",
            };
            // One per cent of slack for the rounding of the bound itself.
            (height < 0.99 * bound).then(|| {
                (format!("starts {height:.3e} above the point"), format!("{bound:.3e} or more"), diagnosis)
            })
        })
    })
}

pub(super) fn shadow_ray_sees_what_is_close(trial: &Trial<'_>) -> CheckResult {
    trial.forall(3000, lit(-3.0..5.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let (height, bound) = start_height(query, ray);
            // 64 float steps of the largest coordinate: the ray must hit any object farther away than that.
            let size = f64::from(query.surface.point.abs().max_element());
            let most = 64.0 * 2.0 * checks::double::U * size + 4.0 * bound;
            (height > most).then(|| {
                (
                    format!("starts {height:.3e} above the point"),
                    format!("at most {most:.3e}"),
                    "your offset is too large here: the ray misses objects that nearly touch the surface",
                )
            })
        })
    })
}

pub(super) fn shadow_ray_is_not_traced_without_effect(trial: &Trial<'_>) -> CheckResult {
    let behind = (unit(), unit(), point(4)).prop_filter_map("a light behind", |(normal, to_light, at)| {
        (normal.dot(to_light) < -1e-3).then(|| shadow(at, normal, to_light, 5.0, 1e-6))
    });
    trial.forall(1000, behind, |queries| {
        compare(queries, trial.kit.shadow_ray(queries), |query, yours| match yours {
            None => Ok(()),
            Some(ray) => Err(Broken::with_texts(
                query.call("shadow_ray"),
                format!("a ray along {}", ray.direction),
                "None",
                "the definition",
            )
            .looks_like(Some(
                "you trace a ray to a light behind the surface, which adds nothing: return None",
            ))),
        })
    })?;
    // Light exactly parallel to the surface, by either normal, adds nothing either.
    let along = shadow(Vec3::ZERO, Vec3::Y, Vec3::X, 5.0, 1e-6);
    let lean = vec3(-0.6, 0.8, 0.0);
    let mut along_smooth = shadow(Vec3::ZERO, Vec3::Y, vec3(0.8, 0.6, 0.0), 5.0, 1e-6);
    along_smooth.surface.shading_normal = lean;
    let mut along_flat = along;
    along_flat.surface.shading_normal = vec3(0.6, 0.8, 0.0);
    for query in [along, along_smooth, along_flat] {
        if trial.kit.shadow_ray(&[query])[0].is_some() {
            return Err(Broken::with_texts(query.call("shadow_ray"), "a ray", "None", "the definition")
                .looks_like(Some(
                    "you trace a ray to a light whose cosine with a normal is 0: return None",
                )));
        }
    }
    let lit = shadow(Vec3::ZERO, Vec3::Y, Vec3::Y, 5.0, 1e-6);
    let dark = ShadowQuery { light: LightSample { radiance: Vec3::ZERO, ..lit.light }, ..lit };
    match trial.kit.shadow_ray(&[dark])[0] {
        None => Ok(()),
        Some(_) => Err(Broken::with_texts(dark.call("shadow_ray"), "a ray", "None", "the definition")
            .looks_like(Some("you trace a ray to a light of radiance 0, which adds nothing: return None"))),
    }
}
