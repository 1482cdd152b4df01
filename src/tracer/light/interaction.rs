//! From a hit to the point that is shaded: its position with a bound on the rounding error, its normals, its
//! material and its texture coordinates.

use crate::graph::Placement;
use crate::kit::{StudentFunctions, Surface};
use crate::material::Material;
use crate::ray::Ray;
use crate::rounding::{UNIT_ROUNDOFF, gamma};
use crate::shape::{Plane, Sphere, Triangle, around_sphere};
use crate::tracer::search::hit::{Detail, Hit, Target};
use crate::tracer::search::intersection::ShapeTests;
use crate::tracer::search::motion::{geometry_at, plane_at};
use crate::tracer::search::solids::intersect_solid;
use crate::world::{Geometry, Instance, Primitive, Solid, SolidShape, World};
use glam::{DVec3, Vec2, Vec3, vec2};

/// A point at which a ray hits a surface, with everything that shading needs.
pub struct SurfaceInteraction {
    /// Position with error bound and unit normals, in world space, as student functions receive them.
    pub surface: Surface,
    /// Whether the ray arrives from outside, against the outward normal of the shape.
    pub entering: bool,
    /// Index of the material at the point in `World::materials`.
    pub material: usize,
    /// From the point to the curved surface of a smooth mesh, if shadow rays start there.
    lift: Option<Vec3>,
}

/// How hits become surface interactions: which tests and which normals are used.
#[derive(Clone, Copy)]
pub struct SurfaceOptions {
    /// Which student functions test rays against triangles and spheres.
    pub tests: ShapeTests,
    /// Whether normals are interpolated over the triangles of smooth meshes.
    pub smooth: bool,
    /// Whether normals are turned to the side from which the ray comes.
    pub facing: bool,
    /// Whether shadow rays of smooth meshes start on the curved surface that the normals describe.
    pub lift: bool,
}

/// A point of a shape, before it is known from which side it is seen.
struct Point {
    point: Vec3,
    /// How far `point` may be from the shape, along each axis.
    error: Vec3,
    /// Unit normal, outwards.
    normal: Vec3,
    /// The interpolated normal of a smooth mesh.
    smooth: Option<Vec3>,
    /// From the point to the curved surface of a smooth mesh, if shadow rays start there.
    lift: Option<Vec3>,
}

impl SurfaceInteraction {
    /// The interaction as light from `[[lights]]` meets it: on the curved surface of a smooth mesh, with the shading normal for both
    /// normals, if shadow rays start there. Otherwise `None`, for the interaction itself.
    ///
    /// The triangle of a smooth mesh faces away from a low light, or lies in the shadow of its neighbours, where the curved
    /// surface is still lit: the border of the light (the shadow terminator) follows the edges of the triangles.
    #[inline(always)]
    pub fn lifted(&self) -> Option<SurfaceInteraction> {
        let Surface { point, error, shading_normal, .. } = self.surface;
        let point = point + self.lift?;
        let error = error + UNIT_ROUNDOFF * point.abs();
        let surface = Surface { point, error, geometric_normal: shading_normal, shading_normal };
        Some(SurfaceInteraction { surface, lift: None, ..*self })
    }

    /// The radiance that the surface emits towards the ray.
    #[inline(always)]
    pub fn emission(&self, material: &Material) -> Vec3 {
        if material.one_sided_emission && !self.entering { Vec3::ZERO } else { material.emission }
    }

