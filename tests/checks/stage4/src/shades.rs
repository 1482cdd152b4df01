//! The whole Phong model: the ambient term, and per light the diffuse and the specular term.

use super::terms::{cos_phi, specular};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{point, unit};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use glam::{DVec3, Vec3, vec3};
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
            // The viewer is on the side of the normal.
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

fn term(query: &ShadeQuery, index: usize) -> TermQuery {
    TermQuery {
        normal: query.surface.shading_normal,
        to_light: query.lights[index].direction,
        to_viewer: query.to_viewer,
        exponent: query.material.exponent,
    }
}

/// The diffuse and the specular contribution of light `index` in double precision, without shadows.
fn shares(query: &ShadeQuery, index: usize) -> [DVec3; 2] {
    let light = &query.lights[index];
    let diffuse = query.surface.shading_normal.as_dvec3().dot(light.direction.as_dvec3()).max(0.0);
    let radiance = light.radiance.as_dvec3();
    let Material { diffuse: kd, specular: ks, .. } = &query.material;
    [radiance * kd.as_dvec3() * diffuse, radiance * ks.as_dvec3() * specular(&term(query, index))]
}

/// Whether light `index` is at the horizon, or the viewer is at right angles to the reflected light. There rounding
/// decides whether the light counts, and with exponent 0 the difference is large.
fn is_on_edge(query: &ShadeQuery, index: usize) -> bool {
    let term = term(query, index);
    term.normal.dot(term.to_light).abs() < 1e-5 || cos_phi(&term).abs() < 1e-5
}

/// The greatest allowed difference of a channel from `right`.
fn tolerance(right: DVec3) -> f64 {
    1e-4 * (1.0 + right.abs().max_element())
}

/// The contribution of light `index` in double precision, without shadows.
fn share(query: &ShadeQuery, index: usize) -> DVec3 {
    shares(query, index).into_iter().sum()
}

fn expected_color(query: &ShadeQuery, counts: impl Fn(usize) -> bool) -> DVec3 {
    let ambient = query.ambient.as_dvec3() * query.material.ambient.as_dvec3();
    (0..query.lights.len()).filter(|&light| counts(light)).map(|light| share(query, light)).sum::<DVec3>()
        + ambient
}

pub(super) fn judge_shades(trial: &Trial<'_>, queries: &[ShadeQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.shade(queries), |query, yours| {
        let color = yours.color.as_dvec3();
        let expected = expected_color(query, |light| query.visible[light]);
        let same = |other: DVec3| (color - other).abs().max_element() < tolerance(other);
        if (0..query.lights.len()).any(|light| is_on_edge(query, light)) || same(expected) {
            return Ok(());
        }
        let diagnosis = shade_diagnosis(query, color, expected, same);
        Err(Broken::new(
            query.call("shade"),
            yours.color,
            expected.as_vec3(),
            "the formula in double precision",
        )
        .looks_like(known(diagnosis)))
    })
}

/// The mistake that gives this colour.
fn shade_diagnosis(
    query: &ShadeQuery,
    color: DVec3,
    expected: DVec3,
    same: impl Fn(DVec3) -> bool,
) -> &'static str {
    let ambient = query.ambient.as_dvec3() * query.material.ambient.as_dvec3();
    let kd = query.material.diffuse.as_dvec3();
    let visible: Vec<usize> = (0..query.lights.len()).filter(|&light| query.visible[light]).collect();
    let only = |part: usize| visible.iter().map(|&light| shares(query, light)[part]).sum::<DVec3>() + ambient;
    let white = ShadeQuery {
        lights: query.lights.iter().map(|light| LightSample { radiance: Vec3::ONE, ..*light }).collect(),
        ..query.clone()
    };
    let one = |light: Option<&usize>| light.is_some_and(|&light| same(share(query, light) + ambient));
    match () {
        () if color.is_nan() => "your colour is NaN: is a negative cosine raised to a fractional power?",
        () if same(expected - ambient) => "the ambient term A·ka is missing",
        () if visible.len() < query.lights.len() && same(expected_color(query, |_| true)) => {
            "you add lights that are occluded: multiply by V_i"
        }
        () if visible.len() < query.lights.len()
            && same(expected_color(query, |light| !query.visible[light])) =>
        {
            "you add the occluded lights and leave out the visible ones"
        }
        () if same(expected.min(DVec3::ONE)) => "you clamp the colour to 1: return it without a clamp",
        () if same(only(1)) => "the diffuse term is missing",
        () if same(only(0)) => "the specular term is missing",
        () if one(visible.first()) || one(visible.last()) => {
            "you count one light, the first or the last: add up all lights"
        }
        () if same(expected_color(&white, |light| query.visible[light])) => {
            "you leave out the radiance of the light"
        }
        () if same(ambient + (expected - ambient) * kd) => "you multiply the light by kd twice",
        () if same(expected + (query.lights.len().max(1) - 1) as f64 * ambient) => {
            "you add the ambient term once per light: add it once"
        }
        () if query.visible.contains(&true) && color.cmpge(expected - 1e-4).all() => {
            "your colour is too bright: is the cosine missing, or do you add a light behind the surface?"
        }
        () => "",
    }
}

