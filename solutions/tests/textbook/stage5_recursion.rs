//! Stage 5 by the formulas of the slides.

use crate::stage5_recursion as own;
use glam::Vec3;
use raykata::kit::{Bounce, Limits, SecondaryRay, Surface};
use raykata::material::{Fresnel, Material};
use raykata::ray::Ray;

pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

pub fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
    let cos_1 = -direction.dot(normal);
    let sin_1 = (1.0 - cos_1 * cos_1).sqrt();
    let sin_2 = n1 / n2 * sin_1;
    let along = (direction + cos_1 * normal) / sin_1;
    (sin_2 <= 1.0).then(|| sin_2 * along - (1.0 - sin_2 * sin_2).sqrt() * normal)
}

/// The cosine behind the surface, by Snell's law.
fn cos_2(cos_1: f32, n1: f32, n2: f32) -> Option<f32> {
    let squared = 1.0 - (n1 / n2).powi(2) * (1.0 - cos_1 * cos_1);
    (squared >= 0.0).then(|| squared.sqrt())
}

pub fn fresnel_schlick(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    let r0 = ((n1 - n2) / (n1 + n2)).powi(2);
    let cosine = if n1 > n2 { cos_2(cos_theta, n1, n2) } else { Some(cos_theta) };
    cosine.map_or(1.0, |cosine| r0 + (1.0 - r0) * (1.0 - cosine).powi(5))
}

pub fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    let Some(cos_2) = cos_2(cos_theta, n1, n2) else { return 1.0 };
    let squared = |p: f32, q: f32| ((p - q) / (p + q)).powi(2);
    0.5 * (squared(n1 * cos_theta, n2 * cos_2) + squared(n1 * cos_2, n2 * cos_theta))
}

pub fn scatter(
    direction: Vec3,
    normal: Vec3,
    entering: bool,
    material: &Material,
    weight: Vec3,
    depth: u32,
    limits: &Limits,
) -> Vec<SecondaryRay> {
    if depth >= limits.max_depth {
        return Vec::new();
    }
    let index = material.index_of_refraction;
    let (n1, n2) = if entering { (1.0, index) } else { (index, 1.0) };
    let cos_theta = -direction.dot(normal);
    let share = match material.fresnel {
        Fresnel::None => 0.0,
        Fresnel::Schlick => own::fresnel_schlick(cos_theta, n1, n2),
        Fresnel::Exact => own::fresnel_exact(cos_theta, n1, n2),
    };
    let mut rays = vec![SecondaryRay {
        bounce: Bounce::Reflection,
        direction: own::reflect(direction, normal),
        weight: weight * (material.mirror + share * material.transmission),
    }];
    if let Some(direction) = own::refract(direction, normal, n1, n2) {
        let weight = weight * (1.0 - share) * material.transmission;
        rays.push(SecondaryRay { bounce: Bounce::Transmission, direction, weight });
    }
    rays.retain(|ray| ray.weight != Vec3::ZERO && ray.weight.max_element() >= limits.min_contribution);
    rays
}

pub fn spawn_ray(surface: &Surface, secondary: &SecondaryRay) -> Ray {
    let normal = surface.geometric_normal;
    let side = if secondary.bounce == Bounce::Reflection { normal } else { -normal };
    Ray::new(surface.point + 1e-3 * side, secondary.direction)
}