    /// The interaction of `ray` with the surface that it hits at `hit`. Panics if `hit` does not belong to
    /// `world`.
    ///
    /// On a sphere the point is computed from the centre, in a triangle from the corners, and on a plane by
    /// projection, so that its error does not grow with the length of the ray. `Surface::error` bounds the
    /// rounding error along each axis in world units.
    #[inline(always)]
    pub fn new<F: StudentFunctions>(world: &World, options: SurfaceOptions, ray: &Ray, hit: &Hit) -> Self {
        let (point, material) = match hit.target {
            Target::Plane(index) => {
                let plane = &world.planes[index as usize];
                (on_plane(ray, hit.t, &plane_at::<F>(plane, ray.time).0), plane.material)
            }
            Target::Primitive(index) => {
                let primitive = &world.primitives[index as usize];
                let point = match geometry_at::<F>(world, primitive, ray.time) {
                    Geometry::Sphere(sphere) => on_sphere::<F>(ray, hit.t, &sphere),
                    Geometry::Triangle(triangle) | Geometry::OneSided(triangle) => {
                        on_triangle::<F>(world, options, ray, primitive, &triangle, hit.detail)
                    }
                    Geometry::Solid(index) => {
                        on_solid::<F>(options.tests, ray, hit, &world.solids[index as usize])
                    }
                    // A hit of an instance names a primitive of its shared mesh, never the instance itself.
                    Geometry::Instance(_) => unreachable!("an instance is not a surface"),
                };
                (point, primitive.material)
            }
            Target::Instance(outer, inner) => in_instance::<F>(world, options, ray, outer, inner, hit.detail),
        };
        let Point { point, error, normal, smooth, lift } = point;
        let geometric_normal = if options.facing { F::face_forward(normal, ray.direction) } else { normal };
        let shading_normal = match smooth {
            Some(_) => F::shading_normal(geometric_normal, smooth, ray.direction),
            None => geometric_normal,
        };
        let surface = Surface { point, error, geometric_normal, shading_normal };
        let entering = normal.dot(ray.direction) < 0.0;
        SurfaceInteraction { surface, entering, material: material as usize, lift }
    }
}

#[cold]
fn in_instance<F: StudentFunctions>(
    world: &World,
    options: SurfaceOptions,
    ray: &Ray,
    outer: u32,
    inner: u32,
    detail: Detail,
) -> (Point, u32) {
    let (instance, primitive, material) = inside(world, outer, inner);
    let ray = F::ray_to_object(ray, &instance.placement.to_object);
    let Some(triangle) = primitive.geometry.triangle() else { unreachable!("shared meshes are triangles") };
    let point = on_triangle::<F>(world, options, &ray, primitive, triangle, detail);
    (to_world::<F>(point, &instance.placement), material)
}

/// The instance that is primitive `outer` of the world, primitive `inner` of its shared mesh, and the index
/// of the material there.
pub fn inside(world: &World, outer: u32, inner: u32) -> (&Instance, &Primitive, u32) {
    let outer = &world.primitives[outer as usize];
    let Geometry::Instance(index) = outer.geometry else { unreachable!("only instances have an inside") };
    let instance = &world.instances[index as usize];
    let primitive = &world.shared_meshes[instance.shared_mesh as usize].primitives[inner as usize];
    let inherits = primitive.material == Primitive::INHERITED;
    (instance, primitive, if inherits { outer.material } else { primitive.material })
}

fn on_sphere<F: StudentFunctions>(ray: &Ray, t: f32, sphere: &Sphere) -> Point {
    // Project the hit onto the sphere, with five roundings of the offset from the centre and one of the sum. In the sphere's
    // own frame the offset has all its digits, however far away the sphere is.
    let normal = F::sphere_normal(Vec3::ZERO, from_center(ray, t, sphere));
    let point = sphere.center + sphere.radius * normal;
    let error = gamma(5) * (sphere.radius * normal).abs() + gamma(1) * point.abs();
    Point { point, error, normal, smooth: None, lift: None }
}

/// The hit at `t`, counted from the centre of the sphere. Single precision has rounded `t` by up to half a unit in its last
/// place. Where that hides the root of the sphere's equation, this takes the root; a `t` that is wrong by more stays wrong.
pub(super) fn from_center(ray: &Ray, t: f32, sphere: &Sphere) -> Vec3 {
    let (origin, direction) = (ray.origin.as_dvec3() - sphere.center.as_dvec3(), ray.direction.as_dvec3());
    // Find the middle of the chord, and half of the chord, both in lengths of the direction.
    let length_squared = direction.length_squared();
    let middle = -origin.dot(direction) / length_squared;
    let beside = (origin + middle * direction).length_squared();
    let half = ((f64::from(sphere.radius).powi(2) - beside).max(0.0) / length_squared).sqrt();
    // Take the first root that is not before `t`, up to the rounding.
    let rounding = f64::from(UNIT_ROUNDOFF) * f64::from(t).abs();
    let (least, most) = (f64::from(t) - rounding, f64::from(t) + rounding);
    let root = if middle - half >= least { middle - half } else { middle + half };
    (origin + root.max(least).min(most) * direction).as_vec3()
}

