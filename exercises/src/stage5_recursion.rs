//! Stage 5 · recursion: reflection and refraction, and the limits that end the recursion.
//!
//! Slides: "Perfect reflection direction", "Snell's law", "Refraction direction", "Illumination in ray tracing",
//! "Ray tree depth".
//!
//! Directions and normals have unit length, and a normal is on the side that the ray comes from. [`scatter`] returns
//! the secondary rays of a surface. The tracer follows them and adds up the light that they find, each times its
//! weight.

use glam::Vec3;
use raykata::kit::{Bounce, Limits, SecondaryRay, Surface};
use raykata::material::{Fresnel, Material};
use raykata::ray::Ray;

/// The direction of the reflected ray: `d' = d - 2 n (d·n)`.
///
/// The direction points to the surface. The result has unit length up to rounding, also after a thousand reflections.
///
/// Pitfall: each reflection makes the direction longer or shorter by a rounding error, and between two mirrors these
/// errors add up.
///
/// Slide "Perfect reflection direction".
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    todo!("reflect direction by the normal, and normalize")
}

/// The direction of the refracted ray by Snell's law, `n1 sin θ1 = n2 sin θ2`.
///
/// The ray comes from the medium of index `n1`, where θ1 is its angle with the normal, and goes into the medium of
/// index `n2`. The result has unit length. Along the normal, and if `n1 == n2`, it is `direction` up to rounding.
/// Beyond the critical angle, where `sin θ2` would be above 1, the result is `None` (total internal reflection).
/// Within rounding of the critical angle both answers pass. The length of `direction` may differ from 1 by a rounding
/// error. NaN is never right.
///
/// Pitfall: the slide divides by `sin θ1`, which is 0 for a ray along the normal. It also takes the square root of
/// `1 - sin² θ2`, which is negative beyond the critical angle.
///
/// Slides "Snell's law" and "Refraction direction".
pub fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
    todo!("bend the part of direction along the surface by n1 / n2; None beyond the critical angle")
}

/// The Fresnel reflectance, the fraction of light that the surface between two clear media reflects, by Schlick's
/// approximation: `R0 + (1 - R0) (1 - cos θ)⁵` with `R0 = ((n1 - n2) / (n1 + n2))²`.
///
/// The ray comes from the medium of index `n1`, and `cos_theta`, in `0..=1`, is the cosine of the angle θ1 between the
/// ray and the normal. In the formula θ is θ1 if `n1 <= n2`, and the angle θ2 of the refracted ray if `n1 > n2`. The
/// result is in `0..=1`, and 1 beyond the critical angle. Within rounding of the critical angle any number in `0..=1`
/// passes, for example if `n1 == n2` and `cos_theta` is 0.
///
/// Pitfall: if `n1 > n2`, the angle in the formula is the larger one, behind the surface.
///
/// Schlick, 1994.
pub fn fresnel_schlick(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    todo!("Schlick's formula; if n1 > n2, with the cosine behind the surface")
}

/// The Fresnel reflectance of unpolarised light by Fresnel's equations: the mean of
/// `((n1 cos θ1 - n2 cos θ2) / (n1 cos θ1 + n2 cos θ2))²` and the same with `θ1` and `θ2` exchanged.
///
/// The ray comes from the medium of index `n1`, and `cos_theta`, in `0..=1`, is `cos θ1`; θ2 is the angle of the
/// refracted ray. The result is in `0..=1`, and 1 beyond the critical angle. Within rounding of the critical angle any
/// number in `0..=1` passes, for example if `n1 == n2` and `cos_theta` is 0.
///
/// Pitfall: in that last case the formula is 0 / 0, which is NaN.
pub fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    todo!("the mean of the two squared ratios")
}

/// The secondary rays that leave a surface, each with its weight: at most one reflected and one refracted ray. Their
/// directions are those of [`reflect`] and [`refract`].
///
/// A ray of weight `weight` arrives along `direction`, after `depth` reflections and refractions. It comes from outside
/// the material if `entering` is true, and from inside otherwise. The index of refraction is
/// `material.index_of_refraction` inside, and 1 outside.
///
/// The reflected ray has the weight `weight · material.mirror`, and the refracted ray
/// `weight · material.transmission`, channel by channel. If `material.fresnel` is not `None`, the Fresnel reflectance
/// F moves a part of the transmission to the reflected ray: the weights are `weight · (mirror + F transmission)` and
/// `weight · (1 - F) transmission`. Beyond the critical angle there is no refracted ray, and F is 1. If
/// `material.fresnel` is `None` there, the reflected weight is still `weight · mirror`.
///
/// A ray is returned only if `depth < limits.max_depth` and the largest channel of its own weight is above 0 and at
/// least `limits.min_contribution`. The order of the rays does not matter for the checks.
///
/// Pitfall: the slide tests the weight of the incoming ray, and so follows rays that add nothing. When the ray leaves
/// the material, n1 and n2 change places.
///
/// Slides "Illumination in ray tracing", "Algorithm (max depth)" and "Algorithm (min contribution)".
pub fn scatter(
    direction: Vec3,
    normal: Vec3,
    entering: bool,
    material: &Material,
    weight: Vec3,
    depth: u32,
    limits: &Limits,
) -> Vec<SecondaryRay> {
    todo!("compute the weights of both rays, and return the rays that add something")
}

/// The ray that starts a secondary ray at a surface.
///
/// It has the direction `secondary.direction` and no end: `t_max` is infinite. A reflected ray starts on the side of
/// `surface.geometric_normal`, and a refracted ray on the other side. The distance of its start from the point along
/// the geometric normal n is as for [`shadow_ray`](crate::stage4_shading::shadow_ray): at least `error·|n|`, where
/// rounding must not make it more than 1 % smaller, and at most `4 error·|n|` plus 64 rounding steps of the largest
/// coordinate.
///
/// Pitfall: the slide starts the ray at `hit.Point()`. That point is rounded, so about half of all rays that start
/// there hit their own surface (self-intersection). Move the point by its error, as for shadow rays.
///
/// Slide "Algorithm (max depth)".
pub fn spawn_ray(surface: &Surface, secondary: &SecondaryRay) -> Ray {
    todo!("start off the surface, on the side to which the ray goes")
}
