//! Stage 2 as in the lecture notes, Möller and Trumbore 1997, and "Physically Based Rendering".

pub use exercises::stage2_triangles::{
    backfacing, face_normal, gram_scalars, inside_by_areas, inside_by_direction, inside_by_planes,
    triangle_gram, vertex_normals,
};
use glam::{Mat3, Vec3};
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::kit::TriangleHit;
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

pub fn interpolate(barycentric: Vec3, corners: [Vec3; 3]) -> Vec3 {
    barycentric.x * corners[0] + barycentric.y * corners[1] + barycentric.z * corners[2]
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
