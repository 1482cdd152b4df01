//! Inputs as Rust expressions that can be pasted into a test. Every number has all its digits.

use glam::{Affine3A, Vec2, Vec3};
use raykata::aabb::Aabb;
use raykata::camera::{Lens, Shutter};
use raykata::emitter::{AreaEmitter, EmitterSample};
use raykata::film::WeightedColor;
use raykata::kit::{
    BoundingSphereQuery, BoundsQuery, BsdfPdfQuery, BsdfQuery, BuildQuery, EmissionQuery, EmitterPdfQuery,
    EmitterQuery, InsideQuery, LightContributionQuery, LightSample, NormalQuery, ObjectRayQuery, OffsetQuery,
    PhongLobeQuery, PlaneEquationQuery, PlaneQuery, RefractQuery, RootQuery, RouletteQuery, SecondaryRay,
    ShadeQuery, ShadowQuery, SlabQuery, SphereQuery, SphereSampleQuery, Surface, TriangleQuery,
};
use raykata::light_path::Scattering;
use raykata::material::Material;
use raykata::message::Message;
use raykata::partition::KdHeuristics;
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

/// Types whose text is that of their [message](Message::rust), behind `&` if functions borrow them.
macro_rules! pasted {
    ($($borrow:literal $($Type:ty)*;)*) => {
        $($(impl Paste for $Type {
            fn paste(&self) -> String {
                format!(concat!($borrow, "{}"), self.rust())
            }
        })*)*
    };
}

pasted! {
    "" (Vec3, Vec3) u32 f32 Vec2 Vec3 Option<Vec3> LightSample WeightedColor;
    "&" Stratum Triangle Surface Sphere Cuboid Cylinder Cone Disk Polygon Affine3A Scattering EmitterSample SecondaryRay AreaEmitter
        Shutter Lens KdHeuristics;
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
    SphereSampleQuery(sphere, from, u);
    PhongLobeQuery(ideal, normal, roughness, u);
    BoundsQuery(to_world, bounds);
    RefractQuery(direction, normal, n1, n2);
    OffsetQuery(point, error, normal, direction);
    RouletteQuery(weight, bounce, u);
    BsdfQuery(scattering, u);
    BsdfPdfQuery(scattering, direction);
    LightContributionQuery(diffuse, normal, sample, bsdf_pdf);
    EmissionQuery(emission, pdf, light_pdf);
    BoundingSphereQuery(ray, sphere);
    ObjectRayQuery(ray, to_object);
    NormalQuery(normal, to_object);
}

/// A tuple of all arguments.
impl<A: Paste, B: Paste> Arguments for (A, B) {
    fn call(&self, function: &str) -> String {
        call(function, &[&self.0, &self.1])
    }
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
    }
}