#[inline(always)]
fn on_triangle<F: StudentFunctions>(
    world: &World,
    options: SurfaceOptions,
    ray: &Ray,
    primitive: &Primitive,
    triangle: &Triangle,
    detail: Detail,
) -> Point {
    let weights = barycentric::<F>(options.tests, ray, triangle, detail);
    let Triangle { a, b, c } = *triangle;
    // Compute the point from the corners: its error is seven roundings of the terms, however long the ray is.
    let at = |weights: Vec3| {
        let terms = [weights.x * a, weights.y * b, weights.z * c];
        let error = gamma(7) * (terms[0].abs() + terms[1].abs() + terms[2].abs());
        (terms[0] + terms[1] + terms[2], error)
    };
    let (mut point, mut error) = at(weights);
    if weights.min_element() < NEAR_AN_EDGE {
        (point, error) = at(off_the_edges(weights, triangle, error));
    }
    let normal = normal_of(triangle);
    // Interpolate the vertex normals, in a moving triangle between times 0 and 1 as well.
    let corner_normals =
        primitive.normals.get().filter(|_| options.smooth).map(|index| match primitive.end.get() {
            None => world.normals[index],
            Some(_) => [0, 1, 2].map(|i| world.normals[index][i].lerp(world.normals[index + 1][i], ray.time)),
        });
    let smooth = corner_normals.map(|normals| F::interpolate(weights, normals));
    let side = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
    let lift =
        corner_normals.filter(|_| options.lift).map(|normals| lift(point, weights, triangle, normals, side));
    Point { point, error, normal, smooth, lift }
}

/// From `point` of a triangle with the unit vectors `normals` at its corners to the curved surface that they describe, on the side
/// of `side`: the mean of the projections of `point` onto the planes through the corners, each along its normal. Only planes
/// above the point count, so a surface that is hollow on this side stays where it is.
///
/// Source: Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021.
#[cold]
fn lift(point: Vec3, weights: Vec3, triangle: &Triangle, normals: [Vec3; 3], side: Vec3) -> Vec3 {
    let corners = [triangle.a, triangle.b, triangle.c];
    let onto_plane = |corner: usize| {
        let normal = normals[corner] * normals[corner].dot(side).signum();
        weights[corner] * (corners[corner] - point).dot(normal).max(0.0) * normal
    };
    onto_plane(0) + onto_plane(1) + onto_plane(2)
}

/// A hit with a smaller barycentric coordinate may lie on an edge up to rounding.
const NEAR_AN_EDGE: f32 = 1e-3;

/// Barycentric coordinates of a point that is at least four times `error` away from each edge, or near the middle of the
/// triangle if it is too small for that.
///
/// A ray that leaves a point of an edge starts in the plane of the neighbouring triangle, up to rounding: perhaps behind it,
/// and so outside of a closed mesh. The ray offset moves the origin by `error` at most, so a distance of four times as much
/// keeps it inside where the faces meet at an angle of 20 degrees or more. The distance is a few roundings of the position,
/// far below what a picture can show.
#[cold]
fn off_the_edges(weights: Vec3, &Triangle { a, b, c }: &Triangle, error: Vec3) -> Vec3 {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    // The height over an edge is twice the area, divided by the length of the edge.
    let double_area = (b - a).cross(c - a).length();
    let per_distance = DVec3::new(b.distance(c), c.distance(a), a.distance(b)) / double_area;
    let least = (4.0 * error.as_dvec3().length() * per_distance).min(DVec3::splat(0.25));
    let moved = weights.as_dvec3().max(least);
    (moved / moved.element_sum()).as_vec3()
}

