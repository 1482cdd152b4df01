//! Inputs as Rust expressions that can be pasted into a test. Every number has all its digits.

use glam::{Affine3A, UVec2, Vec2, Vec3};
use raykata::aabb::Aabb;
use raykata::emitter::{AreaEmitter, EmitterShape};
use raykata::kit::{
    BuildQuery, EmitterPdfQuery, EmitterQuery, InsideQuery, LightSample, PlaneEquationQuery, PlaneQuery,
    RootQuery, ShadeQuery, ShadowQuery, SlabQuery, SphereQuery, Surface, TriangleQuery,
};
use raykata::material::Material;
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon, Sphere, Triangle};

/// Something that can be written as a Rust expression.
pub trait Paste {
    /// The value as a Rust expression.
    fn paste(&self) -> String;
}

/// The call `function(arguments)` as Rust.
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

impl Paste for Vec2 {
    fn paste(&self) -> String {
        format!("vec2({}, {})", self.x.paste(), self.y.paste())
    }
}

impl Paste for Stratum {
    fn paste(&self) -> String {
        let whole = |v: UVec2| format!("uvec2({}, {})", v.x, v.y);
        format!(
            "&Stratum {{ cell: {}, grid: {}, u: {} }}",
            whole(self.cell),
            whole(self.grid),
            self.u.paste()
        )
    }
}

impl Paste for Ray {
    fn paste(&self) -> String {
        let ray = format!("&Ray::new({}, {})", self.origin.paste(), self.direction.paste());
        if (self.t_min, self.t_max) == (0.0, f32::INFINITY) {
            ray
        } else {
            format!("{ray}.with_range({}, {})", self.t_min.paste(), self.t_max.paste())
        }
    }
}

impl Paste for Aabb {
    fn paste(&self) -> String {
        format!("&Aabb::new({}, {})", self.min.paste(), self.max.paste())
    }
}

/// Structs with all of their fields; `&` stands before those that functions borrow.
macro_rules! structs {
    ($($borrow:literal $Type:ident { $($field:ident),* })*) => {
        $(impl Paste for $Type {
            fn paste(&self) -> String {
                let fields = [$(format!("{}: {}", stringify!($field), self.$field.paste())),*];
                format!("{}{} {{ {} }}", $borrow, stringify!($Type), fields.join(", "))
            }
        })*
    };
}

structs! {
    "&" Triangle { a, b, c }
    "&" Surface { point, error, geometric_normal, shading_normal }
    "" LightSample { direction, distance, radiance }
    "&" Sphere { center, radius }
    "&" Cuboid { min, max }
    "&" Cylinder { base, top, radius }
    "&" Cone { base, apex, radius }
    "&" Disk { center, normal, radius }
}

/// The fields of a material that stage 4 uses.
impl Paste for Material {
    fn paste(&self) -> String {
        format!(
            "&Material {{ ambient: {}, diffuse: {}, specular: {}, exponent: {}, ..Material::default() }}",
            self.ambient.paste(),
            self.diffuse.paste(),
            self.specular.paste(),
            self.exponent.paste()
        )
    }
}

impl Paste for Affine3A {
    fn paste(&self) -> String {
        let columns = [self.matrix3.x_axis, self.matrix3.y_axis, self.matrix3.z_axis, self.translation]
            .map(|column| Vec3::from(column).paste().replace("vec3", "vec3a"));
        format!("&Affine3A::from_cols({})", columns.join(", "))
    }
}

impl Paste for Polygon {
    fn paste(&self) -> String {
        format!("&Polygon {{ corners: vec!{} }}", list(&self.corners))
    }
}

