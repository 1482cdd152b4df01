//! The whole illumination.

use super::terms::specular;
use crate::Trial;
use crate::broken::{Broken, Outcome};
use crate::generate::{point, unit};
use crate::judge::{compare, known};
use crate::paste::Arguments;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use raykata::kit::{LightSample, ShadeQuery, Surface, TermQuery};
use raykata::material::Material;

pub(super) fn light() -> impl Strategy<Value = LightSample> + Clone {
    (unit(), 1..=40i32, point(1)).prop_map(|(direction, distance, color)| LightSample {
        direction,
        distance: distance as f32 / 4.0,
        radiance: 2.0 * color.abs(),
    })
}

pub(super) fn shade_query() -> impl Strategy<Value = ShadeQuery> + Clone {
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
pub(super) fn share(query: &ShadeQuery, index: usize) -> DVec3 {
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

pub(super) fn expected_color(query: &ShadeQuery, counts: impl Fn(usize) -> bool) -> DVec3 {
    let ambient = query.ambient.as_dvec3() * query.material.ambient.as_dvec3();
    (0..query.lights.len()).filter(|&light| counts(light)).map(|light| share(query, light)).sum::<DVec3>()
        + ambient
}

pub(super) fn judge_shades(trial: &Trial<'_>, queries: &[ShadeQuery]) -> Vec<Outcome> {
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
        Err(Broken::new(
            query.call("shade"),
            yours.color,
            expected.as_vec3(),
            "the formula in double precision",
        )
        .looks_like(known(diagnosis)))
    })
}

pub(super) fn shade_adds_up_the_lights(trial: &Trial<'_>) -> Outcome {
    let all_visible =
        shade_query().prop_map(|query| ShadeQuery { visible: vec![true; query.lights.len()], ..query });
    trial.forall(2000, all_visible, |queries| judge_shades(trial, queries))
}

pub(super) fn shade_leaves_out_what_is_hidden(trial: &Trial<'_>) -> Outcome {
    trial.forall(2000, shade_query(), |queries| judge_shades(trial, queries))
}

pub(super) fn shade_traces_one_ray_a_light_at_most(trial: &Trial<'_>) -> Outcome {
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
            Err(Broken::told(query.call("shade"), told(&traced), told(&needed), "counted")
                .looks_like(Some(diagnosis)))
        })
    })
}
