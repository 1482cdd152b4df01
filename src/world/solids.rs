//! Shapes that are not made of triangles: each is tested in a space of its own.

use crate::aabb::Aabb;
use crate::graph::Placement;
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Polygon, Shape, Sphere, around_sphere};
use glam::{Vec2, Vec3, vec2};

/// A shape in a space of its own, into which rays are transformed before they are tested (stage 8).
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// The shape, in its own space and as the scene file describes it.
    pub shape: SolidShape,
    /// The transforms from the space of the shape to the world and back.
    pub placement: Placement,
}

/// The shapes that can be a [`Solid`].
#[derive(Clone, Debug, PartialEq)]
pub enum SolidShape {
    /// A sphere; in the world its transform makes it an ellipsoid.
    Sphere(Sphere),
    /// A box with faces along the axes of its own space.
    Cuboid(Cuboid),
    /// A cylinder, closed by a disk at either end.
    Cylinder(Cylinder),
    /// A cone, closed by a disk at its base.
    Cone(Cone),
    /// A flat disk, which has no inside.
    Disk(Disk),
    /// A flat convex polygon, which has no inside.
    Polygon(Polygon),
}

impl SolidShape {
    /// The solid of `shape`; `None` for infinite planes, triangles, meshes and curved surfaces.
    pub(super) fn of(shape: &Shape) -> Option<SolidShape> {
        Some(match shape {
            Shape::Sphere(sphere) => SolidShape::Sphere(*sphere),
            Shape::Cuboid(cuboid) => SolidShape::Cuboid(*cuboid),
            Shape::Cylinder(cylinder) => SolidShape::Cylinder(*cylinder),
            Shape::Cone(cone) => SolidShape::Cone(*cone),
            Shape::Disk(disk) => SolidShape::Disk(*disk),
            Shape::Polygon(polygon) => SolidShape::Polygon(polygon.clone()),
            Shape::Plane(_)
            | Shape::PlaneEquation(_)
            | Shape::Triangle(_)
            | Shape::Mesh(_)
            | Shape::Bezier { .. }
            | Shape::Nurbs { .. } => return None,
        })
    }

    /// The direction along the surface, at a `point` with a `normal`, that leads away from the edges of the shape: along each
    /// axis of a box -1, 0 or 1, and otherwise of unit length or zero.
    pub fn off_the_edges(&self, point: Vec3, normal: Vec3) -> Vec3 {
        let along = |to_middle: Vec3| {
            let (to_middle, n) = (to_middle.as_dvec3(), normal.as_dvec3());
            (to_middle - to_middle.dot(n) / n.length_squared() * n).normalize_or_zero().as_vec3()
        };
        match self {
            SolidShape::Sphere(_) => Vec3::ZERO,
            SolidShape::Cuboid(cuboid) => {
                let to_middle = 0.5 * cuboid.min + 0.5 * cuboid.max - point;
                let across = normal.abs().max_position();
                let mut direction = to_middle.signum();
                direction[across] = 0.0;
                direction
            }
            SolidShape::Cylinder(cylinder) => along(0.5 * cylinder.base + 0.5 * cylinder.top - point),
            SolidShape::Cone(cone) => along(0.5 * cone.base + 0.5 * cone.apex - point),
            SolidShape::Disk(disk) => along(disk.center - point),
            SolidShape::Polygon(polygon) => {
                let count = polygon.corners.len() as f32;
                along(polygon.corners.iter().map(|&corner| (corner - point) / count).sum())
            }
        }
    }

    /// A box around the shape in its own space, a few roundings larger than the exact one on each side, so
    /// that it loses no point of the shape.
    pub fn bounds(&self) -> Aabb {
        let shape = match self.clone() {
            SolidShape::Sphere(sphere) => Shape::Sphere(sphere),
            SolidShape::Cuboid(cuboid) => Shape::Cuboid(cuboid),
            SolidShape::Cylinder(cylinder) => Shape::Cylinder(cylinder),
            SolidShape::Cone(cone) => Shape::Cone(cone),
            SolidShape::Disk(disk) => Shape::Disk(disk),
            SolidShape::Polygon(polygon) => Shape::Polygon(polygon),
        };
        let bounds = shape.bounds(&[]).unwrap_or(Aabb::EMPTY);
        // Enlarge by four roundings: three for a radius times a root plus a coordinate, and one in reserve.
        let room = 2.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs());
        Aabb::new(bounds.min - room, bounds.max + room)
    }

    /// Texture coordinates at `point` of the surface, whose normal is `normal`, both in the space of the
    /// shape; the result lies in `0..=1` along u and v.
    ///
    /// A sphere has an image around it, as in [`around_sphere`]. A box has the whole image on each face. A
    /// coordinate of `point` that is not finite, or along which the box is flat, counts as the middle of the
    /// face. Other shapes show the middle of the image, `(0.5, 0.5)`.
    pub fn texture_coordinates(&self, point: Vec3, normal: Vec3) -> Vec2 {
        match self {
            SolidShape::Sphere(sphere) => around_sphere(point - sphere.center),
            SolidShape::Cuboid(cuboid) => on_face(cuboid, point, normal),
            _ => vec2(0.5, 0.5),
        }
    }
}

/// The images of the side faces stand upright along y; those of top and bottom as if the box were tilted
/// towards a viewer at +z.
fn on_face(cuboid: &Cuboid, point: Vec3, normal: Vec3) -> Vec2 {
    let share = (point - cuboid.min) / (cuboid.max - cuboid.min);
    let share = share.map(|share| if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 });
    let up = |side: f32, there: f32| if side > 0.0 { there } else { 1.0 - there };
    let along = normal.abs();
    match () {
        () if along.z >= along.x && along.z >= along.y => vec2(up(normal.z, share.x), share.y),
        () if along.y >= along.x => vec2(share.x, up(-normal.y, share.z)),
        () => vec2(up(-normal.x, share.z), share.y),
    }
}
