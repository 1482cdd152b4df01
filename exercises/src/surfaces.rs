//! Nothing to do here: from the `t` of a hit to the point that is shaded, with a bound on its rounding error.

use crate::camera_rays::{geometry_at, plane_at};
use crate::placed::{meet_solid, point_on_solid, to_world};
use crate::shape_tests::ShapeTests;
use crate::stage8_scene_graph::ray_to_object;
use crate::{stage1_shapes, stage2_triangles, stage4_shading};
use glam::{Vec2, Vec3, vec2};
use raykata::bvh::PrimitiveHit;
use raykata::kit::Surface;
use raykata::ray::Ray;
use raykata::shape::{Plane, Sphere, Triangle};
use raykata::world::{Geometry, Instance, Primitive, World, around_ball};

/// What a ray has hit.
#[derive(Clone, Copy)]
pub enum Hit {
    Plane {
        t: f32,
        index: usize,
    },
    Primitive(PrimitiveHit),
    /// A primitive of a part, in the instance that is `outer`.
    Inner {
        t: f32,
        outer: u32,
        inner: u32,
    },
}

impl Hit {
    pub fn t(&self) -> f32 {
        match self {
            Hit::Plane { t, .. } | Hit::Primitive(PrimitiveHit { t, .. }) | Hit::Inner { t, .. } => *t,
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

/// A point of a shape, before it is known from which side it is seen.
pub struct Found {
    pub point: Vec3,
    /// How far `point` may be from the shape.
    pub error: Vec3,
    /// Unit normal, outwards.
    pub normal: Vec3,
    /// The interpolated one.
    pub smooth: Option<Vec3>,
}

/// How surfaces are looked at.
#[derive(Clone, Copy)]
pub struct Looks {
    pub tests: ShapeTests,
    /// Whether normals are interpolated over smooth meshes.
    pub smooth: bool,
}

/// The point that was hit, with a bound on its error, its normals, and what is there.
#[inline(always)]
pub fn surface(world: &World, looks: Looks, ray: &Ray, hit: &Hit) -> Place {
    let (found, material) = match *hit {
        Hit::Plane { t, index } => {
            let plane = &world.planes[index];
            (point_on_plane(ray, t, &plane_at(plane, ray.time).0), plane.material)
        }
        Hit::Primitive(hit) => {
            let primitive = &world.primitives[hit.primitive as usize];
            let found = match geometry_at(world, primitive, ray.time) {
                Geometry::Sphere(sphere) => point_on_sphere(ray, hit.t, &sphere),
                Geometry::Triangle(triangle) => point_on_triangle(world, looks, ray, primitive, &triangle),
                Geometry::Solid(index) => {
                    point_on_solid(looks.tests, ray, hit.t, &world.solids[index as usize])
                }
                // A search answers for an instance with what it has hit inside.
                Geometry::Instance(_) => unreachable!("an instance is not a surface"),
            };
            (found, primitive.material)
        }
        Hit::Inner { outer, inner, .. } => point_in_instance(world, looks, ray, outer, inner),
    };
    let Found { point, error, normal, smooth } = found;
    let geometric_normal = stage1_shapes::face_viewer(normal, ray.dir);
    let shading_normal = match smooth {
        Some(_) => stage4_shading::shading_normal(geometric_normal, smooth, ray.dir),
        None => geometric_normal,
    };
    let surface = Surface { point, error, geometric_normal, shading_normal };
    Place { surface, entering: normal.dot(ray.dir) < 0.0, material: material as usize }
}

#[cold]
fn point_in_instance(world: &World, looks: Looks, ray: &Ray, outer: u32, inner: u32) -> (Found, u32) {
    let (instance, primitive, material) = in_instance(world, outer, inner);
    let ray = ray_to_object(ray, &instance.placement.to_object);
    let Geometry::Triangle(triangle) = &primitive.geometry else { unreachable!("parts are meshes") };
    let found = point_on_triangle(world, looks, &ray, primitive, triangle);
    (to_world(found, &instance.placement), material)
}

/// The instance that is primitive `outer`, primitive `inner` of its part, and what that is made of.
fn in_instance(world: &World, outer: u32, inner: u32) -> (&Instance, &Primitive, u32) {
    let outer = &world.primitives[outer as usize];
    let Geometry::Instance(index) = outer.geometry else { unreachable!("only instances have an inside") };
    let instance = &world.instances[index as usize];
    let primitive = &world.parts[instance.part as usize].primitives[inner as usize];
    let inherits = primitive.material == Primitive::INHERITED;
    (instance, primitive, if inherits { outer.material } else { primitive.material })
}

pub fn point_on_sphere(ray: &Ray, t: f32, sphere: &Sphere) -> Found {
    // Pulled back onto the sphere: five roundings of the way from the centre, one of the sum.
    let normal = stage1_shapes::sphere_normal(sphere.center, ray.at(t));
    let point = sphere.center + sphere.radius * normal;
    let error = rounding(5) * (sphere.radius * normal).abs() + rounding(1) * point.abs();
    Found { point, error, normal, smooth: None }
}

#[inline(always)]
fn point_on_triangle(
    world: &World,
    looks: Looks,
    ray: &Ray,
    primitive: &Primitive,
    triangle: &Triangle,
) -> Found {
    let weights = barycentric(looks.tests, ray, triangle);
    let Triangle { a, b, c } = *triangle;
    // A weighted sum of the corners lies in the triangle to seven roundings of its terms, however far the ray came
    // from.
    let terms = [weights.x * a, weights.y * b, weights.z * c];
    let point = terms[0] + terms[1] + terms[2];
    let error = rounding(7) * (terms[0].abs() + terms[1].abs() + terms[2].abs());
    let normal = (b - a).cross(c - a).normalize_or(Vec3::Z);
    let smooth = primitive.normals.get().filter(|_| looks.smooth).map(|index| {
        let at = |index: usize| stage2_triangles::interpolate(weights, world.normals[index]);
        match primitive.end.get() {
            None => at(index),
            Some(_) => at(index).lerp(at(index + 1), ray.time),
        }
    });
    Found { point, error, normal, smooth }
}

/// `(α, β, γ)` of the point in which the ray meets the plane of the triangle, none below 0.
#[inline(always)]
fn barycentric(tests: ShapeTests, ray: &Ray, triangle: &Triangle) -> Vec3 {
    let unbounded = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    let (beta, gamma) =
        tests.triangle(&unbounded, triangle).map_or((1.0 / 3.0, 1.0 / 3.0), |hit| (hit.beta, hit.gamma));
    Vec3::new((1.0 - beta - gamma).max(0.0), beta, gamma)
}

/// The texture coordinates of a hit; the middle of the image where the shape has none.
pub fn texture_coordinates(world: &World, tests: ShapeTests, ray: &Ray, hit: &Hit, at: Vec3) -> Vec2 {
    let middle = vec2(0.5, 0.5);
    match *hit {
        Hit::Plane { index, .. } => {
            let (plane, axes) = plane_at(&world.planes[index], ray.time);
            let along = |axis: Vec3| (at - plane.point).dot(axis) / axis.length_squared();
            vec2(along(axes[0]), along(axes[1]))
        }
        Hit::Primitive(hit) => {
            let primitive = &world.primitives[hit.primitive as usize];
            if let Geometry::Solid(index) = primitive.geometry {
                let solid = &world.solids[index as usize];
                let own = solid.placement.to_object.transform_point3(at);
                let normal = meet_solid(tests, ray, solid).map_or(Vec3::Y, |hit| hit.normal);
                return solid.shape.texture_coordinates(own, normal);
            }
            let Some(image) = primitive.image.get() else { return middle };
            match geometry_at(world, primitive, ray.time) {
                Geometry::Sphere(sphere) => around_ball(world.ball_axes[image] * (at - sphere.center)),
                Geometry::Triangle(triangle) => uv_on_triangle(world, tests, ray, image, &triangle),
                Geometry::Solid(_) | Geometry::Instance(_) => middle,
            }
        }
        Hit::Inner { outer, inner, .. } => {
            let (instance, primitive, _) = in_instance(world, outer, inner);
            match (primitive.image.get(), &primitive.geometry) {
                (Some(image), Geometry::Triangle(triangle)) => {
                    let ray = ray_to_object(ray, &instance.placement.to_object);
                    uv_on_triangle(world, tests, &ray, image, triangle)
                }
                _ => middle,
            }
        }
    }
}

fn uv_on_triangle(world: &World, tests: ShapeTests, ray: &Ray, image: usize, triangle: &Triangle) -> Vec2 {
    let [a, b, c] = world.uvs[image];
    let weights = barycentric(tests, ray, triangle);
    weights.x * a + weights.y * b + weights.z * c
}

/// The hit moved onto the plane: what is left is the rounding of the point and of its distance to the plane.
fn point_on_plane(ray: &Ray, t: f32, plane: &Plane) -> Found {
    let rough = ray.at(t);
    let normal = plane.normal.normalize();
    let offset = rough - plane.point;
    let point = rough - offset.dot(normal) * normal;
    let error = rounding(8) * (point.abs() + plane.point.abs() + Vec3::splat(offset.abs().max_element()));
    Found { point, error, normal: plane.normal, smooth: None }
}

/// `γ_n`, the largest relative error that `n` roundings can add up to (Higham).
fn rounding(n: u32) -> f32 {
    let nu = n as f32 * f32::EPSILON / 2.0;
    nu / (1.0 - nu)
}
