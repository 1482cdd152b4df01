//! A table and a picture that are compared with stored references.

use checks::golden::Table;
use checks::picture::{self, Composed, LARGE};
use checks::prelude::*;
use raykata::material::Material;

pub(super) fn lights(at: Vec3) -> Vec<LightSample> {
    let light = |position: Vec3, radiance: Vec3| {
        let to_light = position - at;
        LightSample { direction: to_light.normalize(), distance: to_light.length(), radiance }
    };
    vec![light(vec3(4.0, 5.0, 3.0), vec3(0.9, 0.8, 0.7)), light(vec3(-5.0, 2.0, 4.0), vec3(0.1, 0.2, 0.5))]
}

/// A point of the unit sphere at the origin, lit by two lights. The second light is occluded at the lower left.
pub(super) fn sphere_point(normal: Vec3, to_viewer: Vec3) -> ShadeQuery {
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
    ShadeQuery { surface, to_viewer, material, ambient: Vec3::splat(0.15), lights: lights(normal), visible }
}

/// The material and the ambient light of [`sphere_point`], and others for a hidden seed.
fn varied(trial: &Trial<'_>, query: ShadeQuery) -> ShadeQuery {
    let color = || (0.05..0.95f32, 0.05..0.95f32, 0.05..0.95f32).prop_map(Vec3::from);
    let public = (query.material.diffuse, query.material.specular, query.material.exponent, query.ambient);
    let hidden = (color(), color(), 5.0..40f32, color().prop_map(|color| 0.3 * color));
    let (diffuse, specular, exponent, ambient) = trial.composed(public, hidden);
    let material = Material { ambient: diffuse, diffuse, specular, exponent, ..query.material };
    ShadeQuery { material, ambient, ..query }
}

pub(super) fn shading_table(trial: &Trial<'_>) -> CheckResult {
    let queries: Vec<ShadeQuery> = (0..24)
        .map(|i| {
            let (azimuth, height) = ((i % 8) as f32 * 0.785, 0.8 - (i / 8) as f32 * 0.7);
            let flat = (1.0 - height * height).sqrt();
            let normal = vec3(flat * azimuth.cos(), height, flat * azimuth.sin());
            varied(trial, sphere_point(normal, (vec3(0.0, 1.0, 6.0) - normal).normalize()))
        })
        .collect();
    let lines = |kit: &dyn Kit| {
        let line = |(query, answer): (&ShadeQuery, ShadeAnswer)| {
            let n = query.surface.point;
            let mut traced = answer.traced;
            traced.sort_unstable();
            format!(
                "shade ({:.2} {:.2} {:.2})  {:.3} {:.3} {:.3}  rays to {traced:?}",
                n.x, n.y, n.z, answer.color.x, answer.color.y, answer.color.z
            )
        };
        queries.iter().zip(kit.shade(&queries)).map(line).collect::<Vec<String>>().join("\n")
    };
    let input = "24 points of a sphere, two lights";
    Table { name: "stage4_shading_table", input }.check(trial, lines)
}

pub(super) fn picture_of_a_lit_sphere(trial: &Trial<'_>) -> CheckResult {
    let rays = picture::rays(trial, LARGE, vec3(0.0, 1.0, 3.2), Vec3::ZERO);
    let points: Vec<Option<Vec3>> = rays
        .iter()
        .map(|ray| {
            let along = -ray.origin.dot(ray.direction);
            let aside = ray.origin + along * ray.direction;
            let inside = 1.0 - aside.length_squared();
            (inside > 0.0).then(|| (aside - inside.sqrt() * ray.direction).normalize())
        })
        .collect();
    let queries: Vec<ShadeQuery> = rays
        .iter()
        .zip(&points)
        .map(|(ray, point)| varied(trial, sphere_point(point.unwrap_or(Vec3::Y), -ray.direction)))
        .collect();
    let colors = |kit: &dyn Kit| {
        let color = |(answer, point): (ShadeAnswer, &Option<Vec3>)| match point {
            Some(_) => answer.color,
            None => Vec3::ZERO,
        };
        kit.shade(&queries).into_iter().zip(&points).map(color).collect()
    };
    // The points are given, so pixels may differ only where a light is exactly at the horizon: a few of 4800.
    let composed = Composed { name: "stage4_lit_sphere", size: LARGE, rays: &rays, may_differ: 0.001 };
    composed.check(trial, colors)
}
