//! Stage 4: light and shade.

use crate::broken::{Broken, Outcome};
use crate::generate::{magnitude, point, rough_point, unit};
use crate::paste::{Paste, call};
use crate::stage1::{compare, known};
use crate::{Trial, checks, golden, picture};
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{LightSample, ShadeQuery, ShadowQuery, Surface, TermQuery};
use raykata::material::Material;

checks! { ($) 4 stage4 [
    shading_normal_faces_the_viewer
    shading_normal_falls_back_to_flat
    diffuse_term_is_the_cosine
    specular_term_is_the_mirrored_cosine
    light_from_behind_adds_nothing
    shadow_ray_reaches_just_short_of_the_light
    shadow_ray_leaves_its_own_surface_at_any_scale
    shadow_ray_sees_what_is_close
    shadow_ray_is_not_traced_in_vain
    shade_adds_up_the_lights
    shade_leaves_out_what_is_hidden
    shade_traces_one_ray_a_light_at_most
    gamma_is_two
    gamma_survives_nonsense
    shading_table
    picture_of_a_lit_ball
] }

// ---- normals ----

fn paste_normal_query((geometric, interpolated, dir): &(Vec3, Option<Vec3>, Vec3)) -> String {
    let interpolated = interpolated.map_or("None".into(), |n| format!("Some({})", n.paste()));
    format!("shading_normal({}, {interpolated}, {})", geometric.paste(), dir.paste())
}

fn shading_normal_faces_the_viewer(trial: &Trial<'_>) -> Outcome {
    // Smooth normals lean up to a third of the way from the geometric one, and may be of any length and either sign.
    let inputs = (unit(), unit(), unit(), any::<bool>(), any::<bool>(), 1..=8i32).prop_map(
        |(geometric, lean, dir, smooth, back, length)| {
            let bent = (geometric + 0.3 * lean) * length as f32 / 4.0;
            (geometric, smooth.then_some(if back { -bent } else { bent }), dir)
        },
    );
    trial.forall(2000, inputs, |queries| {
        compare(queries, trial.kit.shading_normal(queries), |query, yours| {
            let (geometric, interpolated, dir) = *query;
            let facing = if geometric.dot(dir) > 0.0 { -geometric } else { geometric };
            let expected = match interpolated.map(Vec3::normalize) {
                Some(smooth) if smooth.dot(facing) < 0.0 => -smooth,
                Some(smooth) => smooth,
                None => facing,
            };
            let grazing = geometric.dot(dir).abs() < 1e-6;
            let same = |n: Vec3| (yours - n).length() < 1e-5;
            if same(expected) || (grazing && same(-expected)) {
                return Ok(());
            }
            let diagnosis = match () {
                () if same(-expected) => "the normal points away from the viewer",
                () if (yours.normalize_or_zero() - expected).length() < 1e-4 => {
                    "an interpolated normal is shorter than 1: normalise it"
                }
                () if interpolated.is_some() && same(facing) => {
                    "the flat normal, though the surface is smooth"
                }
                () => "",
            };
            Err(Broken::new(paste_normal_query(query), yours, expected, "closed form")
                .looks_like(known(diagnosis)))
        })
    })
}

fn shading_normal_falls_back_to_flat(trial: &Trial<'_>) -> Outcome {
    let queries = [Vec3::ZERO, Vec3::NAN].map(|useless| (Vec3::Y, Some(useless), Vec3::Y));
    for (query, yours) in queries.iter().zip(trial.kit.shading_normal(&queries)) {
        if yours != Vec3::NEG_Y {
            let broken = Broken::new(
                paste_normal_query(query),
                yours,
                Vec3::NEG_Y,
                "the flat normal, facing the viewer",
            );
            return Err(broken
                .looks_like(Some("an average of zero has no direction: fall back to the geometric normal")));
        }
    }
    Ok(())
}

// ---- terms ----

