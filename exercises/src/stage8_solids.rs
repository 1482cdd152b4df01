//! Stage 8 · solids: boxes, cylinders, cones, disks and polygons, each in its own space.
//!
//! Slides: "Ray-Box Intersection", "Other Ray-Primitive Intersections" (cone, cylinder: similar to sphere, must also check
//! end caps; convex polygon: same as triangle).
//!
//! A convex solid is what several simpler sets have in common: a box is three slabs, a cylinder an infinite cylinder and a
//! slab. A line is in each of them for one interval of `t`, so it is in the solid where all intervals overlap, and there is
//! no cap to be forgotten. The first end of the overlap in the range of the ray is the hit.

use glam::{DVec3, Vec3};
use raykata::kit::SolidHit;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};

/// Ray against a solid box: the nearest point of its surface within the range of the ray. From inside that is where the
/// ray leaves. The box may be flat.
///
/// Where the formula lies: "check front-facing sides" loses every ray that starts inside, and a point computed on one face
/// is tested against the others' edges with its rounding, so rays at edges are lost. Cut three intervals instead.
pub fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Option<SolidHit> {
    todo!("cut the intervals of the three axes; the first end in the range of the ray is the hit")
}

/// Ray against a cylinder with both ends closed.
///
/// With the axis `A` from base to top and the moment `L = (o - base) × d`, the line passes the axis at the distance
/// `|A·L| / |d × A|`, so the discriminant of the infinite cylinder is `|d × A|² r² - (A·L)²`.
///
/// Where the formula lies: "similar to sphere": for a ray along the axis `a = |d × A|²` is 0, and 0/0 is NaN. And caps
/// tested as disks on their own leak at the rim.
pub fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<SolidHit> {
    todo!("cut the interval between the caps and the interval in the infinite cylinder")
}

/// Ray against a cone with its base closed.
///
/// With the axis `A` from apex to base and the moment `L = (o - apex) × d`, the discriminant of the double cone
/// `|x × A|² ≤ k (x·A)²`, `k = r²/|A|²`, is `|A|² (k |A × L|² - (A·L)²)`.
///
/// Where the formula lies: the equation describes two cones, tip to tip, and a ray that passes above the tip meets the
/// mirror image. A ray along the side makes `a` 0, and one steeper than the side makes it negative: then it is inside
/// *outside* of the roots.
pub fn cone(ray: &Ray, cone: &Cone) -> Option<SolidHit> {
    todo!("cut the interval between tip and base and the interval in the right one of the two cones")
}

/// Ray against a flat disk, from either side. The rim belongs to it.
pub fn disk(ray: &Ray, disk: &Disk) -> Option<SolidHit> {
    todo!("meet the plane of the disk, then compare the distance to the centre with the radius")
}

/// Ray against a flat convex polygon, from either side. Edges and corners belong to it.
///
/// Where the formula lies: a point on the plane is rounded, and the rounding decides at the edges. Ask on which side of each
/// edge the ray passes, `d · (p × q)` for its ends `p` and `q` as seen from the origin, and a neighbour agrees.
pub fn polygon(ray: &Ray, polygon: &Polygon) -> Option<SolidHit> {
    todo!("the ray must pass all edges on the same side; t comes from the plane of the polygon")
}
