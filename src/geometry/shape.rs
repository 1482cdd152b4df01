//! Shapes as data: sizes and positions. How a ray intersects them is an exercise. The world units of a shape
//! that a node of a scene contains are those of the node's space.

use crate::aabb::{Aabb, bounds_of_points};
use crate::mesh::SceneMesh;
use crate::message;
use glam::{DVec3, Vec2, Vec3, vec2};
use std::f32::consts::{PI, TAU};

/// A sphere: all points at the distance `radius` from `center`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre, in world units.
    pub center: Vec3,
    /// The radius in world units, above 0.
    pub radius: f32,
}

message! { Sphere { center, radius } }

/// An infinite plane through `point`, perpendicular to `normal`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of the plane, in world units.
    pub point: Vec3,
    /// A normal of the plane, of any length but zero.
    pub normal: Vec3,
}

message! { Plane { point, normal } }

/// An infinite plane as an equation: all points `(x, y, z)` with `A x + B y + C z + D = 0`.
///
/// All four coefficients times the same factor other than 0 give the same plane; a negative factor turns its
/// normal to the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneEquation {
    /// `(A, B, C)`, a normal of the plane, of any length but zero.
    pub normal: Vec3,
    /// `D`: minus the distance of the plane from the origin along the normal in world units, times the length
    /// of the normal.
    pub d: f32,
}

message! { PlaneEquation { normal, d } }

impl PlaneEquation {
    /// The same plane by a point and a normal. The point is the one nearest to the origin, rounded to single
    /// precision.
    pub fn to_plane(&self) -> Plane {
        let normal = self.normal.as_dvec3();
        let point = -f64::from(self.d) / normal.length_squared() * normal;
        Plane { point: point.as_vec3(), normal: self.normal }
    }
}

/// A triangle with corners `a`, `b`, `c`; its normal `(b - a) × (c - a)` points to the side from which the
/// corners run anticlockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The first corner, in world units.
    pub a: Vec3,
    /// The second corner, in world units.
    pub b: Vec3,
    /// The third corner, in world units.
    pub c: Vec3,
}

message! { Triangle { a, b, c } }

/// A solid box with faces perpendicular to the axes. It may be flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// The corner with the smallest coordinate on each axis, in world units.
    pub min: Vec3,
    /// The corner with the largest coordinate on each axis, in world units.
    pub max: Vec3,
}

message! { Cuboid { min, max } }

/// A solid cylinder from `base` to `top`, closed by a disk at each end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The centre of one end, in world units.
    pub base: Vec3,
    /// The centre of the other end, in world units; it differs from `base`.
    pub top: Vec3,
    /// The radius in world units, above 0.
    pub radius: f32,
}

message! { Cylinder { base, top, radius } }

/// A solid cone from the disk around `base` to the point `apex`, closed by that disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The centre of the base disk, in world units.
    pub base: Vec3,
    /// The tip of the cone, in world units; it differs from `base`.
    pub apex: Vec3,
    /// The radius of the base disk in world units, above 0.
    pub radius: f32,
}

message! { Cone { base, apex, radius } }

/// A flat disk, which is hit from either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// The centre, in world units.
    pub center: Vec3,
    /// A normal of the disk, of any length but zero.
    pub normal: Vec3,
    /// The radius in world units, above 0.
    pub radius: f32,
}

message! { Disk { center, normal, radius } }

/// A flat convex polygon, which is hit from either side. A concave polygon of a scene file becomes a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Three or more corners in order around the polygon, in world units.
    pub corners: Vec<Vec3>,
}

message! { Polygon { corners } }

/// A bicubic Bézier patch: a curved surface that is defined by a control net of four by four points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BezierPatch {
    /// The control net, in world units: `u` runs along a row and `v` from row to row. The surface passes
    /// through its corners `rows[0][0]`, `rows[0][3]`, `rows[3][3]` and `rows[3][0]`, and in general through
    /// no other of its points.
    pub rows: [[Vec3; 4]; 4],
}

message! { BezierPatch { rows } }

