//! Nothing to do here: what stands in a space of its own, through the functions of stage 8.

use crate::shape_tests::ShapeTests;
use crate::stage8_scene_graph::{bounds_to_world, normal_to_world, ray_to_object};
use crate::stage8_solids::{cone, cuboid, cylinder, disk, polygon};
use crate::surfaces::{Found, point_on_sphere};
use crate::{stage1_shapes, stage3_bvh};
use glam::{DVec3, Vec3};
use raykata::aabb::Aabb;
use raykata::graph::Placement;
use raykata::kit::SolidHit;
use raykata::ray::Ray;
use raykata::world::{Solid, SolidShape};

/// Where a ray of the world meets a solid.
#[inline(never)]
pub fn meet_solid(tests: ShapeTests, ray: &Ray, solid: &Solid) -> Option<SolidHit> {
    meet(tests, &ray_to_object(ray, &solid.placement.to_object), &solid.shape)
}

fn meet(tests: ShapeTests, ray: &Ray, shape: &SolidShape) -> Option<SolidHit> {
    match shape {
        SolidShape::Ball(ball) => {
            let t = tests.sphere(ray, ball)?;
            Some(SolidHit { t, normal: stage1_shapes::sphere_normal(ball.center, ray.at(t)) })
        }
        SolidShape::Cuboid(shape) => cuboid(ray, shape),
        SolidShape::Cylinder(shape) => cylinder(ray, shape),
        SolidShape::Cone(shape) => cone(ray, shape),
        SolidShape::Disk(shape) => disk(ray, shape),
        SolidShape::Polygon(shape) => polygon(ray, shape),
    }
}

/// The point at `t` of a solid, with its normal in the world.
#[cold]
pub fn point_on_solid(tests: ShapeTests, ray: &Ray, t: f32, solid: &Solid) -> Found {
    let placement = &solid.placement;
    let ray = ray_to_object(ray, &placement.to_object);
    if let SolidShape::Ball(ball) = &solid.shape {
        return to_world(point_on_sphere(&ray, t, ball), placement);
    }
    let normal = meet(tests, &ray, &solid.shape).map_or(-ray.dir.normalize_or(Vec3::Z), |hit| hit.normal);
    let point = ray.at(t);
    // The rounding of t moves the point along the ray, and the sum and the product are rounded as well; twice that for
    // tests that are not in double.
    let error = 4.0 * HALF_STEP * (t * ray.dir).abs() + 2.0 * HALF_STEP * point.abs();
    to_world(Found { point, error, normal, smooth: None }, placement)
}

/// Half the distance between 1 and the next number: what rounding takes at most.
const HALF_STEP: f32 = f32::EPSILON / 2.0;

/// What was found in the space of an object, in the world.
pub fn to_world(found: Found, placement: &Placement) -> Found {
    let (up, down) = (placement.to_world.as_daffine3(), placement.to_object.as_daffine3());
    let point = up.transform_point3(found.point.as_dvec3()).as_vec3();
    // How far from the found point a ray would start that is carried back: what both transforms and the rounding of the
    // point add up to, measured and not estimated.
    let back = down.transform_point3(point.as_dvec3());
    let residue = (back - found.point.as_dvec3()).abs();
    // A ray that goes on from here is carried back and rounded, too.
    let rounded = f64::from(HALF_STEP) * back.abs();
    let in_object = found.error.as_dvec3() + residue + 2.0 * rounded;
    let in_world = [up.matrix3.x_axis, up.matrix3.y_axis, up.matrix3.z_axis]
        .into_iter()
        .zip(in_object.to_array())
        .map(|(axis, reach)| axis.abs() * reach)
        .sum::<DVec3>();
    Found {
        point,
        error: in_world.as_vec3() + HALF_STEP * point.abs(),
        normal: normal_to_world(found.normal, &placement.to_object),
        smooth: found.smooth.map(|normal| normal_to_world(normal, &placement.to_object)),
    }
}

/// The box in the world around what has the box `bounds` in its own space.
///
/// A ray that is carried there is rounded, and with it where it passes: by a step of its direction, or 6e-8 of its way. A
/// hundred-thousandth of the size is enough for rays from a hundred sizes away.
pub fn placed_bounds(bounds: &Aabb, placement: &Placement) -> Aabb {
    let room = 1e-5 * (bounds.max - bounds.min).max_element().max(0.0);
    bounds_to_world(&placement.to_world, &Aabb::new(bounds.min - room, bounds.max + room))
}

/// The box around a shape in its own space.
pub fn bounds_of_shape(shape: &SolidShape) -> Aabb {
    match shape {
        SolidShape::Ball(ball) => stage3_bvh::sphere_bounds(ball),
        other => other.bounds(),
    }
}
