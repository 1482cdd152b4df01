//! Stage 8 · solids: boxes, cylinders, cones, disks and polygons, each in its own space.
//!
//! Slides: `slides/stage08.md`.
//!
//! A convex solid is the intersection of simpler convex sets: a box of three slabs, a cylinder of
//! an infinite cylinder and a slab. A line lies in each of them for one interval of `t`, so it lies
//! in the solid where all intervals overlap, and no end cap needs a test of its own. The first end
//! of the overlap in the ray's range is the hit.
//!
//! All functions have the same contract. `t` counts lengths of the direction, which may have any
//! length but 0. A hit counts if [`Ray::contains`] accepts its `t`. From inside a solid the hit is
//! the point where the ray leaves. The normal has unit length and points out of the solid; at
//! edges, rims and tips each of the possible normals is right. Radii are above 0, axes and normals
//! have any length but 0, and `min` is not above `max`: nothing else is asked.

use glam::DVec3;
use raykata::kit::SolidHit;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};

/// A ray is in a box where its intervals in the three slabs overlap:
///
/// ```text
/// x     ├──────────┤
/// y  ├─────────┤
/// z       ├───────────┤
/// box     ├────┤         → t
/// ```
///
/// What if it starts inside? And what is 0/0, for a ray in the plane of a face?
///
/// Faces, edges and corners belong to the box, which may be flat (`min` equal to `max` on an axis).
/// The normal is that of the face that is hit.
pub fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Option<SolidHit> {
    todo!("intersect the intervals of the three axes; the first end in the ray's range is the hit")
}

/// A ray hits a closed cylinder where its intervals in the infinite cylinder and between the end
/// planes overlap. With `A` from base to top and `L = (o - base) × d`, the discriminant is
/// `|d × A|² r² - (A·L)²`. What is `a = |d × A|²` for a ray along the axis?
///
/// Side, ends and rims belong to the cylinder; a ray that only touches the side hits it.
pub fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<SolidHit> {
    todo!("intersect the interval between the ends with the interval in the infinite cylinder")
}

/// A closed cone is the part of a double cone between apex and base:
///
/// ```text
/// \ /
///  •  apex
/// /_\ base
/// ```
///
/// With `x` from the apex, `A` from apex to base and `k = r²/|A|²`, it is `|x × A|² ≤ k (x·A)²`;
/// the discriminant is `|A|² (k |A × L|² - (A·L)²)`, `L = (o - apex) × d`. What if `a < 0`?
///
/// Side, base, rim and apex belong to the cone.
pub fn cone(ray: &Ray, cone: &Cone) -> Option<SolidHit> {
    todo!("intersect the interval between apex and base with the interval in the right one of the cones")
}

/// A ray hits a flat disk, from both sides, if it meets the disk's plane at most the radius away
/// from the centre. What is this `t` for a ray parallel to the disk?
///
/// The rim belongs to the disk. The normal is `disk.normal` as a unit vector on both sides. The
/// result is `None` for a ray parallel to the disk.
pub fn disk(ray: &Ray, disk: &Disk) -> Option<SolidHit> {
    todo!("intersect the plane of the disk, then compare the distance from the centre with the radius")
}

/// A ray hits a flat convex polygon, from both sides, if it passes all edges on the same side: the
/// sign of `d · (p × q)`, for the ends of an edge relative to the ray's origin. Which number does
/// the neighbour at this edge compute? If rounding moved corners off their plane, the triangles of
/// a fan may give other hits near the rim.
///
/// Exactly:
///
/// 1. Edges and corners belong to the polygon; three corners may lie on a line.
/// 2. The normal points to the side from which the corners run anticlockwise, also for rays from
///    behind.
/// 3. A ray in its plane misses it.
/// 4. No ray passes between two polygons that share an edge.
pub fn polygon(ray: &Ray, polygon: &Polygon) -> Option<SolidHit> {
    todo!("test that the ray passes all edges on the same side; take t from the polygon's plane")
}
