//! Which student functions test rays against triangles and spheres.

use crate::kit::{GramScalars, StudentFunctions, TriangleHit};
use crate::ray::Ray;
use crate::shape::{Sphere, Triangle};
use glam::Vec3;

/// The tests of a frame, by the methods and the precision of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeTests {
    /// The test of triangles.
    pub triangles: TriangleTest,
    /// The test of spheres.
    pub spheres: SphereTest,
}

/// Triangle method and precision of the scene as one choice, so that the inner loop has one branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangleTest {
    /// The watertight triangle method of stage 10.
    Watertight,
    /// The triangle method of the student's choice.
    Choice,
    /// The triangle method by Cramer's rule.
    Cramer,
    /// The triangle method by plane and Gram matrix.
    Gram,
    /// The plane of the triangle and inside test I.
    InsideByPlanes,
    /// The plane of the triangle and inside test II.
    InsideByDirection,
    /// The plane of the triangle and inside test III.
    InsideByAreas,
    /// Double precision.
    InDouble,
}

/// Sphere method and precision of the scene as one choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereTest {
    /// The quadratic equation.
    Algebraic,
    /// Right triangles.
    Geometric,
    /// The quadratic equation, solved by `stable_roots`.
    StableRoots,
    /// Double precision.
    InDouble,
}

impl ShapeTests {
    /// The hit of `ray` with `triangle` for `t_min < t < t_max`, if there is one: `t` and barycentric
    /// coordinates. `scalars` are those of the Gram method if they are stored; otherwise that method computes
    /// them.
    #[inline(always)]
    pub fn triangle<F: StudentFunctions>(
        self,
        ray: &Ray,
        triangle: &Triangle,
        scalars: Option<&GramScalars>,
    ) -> Option<TriangleHit> {
        match self.triangles {
            TriangleTest::Watertight => F::watertight(ray, triangle),
            TriangleTest::Choice => F::triangle_choice(ray, triangle),
            TriangleTest::Cramer => F::triangle_cramer(ray, triangle),
            TriangleTest::Gram => match scalars {
                Some(scalars) => F::triangle_gram(ray, triangle, scalars),
                None => F::triangle_gram(ray, triangle, &F::gram_scalars(triangle)),
            },
            TriangleTest::InsideByPlanes => {
                in_plane::<F>(ray, triangle, |point| F::inside_by_planes(ray, point, triangle))
            }
            TriangleTest::InsideByDirection => {
                in_plane::<F>(ray, triangle, |point| F::inside_by_direction(ray, point, triangle))
            }
            TriangleTest::InsideByAreas => {
                let (t, point) = plane_of::<F>(ray, triangle)?;
                F::inside_by_areas(point, triangle).map(|weights| hit(t, weights))
            }
            TriangleTest::InDouble => F::triangle_in_double(ray, triangle),
        }
    }

    /// The smallest `t` with `t_min < t < t_max` at which `ray` hits `sphere`, if there is one.
    #[inline(always)]
    pub fn sphere<F: StudentFunctions>(self, ray: &Ray, sphere: &Sphere) -> Option<f32> {
        match self.spheres {
            SphereTest::Algebraic => F::sphere_algebraic(ray, sphere.center, sphere.radius),
            SphereTest::Geometric => F::sphere_geometric(ray, sphere.center, sphere.radius),
            SphereTest::StableRoots => by_stable_roots::<F>(ray, sphere),
            SphereTest::InDouble => F::sphere_in_double(ray, sphere.center, sphere.radius),
        }
    }
}

fn hit(t: f32, weights: Vec3) -> TriangleHit {
    TriangleHit { t, beta: weights.y, gamma: weights.z }
}

/// The hit of `ray` with the plane of `triangle` in its range: `t` and the point.
fn plane_of<F: StudentFunctions>(ray: &Ray, triangle: &Triangle) -> Option<(f32, Vec3)> {
    let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    let t = F::plane(ray, triangle.a, normal)?;
    Some((t, ray.at(t)))
}

/// The hit of `ray` with the plane of `triangle`, if `inside` holds for its point.
fn in_plane<F: StudentFunctions>(
    ray: &Ray,
    triangle: &Triangle,
    inside: impl Fn(Vec3) -> bool,
) -> Option<TriangleHit> {
    let (t, point) = plane_of::<F>(ray, triangle).filter(|(_, point)| inside(*point))?;
    // Tests I and II give no barycentric coordinates, so ask test III. A point of an edge may be outside for that test by a
    // rounding: then ask for a point nearer to the middle.
    let middle = (triangle.a + triangle.b + triangle.c) / 3.0;
    let weights = [0.0, 1e-6, 1e-3]
        .into_iter()
        .find_map(|share| F::inside_by_areas(point.lerp(middle, share), triangle));
    Some(hit(t, weights.unwrap_or(Vec3::splat(1.0 / 3.0))))
}

/// The hit with a sphere by the quadratic equation of the lecture, with coefficients in single precision.
#[cold]
fn by_stable_roots<F: StudentFunctions>(ray: &Ray, sphere: &Sphere) -> Option<f32> {
    let (from_center, direction) = (ray.origin - sphere.center, ray.direction);
    let c = from_center.length_squared() - sphere.radius * sphere.radius;
    let roots = F::stable_roots(direction.length_squared(), 2.0 * from_center.dot(direction), c)?;
    F::nearest_root(roots, ray)
}
