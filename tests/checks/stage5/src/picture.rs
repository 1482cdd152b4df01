//! The picture of stage 5.

use checks::picture::{self, Composed, LARGE};
use checks::prelude::*;
use raykata::material::{Fresnel, Material};

/// A sphere and its material.
#[derive(Clone, Debug)]
struct Sphere {
    center: Vec3,
    radius: f32,
    material: Material,
}

/// A ray on its way to a pixel.
struct Way {
    pixel: usize,
    ray: Ray,
    weight: Vec3,
    depth: u32,
}

const LIMITS: Limits = Limits { max_depth: 5, min_contribution: 0.004 };

/// The light of the sky: brighter towards the horizon, with a sun of soft rim.
fn sky(direction: Vec3) -> Vec3 {
    let sun = direction.dot(vec3(0.5, 0.7, 0.5).normalize()).max(0.0).powi(40);
    vec3(0.75, 0.8, 0.9).lerp(vec3(0.1, 0.25, 0.65), direction.y.clamp(0.0, 1.0).sqrt())
        + sun * vec3(0.6, 0.5, 0.2)
}

/// The light of the floor at a point: soft squares, darker under the spheres. It has no edges, so that rays with a small
/// rounding error see the same.
fn floor(point: Vec3, spheres: &[Sphere]) -> Vec3 {
    let squares = 0.5 + 0.5 * (3.0 * (2.7 * point.x).sin() * (2.7 * point.z).sin()).tanh();
    let shade: f32 = spheres
        .iter()
        .map(|sphere| 1.0 - 0.7 / (1.0 + 2.5 * (point - sphere.center).reject_from(Vec3::Y).length_squared()))
        .product();
    let far = (-0.12 * point.length()).exp();
    (shade * vec3(0.55, 0.12, 0.08).lerp(vec3(0.85, 0.8, 0.7), squares)).lerp(sky(Vec3::X), 1.0 - far)
}

/// The nearest sphere on the way of a ray, with the point that is hit.
fn nearest<'a>(ray: &Ray, spheres: &'a [Sphere]) -> Option<(f64, &'a Sphere)> {
    let hits = spheres.iter().filter_map(|sphere| {
        let (to_center, direction) = ((sphere.center - ray.origin).as_dvec3(), ray.direction.as_dvec3());
        let middle = to_center.dot(direction);
        let half =
            (f64::from(sphere.radius).powi(2) - (to_center - middle * direction).length_squared()).sqrt();
        [middle - half, middle + half].into_iter().find(|t| *t > f64::from(ray.t_min)).map(|t| (t, sphere))
    });
    hits.min_by(|(p, _), (q, _)| p.total_cmp(q))
}

/// Follows all rays of the picture, one level of their trees after the other.
fn colors(kit: &dyn Kit, rays: &[Ray], spheres: &[Sphere]) -> Vec<Vec3> {
    let mut pixels = vec![Vec3::ZERO; rays.len()];
    let camera_ray = |(pixel, ray): (usize, &Ray)| Way { pixel, ray: *ray, weight: Vec3::ONE, depth: 0 };
    let mut level: Vec<Way> = rays.iter().enumerate().map(camera_ray).collect();
    // A solution that ignores the depth is stopped here, because another check reports that mistake.
    while !level.is_empty() && level[0].depth <= LIMITS.max_depth {
        let (mut hit, mut queries) = (Vec::new(), Vec::new());
        for way in &level {
            let direction = way.ray.direction;
            let Some((t, sphere)) = nearest(&way.ray, spheres) else {
                // Every ray ends at the floor or in the sky.
                let t = -way.ray.origin.y / direction.y;
                let light = if direction.y < 0.0 { floor(way.ray.at(t), spheres) } else { sky(direction) };
                pixels[way.pixel] += way.weight * light;
                continue;
            };
            let point = (way.ray.origin.as_dvec3() + t * direction.as_dvec3()).as_vec3();
            // Of unit length, although the point was rounded.
            let outwards = (point - sphere.center).as_dvec3().normalize().as_vec3();
            let entering = outwards.dot(direction) < 0.0;
            let normal = if entering { outwards } else { -outwards };
            let (weight, depth, material) = (way.weight, way.depth, sphere.material.clone());
            queries.push(ScatterQuery {
                direction,
                normal,
                entering,
                material,
                weight,
                depth,
                limits: LIMITS,
            });
            // A point of a sphere near the origin, rounded once.
            let error = Vec3::splat(1e-6);
            hit.push((way, Surface { point, error, geometric_normal: normal, shading_normal: normal }));
        }
        let scattered = kit.scatter(&queries);
        // At most two rays leave a surface. An answer with many more must not fill the memory of a judge.
        let most = rays.len() << LIMITS.max_depth;
        let leaving: Vec<(&Way, Surface, SecondaryRay)> = hit
            .iter()
            .zip(&scattered)
            .flat_map(|((way, surface), rays)| rays.iter().map(move |ray| (*way, *surface, *ray)))
            .take(most)
            .collect();
        let spawned =
            kit.spawn_ray(&leaving.iter().map(|(_, surface, ray)| (*surface, *ray)).collect::<Vec<_>>());
        let next = leaving.into_iter().zip(spawned).map(|((way, _, secondary), ray)| Way {
            pixel: way.pixel,
            ray,
            weight: secondary.weight,
            depth: way.depth + 1,
        });
        level = next.collect();
    }
    pixels
}

/// Clear glass.
pub(super) fn glass(index_of_refraction: f32) -> Material {
    let fresnel = Fresnel::Exact;
    Material { transmission: Vec3::ONE, index_of_refraction, fresnel, ..Material::default() }
}

pub(super) fn picture_of_a_mirror_and_glass(trial: &Trial<'_>) -> CheckResult {
    let mirror = |mirror: Vec3| Material { mirror, fresnel: Fresnel::None, ..Material::default() };
    let spheres = |x: f32, z: f32, index: f32, gold: Vec3| {
        let sphere = |center: Vec3, material: Material| Sphere { center, radius: center.y, material };
        vec![
            sphere(vec3(-1.05 + x, 1.0, -0.4), mirror(gold)),
            sphere(vec3(0.95, 0.85, 0.5 + z), glass(index)),
            sphere(vec3(-0.15 + x, 0.35, 1.25), mirror(vec3(0.85, 0.87, 0.9))),
        ]
    };
    let public = (0.0, 0.0, 1.5, vec3(0.95, 0.75, 0.4));
    let color = (0.3..0.95f32, 0.3..0.95f32, 0.3..0.95f32).prop_map(Vec3::from);
    let (x, z, index, gold) = trial.composed(public, (-0.3..0.1f32, -0.3..0.3f32, 1.2..1.8f32, color));
    let spheres = spheres(x, z, index, gold);
    let rays = picture::rays(trial, LARGE, vec3(0.3, 1.9, 5.4), vec3(0.0, 0.75, 0.0));
    // The rims of the spheres and of what is seen in them cross about 400 of 4800 pixels. There rounding decides which ray hits;
    // for a wrong pixel a ray must pass a rim at a ten-millionth of the size of the picture.
    let composed = Composed { name: "stage5_mirror_and_glass", size: LARGE, rays: &rays, may_differ: 0.002 };
    composed.check(trial, |kit| colors(kit, &rays, &spheres))
}
