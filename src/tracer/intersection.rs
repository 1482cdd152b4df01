//! Which student functions test rays against triangles and spheres.

use crate::kit::{StudentFunctions, TriangleHit};
use crate::ray::Ray;
use crate::shape::{Sphere, Triangle};

/// Triangle method and precision of the scene as one choice, so that the inner loop has one branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeTests {
    /// The watertight triangle method of stage 10.
    Watertight,
    /// The triangle method of the student's choice.
    Choice,
    /// The triangle method by Cramer's rule.
    Cramer,
    /// The triangle method by plane and Gram matrix.
    Gram,
    /// Triangles and spheres in double precision, whatever the method is.
    InDouble,
}

impl ShapeTests {
    /// The hit of `ray` with `triangle` for `t_min < t < t_max`, if there is one: `t` and barycentric
    /// coordinates.
    #[inline(always)]
    pub fn triangle<F: StudentFunctions>(self, ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
        match self {
            ShapeTests::Watertight => F::watertight(ray, triangle),
            ShapeTests::Choice => F::triangle_choice(ray, triangle),
            ShapeTests::Cramer => F::triangle_cramer(ray, triangle),
            ShapeTests::Gram => F::triangle_gram(ray, triangle, &F::gram_scalars(triangle)),
            ShapeTests::InDouble => F::triangle_in_double(ray, triangle),
        }
    }

    /// The smallest `t` with `t_min < t < t_max` at which `ray` hits `sphere`, if there is one.
    #[inline(always)]
    pub fn sphere<F: StudentFunctions>(self, ray: &Ray, sphere: &Sphere) -> Option<f32> {
        match self {
            ShapeTests::InDouble => F::sphere_in_double(ray, sphere.center, sphere.radius),
            _ => F::sphere_algebraic(ray, sphere.center, sphere.radius),
        }
    }
}
