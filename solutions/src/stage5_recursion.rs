//! Stage 5 · recursion: reflection and refraction, and the limits that end the recursion.
//!
//! Slides: `slides/stage05.md`.
//!
//! Directions and normals have unit length, and a normal is on the side that the ray comes from.
//! [`scatter`] returns the secondary rays of a surface. The tracer follows them and adds up the
//! light that they find, each times its weight.

use glam::Vec3;
use raykata::kit::{Bounce, Limits, SecondaryRay, Surface};
use raykata::material::{Fresnel, Material};
use raykata::ray::Ray;

// <solution>
use crate::stage4_shading::off_surface;
// </solution>

/// A mirror reverses the part of the direction along the normal and keeps the rest:
/// `d' = d - 2 n (d·n)`. Each reflection has a rounding error: how long is d after a thousand?
///
/// The result has unit length up to rounding, also after a thousand reflections.
///
/// Source: "Perfect reflection direction".
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    // <solution>
    // Normalize, because the rounding errors of the length add up between two mirrors.
    (direction - 2.0 * direction.dot(normal) * normal).normalize()
    // <stub> todo!("reflect direction by the normal, and normalize")
    // </solution>
}

/// Snell's law bends light where it goes from a medium of index `n1` into one of `n2`:
/// `n1 sin θ1 = n2 sin θ2`. The part of d along the surface is `sin θ1` long. What is its direction
/// for a ray along the normal? What if `sin θ2 > 1`?
///
/// Returns a unit vector, never NaN.
///
/// Exactly:
///
/// 1. Along the normal, and if `n1 == n2`, it is `direction` up to rounding.
/// 2. `None` beyond the critical angle (total internal reflection). Within rounding of it both
///    answers pass.
/// 3. The length of `direction` may differ from 1 by a rounding error.
///
/// Source: "Snell's law", "Refraction direction".
pub fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
    // <solution>
    let ratio = n1 / n2;
    // Compute the part of the refracted ray that is perpendicular to the normal: n1 / n2 times that
    // of `direction`, because its length is sin θ2 = n1 / n2 sin θ1. This needs no division by sin
    // θ1.
    let cos_1 = -direction.dot(normal);
    let r_perpendicular = ratio * (direction + cos_1 * normal);
    // Compute the part that is parallel to the normal, whose length is cos θ2.
    let cos_2_squared = 1.0 - r_perpendicular.length_squared();
    if !(cos_2_squared >= 0.0) {
        // This is total internal reflection, or NaN.
        return None;
    }
    let r_parallel = -cos_2_squared.sqrt() * normal;
    (r_perpendicular + r_parallel).try_normalize()
    // <stub> todo!("bend the part of direction along the surface by n1 / n2; None beyond the critical angle")
    // </solution>
}

/// The Fresnel reflectance is the fraction of light that a clear surface reflects. Schlick's
/// approximation:
///
/// ```text
/// R0 + (1 - R0) (1 - cos θ)⁵    R0 = ((n1 - n2) / (n1 + n2))²
/// ```
///
/// The ray comes from the medium of index `n1`. `cos_theta`, in `0..=1`, is the cosine of its angle
/// θ1 with the normal, above 0 if `n1 == n2`. θ is the larger one of θ1 and the angle θ2 of the
/// refracted ray.
///
/// Exactly:
///
/// 1. The result is in `0..=1`, and 1 beyond the critical angle. Within rounding of it any number
///    in `0..=1` passes.
///
/// Source: Schlick, 1994.
pub fn fresnel_schlick(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    // <solution>
    // Use the cosine on the side of the smaller index, where the angle is larger.
    let cosine = if n1 > n2 {
        match cos_behind(cos_theta, n1, n2) {
            Some(cos_2) => cos_2,
            None => return 1.0,
        }
    } else {
        cos_theta
    };
    // Compute Schlick's formula.
    let r0 = ((n1 - n2) / (n1 + n2)).powi(2);
    r0 + (1.0 - r0) * (1.0 - cosine).clamp(0.0, 1.0).powi(5)
    // <stub> todo!("Schlick's formula; if n1 > n2, with the cosine behind the surface")
    // </solution>
}

/// The Fresnel reflectance of unpolarised light is the mean of the two polarisations:
///
/// ```text
/// ((n1 cos θ1 - n2 cos θ2) / (n1 cos θ1 + n2 cos θ2))²
/// ((n1 cos θ2 - n2 cos θ1) / (n1 cos θ2 + n2 cos θ1))²
/// ```
///
/// θ1 is the angle of the ray, and θ2 that of the refracted ray. What if there is no θ2?
///
/// Input and range of the result, also beyond the critical angle and near it, are those of
/// [`fresnel_schlick`].
pub fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    // <solution>
    let Some(cos_2) = cos_behind(cos_theta, n1, n2) else { return 1.0 };
    // The squared ratio is 0 / 0 if both cosines are 0, along the surface, where all light is
    // reflected.
    let ratio = |p: f32, q: f32| if p + q > 0.0 { ((p - q) / (p + q)).powi(2) } else { 1.0 };
    // Compute the reflectance of light whose electric field oscillates across the plane of the two
    // rays (s), and of light that oscillates within it (p). Half of unpolarised light is of each
    // kind. At Brewster's angle, tan θ1 = n2 / n1, the p part is 0: hence polarising sunglasses.
    let s = ratio(n1 * cos_theta, n2 * cos_2);
    let p = ratio(n1 * cos_2, n2 * cos_theta);
    0.5 * (s + p)
    // <stub> todo!("the mean of the two squared ratios")
    // </solution>
}

