//! Stage 5 by the third hints. The other functions are those of the textbook, which contain the code of their hints.

use crate::stage4_shading::off;
use crate::textbook_recursion::cos_2 as behind;
pub use crate::textbook_recursion::*;
use glam::Vec3;
use raykata::kit::{Bounce, SecondaryRay, Surface};
use raykata::ray::Ray;

pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    (direction - 2.0 * direction.dot(normal) * normal).normalize()
}

pub fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
    let along = n1 / n2 * (direction - direction.dot(normal) * normal);
    let squared = 1.0 - along.length_squared();
    (squared >= 0.0).then(|| along - squared.sqrt() * normal)
}

pub fn spawn_ray(surface: &Surface, secondary: &SecondaryRay) -> Ray {
    let normal = surface.geometric_normal;
    let side = if secondary.bounce == Bounce::Reflection { normal } else { -normal };
    Ray::new(off(surface, side), secondary.direction)
}

pub fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    let Some(cos_2) = behind(cos_theta, n1, n2) else { return 1.0 };
    let squared = |p: f32, q: f32| if p + q == 0.0 { 1.0 } else { ((p - q) / (p + q)).powi(2) };
    0.5 * (squared(n1 * cos_theta, n2 * cos_2) + squared(n1 * cos_2, n2 * cos_theta))
}
