//! Stage 2 by the third hints. The other functions are those of the textbook, which contain the code of their hints.

pub use crate::textbook_triangles::*;
use glam::{Mat3, Vec3};
use raykata::kit::{GramScalars, TriangleHit};
use raykata::mesh::Mesh;
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

pub fn inside_by_planes(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    let corners = [triangle.a, triangle.b, triangle.c];
    let distances = [0, 1, 2].map(|i| {
        let v1 = corners[i] - ray.origin;
        let v2 = corners[(i + 1) % 3] - ray.origin;
        v1.cross(v2).dot(point - ray.origin)
    });
    distances.iter().all(|&d| d >= 0.0) || distances.iter().all(|&d| d <= 0.0)
}

pub fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    let corners = [triangle.a, triangle.b, triangle.c];
    let signs = [0, 1, 2].map(|i| {
        let v1 = corners[i] - point;
        let v2 = corners[(i + 1) % 3] - point;
        ray.direction.dot(v2.cross(v1))
    });
    signs.iter().all(|&s| s >= 0.0) || signs.iter().all(|&s| s <= 0.0)
}

pub fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3> {
    let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    let area = normal.dot(normal);
    if area == 0.0 {
        return None;
    }
    let alpha = (triangle.c - triangle.b).cross(point - triangle.b).dot(normal) / area;
    let beta = (triangle.a - triangle.c).cross(point - triangle.c).dot(normal) / area;
    let gamma = (triangle.b - triangle.a).cross(point - triangle.a).dot(normal) / area;
    if alpha >= 0.0 && beta >= 0.0 && gamma >= 0.0 { Some(Vec3::new(alpha, beta, gamma)) } else { None }
}

pub fn vertex_normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    let mut any = vec![Vec3::Y; mesh.positions.len()];
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        if let Some(normal) = face_normal(&Triangle { a, b, c }) {
            for &i in corners {
                sums[i as usize] += normal;
                any[i as usize] = normal;
            }
        }
    }
    sums.iter().zip(any).map(|(sum, any)| if sum.length() > 1e-4 { sum.normalize() } else { any }).collect()
}
