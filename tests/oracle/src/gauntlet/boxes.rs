//! Rays at boxes.

use crate::splitmix::Random;
use glam::{BVec3, Vec3};
use raykata::aabb::Aabb;
use raykata::kit::SlabQuery;
use raykata::ray::Ray;

/// A ray at the corner of a box. The box is small or large, near or far, sometimes flat; the direction may
/// have zeros.
pub fn at_a_corner(random: &mut Random) -> Option<SlabQuery> {
    let place = [Vec3::ZERO, Vec3::ONE, Vec3::splat(1e5)][random.below(3) as usize];
    let size = [1.0, 1e-3, 1e3][random.below(3) as usize];
    let (p, mut q) = (place + size * random.in_cube(), place + size * random.in_cube());
    if random.below(4) == 0 {
        let axis = random.below(3) as usize;
        q[axis] = p[axis];
    }
    let bounds = Aabb::new(p.min(q), p.max(q));
    let low = BVec3::from_array([(); 3].map(|()| random.below(2) == 0));
    let corner = Vec3::select(low, bounds.min, bounds.max);
    let mut origin = place + 4.0 * size * random.in_cube();
    if random.below(4) == 0 {
        let axis = random.below(3) as usize;
        origin[axis] = corner[axis];
    }
    let mut direction = corner - origin;
    if random.below(2) == 0 {
        // -0.0 is a zero as well.
        direction = Vec3::select(direction.cmpeq(Vec3::ZERO), Vec3::splat(-0.0), direction);
    }
    (direction != Vec3::ZERO).then(|| SlabQuery { ray: Ray::new(origin, direction), bounds })
}
