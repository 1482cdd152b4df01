//! Stage 2 by the third hints. The other functions are those of the textbook, which contain the code of their hints.

pub use crate::textbook_triangles::*;
use glam::{Mat3, Vec3};
use raykata::kit::{GramScalars, TriangleHit};
use raykata::ray::Ray;
use raykata::shape::Triangle;

pub fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    let [a, e, i] = (triangle.a - triangle.b).to_array();
    let [b, f, j] = (triangle.a - triangle.c).to_array();
    let [c, g, k] = ray.direction.to_array();
    let s = triangle.a - ray.origin;
    let determinant = a * (f * k - g * j) + b * (g * i - e * k) + c * (e * j - f * i);
    let columns = [Vec3::new(a, e, i), Vec3::new(b, f, j), Vec3::new(c, g, k)];
    let replaced = |column: usize| {
        let mut columns = columns;
        columns[column] = s;
        Mat3::from_cols(columns[0], columns[1], columns[2]).determinant() / determinant
    };
    let (beta, gamma, t) = (replaced(0), replaced(1), replaced(2));
    (beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0 && ray.contains(t)).then_some(TriangleHit {
        t,
        beta,
        gamma,
    })
}

pub fn gram_scalars(triangle: &Triangle) -> GramScalars {
    let u = triangle.b - triangle.a;
    let v = triangle.c - triangle.a;
    let (uv, vv, uu) = (u.dot(v), v.dot(v), u.dot(u));
    GramScalars { uv, vv, uu, d: -u.cross(v).length_squared() }
}

pub fn triangle_gram(ray: &Ray, triangle: &Triangle, scalars: &GramScalars) -> Option<TriangleHit> {
    let u = triangle.b - triangle.a;
    let v = triangle.c - triangle.a;
    let normal = u.cross(v);
    let denominator = normal.dot(ray.direction);
    if denominator == 0.0 || scalars.d == 0.0 {
        return None;
    }
    let t = normal.dot(triangle.a - ray.origin) / denominator;
    if !ray.contains(t) {
        return None;
    }
    let w = t * ray.direction - (triangle.a - ray.origin);
    let beta = (scalars.uv * w.dot(v) - scalars.vv * w.dot(u)) / scalars.d;
    let gamma = (scalars.uv * w.dot(u) - scalars.uu * w.dot(v)) / scalars.d;
    (beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0).then_some(TriangleHit { t, beta, gamma })
}

pub fn backfacing(ray: &Ray, triangle: &Triangle) -> bool {
    let [a, b, c, d] = [triangle.a, triangle.b, triangle.c, ray.direction].map(|v| v.as_dvec3());
    (b - a).cross(c - a).dot(d) > 0.0
}

pub fn face_normal(triangle: &Triangle) -> Option<Vec3> {
    let edge = |v: Vec3| v / v.abs().max_element();
    edge(triangle.b - triangle.a).cross(edge(triangle.c - triangle.a)).try_normalize()
}
