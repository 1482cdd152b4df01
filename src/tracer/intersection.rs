//! By which student functions rays are tested against triangles and spheres.

use crate::kit::{StudentFunctions, TriangleHit};
use crate::ray::Ray;
use crate::shape::{Sphere, Triangle};

/// The method and the precision of the scene as one choice, so that the inner loop branches once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeTests {
    /// The method of the student's choice; that of the reference is watertight.
    Watertight,
    /// Cramer's rule.
    Cramer,
    /// Plane and Gram matrix.
    Gram,
    /// Every number in double precision, whatever the method is.
    InDouble,
}

impl ShapeTests {
    /// Where `ray` hits `triangle`, if it does within its range.
    #[inline(always)]
    pub fn triangle<F: StudentFunctions>(self, ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
        match self {
            ShapeTests::Watertight => F::triangle_choice(ray, triangle),
            ShapeTests::Cramer => F::triangle_cramer(ray, triangle),
            ShapeTests::Gram => F::triangle_gram(ray, triangle, &F::gram_scalars(triangle)),
            ShapeTests::InDouble => F::triangle_in_double(ray, triangle),
        }
    }

    /// The `t` at which `ray` hits `sphere` first, if it does within its range.
    #[inline(always)]
    pub fn sphere<F: StudentFunctions>(self, ray: &Ray, sphere: &Sphere) -> Option<f32> {
        match self {
            ShapeTests::InDouble => F::sphere_in_double(ray, sphere.center, sphere.radius),
            _ => F::sphere_algebraic(ray, sphere.center, sphere.radius),
        }
    }
}