/// The unit normal of a triangle of any size, on the side from which its corners run anticlockwise.
#[inline(always)]
fn normal_of(&Triangle { a, b, c }: &Triangle) -> Vec3 {
    let normal = (b - a).cross(c - a);
    // Single precision is enough here: a product that underflows is below 1e-38, which is nothing beside a length of
    // 1e-10, and a product that overflows makes the length infinite or NaN.
    let length_squared = normal.length_squared();
    if (1e-20..1e20).contains(&length_squared) {
        return normal.normalize_or(Vec3::Z);
    }
    normal_in_double(a, b, c)
}

/// The unit normal of a triangle whose edges are shorter than about 1e-5 or longer than about 1e5. In double precision
/// no product of two single precision numbers underflows or overflows.
#[cold]
fn normal_in_double(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or(DVec3::Z).as_vec3()
}

/// Barycentric coordinates `(α, β, γ)` of the hit, with `α >= 0`. If the search did not keep those of the
/// test, the triangle is tested once more.
#[inline(always)]
fn barycentric<F: StudentFunctions>(
    tests: ShapeTests,
    ray: &Ray,
    triangle: &Triangle,
    detail: Detail,
) -> Vec3 {
    let (beta, gamma) = match detail {
        Detail::Triangle(beta, gamma) => (beta, gamma),
        _ => test_again::<F>(tests, ray, triangle),
    };
    Vec3::new((1.0 - beta - gamma).max(0.0), beta, gamma)
}

#[cold]
fn test_again<F: StudentFunctions>(tests: ShapeTests, ray: &Ray, triangle: &Triangle) -> (f32, f32) {
    let unbounded = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    let hit = tests.triangle::<F>(&unbounded, triangle, None);
    hit.map_or((1.0 / 3.0, 1.0 / 3.0), |hit| (hit.beta, hit.gamma))
}

/// The hit projected onto the plane: its error is the rounding of the point and of its distance to the plane.
fn on_plane(ray: &Ray, t: f32, plane: &Plane) -> Point {
    let rough = ray.at(t);
    let normal = plane.normal.normalize();
    let offset = rough - plane.point;
    let point = rough - offset.dot(normal) * normal;
    let error = gamma(8) * (point.abs() + plane.point.abs() + Vec3::splat(offset.abs().max_element()));
    Point { point, error, normal: plane.normal, smooth: None, lift: None }
}

#[cold]
fn on_solid<F: StudentFunctions>(tests: ShapeTests, ray: &Ray, hit: &Hit, solid: &Solid) -> Point {
    let placement = &solid.placement;
    let own = F::ray_to_object(ray, &placement.to_object);
    if let SolidShape::Sphere(sphere) = &solid.shape {
        return to_world::<F>(on_sphere::<F>(&own, hit.t, sphere), placement);
    }
    let normal = normal_of_solid::<F>(tests, ray, hit, solid).unwrap_or(-own.direction.normalize_or(Vec3::Z));
    let point = own.at(hit.t);
    // Bound the error: the rounding of `t` moves the point along the ray, and product and sum are rounded as
    // well. Twice that is enough for tests in single precision.
    let error = 4.0 * UNIT_ROUNDOFF * (hit.t * own.direction).abs() + 2.0 * UNIT_ROUNDOFF * point.abs();
    // Keep away from the edges, as on a triangle.
    let point = point + 4.0 * error.length() * solid.shape.off_the_edges(point, normal);
    to_world::<F>(Point { point, error, normal, smooth: None, lift: None }, placement)
}

/// The normal that the test of the solid found, in the space of the solid.
fn normal_of_solid<F: StudentFunctions>(
    tests: ShapeTests,
    ray: &Ray,
    hit: &Hit,
    solid: &Solid,
) -> Option<Vec3> {
    match hit.detail {
        Detail::Solid(normal) => Some(normal),
        _ => intersect_solid::<F>(tests, ray, solid).map(|hit| hit.normal),
    }
}

