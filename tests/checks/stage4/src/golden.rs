//! A table and a picture that are compared with stored references.

use checks::broken::CheckResult;
use checks::{Trial, golden, picture};
use glam::{Vec3, vec3};
use raykata::kit::{LightSample, ShadeQuery, Surface};
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

pub(super) fn shading_table(trial: &Trial<'_>) -> CheckResult {
    let queries: Vec<ShadeQuery> = (0..24)
        .map(|i| {
            let (azimuth, height) = ((i % 8) as f32 * 0.785, 0.8 - (i / 8) as f32 * 0.7);
            let flat = (1.0 - height * height).sqrt();
            let normal = vec3(flat * azimuth.cos(), height, flat * azimuth.sin());
            sphere_point(normal, (vec3(0.0, 1.0, 6.0) - normal).normalize())
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
    golden::compare("stage4_shading_table", "24 points of a sphere, two lights", &lines.join("\n"))
}

pub(super) fn picture_of_a_lit_sphere(trial: &Trial<'_>) -> CheckResult {
    let rays = picture::rays(trial, vec3(0.0, 1.0, 3.2), Vec3::ZERO);
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
        .map(|(ray, point)| sphere_point(point.unwrap_or(Vec3::Y), -ray.direction))
        .collect();
    let colors = trial.kit.shade(&queries).into_iter().zip(points);
    let colors = colors.map(|(answer, point)| if point.is_some() { answer.color } else { Vec3::ZERO });
    // The points are given, so pixels may differ only where a light is exactly at the horizon: a few of 4800.
    picture::compare(trial, "stage4_lit_sphere", &picture::film_of(colors.collect()), &rays, 0.001)
}
