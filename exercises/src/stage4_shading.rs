//! Stage 4 · shading: the Phong model, shadow rays and gamma correction.
//!
//! Slides: "Local illumination", "Shadow ray", "Cost of shadow computation", "Coloured Lights", "Smooth Shading",
//! "Gamma Correction".
//!
//! All directions have unit length and point away from the surface, unless a function says otherwise. [`Surface`] has
//! the point, its two unit normals (both on the viewer's side) and a bound on the rounding error of the point.

use glam::Vec3;
use raykata::kit::{LightSample, Surface};
use raykata::material::Material;
use raykata::ray::Ray;

/// The unit normal for shading: the `interpolated` normal on a smooth surface, and the `geometric` normal otherwise, each
/// on the side of the surface from which the ray comes.
///
/// `direction` is the direction of the ray that comes from the viewer. `geometric` has unit length; it is negated if
/// its dot product with `direction` is above 0. `interpolated` has either sign and any length between 1e-18 and 1e18; it
/// is normalized, and negated if its dot product with the turned geometric normal is below 0. If `interpolated` is
/// `None`, has length 0 or is NaN, the turned geometric normal is returned. For a dot product of 0 either sign passes.
///
/// Pitfall: the average of several normals may be zero or NaN, which has no direction. Near the silhouette of a smooth
/// mesh the interpolated normal may point away from the viewer, who still sees the front: the geometric normal decides
/// which side is the front, not `direction`.
///
/// Slide "Smooth Shading".
pub fn shading_normal(geometric: Vec3, interpolated: Option<Vec3>, direction: Vec3) -> Vec3 {
    todo!("normalize the interpolated normal if there is one, and turn it to the viewer's side")
}

/// The diffuse term of the Phong model: `cos θ`, the cosine of the angle between the normal and the direction to the
/// light.
///
/// Both vectors have unit length. For a light behind the surface, where the cosine is negative, the result is 0.
///
/// Slide "Local illumination".
pub fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32 {
    todo!("return the cosine, but never less than 0")
}

/// The specular term of the Phong model: `cosⁿ φ`, where φ is the angle between the reflected light and the viewer,
/// and n is `exponent`.
///
/// All vectors have unit length, and `exponent` is at least 0; for an exponent of 0 any result in `0..=1` passes. The
/// result is 0 if the light is behind the surface (`cos θ < 0`, with θ as in [`diffuse_term`]) or if `cos φ < 0`. If one
/// of the two cosines is 0, both 0 and the power pass.
///
/// Pitfall: a negative cosine to an even power is positive, and to a fractional power it is NaN. The reflection of a light
/// behind the surface may still point to the viewer, with `cos φ > 0`.
///
/// Slide "Local illumination".
pub fn specular_term(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32 {
    todo!("reflect the light by the normal, and raise the cosine with the viewer to the exponent")
}

/// The shadow ray from `surface` to `light`: an object that it hits occludes the light.
///
/// The result is `None` if `light.radiance` is 0, or if the light is behind the surface: if the dot product of
/// `light.direction` with the geometric normal or with the shading normal is 0 or less. Otherwise the ray has the
/// direction of the light. It ends just before the light, between 0.99 of `light.distance` and the distance itself (not
/// included); an infinite distance stays infinite. It starts on the viewer's side of the surface. The distance of its
/// start from the point along the geometric normal n is at least `error·|n|`, because the true surface may be that far
/// from the rounded point; rounding must not make it more than 1 % smaller. The distance is at most `4 error·|n|` plus 64
/// rounding steps of the largest coordinate, so that close objects are hit. Here `|n|` has the absolute values of the
/// three coordinates of n.
///
/// Pitfall: a ray that starts at the rounded point hits its own surface in about half of all cases (shadow acne), and a
/// ray over the whole distance hits the light itself. A fixed offset is too small or too large at other scales. The sum
/// `point + offset n` is rounded, too: move each coordinate one float further (`next_up`, `next_down`), or move twice as
/// far.
///
/// Slides "Shadow ray" and "Cost of shadow computation".
#[inline]
pub fn shadow_ray(surface: &Surface, light: &LightSample) -> Option<Ray> {
    todo!("return None for a light behind the surface, otherwise a ray that excludes both ends")
}

/// The colour that the viewer sees, by the Phong model: `A·ka + Σ V_i (I_i·kd·cosθ_i + I_i·ks·cosⁿφ_i)`.
///
/// Colours are multiplied channel by channel. A is `ambient`, I_i is `lights[i].radiance`, and ka, kd, ks and n are
/// `material.ambient`, `diffuse`, `specular` and `exponent`. The cosines are those of [`diffuse_term`] and
/// [`specular_term`] with `surface.shading_normal`. V_i is 1 if `visible(i, ray)` is true for the ray of
/// [`shadow_ray`], and 0 otherwise. Call `visible` before you add a light, at most once per light. Do not call it if
/// `shadow_ray` returns `None` or if the light would add 0 in every channel. The colour is not clamped.
///
/// Pitfall: 1000 × 1000 pixels with 10 lights need at most 10,000,000 shadow rays. A light behind the surface, or one
/// that adds 0, needs none.
///
/// Slides "Local illumination", "Shadows" and "Cost of shadow computation".
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

/// The byte for a component of linear light with gamma 2: 255 times the square root of `linear`, rounded to the nearest
/// byte.
///
/// `linear` is clamped to `0..=1`: values below 0, also -∞, give 0, and values above 1, also ∞, give 255. NaN gives 0.
///
/// Pitfall: the square root of -1e-8 is NaN, and `NaN as u8` is 0 without a warning.
///
/// Slide "Gamma Correction".
pub fn encode_gamma(linear: f32) -> u8 {
    todo!("take the square root and scale to 0..=255; mind values below 0 and above 1")
}

/// The component of linear light for a byte with gamma 2: `(byte / 255)²`, in `0..=1`.
///
/// Slide "Gamma Correction".
pub fn decode_gamma(byte: u8) -> f32 {
    todo!("scale to 0..=1 and square")
}
