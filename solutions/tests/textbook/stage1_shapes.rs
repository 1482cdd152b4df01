//! Stage 1 as in "Ray Tracing in One Weekend" and Haines, "An Introduction to Ray Tracing", chapter 2.

pub use exercises::stage1_shapes::{plane_by_coefficients, sphere_geometric};
use glam::Vec3;
use raykata::ray::Ray;

pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    let [near, far] = if roots[0] < roots[1] { roots } else { [roots[1], roots[0]] };
    if ray.contains(near) {
        Some(near)
    } else if ray.contains(far) {
        Some(far)
    } else {
        None
    }
}

pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    let oc = ray.origin - center;
    let a = ray.direction.dot(ray.direction);
    let b = 2.0 * oc.dot(ray.direction);
    let c = oc.dot(oc) - radius * radius;
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    nearest_root([(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)], ray)
}

pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    (point - center).normalize()
}

pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    let denominator = normal.dot(ray.direction);
    if denominator == 0.0 {
        return None;
    }
    let t = normal.dot(point - ray.origin) / denominator;
    if ray.contains(t) { Some(t) } else { None }
}

pub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 {
    if direction.dot(normal) < 0.0 { normal } else { -normal }
}
