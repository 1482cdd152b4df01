//! Stage 1 as in "Ray Tracing in One Weekend" and Haines, "An Introduction to Ray Tracing", chapter 2.

use glam::Vec3;
use raykata::ray::Ray;

pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    let near = roots[0].min(roots[1]);
    let far = roots[0].max(roots[1]);
    if ray.contains(near) {
        Some(near)
    } else if ray.contains(far) {
        Some(far)
    } else {
        None
    }
}

pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    let oc = center - ray.origin;
    let a = ray.direction.length_squared();
    let h = ray.direction.dot(oc);
    let c = oc.length_squared() - radius * radius;
    let discriminant = h * h - a * c;
    if radius <= 0.0 || discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    nearest_root([(h - root) / a, (h + root) / a], ray)
}

pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    if radius <= 0.0 {
        return None;
    }
    let l = center - ray.origin;
    let length = ray.direction.length();
    let d = ray.direction / length;
    let t_ca = l.dot(d);
    let d_squared = l.dot(l) - t_ca * t_ca;
    if d_squared > radius * radius {
        return None;
    }
    let t_hc = (radius * radius - d_squared).sqrt();
    nearest_root([(t_ca - t_hc) / length, (t_ca + t_hc) / length], ray)
}

pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    (point - center).normalize_or(Vec3::X)
}

pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    let denominator = normal.dot(ray.direction);
    if denominator == 0.0 {
        return None;
    }
    let t = normal.dot(point - ray.origin) / denominator;
    if ray.contains(t) { Some(t) } else { None }
}

pub fn plane_by_coefficients(ray: &Ray, normal: Vec3, d: f32) -> Option<f32> {
    let denominator = normal.dot(ray.direction);
    if denominator == 0.0 {
        return None;
    }
    let t = -(normal.dot(ray.origin) + d) / denominator;
    if ray.contains(t) { Some(t) } else { None }
}

pub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 {
    if direction.dot(normal) < 0.0 { normal } else { -normal }
}