/// A point in the space of an object, transformed to the world with its error bound and its normals.
fn to_world<F: StudentFunctions>(own: Point, placement: &Placement) -> Point {
    let (up, down) = (placement.to_world.as_daffine3(), placement.to_object.as_daffine3());
    let point = up.transform_point3(own.point.as_dvec3()).as_vec3();
    // Measure the error of both transforms and of the rounded point: transform the point back and compare.
    let back = down.transform_point3(point.as_dvec3());
    let residue = (back - own.point.as_dvec3()).abs();
    // Add the rounding of a secondary ray, which is transformed back into the space of the object.
    let rounded = f64::from(UNIT_ROUNDOFF) * back.abs();
    let in_object = own.error.as_dvec3() + residue + 2.0 * rounded;
    // Transform the error bound to the world, with absolute values.
    let in_world = [up.matrix3.x_axis, up.matrix3.y_axis, up.matrix3.z_axis]
        .into_iter()
        .zip(in_object.to_array())
        .map(|(axis, reach)| axis.abs() * reach)
        .sum::<DVec3>();
    Point {
        point,
        error: in_world.as_vec3() + UNIT_ROUNDOFF * point.abs(),
        normal: F::normal_to_world(own.normal, &placement.to_object),
        smooth: own.smooth.map(|normal| F::normal_to_world(normal, &placement.to_object)),
        lift: own.lift.map(|lift| placement.to_world.transform_vector3(lift)),
    }
}

/// The texture coordinates of a hit at `point`, in world space; the middle of the image, `(0.5, 0.5)`, for
/// shapes without any. They may lie outside of `0..=1` on infinite planes and meshes. Panics if `hit` does
/// not belong to `world`.
pub fn texture_coordinates<F: StudentFunctions>(
    world: &World,
    tests: ShapeTests,
    ray: &Ray,
    hit: &Hit,
    point: Vec3,
) -> Vec2 {
    let middle = vec2(0.5, 0.5);
    match hit.target {
        Target::Plane(index) => {
            let (plane, axes) = plane_at::<F>(&world.planes[index as usize], ray.time);
            let along = |axis: Vec3| (point - plane.point).dot(axis) / axis.length_squared();
            vec2(along(axes[0]), along(axes[1]))
        }
        Target::Primitive(index) => {
            let primitive = &world.primitives[index as usize];
            if let Geometry::Solid(index) = primitive.geometry {
                let solid = &world.solids[index as usize];
                let own = solid.placement.to_object.transform_point3(point);
                let normal = normal_of_solid::<F>(tests, ray, hit, solid).unwrap_or(Vec3::Y);
                return solid.shape.texture_coordinates(own, normal);
            }
            let Some(image) = primitive.image.get() else { return middle };
            match geometry_at::<F>(world, primitive, ray.time) {
                Geometry::Sphere(sphere) => {
                    around_sphere(world.sphere_axes[image] * from_center(ray, hit.t, &sphere))
                }
                Geometry::Triangle(triangle) | Geometry::OneSided(triangle) => {
                    uv_on_triangle(world, image, barycentric::<F>(tests, ray, &triangle, hit.detail))
                }
                Geometry::Solid(_) | Geometry::Instance(_) => middle,
            }
        }
        Target::Instance(outer, inner) => {
            let (instance, primitive, _) = inside(world, outer, inner);
            match (primitive.image.get(), primitive.geometry.triangle()) {
                (Some(image), Some(triangle)) => {
                    let ray = F::ray_to_object(ray, &instance.placement.to_object);
                    uv_on_triangle(world, image, barycentric::<F>(tests, &ray, triangle, hit.detail))
                }
                _ => middle,
            }
        }
    }
}

/// Whether the texture coordinates of the hit are longitude and latitude.
pub fn is_sphere(world: &World, hit: &Hit) -> bool {
    let Target::Primitive(index) = hit.target else { return false };
    match world.primitives[index as usize].geometry {
        Geometry::Sphere(_) => true,
        Geometry::Solid(index) => matches!(world.solids[index as usize].shape, SolidShape::Sphere(_)),
        _ => false,
    }
}

fn uv_on_triangle(world: &World, image: usize, weights: Vec3) -> Vec2 {
    let [a, b, c] = world.uvs[image];
    weights.x * a + weights.y * b + weights.z * c
}
