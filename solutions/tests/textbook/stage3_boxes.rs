//! Stage 3, boxes, as in "Physically Based Rendering" and Williams et al. 2005.

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
    Aabb::new(first.min.min(second.min), first.max.max(second.max))
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
    let (mut t0, mut t1) = (ray.t_min, ray.t_max);
    for axis in 0..3 {
        let near = (bounds.min[axis] - ray.origin[axis]) * inverse_direction[axis];
        let far = (bounds.max[axis] - ray.origin[axis]) * inverse_direction[axis];
        t0 = t0.max(near.min(far));
        t1 = t1.min(near.max(far));
        if t0 > t1 {
            return None;
        }
    }
    Some((t0, t1))
}
