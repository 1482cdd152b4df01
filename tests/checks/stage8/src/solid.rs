//! What the checks need per solid: the call, the exact answer, scaled copies, points inside and the extent along a
//! normal.

use super::mistakes::{self, Mistakes, WrongNormals};
use checks::generate::{direction, fractions, point};
use checks::nasty;
use glam::{DVec3, Vec3};
use oracle::exact::{Body, Meeting, meet, polygon::meet_fan};
use proptest::prelude::*;
use raykata::kit::{Kit, SolidHit, SolidQuery};
use raykata::ray::Ray;
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

    /// The same shape, scaled by this factor around a point inside.
    fn grown(&self, factor: f32) -> Self;

    /// The same shape, scaled by this power of two around the origin, which is exact.
    fn scaled(&self, factor: f32) -> Self;

    /// The same shape with x, y and z exchanged in a circle, see [`turned`].
    fn turned(&self) -> Self;

    /// A point inside for each point of the cube from -1 to 1.
    fn inside(&self, at: Vec3) -> Vec3;

    /// The largest `normal · q` over all points `q` of the shape.
    fn reach(&self, normal: DVec3) -> f64;

    /// Random shapes of this kind whose coordinates have few bits.
    fn any() -> BoxedStrategy<Self>;
}

/// The same point with x, y and z exchanged in a circle: x becomes y, y becomes z and z becomes x. This is a rotation.
pub(super) fn turned(v: Vec3) -> Vec3 {
    Vec3::new(v.z, v.x, v.y)
}

fn around(center: Vec3, factor: f32) -> impl Fn(Vec3) -> Vec3 {
    move |point| center + factor * (point - center)
}

/// Directions of axes: on a grid, along the axes of the world, diagonal, and almost parallel to an axis.
fn axis() -> impl Strategy<Value = Vec3> + Clone {
    prop_oneof![2 => direction(), 1 => nasty::unit().prop_map(|unit| 2.0 * unit)]
}

/// Half a unit to two units, in quarters.
fn radius() -> impl Strategy<Value = f32> + Clone {
    fractions(2..=8, 4.0)
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
    const NAME: &'static str = "cuboid";
    const MISTAKES: OfAnswer<Self> = mistakes::of_cuboid;
    const WRONG_NORMALS: fn(&Self, DVec3) -> WrongNormals = mistakes::normals_of_cuboid;

    fn ask(kit: &dyn Kit, queries: &[SolidQuery<Self>]) -> Vec<Option<SolidHit>> {
        kit.cuboid(queries)
    }
    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Cuboid(*self))
    }
    fn grown(&self, factor: f32) -> Self {
        let place = around(0.5 * (self.min + self.max), factor);
        Cuboid { min: place(self.min), max: place(self.max) }
    }
    fn scaled(&self, factor: f32) -> Self {
        Cuboid { min: factor * self.min, max: factor * self.max }
    }
    fn turned(&self) -> Self {
        Cuboid { min: turned(self.min), max: turned(self.max) }
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
    const NAME: &'static str = "cylinder";
    const MISTAKES: OfAnswer<Self> = mistakes::of_cylinder;
    const WRONG_NORMALS: fn(&Self, DVec3) -> WrongNormals = mistakes::normals_of_cylinder;

    fn ask(kit: &dyn Kit, queries: &[SolidQuery<Self>]) -> Vec<Option<SolidHit>> {
        kit.cylinder(queries)
    }
    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Cylinder(*self))
    }
    fn grown(&self, factor: f32) -> Self {
        let place = around(0.5 * (self.base + self.top), factor);
        Cylinder { base: place(self.base), top: place(self.top), radius: factor * self.radius }
    }
    fn scaled(&self, factor: f32) -> Self {
        Cylinder { base: factor * self.base, top: factor * self.top, radius: factor * self.radius }
    }
    fn turned(&self) -> Self {
        Cylinder { base: turned(self.base), top: turned(self.top), radius: self.radius }
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        in_round(self.base, self.top - self.base, self.radius, 0.5 + 0.45 * at.z, at)
    }
    fn reach(&self, normal: DVec3) -> f64 {
        let (base, top) = (self.base.as_dvec3(), self.top.as_dvec3());
        normal.dot(base).max(normal.dot(top)) + f64::from(self.radius) * beside(normal, top - base)
    }
    fn any() -> BoxedStrategy<Self> {
        (point(4), axis(), radius())
            .prop_map(|(base, axis, radius)| Cylinder { base, top: base + axis, radius })
            .boxed()
    }
}

