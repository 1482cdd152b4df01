//! What the checks need per solid: the call, the exact answer, scaled copies, points inside and the extent along a
//! normal.

use super::mistakes::{self, Mistakes, WrongNormals};
use checks::prelude::*;
use oracle::exact::{Body, Meeting, meet, polygon::meet_fan};
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};
use std::fmt::Debug;

/// The mistakes in a query, each with whether it gives this answer. In the student's query, products of the direction and an axis
/// are so many times as large.
type OfAnswer<S> = fn(&SolidQuery<S>, Option<f32>, f64) -> Mistakes;

/// A solid that rays are tested against.
pub(super) trait Solid: checks::paste::Paste + Clone + Debug + Send + Sync + 'static {
    /// The function that students write.
    const NAME: &'static str;

    /// Whether the shape is flat, so that it has no inside.
    const FLAT: bool = false;

    /// The known mistakes that lose hits or find wrong ones.
    const MISTAKES: OfAnswer<Self>;

    /// The normals that known mistakes give at a point of the surface. They may have any length.
    const WRONG_NORMALS: fn(&Self, DVec3) -> WrongNormals = |_, _| Vec::new();

    /// Calls the function for all queries.
    fn ask(kit: &dyn Kit, queries: &[SolidQuery<Self>]) -> Vec<Option<SolidHit>>;

    /// The exact answer.
    fn meet(&self, ray: &Ray) -> Option<Meeting>;

    /// The `t` of the exact answer.
    fn first(&self, ray: &Ray) -> Option<f32> {
        self.meet(ray)?.t
    }

    /// The same shape with each point and each direction mapped, and its radius times `size`.
    fn mapped(&self, point: Map<'_>, direction: Map<'_>, size: f32) -> Self;

    /// A point inside.
    fn middle(&self) -> Vec3;

    /// The same shape, scaled by this factor around its middle.
    fn grown(&self, factor: f32) -> Self {
        let middle = self.middle();
        self.mapped(&|point| middle + factor * (point - middle), &|direction| direction, factor)
    }

    /// The same shape, scaled by this power of two around the origin, which is exact.
    fn scaled(&self, factor: f32) -> Self {
        self.mapped(&|point| factor * point, &|direction| factor * direction, factor)
    }

    /// The same shape with x, y and z exchanged in a circle, see [`turned`].
    fn turned(&self) -> Self {
        self.mapped(&turned, &turned, 1.0)
    }

    /// A point inside for each point of the cube from -1 to 1.
    fn inside(&self, at: Vec3) -> Vec3;

    /// The largest `normal · q` over all points `q` of the shape.
    fn reach(&self, normal: DVec3) -> f64;

    /// Random shapes of this kind whose coordinates have few bits.
    fn any() -> BoxedStrategy<Self>;
}

type Map<'a> = &'a dyn Fn(Vec3) -> Vec3;

/// The same point with x, y and z exchanged in a circle: x becomes y, y becomes z and z becomes x. This is a rotation.
pub(super) fn turned(v: Vec3) -> Vec3 {
    Vec3::new(v.z, v.x, v.y)
}

/// Shapes by a point, an axis and a radius. Directions of axes are on a grid, along the axes of the world, diagonal, and almost
/// parallel to an axis. A radius is half a unit to two units, in quarters.
fn around_axes<S: Debug + 'static>(shape: fn((Vec3, Vec3, f32)) -> S) -> BoxedStrategy<S> {
    let axis = prop_oneof![2 => direction(), 1 => nasty::unit().prop_map(|unit| 2.0 * unit)];
    (point(4), axis, fractions(2..=8, 4.0)).prop_map(shape).boxed()
}

/// The name of the student's function, the known mistakes in it, and how it is called.
macro_rules! asked {
    ($name:ident, $mistakes:ident) => {
        const NAME: &'static str = stringify!($name);
        const MISTAKES: OfAnswer<Self> = mistakes::$mistakes;

        fn ask(kit: &dyn Kit, queries: &[SolidQuery<Self>]) -> Vec<Option<SolidHit>> {
            kit.$name(queries)
        }
    };
}

/// The length of the part of a vector that is perpendicular to `axis`.
fn beside(vector: DVec3, axis: DVec3) -> f64 {
    vector.reject_from(axis.normalize()).length()
}

/// The point of a cylinder at the fraction `along` of its axis, and at `at` within its circle.
fn in_round(base: Vec3, axis: Vec3, radius: f32, along: f32, at: Vec3) -> Vec3 {
    let (x, y) = axis.normalize().any_orthonormal_pair();
    // Scale by 0.7 so that the square from -1 to 1 fits into the circle.
    base + along * axis + 0.7 * radius * (at.x * x + at.y * y)
}

impl Solid for Cuboid {
    asked!(cuboid, of_cuboid);
    const WRONG_NORMALS: fn(&Self, DVec3) -> WrongNormals = mistakes::normals_of_cuboid;

    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Cuboid(*self))
    }
    fn mapped(&self, point: Map<'_>, _: Map<'_>, _: f32) -> Self {
        Cuboid { min: point(self.min), max: point(self.max) }
    }

    fn middle(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        self.min + (0.5 + 0.45 * at) * (self.max - self.min)
    }
    fn reach(&self, normal: DVec3) -> f64 {
        (normal * self.min.as_dvec3()).max(normal * self.max.as_dvec3()).element_sum()
    }
    fn any() -> BoxedStrategy<Self> {
        (point(4), (1..=16i32, 1..=16i32, 1..=16i32))
            .prop_map(|(min, (x, y, z))| Cuboid {
                min,
                max: min + Vec3::new(x as f32, y as f32, z as f32) / 4.0,
            })
            .boxed()
    }
}

