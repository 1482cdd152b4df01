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
    // <solution>
    // Turn the geometric normal to the viewer. It decides which side is the front, because near the
    // silhouette the interpolated normal may point away from a viewer who still sees the front.
    let toward_viewer = if geometric.dot(direction) > 0.0 { -geometric } else { geometric };
    // A sum of normals that is 0 or NaN has no direction: `try_normalize` returns None for it.
    match interpolated.and_then(Vec3::try_normalize) {
        None => toward_viewer,
        Some(smooth) if smooth.dot(toward_viewer) < 0.0 => -smooth,
        Some(smooth) => smooth,
    }
    // <stub> todo!("normalize the interpolated normal if there is one, and turn it to the viewer's side")
    // </solution>
}

/// The diffuse term of the Phong model is `cos θ = n·l`: a tilted surface receives less light per
/// area. It is 0 for a light behind the surface.
///
/// Source: "Local illumination".
pub fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32 {
    // <solution>
    normal.dot(to_light).max(0.0)
    // <stub> todo!("return the cosine, but never less than 0")
    // </solution>
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
    // <solution>
    let cos_theta = normal.dot(to_light);
    let reflected = 2.0 * cos_theta * normal - to_light;
    let cos_phi = reflected.dot(to_viewer);
    // Test both cosines before the power: a negative number to an even power is positive, and to a
    // fractional power it is NaN. The reflection of a light behind the surface may point to the
    // viewer.
    if cos_theta > 0.0 && cos_phi > 0.0 { cos_phi.powf(exponent) } else { 0.0 }
    // <stub> todo!("reflect the light by the normal, and raise the cosine with the viewer to the exponent")
    // </solution>
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
    // <solution>
    // Return None for a light that cannot add anything.
    let in_front = surface.geometric_normal.dot(light.direction) > 0.0
        && surface.shading_normal.dot(light.direction) > 0.0;
    if !in_front || light.radiance == Vec3::ZERO {
        return None;
    }
    // Start off the surface and end before the light.
    let origin = off_surface(surface.point, surface.error, surface.geometric_normal);
    Some(Ray::new(origin, light.direction).with_range(0.0, light.distance * BEFORE_THE_LIGHT))
    // <stub> todo!("return None for a light behind the surface, otherwise a ray that excludes both ends")
    // </solution>
}

// <solution>
/// The fraction of the distance to the light at which a shadow ray ends. The light may be a surface
/// of the scene, and its distance is rounded. One part in ten thousand is more than a thousand
/// roundings of slack, and still too short to hide an object.
const BEFORE_THE_LIGHT: f32 = 0.9999;

/// The origin of a ray that leaves the surface on the side of the unit normal `side`, as close to
/// the surface as the rounding error of `point` allows (Pharr, Jakob and Humphreys, "Physically
/// Based Rendering", 4th edition, section 6.8.6).
#[inline]
pub fn off_surface(point: Vec3, error: Vec3, side: Vec3) -> Vec3 {
    // Move along the normal by the bound on the error: the true surface is at most this far from
    // the point.
    let origin = point + error.dot(side.abs()) * side;
    // Move each coordinate one float further outwards, because the sum is rounded as well.
    let outwards = |axis: usize| match side[axis] {
        along if along > 0.0 => origin[axis].next_up(),
        along if along < 0.0 => origin[axis].next_down(),
        _ => origin[axis],
    };
    Vec3::new(outwards(0), outwards(1), outwards(2))
}
// </solution>

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
    // <solution>
    // Begin with the ambient term.
    let mut color = ambient * material.ambient;
    for (index, light) in lights.iter().enumerate() {
        // Skip lights that need no shadow ray.
        let Some(ray) = shadow_ray(surface, light) else { continue };

        // Compute the diffuse and the specular term.
        let normal = surface.shading_normal;
        let diffuse = material.diffuse * diffuse_term(normal, light.direction);
        // Compute no power for a material without highlights: it takes as long as a ray/triangle
        // test.
        let specular = match material.specular {
            Vec3::ZERO => Vec3::ZERO,
            strength => strength * specular_term(normal, light.direction, to_viewer, material.exponent),
        };

        // Trace the shadow ray only if the light adds something.
        let unshadowed = light.radiance * (diffuse + specular);
        if unshadowed != Vec3::ZERO && visible(index, &ray) {
            color += unshadowed;
        }
    }
    color
    // <stub> todo!("add up the ambient term and, for each visible light, its diffuse and specular terms")
    // </solution>
}

/// With gamma 2, the byte for a component of linear light x is `255 √x`, rounded to the nearest
/// byte. What is the square root of -1e-8?
///
/// `linear` is clamped to `0..=1`, so -∞ gives 0 and ∞ gives 255. It is not NaN.
///
/// Source: "Gamma Correction".
pub fn encode_gamma(linear: f32) -> u8 {
    // <solution>
    // Clamp first, because the root of a negative number is NaN. The cast rounds down, and makes 0
    // of NaN.
    (255.0 * linear.clamp(0.0, 1.0).sqrt() + 0.5) as u8
    // <stub> todo!("take the square root and scale to 0..=255; mind values below 0 and above 1")
    // </solution>
}

/// The component of linear light for a byte with gamma 2: `(byte / 255)²`, in `0..=1`.
///
/// Source: "Gamma Correction".
pub fn decode_gamma(byte: u8) -> f32 {
    // <solution>
    (f32::from(byte) / 255.0).powi(2)
    // <stub> todo!("scale to 0..=1 and square")
    // </solution>
}
