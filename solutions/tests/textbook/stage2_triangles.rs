//! Stage 2 as in the lecture notes, Möller and Trumbore 1997, and "Physically Based Rendering".

use glam::{Mat3, Vec3};
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::kit::{GramScalars, TriangleHit};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;

pub fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    let x = triangle.a - triangle.b;
    let y = triangle.a - triangle.c;
    let z = ray.direction;
    let s = triangle.a - ray.origin;
    let d = Mat3::from_cols(x, y, z).determinant();
    if d == 0.0 {
        return None;
    }
    let beta = Mat3::from_cols(s, y, z).determinant() / d;
    let gamma = Mat3::from_cols(x, s, z).determinant() / d;
    let t = Mat3::from_cols(x, y, s).determinant() / d;
    if beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0 && ray.contains(t) {
        Some(TriangleHit { t, beta, gamma })
    } else {
        None
    }
}

pub fn gram_scalars(triangle: &Triangle) -> GramScalars {
    let u = triangle.b - triangle.a;
    let v = triangle.c - triangle.a;
    let (uv, vv, uu) = (u.dot(v), v.dot(v), u.dot(u));
    GramScalars { uv, vv, uu, d: uv * uv - uu * vv }
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
    let w = ray.at(t) - triangle.a;
    let beta = (scalars.uv * w.dot(v) - scalars.vv * w.dot(u)) / scalars.d;
    let gamma = (scalars.uv * w.dot(u) - scalars.uu * w.dot(v)) / scalars.d;
    (beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0).then_some(TriangleHit { t, beta, gamma })
}

pub fn triangle_choice(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    let edge1 = triangle.b - triangle.a;
    let edge2 = triangle.c - triangle.a;
    let pvec = ray.direction.cross(edge2);
    let det = edge1.dot(pvec);
    if det == 0.0 {
        return None;
    }
    let inv_det = 1.0 / det;
    let tvec = ray.origin - triangle.a;
    let beta = tvec.dot(pvec) * inv_det;
    if beta < 0.0 || beta > 1.0 {
        return None;
    }
    let qvec = tvec.cross(edge1);
    let gamma = ray.direction.dot(qvec) * inv_det;
    if gamma < 0.0 || beta + gamma > 1.0 {
        return None;
    }
    let t = edge2.dot(qvec) * inv_det;
    if ray.contains(t) { Some(TriangleHit { t, beta, gamma }) } else { None }
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

pub fn backfacing(ray: &Ray, triangle: &Triangle) -> bool {
    let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    normal.dot(ray.direction) > 0.0
}

pub fn interpolate(barycentric: Vec3, corners: [Vec3; 3]) -> Vec3 {
    barycentric.x * corners[0] + barycentric.y * corners[1] + barycentric.z * corners[2]
}

pub fn face_normal(triangle: &Triangle) -> Option<Vec3> {
    let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    let length = normal.length();
    if length > 0.0 { Some(normal / length) } else { None }
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

pub fn brute_force(n_primitives: u32, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    let mut closest: Option<PrimitiveHit> = None;
    for primitive in 0..n_primitives {
        if let Some(t) = probe.hit(primitive, ray)
            && closest.is_none_or(|hit| t < hit.t)
        {
            closest = Some(PrimitiveHit { t, primitive });
        }
    }
    closest
}
