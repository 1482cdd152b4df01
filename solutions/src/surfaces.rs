//! Nothing to do here: from the `t` of a hit to the point that is shaded, with a bound on its rounding error.

use crate::{stage1_shapes, stage2_triangles, stage4_shading};
use glam::Vec3;
use raykata::bvh::PrimitiveHit;
use raykata::kit::{Bounce, Child, LightSample, Surface};
use raykata::material::Material;
use raykata::ray::Ray;
use raykata::scene::TriangleMethod;
use raykata::shape::{Plane, Triangle};
use raykata::world::{Geometry, Primitive, World};

/// What a ray has hit.
#[derive(Clone, Copy)]
pub enum Hit {
    Plane { t: f32, index: usize },
    Primitive(PrimitiveHit),
}

impl Hit {
    pub fn t(&self) -> f32 {
        match self {
            Hit::Plane { t, .. } | Hit::Primitive(PrimitiveHit { t, .. }) => *t,
        }
    }
}

/// Where a ray has met a surface.
pub struct Place {
    /// The point with its normals.
    pub surface: Surface,
    /// Whether the ray comes from outside.
    pub entering: bool,
    /// Index of the material.
    pub material: usize,
}

/// The point that was hit, with a bound on its error, its normals, and what is there.
pub fn surface(world: &World, method: TriangleMethod, smooth: bool, ray: &Ray, hit: &Hit) -> Place {
    let (point, error, geometric, interpolated, material) = match *hit {
        Hit::Plane { t, index } => {
            let (plane, material) = &world.planes[index];
            let (point, error) = point_on_plane(ray, t, plane);
            (point, error, plane.normal, None, *material)
        }
        Hit::Primitive(hit) => {
            let primitive = &world.primitives[hit.primitive as usize];
            let (point, error, geometric, interpolated) = on_primitive(world, method, ray, hit.t, primitive);
            (point, error, geometric, interpolated, primitive.material)
        }
    };
    let geometric_normal = stage1_shapes::face_viewer(geometric, ray.dir);
    let shading_normal = if smooth && interpolated.is_some() {
        stage4_shading::shading_normal(geometric_normal, interpolated, ray.dir)
    } else {
        geometric_normal
    };
    let surface = Surface { point, error, geometric_normal, shading_normal };
    Place { surface, entering: geometric.dot(ray.dir) < 0.0, material: material as usize }
}

fn on_primitive(
    world: &World,
    method: TriangleMethod,
    ray: &Ray,
    t: f32,
    primitive: &Primitive,
) -> (Vec3, Vec3, Vec3, Option<Vec3>) {
    match primitive.geometry {
        Geometry::Sphere(sphere) => {
            // Pulled back onto the sphere: five roundings of the way from the centre, one of the sum.
            let normal = stage1_shapes::sphere_normal(sphere.center, ray.at(t));
            let point = sphere.center + sphere.radius * normal;
            let error = rounding(5) * (sphere.radius * normal).abs() + rounding(1) * point.abs();
            (point, error, normal, None)
        }
        Geometry::Triangle(triangle) => {
            let unbounded = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
            let (beta, gamma) = meet_triangle(method, &unbounded, &triangle)
                .map_or((1.0 / 3.0, 1.0 / 3.0), |(_, beta, gamma)| (beta, gamma));
            let weights = Vec3::new((1.0 - beta - gamma).max(0.0), beta, gamma);
            let Triangle { a, b, c } = triangle;
            // A weighted sum of the corners lies in the triangle to seven roundings of its terms, however far
            // the ray came from.
            let terms = [weights.x * a, weights.y * b, weights.z * c];
            let point = terms[0] + terms[1] + terms[2];
            let error = rounding(7) * (terms[0].abs() + terms[1].abs() + terms[2].abs());
            let flat = (b - a).cross(c - a).normalize_or(Vec3::Z);
            let smooth = primitive
                .normals
                .map(|normals| stage2_triangles::interpolate(weights, world.normals[normals as usize]));
            (point, error, flat, smooth)
        }
    }
}

/// `(t, β, γ)` by the method that the scene asks for.
pub fn meet_triangle(method: TriangleMethod, ray: &Ray, triangle: &Triangle) -> Option<(f32, f32, f32)> {
    let hit = match method {
        TriangleMethod::Watertight => stage2_triangles::triangle_choice(ray, triangle),
        TriangleMethod::Cramer => stage2_triangles::triangle_cramer(ray, triangle),
        TriangleMethod::Gram => {
            stage2_triangles::triangle_gram(ray, triangle, &stage2_triangles::gram_scalars(triangle))
        }
    };
    hit.map(|hit| (hit.t, hit.beta, hit.gamma))
}

/// Whether a surface can send rays on at all: most cannot, and need not be asked.
pub fn sends_on(material: &Material) -> bool {
    material.mirror != Vec3::ZERO || material.transmission != Vec3::ZERO
}

/// A ray that goes on, starting as far from the surface as a shadow ray does.
pub fn leave(surface: &Surface, child: &Child) -> Ray {
    let side = match child.bounce {
        Bounce::Reflection => surface.geometric_normal,
        Bounce::Transmission => -surface.geometric_normal,
    };
    let from = Surface { geometric_normal: side, shading_normal: side, ..*surface };
    let ahead = LightSample { direction: side, distance: f32::INFINITY, radiance: Vec3::ONE };
    let start = stage4_shading::shadow_ray(&from, &ahead).map_or(surface.point, |ray| ray.at(ray.t_min));
    Ray::new(start, child.direction)
}

/// The hit moved onto the plane: what is left is the rounding of the point and of its distance to the plane.
fn point_on_plane(ray: &Ray, t: f32, plane: &Plane) -> (Vec3, Vec3) {
    let rough = ray.at(t);
    let normal = plane.normal.normalize();
    let offset = rough - plane.point;
    let point = rough - offset.dot(normal) * normal;
    (point, rounding(8) * (point.abs() + plane.point.abs() + Vec3::splat(offset.abs().max_element())))
}

/// `γ_n`, the largest relative error that `n` roundings can add up to (Higham).
fn rounding(n: u32) -> f32 {
    let nu = n as f32 * f32::EPSILON / 2.0;
    nu / (1.0 - nu)
}
