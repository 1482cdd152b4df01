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
    todo!("normalise the interpolated normal if there is one, and turn it to the viewer's side")
}

/// `cos θ` between normal and light, the share of diffuse light. A light behind the surface gives 0, not less.
pub fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32 {
    todo!("return the cosine, but never less than 0")
}

/// `cosⁿ φ` between the mirrored light and the viewer, the strength of the highlight; 0 if the light is behind the
/// surface.
///
/// Where the formula lies: for `cos φ < 0` an even power is positive, and a broken one is NaN.
pub fn specular_term(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32 {
    todo!("mirror the light on the normal and raise its cosine with the viewer to the exponent")
}

/// The ray that asks whether `light` is visible from `surface`: it starts just off the surface, has the light's
/// direction, and ends just before the light. `None` if the light is behind the surface or has no light to give, for
/// then no ray is worth tracing.
///
/// Where the formula lies: a ray from the point itself hits the surface it starts on in half of all cases, and one
/// that reaches all the way hits the light. A fixed distance fails at other scales: move by the error of the point.
pub fn shadow_ray(surface: &Surface, light: &LightSample) -> Option<Ray> {
    todo!("return None for a light behind the surface; else a ray that leaves out both ends")
}

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
    todo!("add up ambient light and, for each light that is visible, its diffuse and specular part")
}

/// Linear light to a byte with gamma 2: the square root of `linear`, in `0..=255`, rounded.
///
/// Where the formula lies: the root of -1e-8 is NaN, and NaN becomes a silent black.
pub fn encode_gamma(linear: f32) -> u8 {
    todo!("take the square root and scale to 0..=255; mind values below 0 and above 1")
}

/// A byte back to linear light with gamma 2.
pub fn decode_gamma(byte: u8) -> f32 {
    todo!("scale to 0..=1 and square")
}