impl Paste for AreaEmitter {
    fn paste(&self) -> String {
        let unborrowed = |text: String| text.trim_start_matches('&').to_owned();
        let shape = match &self.shape {
            EmitterShape::Sphere(sphere) => format!("Sphere({})", unborrowed(sphere.paste())),
            EmitterShape::Triangle(triangle) => format!("Triangle({})", unborrowed(triangle.paste())),
            EmitterShape::Parallelogram { corner, edges: (first, second) } => format!(
                "Parallelogram {{ corner: {}, edges: ({}, {}) }}",
                corner.paste(),
                first.paste(),
                second.paste()
            ),
        };
        let (radiance, two_sided) = (self.radiance.paste(), self.two_sided);
        format!(
            "&AreaEmitter {{ shape: EmitterShape::{shape},\nradiance: {radiance}, two_sided: {two_sided} }}"
        )
    }
}

/// The items as a Rust array, `[a, b, c]`.
pub fn list<'a, P: Paste + 'a>(items: impl IntoIterator<Item = &'a P>) -> String {
    let items: Vec<String> =
        items.into_iter().map(|item| item.paste().trim_start_matches('&').to_owned()).collect();
    format!("[{}]", items.join(", "))
}

/// A query as the call of the student's function.
pub trait Arguments {
    /// The call `function(arguments)` as Rust.
    fn call(&self, function: &str) -> String;
}

impl Arguments for RootQuery {
    fn call(&self, function: &str) -> String {
        let [first, second] = self.roots;
        format!("{function}([{}, {}], {})", first.paste(), second.paste(), self.ray.paste())
    }
}

/// Queries whose fields are the arguments, in this order.
macro_rules! arguments {
    ($($Query:ident($($($field:ident).+),*);)*) => {
        $(impl Arguments for $Query {
            fn call(&self, function: &str) -> String {
                call(function, &[$(&self.$($field).+),*])
            }
        })*
    };
}

arguments! {
    SphereQuery(ray, sphere.center, sphere.radius);
    PlaneQuery(ray, plane.point, plane.normal);
    PlaneEquationQuery(ray, plane.normal, plane.d);
    TriangleQuery(ray, triangle);
    InsideQuery(ray, point, triangle);
    EmitterQuery(emitter, from, u);
    EmitterPdfQuery(emitter, from, direction);
}

impl Arguments for SlabQuery {
    fn call(&self, function: &str) -> String {
        call(function, &[&self.ray, &self.ray.direction.recip(), &self.bounds])
    }
}

impl Arguments for ShadowQuery {
    fn call(&self, function: &str) -> String {
        format!("{function}({},\n&{})", self.surface.paste(), self.light.paste())
    }
}

impl Arguments for ShadeQuery {
    fn call(&self, function: &str) -> String {
        format!(
            "{function}({}, {},\n{}, {},\n&{}, |i, _| {:?}[i])",
            self.surface.paste(),
            self.to_viewer.paste(),
            self.material.paste(),
            self.ambient.paste(),
            list(&self.lights),
            self.visible
        )
    }
}

impl Arguments for BuildQuery {
    fn call(&self, function: &str) -> String {
        format!("{function}(&{}, Split::{:?}, {})", list(&self.bounds), self.split, self.leaf_size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_pasted_is_rust_with_every_digit() {
        let ray = Ray::new(Vec3::new(0.1, -0.0, f32::INFINITY), Vec3::X).with_range(1e-7, 3.0);
        assert_eq!(
            ray.paste(),
            "&Ray::new(vec3(0.1, -0.0, f32::INFINITY), vec3(1.0, 0.0, 0.0)).with_range(1e-7, 3.0)"
        );
        let boxes = [Aabb::new(Vec3::ZERO, Vec3::ONE); 2];
        assert_eq!(list(&boxes[..1]), "[Aabb::new(vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0))]");
        let query =
            BuildQuery { bounds: boxes.to_vec(), split: raykata::scene::Split::SurfaceArea, leaf_size: 2 };
        assert!(query.call("build").ends_with("vec3(1.0, 1.0, 1.0))], Split::SurfaceArea, 2)"));
    }
}
