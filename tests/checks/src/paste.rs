//! Inputs as Rust that can be pasted into a test: every number with all its digits.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::{InsideQuery, PlaneQuery, RootQuery, SlabQuery, SphereQuery, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// Something that can be written as a Rust expression.
pub trait Paste {
    /// The expression.
    fn paste(&self) -> String;
}

/// `function(arguments)`.
pub fn call(function: &str, arguments: &[&dyn Paste]) -> String {
    let arguments: Vec<String> = arguments.iter().map(|argument| argument.paste()).collect();
    format!("{function}({})", arguments.join(", "))
}

impl Paste for f32 {
    fn paste(&self) -> String {
        if self.is_nan() {
            "f32::NAN".into()
        } else if self.is_infinite() {
            if *self > 0.0 { "f32::INFINITY".into() } else { "f32::NEG_INFINITY".into() }
        } else {
            format!("{self:?}")
        }
    }
}

impl Paste for Vec3 {
    fn paste(&self) -> String {
        format!("vec3({}, {}, {})", self.x.paste(), self.y.paste(), self.z.paste())
    }
}

impl Paste for Ray {
    fn paste(&self) -> String {
        let ray = format!("&Ray::new({}, {})", self.origin.paste(), self.dir.paste());
        if (self.t_min, self.t_max) == (0.0, f32::INFINITY) {
            ray
        } else {
            format!("{ray}.with_range({}, {})", self.t_min.paste(), self.t_max.paste())
        }
    }
}

impl Paste for Triangle {
    fn paste(&self) -> String {
        format!("&Triangle {{ a: {}, b: {}, c: {} }}", self.a.paste(), self.b.paste(), self.c.paste())
    }
}

impl Paste for Aabb {
    fn paste(&self) -> String {
        format!("&Aabb::new({}, {})", self.min.paste(), self.max.paste())
    }
}

/// The arguments of the call that a query makes.
pub trait Arguments {
    /// `function(arguments)`.
    fn call(&self, function: &str) -> String;
}

impl Arguments for RootQuery {
    fn call(&self, function: &str) -> String {
        let [first, second] = self.roots;
        format!("{function}([{}, {}], {})", first.paste(), second.paste(), self.ray.paste())
    }
}

impl Arguments for SphereQuery {
    fn call(&self, function: &str) -> String {
        call(function, &[&self.ray, &self.sphere.center, &self.sphere.radius])
    }
}

impl Arguments for PlaneQuery {
    fn call(&self, function: &str) -> String {
        call(function, &[&self.ray, &self.plane.point, &self.plane.normal])
    }
}

impl Arguments for TriangleQuery {
    fn call(&self, function: &str) -> String {
        call(function, &[&self.ray, &self.triangle])
    }
}

impl Arguments for InsideQuery {
    fn call(&self, function: &str) -> String {
        call(function, &[&self.ray, &self.point, &self.triangle])
    }
}

impl Arguments for SlabQuery {
    fn call(&self, function: &str) -> String {
        call(function, &[&self.ray, &self.ray.dir.recip(), &self.bounds])
    }
}