impl Solid for Cone {
    const NAME: &'static str = "cone";
    const MISTAKES: OfAnswer<Self> = mistakes::of_cone;
    const WRONG_NORMALS: fn(&Self, DVec3) -> WrongNormals = mistakes::normals_of_cone;

    fn ask(kit: &dyn Kit, queries: &[SolidQuery<Self>]) -> Vec<Option<SolidHit>> {
        kit.cone(queries)
    }
    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Cone(*self))
    }
    fn grown(&self, factor: f32) -> Self {
        let place = around(self.base + 0.25 * (self.apex - self.base), factor);
        Cone { base: place(self.base), apex: place(self.apex), radius: factor * self.radius }
    }
    fn scaled(&self, factor: f32) -> Self {
        Cone { base: factor * self.base, apex: factor * self.apex, radius: factor * self.radius }
    }
    fn turned(&self) -> Self {
        Cone { base: turned(self.base), apex: turned(self.apex), radius: self.radius }
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
        (point(4), axis(), radius())
            .prop_map(|(base, axis, radius)| Cone { base, apex: base + axis, radius })
            .boxed()
    }
}

impl Solid for Disk {
    const NAME: &'static str = "disk";
    const MISTAKES: OfAnswer<Self> = mistakes::of_disk;
    const FLAT: bool = true;

    fn ask(kit: &dyn Kit, queries: &[SolidQuery<Self>]) -> Vec<Option<SolidHit>> {
        kit.disk(queries)
    }
    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet(ray, Body::Disk(*self))
    }
    fn grown(&self, factor: f32) -> Self {
        Disk { radius: factor * self.radius, ..*self }
    }
    fn scaled(&self, factor: f32) -> Self {
        // The normal of a disk may have any length, so scale it as well.
        Disk { center: factor * self.center, normal: factor * self.normal, radius: factor * self.radius }
    }
    fn turned(&self) -> Self {
        Disk { center: turned(self.center), normal: turned(self.normal), radius: self.radius }
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        in_round(self.center, self.normal, self.radius, 0.0, at)
    }
    fn reach(&self, normal: DVec3) -> f64 {
        normal.dot(self.center.as_dvec3()) + f64::from(self.radius) * beside(normal, self.normal.as_dvec3())
    }
    fn any() -> BoxedStrategy<Self> {
        (point(4), axis(), radius())
            .prop_map(|(center, normal, radius)| Disk { center, normal, radius })
            .boxed()
    }
}

impl Solid for Polygon {
    const NAME: &'static str = "polygon";
    const MISTAKES: OfAnswer<Self> = mistakes::of_polygon;
    const FLAT: bool = true;

    fn ask(kit: &dyn Kit, queries: &[SolidQuery<Self>]) -> Vec<Option<SolidHit>> {
        kit.polygon(queries)
    }
    fn meet(&self, ray: &Ray) -> Option<Meeting> {
        meet_fan(ray, self).map(|(meeting, _)| meeting)
    }
    fn grown(&self, factor: f32) -> Self {
        let middle = self.corners.iter().sum::<Vec3>() / self.corners.len() as f32;
        Polygon { corners: self.corners.iter().copied().map(around(middle, factor)).collect() }
    }
    fn scaled(&self, factor: f32) -> Self {
        Polygon { corners: self.corners.iter().map(|corner| factor * corner).collect() }
    }
    fn turned(&self) -> Self {
        Polygon { corners: self.corners.iter().copied().map(turned).collect() }
    }
    fn inside(&self, at: Vec3) -> Vec3 {
        let middle = self.corners.iter().sum::<Vec3>() / self.corners.len() as f32;
        let corner = ((0.5 + 0.49 * at.x) * self.corners.len() as f32) as usize;
        middle.lerp(self.corners[corner], 0.9 * at.y.abs())
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