impl Solid for Cylinder {
    asked!(cylinder, of_cylinder);
    const WRONG_NORMALS: fn(&Self, DVec3) -> WrongNormals = mistakes::normals_of_cylinder;

    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Cylinder(*self))
    }
    fn mapped(&self, point: Map<'_>, _: Map<'_>, size: f32) -> Self {
        Cylinder { base: point(self.base), top: point(self.top), radius: size * self.radius }
    }

    fn middle(&self) -> Vec3 {
        0.5 * (self.base + self.top)
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        in_round(self.base, self.top - self.base, self.radius, 0.5 + 0.45 * at.z, at)
    }
    fn reach(&self, normal: DVec3) -> f64 {
        let (base, top) = (self.base.as_dvec3(), self.top.as_dvec3());
        normal.dot(base).max(normal.dot(top)) + f64::from(self.radius) * beside(normal, top - base)
    }
    fn any() -> BoxedStrategy<Self> {
        around_axes(|(base, axis, radius)| Cylinder { base, top: base + axis, radius })
    }
}

impl Solid for Cone {
    asked!(cone, of_cone);
    const WRONG_NORMALS: fn(&Self, DVec3) -> WrongNormals = mistakes::normals_of_cone;

    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Cone(*self))
    }
    fn mapped(&self, point: Map<'_>, _: Map<'_>, size: f32) -> Self {
        Cone { base: point(self.base), apex: point(self.apex), radius: size * self.radius }
    }

    fn middle(&self) -> Vec3 {
        self.base + 0.25 * (self.apex - self.base)
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        // Use a cylinder inside the cone, with less than half the height and less than half the radius.
        in_round(self.base, self.apex - self.base, 0.5 * self.radius, 0.25 + 0.2 * at.z, at)
    }
    fn reach(&self, normal: DVec3) -> f64 {
        let (base, apex) = (self.base.as_dvec3(), self.apex.as_dvec3());
        normal.dot(apex).max(normal.dot(base) + f64::from(self.radius) * beside(normal, apex - base))
    }
    fn any() -> BoxedStrategy<Self> {
        around_axes(|(base, axis, radius)| Cone { base, apex: base + axis, radius })
    }
}

impl Solid for Disk {
    asked!(disk, of_disk);
    const FLAT: bool = true;

    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Disk(*self))
    }
    fn mapped(&self, point: Map<'_>, direction: Map<'_>, size: f32) -> Self {
        // The normal of a disk may have any length.
        Disk { center: point(self.center), normal: direction(self.normal), radius: size * self.radius }
    }

    fn middle(&self) -> Vec3 {
        self.center
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        in_round(self.center, self.normal, self.radius, 0.0, at)
    }
    fn reach(&self, normal: DVec3) -> f64 {
        normal.dot(self.center.as_dvec3()) + f64::from(self.radius) * beside(normal, self.normal.as_dvec3())
    }
    fn any() -> BoxedStrategy<Self> {
        around_axes(|(center, normal, radius)| Disk { center, normal, radius })
    }
}

impl Solid for Polygon {
    asked!(polygon, of_polygon);
    const FLAT: bool = true;

    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet_fan(ray, self).map(|(meeting, _)| meeting)
    }
    fn mapped(&self, point: Map<'_>, _: Map<'_>, _: f32) -> Self {
        Polygon { corners: self.corners.iter().copied().map(point).collect() }
    }

    fn middle(&self) -> Vec3 {
        self.corners.iter().sum::<Vec3>() / self.corners.len() as f32
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        let corner = ((0.5 + 0.49 * at.x) * self.corners.len() as f32) as usize;
        self.middle().lerp(self.corners[corner], 0.9 * at.y.abs())
    }
    fn reach(&self, normal: DVec3) -> f64 {
        self.corners.iter().map(|corner| normal.dot(corner.as_dvec3())).fold(f64::NEG_INFINITY, f64::max)
    }
    fn any() -> BoxedStrategy<Self> {
        // Take three to seven corners of an octagon with coordinates in eighths, in the plane of two perpendicular
        // vectors.
        let octagon = [(8, 3), (3, 8), (-3, 8), (-8, 3), (-8, -3), (-3, -8), (3, -8), (8, -3)];
        let axes = prop_oneof![
            Just((Vec3::X, Vec3::Y)),
            Just((Vec3::Y, Vec3::Z)),
            Just((Vec3::Z, Vec3::X)),
            Just((Vec3::new(1.0, 2.0, 2.0), Vec3::new(2.0, 1.0, -2.0))),
            Just((Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.5, 1.0, -0.5))),
        ];
        (point(4), axes, prop::sample::subsequence(octagon.to_vec(), 3..=7), any::<bool>())
            .prop_map(|(center, (u, v), mut corners, backwards)| {
                if backwards {
                    corners.reverse();
                }
                let place = |&(x, y): &(i32, i32)| center + x as f32 / 8.0 * u + y as f32 / 8.0 * v;
                Polygon { corners: corners.iter().map(place).collect() }
            })
            .boxed()
    }
}
