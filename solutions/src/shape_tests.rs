//! Nothing to do here: by which functions of the exercises rays are tested against triangles and spheres.

use crate::plan::written;
use crate::stage1_shapes::sphere_algebraic;
use crate::stage2_triangles::{gram_scalars, triangle_choice, triangle_cramer, triangle_gram};
use crate::stage10_stability::{sphere_in_double, triangle_in_double};
use glam::Vec3;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::scene::{Precision, Quality, TriangleMethod};
use raykata::shape::{Sphere, Triangle};

/// What the scene says of method and of precision, made one, so that the inner loop asks once.
#[derive(Clone, Copy)]
pub enum ShapeTests {
    Watertight,
    Cramer,
    Gram,
    /// Whatever the method is.
    InDouble,
}

impl ShapeTests {
    /// Those that the scene asks for, as far as they are written.
    pub fn choose(quality: &Quality, notes: &mut Vec<String>) -> ShapeTests {
        let single = match quality.triangle_method {
            TriangleMethod::Watertight => ShapeTests::Watertight,
            TriangleMethod::Cramer => ShapeTests::Cramer,
            TriangleMethod::Gram => ShapeTests::Gram,
        };
        if quality.precision == Precision::Single {
            return single;
        }
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        let triangle = Triangle { a: Vec3::Z, b: Vec3::X, c: Vec3::Y };
        let triangles = written(|| triangle_in_double(&ray, &triangle));
        let missing = match (triangles, written(|| sphere_in_double(&ray, Vec3::Z, 0.5))) {
            (true, true) => return ShapeTests::InDouble,
            (false, true) => "`triangle_in_double` of stage 10 is",
            (true, false) => "`sphere_in_double` of stage 10 is",
            (false, false) => "`triangle_in_double` and `sphere_in_double` of stage 10 are",
        };
        notes.push(format!("rays are tested in single precision: {missing} not written yet"));
        single
    }

    #[inline(always)]
    pub fn triangle(self, ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
        match self {
            ShapeTests::Watertight => triangle_choice(ray, triangle),
            ShapeTests::Cramer => triangle_cramer(ray, triangle),
            ShapeTests::Gram => triangle_gram(ray, triangle, &gram_scalars(triangle)),
            ShapeTests::InDouble => triangle_in_double(ray, triangle),
        }
    }

    /// The `t` of the nearest hit that counts.
    #[inline(always)]
    pub fn sphere(self, ray: &Ray, sphere: &Sphere) -> Option<f32> {
        match self {
            ShapeTests::InDouble => sphere_in_double(ray, sphere.center, sphere.radius),
            _ => sphere_algebraic(ray, sphere.center, sphere.radius),
        }
    }
}