fn terms() -> impl Strategy<Value = TermQuery> + Clone {
    (unit(), unit(), unit(), 0..=64i32, any::<bool>()).prop_map(
        |(normal, to_light, to_viewer, exponent, aim)| {
            // Half of the viewers stand near the mirrored light, or there would be no highlight to judge.
            let mirrored = 2.0 * normal.dot(to_light) * normal - to_light;
            let to_viewer = if aim { (mirrored + 0.3 * to_viewer).normalize() } else { to_viewer };
            TermQuery { normal, to_light, to_viewer, exponent: exponent as f32 / 2.0 }
        },
    )
}

fn paste_term(name: &str, query: &TermQuery) -> String {
    match name {
        "diffuse_term" => call(name, &[&query.normal, &query.to_light]),
        _ => call(name, &[&query.normal, &query.to_light, &query.to_viewer, &query.exponent]),
    }
}

fn diffuse_term_is_the_cosine(trial: &Trial<'_>) -> Outcome {
    trial.forall(2000, terms(), |queries| {
        compare(queries, trial.kit.diffuse_term(queries), |query, yours| {
            let cosine = query.normal.as_dvec3().dot(query.to_light.as_dvec3());
            let expected = cosine.max(0.0) as f32;
            let diagnosis = match () {
                () if (f64::from(yours) - cosine).abs() < 1e-6 => {
                    "a light behind the surface adds nothing; it must not subtract: clamp at 0"
                }
                () if (f64::from(yours) - cosine.abs()).abs() < 1e-6 => {
                    "a light behind the surface lights it: clamp at 0, do not take the absolute value"
                }
                () if yours == 1.0 => "the cosine is missing",
                () => "",
            };
            let input = paste_term("diffuse_term", query);
            // Three products and two sums of numbers up to 1.
            if (yours - expected).abs() < 1e-6 {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}

/// `cosⁿ φ` in double precision.
fn specular(query: &TermQuery) -> f64 {
    let [n, l, v] = [query.normal, query.to_light, query.to_viewer].map(Vec3::as_dvec3);
    let cos_theta = n.dot(l);
    let cos_phi = (2.0 * cos_theta * n - l).dot(v);
    if cos_theta > 0.0 && cos_phi > 0.0 { cos_phi.powf(f64::from(query.exponent)) } else { 0.0 }
}

fn specular_term_is_the_mirrored_cosine(trial: &Trial<'_>) -> Outcome {
    trial.forall(3000, terms(), |queries| {
        compare(queries, trial.kit.specular_term(queries), |query, yours| {
            let [n, l, v] = [query.normal, query.to_light, query.to_viewer].map(Vec3::as_dvec3);
            let exponent = f64::from(query.exponent);
            let expected = specular(query);
            // A cosine near 0 decides between 0 and 1 for exponent 0.
            let edge = n.dot(l).abs() < 1e-5 || (2.0 * n.dot(l) * n - l).dot(v).abs() < 1e-5;
            // The cosine is off by a few roundings, and the power makes n times as much of that.
            if edge || (f64::from(yours) - expected).abs() < 1e-6 * (1.0 + exponent) {
                return Ok(());
            }
            let near = |value: f64| (f64::from(yours) - value).abs() < 1e-5 * (1.0 + exponent);
            let half = (l + v).normalize().dot(n).max(0.0);
            let diagnosis = match () {
                () if yours.is_nan() => "a negative cosine to a broken power is NaN: clamp it first",
                () if n.dot(l) <= 0.0 => "the light is behind the surface: no highlight",
                () if near(half.powf(exponent)) => {
                    "the half-vector form (Blinn); the notes mirror the light (Phong)"
                }
                () if near((-(l - 2.0 * n.dot(l) * n)).dot(-v).powf(exponent)) => {
                    "the mirrored direction points into the surface"
                }
                () if near(n.dot(l).max(0.0).powf(exponent)) => {
                    "φ is the angle between mirrored light and viewer, not θ"
                }
                () => "",
            };
            Err(Broken::new(paste_term("specular_term", query), yours, expected as f32, "closed form")
                .looks_like(known(diagnosis)))
        })
    })
}

fn light_from_behind_adds_nothing(trial: &Trial<'_>) -> Outcome {
    // L1: cos φ = -0.5 to an even power is positive, to a broken power NaN; and a light below the horizon.
    let below = vec3(0.6, -0.8, 0.0);
    let aside = vec3(0.8, 0.6, 0.0);
    let queries: Vec<TermQuery> = [0.0, 2.0, 2.5, 32.0]
        .into_iter()
        .flat_map(|exponent| {
            [
                TermQuery { normal: Vec3::Y, to_light: below, to_viewer: vec3(-0.6, 0.8, 0.0), exponent },
                TermQuery { normal: Vec3::Y, to_light: below, to_viewer: vec3(0.6, 0.8, 0.0), exponent },
                TermQuery { normal: Vec3::Y, to_light: aside, to_viewer: vec3(0.8, -0.6, 0.0), exponent },
                TermQuery { normal: Vec3::Y, to_light: aside, to_viewer: vec3(0.96, 0.28, 0.0), exponent },
            ]
        })
        .collect();
    for (query, yours) in queries.iter().zip(trial.kit.specular_term(&queries)) {
        if yours != 0.0 {
            let broken = Broken::new(paste_term("specular_term", query), yours, 0.0, "closed form");
            return Err(broken.looks_like(Some(
                "cos φ < 0, or the light is behind the surface: the highlight is 0, whatever the power",
            )));
        }
    }
    Ok(())
}

// ---- shadow rays ----

/// A point on a surface and a light at `distance` towards `direction`.
fn shadow(point: Vec3, normal: Vec3, direction: Vec3, distance: f32, error: f32) -> ShadowQuery {
    let surface =
        Surface { point, error: Vec3::splat(error), geometric_normal: normal, shading_normal: normal };
    ShadowQuery { surface, light: LightSample { direction, distance, radiance: Vec3::ONE } }
}

fn paste_shadow(query: &ShadowQuery) -> String {
    let ShadowQuery { surface, light } = query;
    format!(
        "shadow_ray from {} (error {}), normal {}\nto a light in direction {}, {:?} away, of radiance {}",
        surface.point.paste(),
        surface.error.paste(),
        surface.geometric_normal.paste(),
        light.direction.paste(),
        light.distance,
        light.radiance.paste()
    )
}

/// Points at coordinates of this size, on surfaces in any position, with lights well above the horizon.
fn lit(sizes: std::ops::Range<f32>) -> impl Strategy<Value = ShadowQuery> + Clone {
    (unit(), unit(), rough_point(1.0), magnitude(sizes.start, sizes.end), 1..=64i32).prop_map(
        |(normal, lean, at, size, distance)| {
            let direction = (normal + 0.8 * lean).normalize();
            // Seven roundings of each coordinate, as for a point of a triangle of this size.
            shadow(size * at, normal, direction, size * distance as f32 / 4.0, 4e-7 * size)
        },
    )
}

fn judge_shadow_rays(
    trial: &Trial<'_>,
    queries: &[ShadowQuery],
    law: impl Fn(&ShadowQuery, &raykata::ray::Ray) -> Option<(String, String, &'static str)>,
) -> Vec<Outcome> {
    compare(queries, trial.kit.shadow_ray(queries), |query, yours| match yours {
        None => Err(Broken::told(
            paste_shadow(query),
            "None",
            "a ray: the light is in front of the surface",
            "the definition",
        )),
        Some(ray) => match law(query, &ray) {
            None => Ok(()),
            Some((yours, expected, diagnosis)) => {
                Err(Broken::told(paste_shadow(query), yours, expected, "closed form")
                    .looks_like(known(diagnosis)))
            }
        },
    })
}

fn shadow_ray_reaches_just_short_of_the_light(trial: &Trial<'_>) -> Outcome {
    trial.forall(1000, lit(-1.0..2.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let light = &query.light;
            let length = ray.dir.length();
            if (ray.dir / length - light.direction).length() > 1e-4 {
                return Some((
                    format!("direction {}", ray.dir),
                    format!("direction {}", light.direction),
                    if (ray.dir / length + light.direction).length() < 1e-4 {
                        "the ray goes away from the light"
                    } else {
                        ""
                    },
                ));
            }
            let reach = ray.t_max * length;
            let told = || (format!("ends after {reach}"), format!("just below {}", light.distance));
            // L2: a lamp that is a surface of the scene must not shadow itself; what stands near it must.
            match () {
                () if reach == f32::INFINITY => Some((
                    told().0,
                    told().1,
                    "the ray goes on behind the light, where nothing can shadow it: set t_max",
                )),
                () if !(reach < light.distance) => Some((
                    told().0,
                    told().1,
                    "the ray reaches the lamp, which would shadow itself: end a little before it",
                )),
                () if reach < 0.99 * light.distance => Some((
                    told().0,
                    told().1,
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
fn start_height(query: &ShadowQuery, ray: &raykata::ray::Ray) -> (f64, f64) {
    let normal = query.surface.geometric_normal.as_dvec3();
    let start = ray.origin.as_dvec3() + f64::from(ray.t_min) * ray.dir.as_dvec3();
    ((start - query.surface.point.as_dvec3()).dot(normal), query.surface.error.as_dvec3().dot(normal.abs()))
}

fn shadow_ray_leaves_its_own_surface_at_any_scale(trial: &Trial<'_>) -> Outcome {
    // R6: the true surface is up to `error` above the point. Sizes from a thousandth to a hundred thousand.
    trial.forall(3000, lit(-3.0..5.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let (height, bound) = start_height(query, ray);
            let diagnosis = match () {
                () if height == 0.0 => {
                    "the ray starts on the surface itself, and hits it in half of all cases"
                }
                () if height < 0.0 => "the ray starts below the surface",
                () => "a fixed offset is too small here: move by the error of the point, error · |n|",
            };
            // A hundredth for the rounding of the bound itself.
            (height < 0.99 * bound).then(|| {
                (format!("starts {height:.3e} above the point"), format!("{bound:.3e} or more"), diagnosis)
            })
        })
    })
}

fn shadow_ray_sees_what_is_close(trial: &Trial<'_>) -> Outcome {
    trial.forall(3000, lit(-3.0..5.0), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let (height, bound) = start_height(query, ray);
            // 64 steps of the largest coordinate: anything farther away than that must be seen.
            let size = f64::from(query.surface.point.abs().max_element());
            let most = 64.0 * 2.0 * crate::double::U * size + 4.0 * bound;
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

fn shadow_ray_is_not_traced_in_vain(trial: &Trial<'_>) -> Outcome {
    let behind = (unit(), unit(), point(4)).prop_filter_map("a light behind", |(normal, to_light, at)| {
        (normal.dot(to_light) < -1e-3).then(|| shadow(at, normal, to_light, 5.0, 1e-6))
    });
    trial.forall(1000, behind, |queries| {
        compare(queries, trial.kit.shadow_ray(queries), |query, yours| match yours {
            None => Ok(()),
            Some(ray) => Err(Broken::told(
                paste_shadow(query),
                format!("a ray along {}", ray.dir),
                "None",
                "the definition",
            )
            .looks_like(Some(
                "the light is behind the surface: no ray is needed to know that it adds nothing",
            ))),
        })
    })?;
    let lit = shadow(Vec3::ZERO, Vec3::Y, Vec3::Y, 5.0, 1e-6);
    let dark = ShadowQuery { light: LightSample { radiance: Vec3::ZERO, ..lit.light }, ..lit };
    match trial.kit.shadow_ray(&[dark])[0] {
        None => Ok(()),
        Some(_) => Err(Broken::told(paste_shadow(&dark), "a ray", "None", "the definition")
            .looks_like(Some("a light that is switched off needs no ray"))),
    }
}

// ---- shading ----

fn light() -> impl Strategy<Value = LightSample> + Clone {
    (unit(), 1..=40i32, point(1)).prop_map(|(direction, distance, color)| LightSample {
        direction,
        distance: distance as f32 / 4.0,
        radiance: 2.0 * color.abs(),
    })
}

fn shade_query() -> impl Strategy<Value = ShadeQuery> + Clone {
    let colors = (point(1), point(1), point(1), point(1));
    let lights = prop::collection::vec((light(), any::<bool>()), 0..5);
    (unit(), unit(), colors, 0..=64i32, lights).prop_map(
        |(normal, to_viewer, (ambient, a, d, s), exponent, lights)| {
            // The viewer stands on the side of the normal.
            let to_viewer = if to_viewer.dot(normal) < 0.0 { -to_viewer } else { to_viewer };
            let material = Material {
                ambient: a.abs(),
                diffuse: d.abs(),
                specular: s.abs(),
                exponent: exponent as f32 / 2.0,
                ..Material::default()
            };
            let (lights, visible) = lights.into_iter().unzip();
            let surface = Surface {
                point: Vec3::ZERO,
                error: Vec3::splat(1e-7),
                geometric_normal: normal,
                shading_normal: normal,
            };
            ShadeQuery { surface, to_viewer, material, ambient: ambient.abs(), lights, visible }
        },
    )
}

/// The share of light `index` in double precision, shadows aside.
fn share(query: &ShadeQuery, index: usize) -> DVec3 {
    let light = &query.lights[index];
    let normal = query.surface.shading_normal;
    let diffuse = normal.as_dvec3().dot(light.direction.as_dvec3()).max(0.0);
    let term = TermQuery {
        normal,
        to_light: light.direction,
        to_viewer: query.to_viewer,
        exponent: query.material.exponent,
    };
    light.radiance.as_dvec3()
        * (query.material.diffuse.as_dvec3() * diffuse + query.material.specular.as_dvec3() * specular(&term))
}

fn expected_color(query: &ShadeQuery, counts: impl Fn(usize) -> bool) -> DVec3 {
    let ambient = query.ambient.as_dvec3() * query.material.ambient.as_dvec3();
    (0..query.lights.len()).filter(|&light| counts(light)).map(|light| share(query, light)).sum::<DVec3>()
        + ambient
}

fn describe(query: &ShadeQuery) -> String {
    let material = &query.material;
    let lights: Vec<String> = query
        .lights
        .iter()
        .zip(&query.visible)
        .map(|(light, visible)| {
            format!("{} from {}{}", light.radiance, light.direction, if *visible { "" } else { " (hidden)" })
        })
        .collect();
    format!(
        "n {} v {} ka {} kd {} ks {} n {} A {}\nlights: {}",
        query.surface.shading_normal,
        query.to_viewer,
        material.ambient,
        material.diffuse,
        material.specular,
        material.exponent,
        query.ambient,
        lights.join("; ")
    )
}

fn judge_shades(trial: &Trial<'_>, queries: &[ShadeQuery]) -> Vec<Outcome> {
    compare(queries, trial.kit.shade(queries), |query, yours| {
        let color = yours.color.as_dvec3();
        let expected = expected_color(query, |light| query.visible[light]);
        // Lights on the horizon may or may not count, and with exponent 0 that is not a small difference.
        let horizon =
            query.lights.iter().any(|light| light.direction.dot(query.surface.shading_normal).abs() < 1e-5);
        let same =
            |other: DVec3| (color - other).abs().max_element() < 1e-4 * (1.0 + other.abs().max_element());
        if horizon || same(expected) {
            return Ok(());
        }
        let ambient = query.ambient.as_dvec3() * query.material.ambient.as_dvec3();
        let diagnosis = match () {
            () if color.is_nan() => "NaN: a negative cosine to a broken power?",
            () if same(expected_color(query, |_| true)) => "hidden lights shine as well: multiply by V_i",
            () if same(expected - ambient) => "the ambient part is missing",
            () if same(expected_color(query, |light| !query.visible[light])) => {
                "visible and hidden are swapped"
            }
            () if same(ambient + (expected - ambient) * query.material.diffuse.as_dvec3()) => {
                "the light is multiplied by kd twice"
            }
            () if query.visible.contains(&true) && color.cmpge(expected - 1e-4).all() => {
                "too bright: is the cosine left out, or a light counted that is behind the surface?"
            }
            () => "",
        };
        Err(Broken::new(describe(query), yours.color, expected.as_vec3(), "the formula in double precision")
            .looks_like(known(diagnosis)))
    })
}

fn shade_adds_up_the_lights(trial: &Trial<'_>) -> Outcome {
    let all_visible =
        shade_query().prop_map(|query| ShadeQuery { visible: vec![true; query.lights.len()], ..query });
    trial.forall(2000, all_visible, |queries| judge_shades(trial, queries))
}

fn shade_leaves_out_what_is_hidden(trial: &Trial<'_>) -> Outcome {
    trial.forall(2000, shade_query(), |queries| judge_shades(trial, queries))
}

fn shade_traces_one_ray_a_light_at_most(trial: &Trial<'_>) -> Outcome {
    // Every fourth surface is black.
    let queries = (shade_query(), 0..4i32).prop_map(|(mut query, which)| {
        if which == 0 {
            (query.material.diffuse, query.material.specular) = (Vec3::ZERO, Vec3::ZERO);
        }
        query
    });
    trial.forall(2000, queries, |queries| {
        compare(queries, trial.kit.shade(queries), |query, yours| {
            // A light needs a ray if it is in front of the surface and has a share to give.
            let cosine = |light: usize| query.lights[light].direction.dot(query.surface.shading_normal);
            let needed: Vec<usize> = (0..query.lights.len())
                .filter(|&light| cosine(light) > 1e-5 && share(query, light) != DVec3::ZERO)
                .collect();
            let needless =
                |light: &usize| cosine(*light) < -1e-5 || query.lights[*light].radiance == Vec3::ZERO;
            let mut traced = yours.traced.clone();
            traced.sort_unstable();
            let twice = traced.windows(2).any(|pair| pair[0] == pair[1]);
            let vain = traced.iter().any(needless);
            let missed = needed.iter().any(|light| !traced.contains(light));
            let black = query.material.diffuse == Vec3::ZERO
                && query.material.specular == Vec3::ZERO
                && !traced.is_empty();
            let diagnosis = match () {
                () if twice => "two rays to one light: keep the answer",
                () if vain => "a ray to a light that is behind the surface or switched off",
                () if black => "the surface is black: no light changes that, so no ray is needed",
                () if missed => "a light is counted without asking whether it is visible",
                () => return Ok(()),
            };
            let told = |lights: &[usize]| format!("shadow rays to lights {lights:?}");
            Err(Broken::told(describe(query), told(&traced), told(&needed), "counted")
                .looks_like(Some(diagnosis)))
        })
    })
}

// ---- gamma ----

fn gamma_is_two(trial: &Trial<'_>) -> Outcome {
    let bytes: Vec<u8> = (0..=255).collect();
    let linear = trial.kit.decode_gamma(&bytes);
    for (&byte, &yours) in bytes.iter().zip(&linear) {
        let expected = (f64::from(byte) / 255.0).powi(2);
        if (f64::from(yours) - expected).abs() > 1e-6 {
            let diagnosis = match () {
                () if (f64::from(yours) - f64::from(byte) / 255.0).abs() < 1e-6 => "the square is missing",
                () if (f64::from(yours) - expected * 255.0 * 255.0).abs() < 1e-2 => "divide by 255 first",
                () => "",
            };
            return Err(Broken::new(
                format!("decode_gamma({byte})"),
                yours,
                expected as f32,
                "(byte / 255)²",
            )
            .looks_like(known(diagnosis)));
        }
    }
    let round_trip = trial.kit.encode_gamma(&linear);
    if let Some(byte) = (0..256).find(|&byte| usize::from(round_trip[byte]) != byte) {
        let broken = Broken::new(
            format!("encode_gamma(decode_gamma({byte}))"),
            round_trip[byte],
            byte as u8,
            "there and back",
        );
        return Err(broken.looks_like(Some(match round_trip[byte] as usize {
            below if below + 1 == byte => "rounded down: add one half before the cast",
            _ => "the root (and only one) of the linear value, times 255",
        })));
    }
    let between: Vec<f32> = (0..=1000).map(|i| i as f32 / 1000.0).collect();
    for (linear, yours) in between.iter().zip(trial.kit.encode_gamma(&between)) {
        let exact = 255.0 * f64::from(*linear).sqrt();
        if (f64::from(yours) - exact).abs() > 0.501 {
            let input = format!("encode_gamma({linear:?})");
            let down =
                (f64::from(yours) == exact.floor()).then_some("rounded down: add one half before the cast");
            return Err(
                Broken::new(input, yours, exact.round() as u8, "255 √linear, rounded").looks_like(down)
            );
        }
    }
    Ok(())
}

fn gamma_survives_nonsense(trial: &Trial<'_>) -> Outcome {
    let cases =
        [(-1e-8, 0), (-5.0, 0), (1.0000001, 255), (7.0, 255), (f32::INFINITY, 255), (f32::NEG_INFINITY, 0)];
    for ((linear, expected), yours) in cases.iter().zip(trial.kit.encode_gamma(&cases.map(|case| case.0))) {
        if yours != *expected {
            return Err(Broken::new(format!("encode_gamma({})", linear.paste()), yours, expected, "clamped")
                .looks_like(Some("clamp to 0..=1 before the root")));
        }
    }
    Ok(())
}

// ---- golden text and picture ----

fn lamps(at: Vec3) -> Vec<LightSample> {
    let lamp = |position: Vec3, radiance: Vec3| {
        let to_light = position - at;
        LightSample { direction: to_light.normalize(), distance: to_light.length(), radiance }
    };
    vec![lamp(vec3(4.0, 5.0, 3.0), vec3(0.9, 0.8, 0.7)), lamp(vec3(-5.0, 2.0, 4.0), vec3(0.1, 0.2, 0.5))]
}

/// A point of a unit ball at the origin, lit by two lamps, one of which a second ball hides from the lower left.
fn ball_point(normal: Vec3, to_viewer: Vec3) -> ShadeQuery {
    let surface =
        Surface { point: normal, error: Vec3::splat(4e-7), geometric_normal: normal, shading_normal: normal };
    let material = Material {
        ambient: vec3(0.8, 0.3, 0.2),
        diffuse: vec3(0.8, 0.3, 0.2),
        specular: Vec3::splat(0.5),
        exponent: 20.0,
        ..Material::default()
    };
    let visible = vec![true, normal.x + normal.y > -0.6];
    ShadeQuery { surface, to_viewer, material, ambient: Vec3::splat(0.15), lights: lamps(normal), visible }
}

fn shading_table(trial: &Trial<'_>) -> Outcome {
    let queries: Vec<ShadeQuery> = (0..24)
        .map(|i| {
            let (azimuth, height) = ((i % 8) as f32 * 0.785, 0.8 - (i / 8) as f32 * 0.7);
            let flat = (1.0 - height * height).sqrt();
            let normal = vec3(flat * azimuth.cos(), height, flat * azimuth.sin());
            ball_point(normal, (vec3(0.0, 1.0, 6.0) - normal).normalize())
        })
        .collect();
    let lines: Vec<String> = queries
        .iter()
        .zip(trial.kit.shade(&queries))
        .map(|(query, answer)| {
            let n = query.surface.point;
            let mut traced = answer.traced;
            traced.sort_unstable();
            format!(
                "({:.2} {:.2} {:.2})  {:.3} {:.3} {:.3}  rays to {traced:?}",
                n.x, n.y, n.z, answer.color.x, answer.color.y, answer.color.z
            )
        })
        .collect();
    golden::compare("stage4_shading_table", "24 points of a ball, two lamps", &lines.join("\n"))
}

fn picture_of_a_lit_ball(trial: &Trial<'_>) -> Outcome {
    let rays = picture::rays(vec3(0.0, 1.0, 3.2), Vec3::ZERO);
    let points: Vec<Option<Vec3>> = rays
        .iter()
        .map(|ray| {
            let along = -ray.origin.dot(ray.dir);
            let aside = ray.origin + along * ray.dir;
            let inside = 1.0 - aside.length_squared();
            (inside > 0.0).then(|| (aside - inside.sqrt() * ray.dir).normalize())
        })
        .collect();
    let queries: Vec<ShadeQuery> =
        rays.iter().zip(&points).map(|(ray, point)| ball_point(point.unwrap_or(Vec3::Y), -ray.dir)).collect();
    let colors = trial.kit.shade(&queries).into_iter().zip(points);
    let colors = colors.map(|(answer, point)| if point.is_some() { answer.color } else { Vec3::ZERO });
    // The points are given, so only light on the horizon may round either way: a few of 4800 pixels.
    picture::compare("stage4_lit_ball", &picture::develop(colors.collect()), 0.001)
}
