//! Stage 5 · recursion: mirrors and glass send rays on, and something has to stop them.
//!
//! Slides: "Perfect reflection direction", "Snell's law", "Refraction direction", "Illumination in ray tracing",
//! "Ray tree depth".
//!
//! Directions and normals are of unit length; a normal is on the side that the ray comes from. Which rays go on is
//! yours to say, with [`children`]; the tracer follows them and adds up what they find, each times its weight.

use glam::Vec3;
use raykata::kit::{Bounce, Limits, SecondaryRay, Surface};
use raykata::material::{Fresnel, Material};
use raykata::ray::Ray;

/// The direction of a mirrored ray: `d' = d - 2 n (d·n)`, of unit length.
///
/// Where the formula lies: each bounce makes the direction a rounding longer or shorter, and between two mirrors that
/// adds up.
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    todo!("mirror direction on the normal, and normalise")
}

/// The direction behind the surface by Snell's law, `n1 sin θ1 = n2 sin θ2`, of unit length; `None` if all light is
/// mirrored: beyond the critical angle there is no such direction.
///
/// Where the formula lies: the slide divides by `sin θ1`, which is 0 for a ray along the normal, and takes the root of
/// `1 - sin² θ2`, which is negative beyond the critical angle.
pub fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
    todo!("bend the part of direction along the surface by n1 / n2; None beyond the critical angle")
}

/// The share of light that a surface between two clear media mirrors, by Schlick's formula
/// `R0 + (1 - R0) (1 - cos θ)⁵` with `R0 = ((n1 - n2) / (n1 + n2))²`; 1 beyond the critical angle.
///
/// Where the formula lies: coming from the denser side, the angle in it must be the larger one, behind the surface.
pub fn fresnel_schlick(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    todo!("Schlick's formula; from the denser side with the cosine behind the surface")
}

/// The same exactly, for light without polarisation: the mean of
/// `((n1 cos θ1 - n2 cos θ2) / (n1 cos θ1 + n2 cos θ2))²` and the same with `θ1` and `θ2` exchanged; 1 beyond the
/// critical angle.
pub fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    todo!("the mean of the two squared ratios")
}

/// The rays that go on from a surface, and what each counts. A ray with weight `weight` and `depth` bounces behind it
/// has come along `direction`; outside of the material the index is 1, and the ray comes from outside if it is `entering`.
///
/// The mirrored ray counts `weight · material.mirror`, the refracted one `weight · material.transmission`. If
/// `material.fresnel` asks for it, the share F of the transmission is mirrored instead. A child is traced only if its
/// own weight is not zero, reaches `limits.min_contribution` in some channel, and `depth` is below `limits.max_depth`.
///
/// Where the formula lies: the slide tests the weight of the parent, and so follows rays that count nothing. Leaving
/// the material, n1 and n2 change places.
pub fn scatter(
    direction: Vec3,
    normal: Vec3,
    entering: bool,
    material: &Material,
    weight: Vec3,
    depth: u32,
    limits: &Limits,
) -> Vec<SecondaryRay> {
    todo!("weigh the mirrored and the refracted ray, and return those that are worth tracing")
}

/// The endless ray that follows `child`. It starts just off the surface, on the side to which it goes: what is mirrored
/// on the side of `surface.geometric_normal`, what goes through on the other one.
///
/// Where the formula lies: the slide starts it at `hit.Point()`. That point is rounded, so half of all rays that start
/// there meet their own surface again. Move it by its error, as for shadow rays.
pub fn spawn_ray(surface: &Surface, child: &SecondaryRay) -> Ray {
    todo!("start off the surface, on the side to which the ray goes")
}