/// A NURBS surface: a control net of any size with a weight for each point, and a degree and knots along both directions.
/// With equal weights it is a B-spline surface.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsPatch {
    /// The degrees along `u` and along `v`, each at least 1.
    pub degrees: [usize; 2],
    /// The knots along `u` and along `v`, which never descend: as many as there are control points in this direction, plus
    /// the degree, plus 1.
    pub knots: [Vec<f32>; 2],
    /// The control net, in world units: `u` runs along a row and `v` from row to row. All rows have the same length, and
    /// there are more points in each direction than its degree.
    pub rows: Vec<Vec<Vec3>>,
    /// The weight of each control point, above 0, in rows like those of the net.
    pub weights: Vec<Vec<f32>>,
}

message! { NurbsPatch { degrees, knots, rows, weights } }

impl NurbsPatch {
    /// The spans that are not empty between the knots of the domain, each with its ends, in ascending order: along `u` for
    /// `axis` 0 and along `v` for `axis` 1.
    ///
    /// # Panics
    ///
    /// If `axis` is above 1, or if there are too few knots for the degree.
    pub fn spans(&self, axis: usize) -> Vec<[f32; 2]> {
        let (knots, degree) = (&self.knots[axis], self.degrees[axis]);
        let domain = &knots[degree..knots.len() - degree];
        domain.windows(2).map(|ends| [ends[0], ends[1]]).filter(|ends| ends[0] < ends[1]).collect()
    }
}

/// A shape of a scene, in the space of the node that contains it.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The surface of a sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// An infinite plane that is given by its coefficients.
    PlaneEquation(PlaneEquation),
    /// A single triangle.
    Triangle(Triangle),
    /// A solid box with faces perpendicular to the axes.
    Cuboid(Cuboid),
    /// A closed cylinder.
    Cylinder(Cylinder),
    /// A closed cone.
    Cone(Cone),
    /// A flat disk.
    Disk(Disk),
    /// A flat convex polygon.
    Polygon(Polygon),
    /// A Bézier patch, which is divided into triangles before rendering.
    Bezier {
        /// The patch itself.
        patch: Box<BezierPatch>,
        /// The number of squares along each side, at least 1; each square becomes two triangles.
        steps: u32,
    },
    /// A B-spline or NURBS surface, which is divided into triangles before rendering.
    Nurbs {
        /// The surface itself.
        patch: Box<NurbsPatch>,
        /// The number of squares along each side of a span between two knots, at least 1; each square becomes two
        /// triangles.
        steps: u32,
    },
    /// An instance of the mesh with this index in [`crate::scene::Scene::meshes`].
    Mesh(usize),
}

message! { enum Shape {
    Sphere(a), Plane(a), PlaneEquation(a), Triangle(a), Cuboid(a), Cylinder(a), Cone(a), Disk(a),
    Polygon(a), Bezier { patch, steps }, Nurbs { patch, steps }, Mesh(a)
} }

impl Shape {
    /// A box around the shape in the shape's own space; `meshes` are those that instances refer to. `None`
    /// for an infinite plane.
    ///
    /// The box is rounded to nearest. So a point of a curved shape can lie outside by a rounding error; add a
    /// margin where that matters.
    ///
    /// # Panics
    ///
    /// If the shape is a mesh whose index is not in `meshes`.
    pub fn bounds(&self, meshes: &[SceneMesh]) -> Option<Aabb> {
        Some(match self {
            Shape::Plane(_) | Shape::PlaneEquation(_) => return None,
            Shape::Sphere(s) => around([s.center], [Vec3::splat(s.radius)]),
            Shape::Triangle(t) => bounds_of_points(&[t.a, t.b, t.c]),
            Shape::Cuboid(c) => Aabb::new(c.min, c.max),
            Shape::Cylinder(c) => {
                let reach = disk_reach(c.top - c.base, c.radius);
                around([c.base, c.top], [reach, reach])
            }
            Shape::Cone(c) => around([c.base, c.apex], [disk_reach(c.apex - c.base, c.radius), Vec3::ZERO]),
            Shape::Disk(d) => around([d.center], [disk_reach(d.normal, d.radius)]),
            Shape::Polygon(p) => bounds_of_points(&p.corners),
            // Each point of the surface is a weighted mean of the control points.
            Shape::Bezier { patch, .. } => bounds_of_points(patch.rows.as_flattened()),
            Shape::Nurbs { patch, .. } => bounds_of_points(&patch.rows.concat()),
            Shape::Mesh(index) => meshes[*index].mesh.bounds(),
        })
    }
}

