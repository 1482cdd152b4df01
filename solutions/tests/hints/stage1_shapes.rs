//! Stage 1 by the third hints. The other functions are those of the textbook, which contain the code of their hints.

pub use crate::textbook_shapes::*;
use glam::Vec3;
use raykata::ray::Ray;

pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    let near = roots[0].min(roots[1]);
    let far = roots[0].max(roots[1]);
    [near, far].into_iter().find(|&t| ray.contains(t))
}

pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    let d = ray.direction;
    let f = ray.origin - center;
    let a = d.dot(d);
    let b = -f.dot(d);
    let c = f.dot(f) - radius * radius;
    let f_perpendicular = f + (b / a) * d;
    let discriminant = a * (radius * radius - f_perpendicular.length_squared());
    if !(discriminant >= 0.0 && radius > 0.0) {
        return None;
    }
    let q = b + b.signum() * discriminant.sqrt();
    nearest_root([q / a, c / q], ray)
}

pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    let d = ray.direction;
    let l = center - ray.origin;
    let t_ca = l.dot(d) / d.dot(d);
    let n = l - t_ca * d;
    let discriminant = (radius * radius - n.length_squared()) / d.dot(d);
    if !(discriminant >= 0.0 && radius > 0.0) {
        return None;
    }
    let t_hc = discriminant.sqrt();
    let larger = if t_ca > 0.0 { t_ca + t_hc } else { t_ca - t_hc };
    let product = (l.length_squared() - radius * radius) / d.dot(d);
    nearest_root([product / larger, larger], ray)
}

pub fn plane_by_coefficients(ray: &Ray, normal: Vec3, d: f32) -> Option<f32> {
    let (n, o, v) = (normal.as_dvec3(), ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let t = (-f64::from(d) - n.dot(o)) / n.dot(v);
    let t = t as f32;
    ray.contains(t).then_some(t)
}
