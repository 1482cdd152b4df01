//! Stage 7 · effects: look at the scene first, and compute only what it calls for.
//!
//! Slides: "Cost of shadow computation", "Distributed Ray Tracing", "Each vertex holds … texture coordinates"; and the promise of this kit that
//! no effect costs anything where it is not seen.
//!
//! What you return decides what the tracer does. Too much, and the picture is right but costs more than it should; too
//! little, and something is missing.

use glam::{Vec2, Vec3};
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{MaterialHits, RayCounts};
use raykata::material::{Emitter, Fresnel, Light, Material, Texture, Wrap};
use raykata::scene::{Quality, Scene};

/// What a light takes: for one without any light nothing at all, `LightEffects::default()`. Otherwise it casts shadows
/// if `light.shadows`; an area light is spread over `quality.light_samples` places if there are any; everything else
/// shines from 1 place.
pub fn light_effects(light: &Light, quality: &Quality) -> LightEffects {
    todo!("no light: nothing; a light with an extent: quality.light_samples places; else one place")
}

/// What a surface takes that is made of `material`.
///
/// - A light matters if some channel of its [`Light::radiance`] meets a `diffuse` or `specular` that is not 0 there.
/// - Rays are mirrored if `mirror` is not 0, or if the surface lets light through and `fresnel` mirrors part of it; they
///   go through if `transmission` is not 0; neither if `quality.max_depth` is 0.
/// - Rough is only what is also mirrored or seen through. An image matters if `diffuse` or `ambient` is not 0.
pub fn material_effects(material: &Material, lights: &[Light], quality: &Quality) -> MaterialEffects {
    todo!("which lights matter, and whether it mirrors, lets through, blurs, reads an image")
}

/// What the scene takes. [`Scene::shown`] lists all shapes that are in it, with their materials and whether they move.
///
/// - The lens matters if its aperture is above 0.
/// - Time matters if something that is shown moves, and the shutter closes later than it opens.
/// - Materials of which nothing is shown take nothing, `MaterialEffects::default()`. Meshes of which none is shown are
///   not smooth.
/// - `indirect_light` is as the scene says.
pub fn effects(scene: &Scene) -> Effects {
    todo!("ask what is shown, and put together what each part takes")
}

/// The most rays that the scene can take, as if every ray hit the surface that costs most.
///
/// - One ray from the camera for each sample of each pixel.
/// - A hit mirrors at most as many rays as the material that mirrors most of them: 1, or `quality.glossy_samples` if it
///   is rough; likewise for rays that go through, and for both together. This goes on for `quality.max_depth` bounces,
///   or until even the brightest ray counts too little: a ray is traced while the weight of the mirror image (of the
///   glass) as a whole is above 0 and reaches `quality.min_contribution`, and counts its part of that weight. With
///   `fresnel`, the mirror image weighs at most `mirror + transmission`.
/// - Each hit sends a shadow ray to each place of each light that matters and casts shadows, at most as many as for the
///   material with most of them.
///
/// Products and sums that do not fit stay at `u64::MAX`.
pub fn most_rays(scene: &Scene, effects: &Effects) -> RayCounts {
    todo!("primary rays; then level by level what the worst material sends on; then shadows for every hit")
}

/// The rays that these hits take, exactly: one ray each that made the hits (`primary`); one to each place on a light in
/// front of the surface, if the light matters to the material and casts shadows; and what the material sends on, 1 ray
/// of a kind or `quality.glossy_samples` if it is rough.
///
/// Where the formula lies: hits times lights is right only if every surface is lit by every light.
pub fn rays_of_hits(hits: &[MaterialHits], effects: &Effects, quality: &Quality) -> RayCounts {
    todo!("add up, material by material, only what its effects say")
}

/// How many random samples it takes until their mean is off by no more than `error` on average, if one sample is off by
/// `deviation`: n with `deviation / √n <= error`, the smallest one, at least 1; as many as there can be (`u32::MAX`) if
/// none is enough.
pub fn samples_for_error(deviation: f32, error: f32) -> u32 {
    todo!("solve deviation / √n = error for n, and round up")
}

/// The column (or row) of an image of `size` columns that is shown where column `index` would be, which may lie far
/// outside: `Repeat` begins again, `Clamp` draws out the border, `Mirror` goes back and forth, showing the border twice.
///
/// Where the formula lies: `%` of a negative number is negative.
pub fn texel(index: i64, size: u32, wrap: Wrap) -> u32 {
    todo!("bring the index into 0..size")
}

/// The colour of the image at `uv`, from the four nearest pixels (bilinear). `(0, 0)` is the lower left corner of the
/// image and `(1, 1)` the upper right one; rows are stored from the top. A coordinate that is not finite counts as 0.
///
/// Where the formula lies: the colour of a pixel belongs to its middle, so pixel 0 is at half a pixel and not at 0.
pub fn texture_color(texture: &Texture, uv: Vec2) -> Vec3 {
    todo!("find the four pixels around uv, and blend them by how near they are")
}