/// Longitude and latitude of `direction` as texture coordinates in `0..=1`: the equirectangular image around
/// a sphere, upright along y.
///
/// The v coordinate is 0 at -y and 1 at +y. The u coordinate is 0.5 at +z and 0.75 at +x, and jumps from 1 to
/// 0 at -z. The direction may be of any length; zero, infinite and NaN directions count as +y.
pub fn around_sphere(direction: Vec3) -> Vec2 {
    let own = direction.as_dvec3().normalize_or(DVec3::Y).as_vec3();
    vec2(0.5 + own.x.atan2(own.z) / TAU, 0.5 + own.y.clamp(-1.0, 1.0).asin() / PI)
}

/// Coordinates of [`around_sphere`] kept half a pixel away from the lower and the upper edge of an image with `rows` rows:
/// interpolation beyond an edge of an image that repeats would show the other pole.
pub fn between_poles(uv: Vec2, rows: u32) -> Vec2 {
    let half = 0.5 / rows as f32;
    vec2(uv.x, uv.y.clamp(half, 1.0 - half))
}

/// Half the extent of a disk along each axis: `r sin` of the angle between normal and axis.
fn disk_reach(normal: Vec3, radius: f32) -> Vec3 {
    let n = normal.as_dvec3().normalize_or_zero().as_vec3();
    radius * (Vec3::ONE - n * n).max(Vec3::ZERO).map(f32::sqrt)
}

/// The box around boxes that are given by their centres and half extents.
fn around<const N: usize>(centers: [Vec3; N], reaches: [Vec3; N]) -> Aabb {
    let corners: Vec<Vec3> = centers.iter().zip(reaches).flat_map(|(&c, r)| [c - r, c + r]).collect();
    bounds_of_points(&corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    fn check(shape: Shape, min: Vec3, max: Vec3) {
        let bounds = shape.bounds(&[]).expect("only planes have none");
        // A few roundings of numbers up to 4.
        let near = |p: Vec3, q: Vec3| (p - q).abs().max_element() < 2e-6;
        assert!(near(bounds.min, min) && near(bounds.max, max), "{shape:?}: {bounds:?}");
    }

    #[test]
    fn boxes_are_tight_around_every_shape() {
        let (a, b, c) = (vec3(1.0, -1.0, 0.0), vec3(2.0, 3.0, 0.5), vec3(0.0, 0.0, -2.0));
        check(Shape::Sphere(Sphere { center: b, radius: 0.5 }), b - 0.5, b + 0.5);
        check(Shape::Triangle(Triangle { a, b, c }), vec3(0.0, -1.0, -2.0), vec3(2.0, 3.0, 0.5));
        check(Shape::Polygon(Polygon { corners: vec![a, b, c] }), vec3(0.0, -1.0, -2.0), vec3(2.0, 3.0, 0.5));
        check(Shape::Cuboid(Cuboid { min: c, max: b }), c, b);
        check(
            Shape::Disk(Disk { center: a, normal: 3.0 * Vec3::Y, radius: 2.0 }),
            a - vec3(2.0, 0.0, 2.0),
            a + vec3(2.0, 0.0, 2.0),
        );
        // Leaning 45° in the xy plane, a disk of radius 1 reaches √½ along x and y and 1 along z.
        let reach = vec3(0.5f32.sqrt(), 0.5f32.sqrt(), 1.0);
        let leaning = vec3(2.0, 2.0, 0.0);
        check(
            Shape::Cylinder(Cylinder { base: Vec3::ZERO, top: leaning, radius: 1.0 }),
            -reach,
            leaning + reach,
        );
        check(
            Shape::Cone(Cone { base: Vec3::ZERO, apex: leaning, radius: 1.0 }),
            -reach,
            vec3(2.0, 2.0, 1.0),
        );
        assert_eq!(Shape::Plane(Plane { point: a, normal: b }).bounds(&[]), None);
        assert_eq!(Shape::PlaneEquation(PlaneEquation { normal: a, d: 1.0 }).bounds(&[]), None);
    }

    #[test]
    fn a_plane_equation_holds_at_its_point() {
        // 2 y - 6 = 0 is the plane y = 3, for any factor.
        for factor in [1.0, -2.0, 1e-30] {
            let equation = PlaneEquation { normal: factor * vec3(0.0, 2.0, 0.0), d: factor * -6.0 };
            assert!((equation.to_plane().point - vec3(0.0, 3.0, 0.0)).length() < 1e-6);
        }
    }
}
