//! Stage 4 · shading: how bright is a point, and does light reach it at all?
//!
//! Slides: "Local illumination", "Shadow ray", "Cost of shadow computation", "Coloured Lights", "Smooth Shading",
//! "Gamma Correction".
//!
//! All directions are of unit length and point away from the surface. [`Surface`] has the point, its two normals (both
//! on the viewer's side) and a bound on the rounding error of the point.

use glam::Vec3;
use raykata::kit::{LightSample, Surface};
use raykata::material::Material;
use raykata::ray::Ray;

/// The normal to shade with, on the side from which a ray of direction `direction` comes: on a smooth surface the
/// `interpolated` one, otherwise the `geometric` one.
///
/// Where the formula lies: normals may average to zero or to NaN, which has no direction. Then the surface is shaded
/// flat.
pub fn shading_normal(geometric: Vec3, interpolated: Option<Vec3>, direction: Vec3) -> Vec3 {
    // <solution>
    let toward_viewer = if geometric.dot(direction) > 0.0 { -geometric } else { geometric };
    match interpolated.and_then(Vec3::try_normalize) {
        None => toward_viewer,
        Some(smooth) if smooth.dot(toward_viewer) < 0.0 => -smooth,
        Some(smooth) => smooth,
    }
    // <stub> todo!("normalise the interpolated normal if there is one, and turn it to the viewer's side")
    // </solution>
}

/// `cos θ` between normal and light, the share of diffuse light. A light behind the surface gives 0, not less.
pub fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32 {
    // <solution>
    normal.dot(to_light).max(0.0)
    // <stub> todo!("return the cosine, but never less than 0")
    // </solution>
}

/// `cosⁿ φ` between the mirrored light and the viewer, the strength of the highlight; 0 if the light is behind the
/// surface.
///
/// Where the formula lies: for `cos φ < 0` an even power is positive, and a broken one is NaN.
pub fn specular_term(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32 {
    // <solution>
    let cos_theta = normal.dot(to_light);
    let mirrored = 2.0 * cos_theta * normal - to_light;
    let cos_phi = mirrored.dot(to_viewer);
    if cos_theta > 0.0 && cos_phi > 0.0 { cos_phi.powf(exponent) } else { 0.0 }
    // <stub> todo!("mirror the light on the normal and raise its cosine with the viewer to the exponent")
    // </solution>
}

/// The ray that asks whether `light` is visible from `surface`: it starts just off the surface, has the light's
/// direction, and ends just before the light. `None` if the light is behind the surface or has no light to give, for
/// then no ray is worth tracing.
///
/// Where the formula lies: a ray from the point itself hits the surface it starts on in half of all cases, and one
/// that reaches all the way hits the light. A fixed distance fails at other scales: move by the error of the point.
pub fn shadow_ray(surface: &Surface, light: &LightSample) -> Option<Ray> {
    // <solution>
    let in_front = surface.geometric_normal.dot(light.direction) > 0.0
        && surface.shading_normal.dot(light.direction) > 0.0;
    if !in_front || light.radiance == Vec3::ZERO {
        return None;
    }
    let origin = off_surface(surface);
    Some(Ray::new(origin, light.direction).with_range(0.0, light.distance * BEFORE_THE_LIGHT))
    // <stub> todo!("return None for a light behind the surface; else a ray that leaves out both ends")
    // </solution>
}

// <solution>
/// A light may be a surface of the scene, and its distance is rounded. One part in ten thousand is a thousand roundings
/// of slack, and too short for anything to be seen between.
const BEFORE_THE_LIGHT: f32 = 0.9999;

/// A point on the viewer's side of the surface, as near to it as its error allows (Pharr, Jakob and Humphreys,
/// "Physically Based Rendering", 4th edition, section 6.8.6).
pub fn off_surface(surface: &Surface) -> Vec3 {
    // Stage 10 says this once more: its `offset_origin` is an exercise, and shadows may not wait for that.
    // The true surface is within `error` of the point; seen along the normal, that is this far.
    let normal = surface.geometric_normal;
    let origin = surface.point + surface.error.dot(normal.abs()) * normal;

    // The sum is rounded as well, so go one more step outwards on each axis.
    let mut outside = origin;
    for axis in 0..3 {
        if normal[axis] > 0.0 {
            outside[axis] = origin[axis].next_up();
        } else if normal[axis] < 0.0 {
            outside[axis] = origin[axis].next_down();
        }
    }
    outside
}
// </solution>

/// The colour that the viewer sees: `A·ka + Σ V_i (I_i·kd·cosθ_i + I_i·ks·cosⁿφ_i)`, channel by channel, with
/// `material.ambient`, `diffuse`, `specular` and `exponent`. `visible(i, ray)` traces a shadow ray for light `i`; ask
/// only when the answer can matter.
///
/// Where the formula lies: 1000 × 1000 pixels with 10 lights need 10,000,000 shadow rays at most. A light behind the
/// surface, or one that adds nothing, needs none.
pub fn shade(
    surface: &Surface,
    to_viewer: Vec3,
    material: &Material,
    ambient: Vec3,
    lights: &[LightSample],
    mut visible: impl FnMut(usize, &Ray) -> bool,
) -> Vec3 {
    // <solution>
    let mut color = ambient * material.ambient;
    for (index, light) in lights.iter().enumerate() {
        let Some(ray) = shadow_ray(surface, light) else { continue };
        let normal = surface.shading_normal;
        let diffuse = material.diffuse * diffuse_term(normal, light.direction);
        // A power takes as long as a ray/triangle test, so dull surfaces do without.
        let specular = match material.specular {
            Vec3::ZERO => Vec3::ZERO,
            strength => strength * specular_term(normal, light.direction, to_viewer, material.exponent),
        };
        let unshadowed = light.radiance * (diffuse + specular);
        if unshadowed != Vec3::ZERO && visible(index, &ray) {
            color += unshadowed;
        }
    }
    color
    // <stub> todo!("add up ambient light and, for each light that is visible, its diffuse and specular part")
    // </solution>
}

/// Linear light to a byte with gamma 2: the square root of `linear`, in `0..=255`, rounded.
///
/// Where the formula lies: the root of -1e-8 is NaN, and NaN becomes a silent black.
pub fn encode_gamma(linear: f32) -> u8 {
    // <solution>
    (255.0 * linear.clamp(0.0, 1.0).sqrt() + 0.5) as u8
    // <stub> todo!("take the square root and scale to 0..=255; mind values below 0 and above 1")
    // </solution>
}

/// A byte back to linear light with gamma 2.
pub fn decode_gamma(byte: u8) -> f32 {
    // <solution>
    (f32::from(byte) / 255.0).powi(2)
    // <stub> todo!("scale to 0..=1 and square")
    // </solution>
}
