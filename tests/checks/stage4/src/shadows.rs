//! Shadow rays.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::generate::{magnitude, point, rough_point, unit};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{LightSample, ShadowQuery, Surface};

/// A point on a surface and a light at `distance` towards `direction`.
pub(super) fn shadow(point: Vec3, normal: Vec3, direction: Vec3, distance: f32, error: f32) -> ShadowQuery {
    let surface =
        Surface { point, error: Vec3::splat(error), geometric_normal: normal, shading_normal: normal };
    ShadowQuery { surface, light: LightSample { direction, distance, radiance: Vec3::ONE } }
}

/// Points at coordinates of this size, on surfaces in any position, with lights well above the horizon.
pub(super) fn lit(sizes: std::ops::Range<f32>) -> impl Strategy<Value = ShadowQuery> + Clone {
    (unit(), unit(), rough_point(1.0), magnitude(sizes.start, sizes.end), 1..=64i32).prop_map(
        |(normal, lean, at, size, distance)| {
            let direction = (normal + 0.8 * lean).normalize();
            // Seven roundings of each coordinate, as for a point of a triangle of this size.
            shadow(size * at, normal, direction, size * distance as f32 / 4.0, 4e-7 * size)
        },
    )
}

pub(super) fn judge_shadow_rays(
    trial: &Trial<'_>,
    queries: &[ShadowQuery],
    law: impl Fn(&ShadowQuery, &raykata::ray::Ray) -> Option<(String, String, &'static str)>,
) -> Vec<Outcome> {
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

pub(super) fn shadow_ray_reaches_just_short_of_the_light(trial: &Trial<'_>) -> Outcome {
    trial.forall(1000, lit(-1.0..2.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let light = &query.light;
            let length = ray.direction.length();
            if (ray.direction / length - light.direction).length() > 1e-4 {
                return Some((
                    format!("direction {}", ray.direction),
                    format!("direction {}", light.direction),
                    if (ray.direction / length + light.direction).length() < 1e-4 {
                        "the ray goes away from the light"
                    } else {
                        ""
                    },
                ));
            }
            let reach = ray.t_max * length;
            let describe = || (format!("ends after {reach}"), format!("just below {}", light.distance));
            // L2: a light that is a surface of the scene must not shadow itself; what stands near it must.
            match () {
                () if (length - 1.0).abs() > 1e-3 && reach > light.distance && ray.t_max <= light.distance => Some((
                    describe().0,
                    describe().1,
                    "t counts lengths of the direction: if it is as long as the way, the light is at t = 1",
                )),
                () if reach == f32::INFINITY => Some((
                    describe().0,
                    describe().1,
                    "the ray goes on behind the light, where nothing can shadow it: set t_max",
                )),
                () if !(reach < light.distance) => Some((
                    describe().0,
                    describe().1,
                    "the ray reaches the light, which would shadow itself: end a little before it",
                )),
                () if reach < 0.99 * light.distance => Some((
                    describe().0,
                    describe().1,
                    "the ray ends too early: what stands before the light is not seen",
                )),
                () => None,
            }
        })
    })?;
    let sun = shadow(Vec3::ZERO, Vec3::Y, vec3(0.6, 0.8, 0.0), f32::INFINITY, 1e-7);
    judge_shadow_rays(trial, &[sun], |_, ray| {
        (ray.t_max != f32::INFINITY).then(|| {
            (format!("t_max = {}", ray.t_max), "t_max = inf".into(), "the sun is endlessly far away")
        })
    })
    .into_iter()
    .collect()
}

/// How far above the point, along the normal, the ray begins to count: `(height, bound on the point's error)`.
pub(super) fn start_height(query: &ShadowQuery, ray: &raykata::ray::Ray) -> (f64, f64) {
    let normal = query.surface.geometric_normal.as_dvec3();
    let start = ray.origin.as_dvec3() + f64::from(ray.t_min) * ray.direction.as_dvec3();
    ((start - query.surface.point.as_dvec3()).dot(normal), query.surface.error.as_dvec3().dot(normal.abs()))
}

/// Whether the start has moved towards the light, and not along the normal.
fn goes_along_the_light(query: &ShadowQuery, ray: &raykata::ray::Ray) -> bool {
    let moved = (ray.origin - query.surface.point).normalize_or_zero();
    let (normal, to_light) = (query.surface.geometric_normal, query.light.direction);
    moved.dot(to_light) > 0.99 && moved.dot(normal) < 0.9
}

pub(super) fn shadow_ray_leaves_its_own_surface_at_any_scale(trial: &Trial<'_>) -> Outcome {
    // R6: the true surface is up to `error` above the point. Sizes from a thousandth to a hundred thousand.
    trial.forall(3000, lit(-3.0..5.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let (height, bound) = start_height(query, ray);
            let diagnosis = match () {
                () if height == 0.0 => {
                    "the ray starts on the surface itself, and hits it in half of all cases"
                }
                () if height < 0.0 => "the ray starts below the surface",
                () if goes_along_the_light(query, ray) => {
                    "the offset goes along the ray, which may be nearly along the surface: go along the normal"
                }
                () => "a fixed offset is too small here: move by the error of the point, error · |n|",
            };
            // A hundredth for the rounding of the bound itself.
            (height < 0.99 * bound).then(|| {
                (format!("starts {height:.3e} above the point"), format!("{bound:.3e} or more"), diagnosis)
            })
        })
    })
}

pub(super) fn shadow_ray_sees_what_is_close(trial: &Trial<'_>) -> Outcome {
    trial.forall(3000, lit(-3.0..5.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let (height, bound) = start_height(query, ray);
            // 64 steps of the largest coordinate: anything farther away than that must be seen.
            let size = f64::from(query.surface.point.abs().max_element());
            let most = 64.0 * 2.0 * checks::double::U * size + 4.0 * bound;
            (height > most).then(|| {
                (
                    format!("starts {height:.3e} above the point"),
                    format!("at most {most:.3e}"),
                    "a fixed offset is too large here: what touches the surface casts no shadow on it",
                )
            })
        })
    })
}

pub(super) fn shadow_ray_is_not_traced_in_vain(trial: &Trial<'_>) -> Outcome {
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
                "the light is behind the surface: no ray is needed to know that it adds nothing",
            ))),
        })
    })?;
    // Exactly along the surface, or along the interpolated one, light adds nothing either.
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
                    "the light shines exactly along the surface: its cosine is 0, so it adds nothing",
                )));
        }
    }
    let lit = shadow(Vec3::ZERO, Vec3::Y, Vec3::Y, 5.0, 1e-6);
    let dark = ShadowQuery { light: LightSample { radiance: Vec3::ZERO, ..lit.light }, ..lit };
    match trial.kit.shadow_ray(&[dark])[0] {
        None => Ok(()),
        Some(_) => Err(Broken::with_texts(dark.call("shadow_ray"), "a ray", "None", "the definition")
            .looks_like(Some("a light that is switched off needs no ray"))),
    }
}
