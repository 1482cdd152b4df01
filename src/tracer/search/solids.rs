//! Shapes in spaces of their own: their hits with rays in world space, and their bounding boxes.

use super::intersection::ShapeTests;
use crate::aabb::Aabb;
use crate::graph::Placement;
use crate::kit::{SolidHit, StudentFunctions};
use crate::ray::Ray;
use crate::world::{Solid, SolidShape};

/// The hit of a ray in world space with a solid for `t_min < t < t_max`: its `t`, and the unit normal in the
/// space of the solid. `t` is the same in both spaces.
#[inline(never)]
pub fn intersect_solid<F: StudentFunctions>(tests: ShapeTests, ray: &Ray, solid: &Solid) -> Option<SolidHit> {
    let ray = &F::ray_to_object(ray, &solid.placement.to_object);
    match &solid.shape {
        SolidShape::Sphere(sphere) => {
            let t = tests.sphere::<F>(ray, sphere)?;
            Some(SolidHit { t, normal: F::sphere_normal(sphere.center, ray.at(t)) })
        }
        SolidShape::Cuboid(shape) => F::cuboid(ray, shape),
        SolidShape::Cylinder(shape) => F::cylinder(ray, shape),
        SolidShape::Cone(shape) => F::cone(ray, shape),
        SolidShape::Disk(shape) => F::disk(ray, shape),
        SolidShape::Polygon(shape) => F::polygon(ray, shape),
    }
}

/// The bounding box of a solid in world space, with room for rounding errors.
pub fn bounds_of_solid<F: StudentFunctions>(solid: &Solid) -> Aabb {
    let own = match &solid.shape {
        SolidShape::Sphere(sphere) => F::sphere_bounds(sphere),
        other => other.bounds(),
    };
    placed_bounds::<F>(&own, &solid.placement)
}

/// The bounding box in world space of an object whose bounding box in its own space is `bounds`.
///
/// The box is enlarged by a hundred-thousandth of its largest extent, because the direction of a ray is
/// rounded when it is transformed to the space of the object: that moves the ray by 6e-8 of its distance. The
/// margin is enough for rays from a distance of a hundred times the extent.
pub fn placed_bounds<F: StudentFunctions>(bounds: &Aabb, placement: &Placement) -> Aabb {
    let room = 1e-5 * (bounds.max - bounds.min).max_element().max(0.0);
    F::bounds_to_world(&placement.to_world, &Aabb::new(bounds.min - room, bounds.max + room))
}
