//! Stage 7 · effects: analyse the scene first, and compute only what it needs.
//!
//! Slides: "Cost of shadow computation", "Distributed Ray Tracing", "Each vertex holds … texture coordinates". This kit
//! promises that an effect costs nothing where it is not visible.
//!
//! The tracer does what your functions return. If they return too much, the picture is right but costs too many rays; if
//! they return too little, something is missing in the picture.

use glam::{Vec2, Vec3};
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{MaterialHits, RayCounts};
use raykata::material::{Emitter, Fresnel, Light, Material, Texture, Wrap};
use raykata::scene::{Quality, Scene};

/// Computes how many samples a light needs, whether they are spread over an area, and whether it casts shadows.
///
/// - A light whose [`Light::radiance`] is zero in all channels emits nothing and needs nothing:
///   `LightEffects::default()`.
/// - An area light needs `quality.light_samples` samples, and `area` is `true`, if that number is above 0.
/// - Every other light needs 1 sample, and `area` is `false`. So does an area light if `quality.light_samples` is 0.
/// - `shadows` is `light.shadows`.
///
/// Pitfall: a light emits nothing if its colour or its intensity is 0. A red light has two channels of 0 and still emits.
pub fn light_effects(light: &Light, quality: &Quality) -> LightEffects {
    todo!("radiance zero: the default; an area light: quality.light_samples samples; else 1 sample")
}

/// Computes which lights, secondary rays and images can change the colour of a surface of `material`.
///
/// - `lights`: the indices of the lights that matter, in ascending order. A light matters if, in some channel, its
///   [`Light::radiance`] is not 0 and `diffuse` or `specular` is not 0.
/// - `transmission`: whether `material.transmission` is not 0 in some channel, for every index of refraction.
/// - `mirror`: whether `material.mirror` is not 0 in some channel, or rays are refracted and `fresnel` is not
///   [`Fresnel::None`], because then the surface also reflects a part of this light, or `coat` is not 1.
/// - Both are `false` if `quality.max_depth` is 0.
/// - `glossy`: whether `roughness` is above 0 and `mirror` or `transmission` is set.
/// - `texture`: whether there is an image and `diffuse` or `ambient`, which the image multiplies, is not 0.
///
/// Pitfall: a red light adds nothing to a green wall, although neither is black. Multiply channel by channel.
pub fn material_effects(material: &Material, lights: &[Light], quality: &Quality) -> MaterialEffects {
    todo!("find the lights that matter; then set mirror, transmission, glossy and texture")
}

/// Computes the effects that the scene needs. [`Scene::shown`] lists the shapes that a root of the scene reaches, with
/// their materials and meshes and whether they move.
///
/// - `lens`: whether there is a lens whose aperture is above 0.
/// - `motion`: whether a shown shape moves and the shutter closes later than it opens. Without a shutter it is `false`.
/// - `indirect_light`: as in the scene.
/// - `lights`: [`light_effects`] for each light of the scene, in order, also for lights that emit nothing.
/// - `materials`: [`material_effects`] for each material that some shown shape has, and `MaterialEffects::default()` for
///   all others, in the order of the scene. But `texture` is `false` where nothing lights the image: `scene.ambient`
///   times `ambient` is 0, each light's radiance times `diffuse` is 0, and so is `diffuse` or there is no indirect light.
/// - `smooth_meshes`: for each mesh of the scene whether it is smooth and shown.
/// - If nothing shines, the picture is black: everything except `lights` is `false`, and each material has the default.
///   Nothing shines if the background [`is_black`](raykata::scene::Background::is_black), and each shown material has no
///   `emission`, lists no light, and `scene.ambient` times `ambient` is 0.
///
/// Pitfall: a mesh can have several materials, and a node that no root reaches is not shown.
pub fn effects(scene: &Scene) -> Effects {
    todo!("list the shown shapes; then combine the effects of camera, lights, materials and meshes")
}