/// A surface with two lights for which every known mistake gives a different colour.
fn drawn(brightness: f32, visible: [bool; 2]) -> ShadeQuery {
    let light = |direction: Vec3, radiance: Vec3| LightSample { direction, distance: 2.0, radiance };
    let material = Material {
        ambient: vec3(0.5, 0.25, 0.5),
        diffuse: vec3(0.5, 0.25, 0.75),
        specular: vec3(0.25, 0.5, 0.125),
        exponent: 4.0,
        ..Material::default()
    };
    ShadeQuery {
        surface: Surface {
            point: Vec3::ZERO,
            error: Vec3::splat(1e-7),
            geometric_normal: Vec3::Y,
            shading_normal: Vec3::Y,
        },
        to_viewer: vec3(0.28, 0.96, 0.0),
        material,
        ambient: vec3(0.2, 0.4, 0.6),
        lights: vec![
            light(vec3(-0.6, 0.8, 0.0), brightness * vec3(0.5, 0.25, 0.75)),
            light(vec3(0.0, 0.8, 0.6), brightness * vec3(0.25, 0.5, 0.125)),
        ],
        visible: visible.to_vec(),
    }
}

pub(super) fn shade_adds_up_the_lights(trial: &Trial<'_>) -> CheckResult {
    let drawn = [drawn(1.0, [true; 2]), drawn(8.0, [true; 2])];
    judge_shades(trial, &drawn).into_iter().collect::<CheckResult>()?;
    let all_visible =
        shade_query().prop_map(|query| ShadeQuery { visible: vec![true; query.lights.len()], ..query });
    trial.forall(2000, all_visible, |queries| judge_shades(trial, queries))
}

pub(super) fn shade_leaves_out_what_is_hidden(trial: &Trial<'_>) -> CheckResult {
    judge_shades(trial, &[drawn(1.0, [true, false])]).into_iter().collect::<CheckResult>()?;
    trial.forall(2000, shade_query(), |queries| judge_shades(trial, queries))
}

pub(super) fn shade_traces_at_most_one_ray_per_light(trial: &Trial<'_>) -> CheckResult {
    // Every fourth surface is black.
    let queries = (shade_query(), 0..4i32).prop_map(|(mut query, which)| {
        if which == 0 {
            (query.material.diffuse, query.material.specular) = (Vec3::ZERO, Vec3::ZERO);
        }
        query
    });
    trial.forall(2000, queries, |queries| {
        compare(queries, trial.kit.shade(queries), |query, yours| {
            // A light needs a ray if its contribution is above the tolerance of colours, because a cosine to the power
            // of 32 may be 0 in single precision.
            let cosine = |light: usize| query.lights[light].direction.dot(query.surface.shading_normal);
            let shows = |light: usize| share(query, light).max_element() > tolerance(DVec3::ZERO);
            let needed: Vec<usize> =
                (0..query.lights.len()).filter(|&light| !is_on_edge(query, light) && shows(light)).collect();
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
                () if twice => "you trace two rays to one light: trace one and keep the answer",
                () if vain => "you trace a ray to a light that is behind the surface or switched off",
                () if black => "you trace a ray from a black surface: every light adds 0 there",
                () if missed => "you count a light without asking whether it is visible",
                () => return Ok(()),
            };
            let describe = |lights: &[usize]| format!("shadow rays to lights {lights:?}");
            Err(Broken::with_texts(query.call("shade"), describe(&traced), describe(&needed), "counted")
                .looks_like(Some(diagnosis)))
        })
    })
}
