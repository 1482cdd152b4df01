//! Stage 4 · shading: the Phong model, shadow rays and gamma correction.
//!
//! Slides: `slides/stage04.md`.
//!
//! All directions have unit length and point away from the surface, unless a function says
//! otherwise. [`Surface`] has the point, its two unit normals (both on the viewer's side) and a
//! bound on the rounding error of the point.

use glam::Vec3;
use raykata::kit::{LightSample, Surface};
use raykata::material::Material;
use raykata::ray::Ray;

/// A smooth surface is shaded with its `interpolated` normal, a flat one with its `geometric`
/// normal, on the viewer's side. Near a silhouette the two may disagree: which one tells this side?
///
/// Returns a unit normal, with either sign where a dot product is 0. `direction` is that of the
/// ray from the viewer.
///
/// Exactly:
///
/// 1. `geometric`, of unit length, is negated if its dot product with `direction` is above 0.
/// 2. `interpolated` (length 1e-18 to 1e18) is normalized, and negated if its dot product with the
///    turned geometric normal is below 0.
/// 3. If `interpolated` is `None` or 0, the turned geometric normal is returned.
///
/// Source: "Smooth Shading".
pub fn shading_normal(geometric: Vec3, interpolated: Option<Vec3>, direction: Vec3) -> Vec3 {
    todo!("normalize the interpolated normal if there is one, and turn it to the viewer's side")
}

/// The diffuse term of the Phong model is `cos θ = n·l`: a tilted surface receives less light per
/// area. It is 0 for a light behind the surface.
///
/// Source: "Local illumination".
pub fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32 {
    todo!("return the cosine, but never less than 0")
}

/// The specular term of the Phong model is `cosⁿ φ`, with the angle φ between the reflected light
/// `r = 2 (n·l) n - l` and the viewer. What is a power of a negative cosine? Can a light behind the
/// surface give a positive one?
///
/// The power n is `exponent`, at least 0. If it is 0, any result in `0..=1` passes. If one of the
/// cosines is 0, both 0 and the power pass.
///
/// Exactly:
///
/// 1. 0 if the light is behind the surface (`cos θ = n·l < 0`).
/// 2. 0 if `cos φ < 0`.
///
/// Source: "Local illumination".
pub fn specular_term(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32 {
    todo!("reflect the light by the normal, and raise the cosine with the viewer to the exponent")
}

/// A shadow ray goes from the surface to the light: what it hits occludes the light. The point is
/// rounded, so it may lie on either side of the surface. What does the ray hit first? What is at
/// its other end?
///
/// Exactly:
///
/// 1. `None` if `light.radiance` is 0, or if the dot product of `light.direction` with either
///    normal is 0 or less.
/// 2. The ray has the direction of the light. It ends between 0.99 and 1 times `light.distance`
///    (not included); an infinite distance stays infinite.
/// 3. It starts on the viewer's side, at least `error·|n|` from the point along the geometric
///    normal n; `|n|` has the absolute values of its coordinates. Rounding must not make this more
///    than 1 % smaller.
/// 4. It starts at most `4 error·|n|` plus 64 rounding steps of the largest coordinate away, so
///    that close objects are hit.
///
/// Source: "Shadow ray", "Cost of shadow computation".
#[inline]
pub fn shadow_ray(surface: &Surface, light: &LightSample) -> Option<Ray> {
    todo!("return None for a light behind the surface, otherwise a ray that excludes both ends")
}

/// The colour that the viewer sees, by the Phong model:
///
/// ```text
/// A·ka + Σ V_i (I_i·kd·cosθ_i + I_i·ks·cosⁿφ_i)
/// ```
///
/// A is `ambient`, I_i is `lights[i].radiance`, and ka, kd, ks and n are those of `material`. Which
/// lights need no shadow ray?
///
/// Exactly:
///
/// 1. Colours are multiplied channel by channel. The sum is not clamped.
/// 2. The cosines are those of [`diffuse_term`] and [`specular_term`] with
///    `surface.shading_normal`.
/// 3. V_i is 1 if `visible(i, ray)` is true for the ray of [`shadow_ray`], and 0 otherwise.
/// 4. `visible` is called at most once per light, and not if `shadow_ray` is `None` or the light
///    would add 0 in every channel.
///
/// Source: "Local illumination", "Shadows", "Cost of shadow computation".
pub fn shade(
    surface: &Surface,
    to_viewer: Vec3,
    material: &Material,
    ambient: Vec3,
    lights: &[LightSample],
    mut visible: impl FnMut(usize, &Ray) -> bool,
) -> Vec3 {
    todo!("add up the ambient term and, for each visible light, its diffuse and specular terms")
}

/// With gamma 2, the byte for a component of linear light x is `255 √x`, rounded to the nearest
/// byte. What is the square root of -1e-8?
///
/// `linear` is clamped to `0..=1`, so -∞ gives 0 and ∞ gives 255. It is not NaN.
///
/// Source: "Gamma Correction".
pub fn encode_gamma(linear: f32) -> u8 {
    todo!("take the square root and scale to 0..=255; mind values below 0 and above 1")
}

/// The component of linear light for a byte with gamma 2: `(byte / 255)²`, in `0..=1`.
///
/// Source: "Gamma Correction".
pub fn decode_gamma(byte: u8) -> f32 {
    todo!("scale to 0..=1 and square")
}
