//! Shapes that stay what they are, each in a space of its own.

use crate::aabb::Aabb;
use crate::graph::Placement;
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Polygon, Shape, Sphere};
use glam::{Vec2, Vec3, vec2};
use std::f32::consts::{PI, TAU};

/// A shape that rays are carried to.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// The shape, in its own space.
    pub shape: SolidShape,
    /// Where it stands.
    pub placement: Placement,
}

/// What can be a [`Solid`].
#[derive(Clone, Debug, PartialEq)]
pub enum SolidShape {
    /// A sphere that its transform stretches.
    Ball(Sphere),
    /// A box.
    Cuboid(Cuboid),
    /// A closed cylinder.
    Cylinder(Cylinder),
    /// A closed cone.
    Cone(Cone),
    /// A disk.
    Disk(Disk),
    /// A convex polygon.
    Polygon(Polygon),
}

impl SolidShape {
    /// `shape`, if it is one of these; a sphere is.
    pub(super) fn of(shape: &Shape) -> Option<SolidShape> {
        Some(match shape {
            Shape::Sphere(ball) => SolidShape::Ball(*ball),
            Shape::Cuboid(cuboid) => SolidShape::Cuboid(*cuboid),
            Shape::Cylinder(cylinder) => SolidShape::Cylinder(*cylinder),
            Shape::Cone(cone) => SolidShape::Cone(*cone),
            Shape::Disk(disk) => SolidShape::Disk(*disk),
            Shape::Polygon(polygon) => SolidShape::Polygon(polygon.clone()),
            Shape::Plane(_) | Shape::Triangle(_) | Shape::Mesh(_) | Shape::Bezier { .. } => return None,
        })
    }

    /// A box around the shape, with room for its roundings.
    pub fn bounds(&self) -> Aabb {
        let shape = match self.clone() {
            SolidShape::Ball(ball) => Shape::Sphere(ball),
            SolidShape::Cuboid(cuboid) => Shape::Cuboid(cuboid),
            SolidShape::Cylinder(cylinder) => Shape::Cylinder(cylinder),
            SolidShape::Cone(cone) => Shape::Cone(cone),
            SolidShape::Disk(disk) => Shape::Disk(disk),
            SolidShape::Polygon(polygon) => Shape::Polygon(polygon),
        };
        let bounds = shape.bounds(&[]).unwrap_or(Aabb::EMPTY);
        // A radius times a root, added to a coordinate: three roundings, and one to spare.
        let room = 2.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs());
        Aabb::new(bounds.min - room, bounds.max + room)
    }

    /// Texture coordinates at a point of the surface: an image around a ball, one on each face of a box; the middle of the
    /// image for shapes that have none.
    pub fn texture_coordinates(&self, point: Vec3, normal: Vec3) -> Vec2 {
        match self {
            SolidShape::Ball(ball) => around_ball(point - ball.center),
            SolidShape::Cuboid(cuboid) => on_face(cuboid, point, normal),
            _ => vec2(0.5, 0.5),
        }
    }
}

/// Longitude and latitude of a direction, as an image wraps around a ball.
pub fn around_ball(direction: Vec3) -> Vec2 {
    let own = direction.normalize_or(Vec3::Y);
    vec2(0.5 + own.x.atan2(own.z) / TAU, 0.5 + own.y.clamp(-1.0, 1.0).asin() / PI)
}

/// The images of the side faces stand upright along y; those of top and bottom as if the box were tilted towards the
/// viewer at +z.
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