/// An upper bound on the number of rays of each kind, as if every ray hit the most expensive material: what is the most that
/// a picture can cost? A hit has one material.
///
/// Exactly:
///
/// - `primary`: one ray per sample of each pixel.
/// - `reflection`: each hit spawns `quality.glossy_samples` rays if its material is glossy, else 1; `transmission` alike. The
///   largest number over all materials counts, for the next level that of both kinds together.
/// - A bounce is traced if it is one of the first `quality.max_depth`, and the weight of its whole reflection or refraction is
///   above 0 and at least `quality.min_contribution`.
/// - A camera ray weighs 1. A reflection weighs the largest channel of `mirror` (with `fresnel`, of `mirror + transmission`;
///   with a `coat` other than 1, at least 1), a refraction that of `transmission`, times the weight of the ray. The largest
///   weight over all materials counts; each of the `glossy_samples` rays has an equal part of it.
/// - `shadow`: each hit, also of the last bounce, needs a ray per sample of each light that its material lists and that casts
///   shadows. The material with the largest sum counts.
/// - What does not fit `u64` is `u64::MAX`.
pub fn most_rays(scene: &Scene, effects: &Effects) -> RayCounts {
    todo!("count camera rays; then secondary rays bounce by bounce; then shadow rays of all hits")
}

/// Counts the rays of each kind that these hits need, exactly. Each row of the table names its material by an index into
/// `effects.materials`; several rows can name the same material.
///
/// - `primary`: one ray made each hit, so this is the sum of `hits`.
/// - `shadow`: the sum of `in_front[light]` over all lights that matter to the material and cast shadows. `in_front`
///   counts the samples of a light in front of the surface, over all hits of the row.
/// - `reflection`: for each hit of a material with `mirror`, `quality.glossy_samples` rays if it is glossy, else 1.
///   `transmission`: the same for a material with `transmission`.
///
/// Pitfall: hits times lights is right only if all lights lie in front of all surfaces.
pub fn rays_of_hits(hits: &[MaterialHits], effects: &Effects, quality: &Quality) -> RayCounts {
    todo!("add up the rays row by row, as the effects of the row's material say")
}

/// Computes how many random samples make the standard error of their mean at most `error`, if the standard deviation of
/// one sample is `deviation`. Both are 0 or more.
///
/// The result is the smallest n of at least 1 with `deviation / √n <= error`, computed in double precision. It is
/// `u32::MAX` if n does not fit `u32` or no n is large enough, and 1 if `deviation` is 0, also with an `error` of 0.
///
/// Pitfall: the error falls with the square root of n, so half the error needs four times as many samples.
pub fn samples_for_error(deviation: f32, error: f32) -> u32 {
    todo!("solve deviation / √n = error for n, and round up")
}

/// Computes which column (or row) of an image is shown at `index`, which may lie far outside of the image. The image has
/// `size` columns, at least 1; the result is in `0..size`.
///
/// - [`Wrap::Repeat`]: the image starts again: 0 follows `size - 1`.
/// - [`Wrap::Clamp`]: the border continues: the result is 0 below 0, and `size - 1` above.
/// - [`Wrap::Mirror`]: the image runs back and forth and shows each border pixel twice in a row: -1 gives 0, and `size`
///   gives `size - 1`.
///
/// Pitfall: `%` of a negative number is negative or 0. Use `rem_euclid`.
pub fn texel(index: i64, size: u32, wrap: Wrap) -> u32 {
    todo!("map the index into 0..size, as the wrap mode says")
}

/// Computes the colour of the texture at `uv` by bilinear interpolation of the four nearest pixels.
///
/// `(0, 0)` is the lower left corner of the image and `(1, 1)` its upper right corner. Rows are stored from the top.
/// Outside of the image, [`texel`] with `texture.wrap` gives the column and the row of each of the four pixels. Every
/// `uv` gives a colour: a coordinate that is NaN or infinite counts as 0, and so does one whose product with the width
/// or height is infinite.
///
/// Pitfall: the colour of a pixel belongs to its centre, so column 0 lies at half a pixel, not at 0.
pub fn texture_color(texture: &Texture, uv: Vec2) -> Vec3 {
    todo!("find the four pixels around uv and interpolate between them")
}
