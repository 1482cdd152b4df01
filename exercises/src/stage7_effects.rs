//! Stage 7 · effects: analyse the scene first, and compute only what it needs.
//!
//! Slides: `slides/stage07.md`. This kit promises that an effect costs nothing where it is not
//! visible.
//!
//! The tracer does what your functions return. If they return too much, the picture is right but
//! costs too many rays; if they return too little, something is missing in the picture.

use glam::{Vec2, Vec3};
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{MaterialHits, RayCounts};
use raykata::material::{Emitter, Fresnel, Light, Material, Texture, Wrap};
use raykata::scene::{Quality, Scene};

/// How many samples a light needs, whether they are spread over an area, and whether it casts
/// shadows. Each sample costs a shadow ray per hit. Which lights emit nothing?
///
/// Exactly:
///
/// 1. A [`Light::radiance`] of 0 in all channels needs nothing: `LightEffects::default()`.
/// 2. An area light has `area`, and `quality.light_samples` samples, if that number is above 0.
/// 3. Every other light has 1 sample and no `area`.
/// 4. `shadows` is `light.shadows`.
pub fn light_effects(light: &Light, quality: &Quality) -> LightEffects {
    todo!("radiance zero: the default; an area light: quality.light_samples samples; else 1 sample")
}

/// Which lights, secondary rays and images can change the colour of a surface of `material`. What
/// does a red light add to a green wall?
///
/// Exactly:
///
/// 1. `lights`: the indices, ascending, of all lights of which, in some channel,
///    [`Light::radiance`] is not 0 and `diffuse` or `specular` is not 0.
/// 2. `transmission`: `material.transmission` is not 0 in some channel, for every index of
///    refraction.
/// 3. `mirror`: `material.mirror` is not 0 in some channel, or `coat` is not 1, or rays are
///    refracted and `fresnel` is not [`Fresnel::None`].
/// 4. Both are `false` if `quality.max_depth` is 0.
/// 5. `glossy`: `roughness` is above 0, and `mirror` or `transmission` is set.
/// 6. `texture`: there is an image, and `diffuse` or `ambient` is not 0.
pub fn material_effects(material: &Material, lights: &[Light], quality: &Quality) -> MaterialEffects {
    todo!("find the lights that matter; then set mirror, transmission, glossy and texture")
}

/// The effects that the scene needs. [`Scene::shown`] lists the shapes that a root reaches, with
/// their materials and meshes, and whether they move. What can a scene name that no ray meets?
///
/// Exactly:
///
/// 1. `lens`: a lens has an aperture above 0.
/// 2. `motion`: a shown shape moves, and a shutter closes later than it opens.
/// 3. `indirect_light`: as in the scene.
/// 4. `lights`: [`light_effects`] of each light in order, also of those that emit nothing.
/// 5. `materials`: [`material_effects`] of each material that a shown shape has, the default for
///    all others.
/// 6. `texture` is also `false` if nothing lights the image: `scene.ambient` times `ambient` and
///    each radiance times `diffuse` are 0, and so is `diffuse` or there is no indirect light.
/// 7. `smooth_meshes`: per mesh, whether it is smooth and shown.
/// 8. All but `lights` is `false` or the default if nothing shines: the background
///    [`is_black`](raykata::scene::Background::is_black), and each shown material has no
///    `emission`, lists no light, and `scene.ambient` times `ambient` is 0.
pub fn effects(scene: &Scene) -> Effects {
    todo!("list the shown shapes; then combine the effects of camera, lights, materials and meshes")
}

/// The most rays that a picture can cost, as if every ray hit the most expensive material. How many
/// can there be after 1000 bounces?
///
/// Exactly:
///
/// 1. `primary`: one ray per sample of each pixel.
/// 2. `reflection`: a hit of a material with `mirror` spawns `quality.glossy_samples` rays if it is
///    glossy, else 1; `transmission` likewise. The largest number over all materials counts; for
///    the next level, that of both together.
/// 3. There are at most `quality.max_depth` bounces, each only if the weight of the whole
///    reflection or refraction is above 0 and at least `quality.min_contribution`.
/// 4. A camera ray weighs 1. A reflection weighs the largest channel of `mirror` (with `fresnel`,
///    of `mirror + transmission`; with `coat` not 1, at least 1), a refraction that of
///    `transmission`, times the ray's weight. The largest counts; each of `glossy_samples` rays has
///    an equal part.
/// 5. `shadow`: each hit, also of the last bounce, needs a ray per sample of each shadow-casting
///    light that its material lists. The largest sum counts.
/// 6. A number beyond `u64` is `u64::MAX`.
pub fn most_rays(scene: &Scene, effects: &Effects) -> RayCounts {
    todo!("count camera rays; then secondary rays bounce by bounce; then shadow rays of all hits")
}

/// Counts the rays that these hits need, exactly. When is hits times lights too many? Each row has
/// an index into `effects.materials`; several rows can have the same one. `in_front[light]` counts
/// the samples of a light in front of the surface, over all hits of the row.
///
/// Exactly:
///
/// 1. `primary`: the sum of `hits`.
/// 2. `shadow`: the sum of `in_front[light]` over all lights that matter to the material and cast
///    shadows.
/// 3. `reflection`: per hit of a material with `mirror`, `quality.glossy_samples` rays if it is
///    glossy, else 1. `transmission` likewise.
pub fn rays_of_hits(hits: &[MaterialHits], effects: &Effects, quality: &Quality) -> RayCounts {
    todo!("add up the rays row by row, as the effects of the row's material say")
}

/// The standard error of the mean of n random samples is `deviation / √n`. How many more samples
/// does half the error need?
///
/// Returns the smallest n of at least 1 with `deviation / √n <= error`, in double precision; both
/// numbers are 0 or more. It is 1 if `deviation` is 0, also with an `error` of 0, and `u32::MAX` if
/// n does not fit `u32` or no n is large enough.
pub fn samples_for_error(deviation: f32, error: f32) -> u32 {
    todo!("solve deviation / √n = error for n, and round up")
}

/// The column (or row), in `0..size`, that is shown at `index`, which may lie far outside. `size`
/// is at least 1. What is `-1 % 3`?
///
/// ```text
/// index   -2 -1  0  1  2  3  4   (size 3)
/// Repeat   1  2  0  1  2  0  1   starts again
/// Clamp    0  0  0  1  2  2  2   the border continues
/// Mirror   1  0  0  1  2  2  1   back and forth, each border pixel twice
/// ```
pub fn texel(index: i64, size: u32, wrap: Wrap) -> u32 {
    todo!("map the index into 0..size, as the wrap mode says")
}

/// The colour of the texture at `uv`, by bilinear interpolation of the four nearest pixels.
/// `(0, 0)` is the lower left corner and `(1, 1)` the upper right one, but rows are stored from the
/// top. A pixel's colour belongs to its centre. At which u is the centre of the first column?
///
/// Exactly:
///
/// 1. [`texel`] with `texture.wrap` gives the column and row of each pixel.
pub fn texture_color(texture: &Texture, uv: Vec2) -> Vec3 {
    todo!("find the four pixels around uv and interpolate between them")
}
