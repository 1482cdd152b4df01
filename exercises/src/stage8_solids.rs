//! Stage 8 · solids: boxes, cylinders, cones, disks and polygons, each in its own space.
//!
//! Slides: "Ray-Box Intersection", "Other Ray-Primitive Intersections" (cone, cylinder: similar to sphere, must also
//! check end caps; convex polygon: same as triangle).
//!
//! A convex solid is the intersection of simpler convex sets: a box of three slabs, a cylinder of an infinite cylinder
//! and a slab. A line lies in each of them for one interval of `t`, so it lies in the solid where all intervals
//! overlap, and no end cap needs a test of its own. The first end of the overlap in the ray's range is the hit.
//!
//! All functions have the same contract. `t` counts lengths of the direction, which may have any length but 0. A hit
//! counts if [`Ray::contains`] accepts its `t`. From inside a solid the hit is the point where the ray leaves. The
//! normal has unit length and points out of the solid; at edges, rims and tips each of the possible normals is right.
//! The result is `None` for a ray or shape with NaN or infinite coordinates, and for a direction of 0. Otherwise radii
//! are above 0, axes and normals have any length but 0, and `min` is not above `max`: nothing else is asked.

use glam::{DVec3, Vec3};
use raykata::kit::SolidHit;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};

/// Intersects a ray with a solid box: returns the nearest point of its surface in the ray's range. Faces, edges and
/// corners belong to the box, which may be flat (`min` equal to `max` on an axis). The normal is that of the face that
/// is hit.
///
/// Pitfall: the slide's "check front-facing sides" loses every ray that starts inside. A rounded point on one face can
/// lie outside of the face's edges, so a test of points loses rays at edges. Intersect three intervals instead.
pub fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Option<SolidHit> {
    todo!("intersect the intervals of the three axes; the first end in the ray's range is the hit")
}

/// Intersects a ray with a cylinder whose ends are closed: returns the nearest point of side or ends in the ray's
/// range. Side, ends and rims belong to the cylinder, and a ray that only touches the side hits it.
///
/// With the axis `A` from base to top and the moment `L = (o - base) × d`, the line passes the axis at the distance
/// `|A·L| / |d × A|`, so the discriminant of the infinite cylinder is `|d × A|² r² - (A·L)²`.
///
/// Pitfall: the slide's "similar to sphere" is not enough. For a ray parallel to the axis, `a = |d × A|²` is 0, and 0/0
/// is NaN. Caps that are tested as separate disks leak at the rim.
pub fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<SolidHit> {
    todo!("intersect the interval between the ends with the interval in the infinite cylinder")
}

/// Intersects a ray with a cone whose base is closed: returns the nearest point of side or base in the ray's range. Side,
/// base, rim and apex belong to the cone.
///
/// With the axis `A` from apex to base and the moment `L = (o - apex) × d`, the discriminant of the double cone
/// `|x × A|² ≤ k (x·A)²`, `k = r²/|A|²`, is `|A|² (k |A × L|² - (A·L)²)`.
///
/// Pitfall: the equation describes two cones, apex to apex, and a ray that passes above the apex meets the second cone.
/// For a ray parallel to the side `a` is 0. For a steeper ray `a` is negative, and the ray is inside *beyond* the
/// roots, not between them.
pub fn cone(ray: &Ray, cone: &Cone) -> Option<SolidHit> {
    todo!("intersect the interval between apex and base with the interval in the right one of the cones")
}

/// Intersects a ray with a flat disk, from both sides. The rim belongs to the disk. The normal is `disk.normal` as a
/// unit vector, also if the ray comes from the other side. The result is `None` for a radius that is NaN, and for a ray
/// parallel to the disk.
///
/// Pitfall: `t` is infinite or NaN for a ray parallel to the disk. Write comparisons that are false for NaN.
pub fn disk(ray: &Ray, disk: &Disk) -> Option<SolidHit> {
    todo!("intersect the plane of the disk, then compare the distance from the centre with the radius")
}

/// Intersects a ray with a flat convex polygon, from both sides. Edges and corners belong to the polygon, and three
/// corners may lie on a line. The normal points to the side from which the corners run anticlockwise, also if the ray
/// comes from the other side. A ray in the plane of the polygon does not hit it.
///
/// Pitfall: a point on the plane is rounded, and near an edge this rounding decides. Test on which side of each edge
/// the ray passes instead: the sign of `d · (p × q)` for the ends `p` and `q` of the edge relative to the ray's origin.
/// A neighbouring polygon computes the same value for the shared edge, up to the sign, so no ray passes between them.
/// Corners that rounding moved off their plane have no common plane: near its rim such a polygon differs from the triangles
/// of its fan.
pub fn polygon(ray: &Ray, polygon: &Polygon) -> Option<SolidHit> {
    todo!("test that the ray passes all edges on the same side; take t from the polygon's plane")
}
