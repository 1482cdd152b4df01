//! Shapes in spaces of their own: where a ray of the world meets one, and a box around it.

use super::intersection::ShapeTests;
use crate::aabb::Aabb;
use crate::graph::Placement;
use crate::kit::{SolidHit, StudentFunctions};
use crate::ray::Ray;
use crate::world::{Solid, SolidShape};

/// Where a ray of the world meets a solid, with the normal in the space of the solid.
#[inline(never)]
pub fn intersect_solid<F: StudentFunctions>(tests: ShapeTests, ray: &Ray, solid: &Solid) -> Option<SolidHit> {
    let ray = &F::ray_to_object(ray, &solid.placement.to_object);
    match &solid.shape {
        SolidShape::Ball(ball) => {
            let t = tests.sphere::<F>(ray, ball)?;
            Some(SolidHit { t, normal: F::sphere_normal(ball.center, ray.at(t)) })
        }
        SolidShape::Cuboid(shape) => F::cuboid(ray, shape),
        SolidShape::Cylinder(shape) => F::cylinder(ray, shape),
        SolidShape::Cone(shape) => F::cone(ray, shape),
        SolidShape::Disk(shape) => F::disk(ray, shape),
        SolidShape::Polygon(shape) => F::polygon(ray, shape),
    }
}

/// The box in the world around a solid.
pub fn bounds_of_solid<F: StudentFunctions>(solid: &Solid) -> Aabb {
    let own = match &solid.shape {
        SolidShape::Ball(ball) => F::sphere_bounds(ball),
        other => other.bounds(),
    };
    placed_bounds::<F>(&own, &solid.placement)
}

/// The box in the world around what has the box `bounds` in its own space.
///
/// A ray that is carried there is rounded, and with it where it passes: by a step of its direction, or 6e-8 of its way. A
/// hundred-thousandth of the size is enough for rays from a hundred sizes away.
pub fn placed_bounds<F: StudentFunctions>(bounds: &Aabb, placement: &Placement) -> Aabb {
    let room = 1e-5 * (bounds.max - bounds.min).max_element().max(0.0);
    F::bounds_to_world(&placement.to_world, &Aabb::new(bounds.min - room, bounds.max + room))
}
