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

// <solution>
use crate::stage4_shading::off_surface;
// </solution>

/// The direction of a mirrored ray: `d' = d - 2 n (d·n)`, of unit length.
///
/// Where the formula lies: each bounce makes the direction a rounding longer or shorter, and between two mirrors that
/// adds up.
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    // <solution>
    (direction - 2.0 * direction.dot(normal) * normal).normalize()
    // <stub> todo!("mirror direction on the normal, and normalise")
    // </solution>
}

/// The direction behind the surface by Snell's law, `n1 sin θ1 = n2 sin θ2`, of unit length; `None` if all light is
/// mirrored: beyond the critical angle there is no such direction.
///
/// Where the formula lies: the slide divides by `sin θ1`, which is 0 for a ray along the normal, and takes the root of
/// `1 - sin² θ2`, which is negative beyond the critical angle.
pub fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
    // <solution>
    let ratio = n1 / n2;
    // direction = sin θ1 m - cos θ1 n for some m along the surface. Keeping sin θ1 m in one piece needs no division.
    let cos_1 = -direction.dot(normal);
    let along = direction + cos_1 * normal;
    let along_2 = ratio * along;
    let cos_2_squared = 1.0 - along_2.length_squared();
    if !(cos_2_squared >= 0.0) {
        return None; // Total internal reflection; NaN ends here, too.
    }
    (along_2 - cos_2_squared.sqrt() * normal).try_normalize()
    // <stub> todo!("bend the part of direction along the surface by n1 / n2; None beyond the critical angle")
    // </solution>
}

/// The share of light that a surface between two clear media mirrors, by Schlick's formula
/// `R0 + (1 - R0) (1 - cos θ)⁵` with `R0 = ((n1 - n2) / (n1 + n2))²`; 1 beyond the critical angle.
///
/// Where the formula lies: coming from the denser side, the angle in it must be the larger one, behind the surface.
pub fn fresnel_schlick(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    // <solution>
    let cosine = if n1 > n2 {
        match cos_behind(cos_theta, n1, n2) {
            Some(cos_2) => cos_2,
            None => return 1.0,
        }
    } else {
        cos_theta
    };
    let r0 = ((n1 - n2) / (n1 + n2)).powi(2);
    r0 + (1.0 - r0) * (1.0 - cosine).clamp(0.0, 1.0).powi(5)
    // <stub> todo!("Schlick's formula; from the denser side with the cosine behind the surface")
    // </solution>
}

/// The same exactly, for light without polarisation: the mean of
/// `((n1 cos θ1 - n2 cos θ2) / (n1 cos θ1 + n2 cos θ2))²` and the same with `θ1` and `θ2` exchanged; 1 beyond the
/// critical angle.
pub fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32 {
    // <solution>
    let Some(cos_2) = cos_behind(cos_theta, n1, n2) else { return 1.0 };
    let ratio = |p: f32, q: f32| if p + q > 0.0 { ((p - q) / (p + q)).powi(2) } else { 1.0 };
    0.5 * (ratio(n1 * cos_theta, n2 * cos_2) + ratio(n1 * cos_2, n2 * cos_theta))
    // <stub> todo!("the mean of the two squared ratios")
    // </solution>
}

// <solution>
/// `cos θ2` by Snell's law; `None` beyond the critical angle.
fn cos_behind(cos_1: f32, n1: f32, n2: f32) -> Option<f32> {
    let sin_2_squared = (n1 / n2).powi(2) * (1.0 - cos_1 * cos_1).max(0.0);
    (sin_2_squared <= 1.0).then(|| (1.0 - sin_2_squared).sqrt())
}
// </solution>

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
    // <solution>
    if depth >= limits.max_depth {
        return Vec::new();
    }
    let (n1, n2) =
        if entering { (1.0, material.index_of_refraction) } else { (material.index_of_refraction, 1.0) };
    let cos_theta = (-direction.dot(normal)).clamp(0.0, 1.0);
    let mirrored_share = match material.fresnel {
        Fresnel::None => 0.0,
        Fresnel::Schlick => fresnel_schlick(cos_theta, n1, n2),
        Fresnel::Exact => fresnel_exact(cos_theta, n1, n2),
    };

    let reflected = weight * (material.mirror + mirrored_share * material.transmission);
    let transmitted = weight * (1.0 - mirrored_share) * material.transmission;
    let counts = |weight: Vec3| weight.max_element() > 0.0 && weight.max_element() >= limits.min_contribution;

    let mut children = Vec::new();
    if counts(reflected) {
        children.push(SecondaryRay {
            bounce: Bounce::Reflection,
            direction: reflect(direction, normal),
            weight: reflected,
        });
    }
    if counts(transmitted)
        && let Some(direction) = refract(direction, normal, n1, n2)
    {
        children.push(SecondaryRay { bounce: Bounce::Transmission, direction, weight: transmitted });
    }
    children
    // <stub> todo!("weigh the mirrored and the refracted ray, and return those that are worth tracing")
    // </solution>
}

/// The endless ray that follows `child`. It starts just off the surface, on the side to which it goes: what is mirrored
/// on the side of `surface.geometric_normal`, what goes through on the other one.
///
/// Where the formula lies: the slide starts it at `hit.Point()`. That point is rounded, so half of all rays that start
/// there meet their own surface again. Move it by its error, as for shadow rays.
pub fn spawn_ray(surface: &Surface, child: &SecondaryRay) -> Ray {
    // <solution>
    let side = match child.bounce {
        Bounce::Reflection => surface.geometric_normal,
        Bounce::Transmission => -surface.geometric_normal,
    };
    Ray::new(off_surface(&Surface { geometric_normal: side, ..*surface }), child.direction)
    // <stub> todo!("start off the surface, on the side to which the ray goes")
    // </solution>
}
