//! Stage 3, boxes, by the third hints.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::shape::{Sphere, Triangle};

pub fn triangle_bounds(triangle: &Triangle) -> Aabb {
    Aabb::new(triangle.a.min(triangle.b).min(triangle.c), triangle.a.max(triangle.b).max(triangle.c))
}

pub fn sphere_bounds(sphere: &Sphere) -> Aabb {
    Aabb::new(sphere.center - Vec3::splat(sphere.radius), sphere.center + Vec3::splat(sphere.radius))
}

pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
    let each =
        |of: fn(f32, f32) -> f32, a: Vec3, b: Vec3| Vec3::new(of(a.x, b.x), of(a.y, b.y), of(a.z, b.z));
    Aabb::new(each(f32::min, first.min, second.min), each(f32::max, first.max, second.max))
}

pub fn centroid(bounds: &Aabb) -> Vec3 {
    (bounds.min + bounds.max) / 2.0
}

pub fn surface_area(bounds: &Aabb) -> f32 {
    if bounds.is_empty() {
        return 0.0;
    }
    let d = bounds.max - bounds.min;
    2.0 * (d.x * d.y + d.y * d.z + d.z * d.x)
}

pub fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    let u = 2f32.powi(-24);
    let gamma_3 = 3.0 * u / (1.0 - 3.0 * u);
    let (mut near, mut far) = (ray.t_min, ray.t_max);
    for axis in 0..3 {
        let [min, max] =
            [bounds.min, bounds.max].map(|corner| (corner - ray.origin)[axis] * inverse_direction[axis]);
        let (enter, exit) = if inverse_direction[axis].is_sign_negative() { (max, min) } else { (min, max) };
        let exit = exit * (1.0 + 2.0 * gamma_3);
        if enter > near {
            near = enter;
        }
        if exit < far {
            far = exit;
        }
    }
    (near <= far).then_some((near, far))
}