// <solution>
/// The cosine of the angle of the refracted ray, `cos θ2`, by Snell's law; `None` beyond the
/// critical angle.
fn cos_behind(cos_1: f32, n1: f32, n2: f32) -> Option<f32> {
    let sin_2_squared = (n1 / n2).powi(2) * (1.0 - cos_1 * cos_1).max(0.0);
    (sin_2_squared <= 1.0).then(|| (1.0 - sin_2_squared).sqrt())
}
// </solution>

/// At most one reflected and one refracted ray leave a surface, each with a weight. Fresnel
/// reflectance F moves a part of the transmission to the reflected ray. Which of the two change the
/// picture? What are n1 and n2 when a ray leaves glass?
///
/// The ray of weight `weight` comes after `depth` reflections and refractions, from outside the
/// material if `entering`. The index of refraction is `material.index_of_refraction` inside and 1
/// outside.
///
/// Exactly:
///
/// 1. The directions are those of [`reflect`] and [`refract`].
/// 2. The weights are `weight · (mirror + F transmission)` and `weight · (1 - F) transmission`,
///    channel by channel.
/// 3. F is that of `material.fresnel`, and 0 for `None`, also beyond the critical angle, where
///    there is no refracted ray.
/// 4. A ray is returned only if `depth < limits.max_depth` and the largest channel of its own
///    weight is above 0 and at least `limits.min_contribution`. The order does not matter.
///
/// Source: "Illumination in ray tracing", "Algorithm (max depth)", "Algorithm (min contribution)".
pub fn scatter(
    direction: Vec3,
    normal: Vec3,
    entering: bool,
    material: &Material,
    weight: Vec3,
    depth: u32,
    limits: &Limits,
) -> Vec<SecondaryRay> {
    // <solution>
    // End the tree at its greatest depth.
    if depth >= limits.max_depth {
        return Vec::new();
    }

    // Compute the Fresnel reflectance for the media on both sides.
    let (n1, n2) =
        if entering { (1.0, material.index_of_refraction) } else { (material.index_of_refraction, 1.0) };
    let cos_theta = (-direction.dot(normal)).clamp(0.0, 1.0);
    let reflectance = match material.fresnel {
        Fresnel::None => 0.0,
        Fresnel::Schlick => fresnel_schlick(cos_theta, n1, n2),
        Fresnel::Exact => fresnel_exact(cos_theta, n1, n2),
    };

    // Compute the weights of both rays.
    let reflected = weight * (material.mirror + reflectance * material.transmission);
    let transmitted = weight * (1.0 - reflectance) * material.transmission;
    let counts = |weight: Vec3| weight.max_element() > 0.0 && weight.max_element() >= limits.min_contribution;

    // Return the rays whose own weight is large enough.
    let mut rays = Vec::new();
    if counts(reflected) {
        rays.push(SecondaryRay {
            bounce: Bounce::Reflection,
            direction: reflect(direction, normal),
            weight: reflected,
        });
    }
    if counts(transmitted)
        && let Some(direction) = refract(direction, normal, n1, n2)
    {
        rays.push(SecondaryRay { bounce: Bounce::Transmission, direction, weight: transmitted });
    }
    rays
    // <stub> todo!("compute the weights of both rays, and return the rays that add something")
    // </solution>
}

/// The slide starts a secondary ray at `hit.Point()`. That point is rounded: which surface do half
/// of these rays hit first?
///
/// The ray has the direction `secondary.direction` and an infinite `t_max`.
///
/// Exactly:
///
/// 1. A reflected ray starts on the side of `surface.geometric_normal`, a refracted ray on the
///    other side: the side to which it goes.
/// 2. Its distance from the point along the normal is as for
///    [`shadow_ray`](crate::stage4_shading::shadow_ray).
///
/// Source: "Algorithm (max depth)".
pub fn spawn_ray(surface: &Surface, secondary: &SecondaryRay) -> Ray {
    // <solution>
    // Move the point by its error, as for shadow rays, because it is rounded to either side of the
    // surface.
    let side = match secondary.bounce {
        Bounce::Reflection => surface.geometric_normal,
        Bounce::Transmission => -surface.geometric_normal,
    };
    Ray::new(off_surface(surface.point, surface.error, side), secondary.direction)
    // <stub> todo!("start off the surface, on the side to which the ray goes")
    // </solution>
}
