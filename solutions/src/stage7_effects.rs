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
    // <solution>
    if light.radiance() == Vec3::ZERO {
        return LightEffects::default();
    }
    let area = matches!(light.emitter, Emitter::Area { .. }) && quality.light_samples > 0;
    LightEffects { samples: if area { quality.light_samples } else { 1 }, area, shadows: light.shadows }
    // <stub> todo!("no light: nothing; a light with an extent: quality.light_samples places; else one place")
    // </solution>
}

/// What a surface takes that is made of `material`.
///
/// - A light matters if some channel of its [`Light::radiance`] meets a `diffuse` or `specular` that is not 0 there.
/// - Rays are mirrored if `mirror` is not 0, or if the surface lets light through and `fresnel` mirrors part of it; they
///   go through if `transmission` is not 0; neither if `quality.max_depth` is 0.
/// - Rough is only what is also mirrored or seen through. An image matters if `diffuse` or `ambient` is not 0.
pub fn material_effects(material: &Material, lights: &[Light], quality: &Quality) -> MaterialEffects {
    // <solution>
    let matters = |light: &Light| {
        let radiance = light.radiance();
        radiance * material.diffuse != Vec3::ZERO || radiance * material.specular != Vec3::ZERO
    };
    let goes_on = quality.max_depth > 0;
    let transmission = goes_on && material.transmission != Vec3::ZERO;
    let mirror =
        (goes_on && material.mirror != Vec3::ZERO) || (transmission && material.fresnel != Fresnel::None);
    MaterialEffects {
        lights: (0..lights.len()).filter(|&light| matters(&lights[light])).collect(),
        mirror,
        transmission,
        glossy: material.roughness > 0.0 && (mirror || transmission),
        texture: material.texture.is_some()
            && (material.diffuse != Vec3::ZERO || material.ambient != Vec3::ZERO),
    }
    // <stub> todo!("which lights matter, and whether it mirrors, lets through, blurs, reads an image")
    // </solution>
}

/// What the scene takes. [`Scene::shown`] lists all shapes that are in it, with their materials and whether they move.
///
/// - The lens matters if its aperture is above 0.
/// - Time matters if something that is shown moves, and the shutter closes later than it opens.
/// - Materials of which nothing is shown take nothing, `MaterialEffects::default()`. Meshes of which none is shown are
///   not smooth.
/// - `indirect_light` is as the scene says.
pub fn effects(scene: &Scene) -> Effects {
    // <solution>
    let shown = scene.shown();
    let is_shown = |material: usize| shown.iter().any(|shape| shape.materials.contains(&material));
    let material = |(index, material)| match is_shown(index) {
        true => material_effects(material, &scene.lights, &scene.quality),
        false => MaterialEffects::default(),
    };
    let shutter_moves = scene.camera.shutter.is_some_and(|shutter| shutter.close > shutter.open);
    Effects {
        lens: scene.camera.lens.is_some_and(|lens| lens.aperture > 0.0),
        motion: shutter_moves && shown.iter().any(|shape| shape.moves),
        indirect_light: scene.indirect_light,
        lights: scene.lights.iter().map(|light| light_effects(light, &scene.quality)).collect(),
        materials: scene.materials.iter().enumerate().map(material).collect(),
        smooth_meshes: (0..scene.meshes.len())
            .map(|mesh| scene.meshes[mesh].smooth && shown.iter().any(|shape| shape.mesh == Some(mesh)))
            .collect(),
    }
    // <stub> todo!("ask what is shown, and put together what each part takes")
    // </solution>
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
    // <solution>
    let quality = &scene.quality;
    let film = &scene.film;
    let primary = u64::from(film.width) * u64::from(film.height) * u64::from(quality.samples_per_pixel);

    let mut most = Branching::default();
    let mut most_shadows = 0;
    for (material, takes) in scene.materials.iter().zip(&effects.materials) {
        most = most.or(Branching::of(material, takes, quality));
        most_shadows = most_shadows.max(shadow_places(takes, &effects.lights));
    }

    let mut rays = RayCounts { primary, ..RayCounts::default() };
    let (mut level, mut hits, mut weight) = (primary, primary, 1.0);
    for _ in 0..quality.max_depth {
        let image = weight * most.image_weight;
        if !(image > 0.0 && image >= quality.min_contribution) {
            break;
        }
        rays.reflection = rays.reflection.saturating_add(level.saturating_mul(most.reflected));
        rays.transmission = rays.transmission.saturating_add(level.saturating_mul(most.transmitted));
        level = level.saturating_mul(most.both);
        hits = hits.saturating_add(level);
        weight *= most.ray_weight;
    }
    rays.shadow = hits.saturating_mul(most_shadows);
    rays
    // <stub> todo!("primary rays; then level by level what the worst material sends on; then shadows for every hit")
    // </solution>
}

// <solution>
/// What a hit can send on at most, and what that weighs at most.
#[derive(Clone, Copy, Default)]
struct Branching {
    reflected: u64,
    transmitted: u64,
    both: u64,
    /// Of all mirrored or all refracted rays of a hit together.
    image_weight: f32,
    /// Of one of them.
    ray_weight: f32,
}

impl Branching {
    fn of(material: &Material, takes: &MaterialEffects, quality: &Quality) -> Branching {
        let parts = if takes.glossy { quality.glossy_samples } else { 1 };
        let count = |sent: bool| if sent { u64::from(parts) } else { 0 };
        let through = if takes.transmission { material.transmission } else { Vec3::ZERO };
        let mirrored = match material.fresnel {
            Fresnel::None => material.mirror,
            Fresnel::Schlick | Fresnel::Exact => material.mirror + through,
        };
        let mirrored = if takes.mirror { mirrored } else { Vec3::ZERO };
        let image_weight = mirrored.max_element().max(through.max_element());
        Branching {
            reflected: count(takes.mirror),
            transmitted: count(takes.transmission),
            both: count(takes.mirror) + count(takes.transmission),
            image_weight,
            ray_weight: image_weight / parts as f32,
        }
    }

    fn or(self, other: Branching) -> Branching {
        Branching {
            reflected: self.reflected.max(other.reflected),
            transmitted: self.transmitted.max(other.transmitted),
            both: self.both.max(other.both),
            image_weight: self.image_weight.max(other.image_weight),
            ray_weight: self.ray_weight.max(other.ray_weight),
        }
    }
}

/// Places on lights that a hit asks with a shadow ray, at most.
fn shadow_places(takes: &MaterialEffects, lights: &[LightEffects]) -> u64 {
    let casting = takes.lights.iter().map(|&light| &lights[light]).filter(|light| light.shadows);
    casting.map(|light| u64::from(light.samples)).sum()
}
// </solution>

/// The rays that these hits take, exactly: one ray each that made the hits (`primary`); one to each place on a light in
/// front of the surface, if the light matters to the material and casts shadows; and what the material sends on, 1 ray
/// of a kind or `quality.glossy_samples` if it is rough.
///
/// Where the formula lies: hits times lights is right only if every surface is lit by every light.
pub fn rays_of_hits(hits: &[MaterialHits], effects: &Effects, quality: &Quality) -> RayCounts {
    // <solution>
    let mut rays = RayCounts::default();
    for MaterialHits { material, hits, in_front } in hits {
        let takes = &effects.materials[*material];
        let parts = if takes.glossy { u64::from(quality.glossy_samples) } else { 1 };
        rays.primary += hits;
        rays.shadow += takes
            .lights
            .iter()
            .filter(|&&light| effects.lights[light].shadows)
            .map(|&light| in_front[light])
            .sum::<u64>();
        rays.reflection += if takes.mirror { hits * parts } else { 0 };
        rays.transmission += if takes.transmission { hits * parts } else { 0 };
    }
    rays
    // <stub> todo!("add up, material by material, only what its effects say")
    // </solution>
}

/// How many random samples it takes until their mean is off by no more than `error` on average, if one sample is off by
/// `deviation`: n with `deviation / √n <= error`, the smallest one, at least 1; as many as there can be (`u32::MAX`) if
/// none is enough.
pub fn samples_for_error(deviation: f32, error: f32) -> u32 {
    // <solution>
    // The error falls with the root of the number, so half of it takes four times as many.
    let ratio = f64::from(deviation) / f64::from(error);
    // `as` takes what is too large for the largest number, and NaN (0 / 0: nothing is off) for 0.
    ((ratio * ratio).ceil() as u32).max(1)
    // <stub> todo!("solve deviation / √n = error for n, and round up")
    // </solution>
}

/// The column (or row) of an image of `size` columns that is shown where column `index` would be, which may lie far
/// outside: `Repeat` begins again, `Clamp` draws out the border, `Mirror` goes back and forth, showing the border twice.
///
/// Where the formula lies: `%` of a negative number is negative.
pub fn texel(index: i64, size: u32, wrap: Wrap) -> u32 {
    // <solution>
    let size = i64::from(size);
    let inside = match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Clamp => index.clamp(0, size - 1),
        Wrap::Mirror => {
            let back_and_forth = index.rem_euclid(2 * size);
            back_and_forth.min(2 * size - 1 - back_and_forth)
        }
    };
    inside as u32
    // <stub> todo!("bring the index into 0..size")
    // </solution>
}

/// The colour of the image at `uv`, from the four nearest pixels (bilinear). `(0, 0)` is the lower left corner of the
/// image and `(1, 1)` the upper right one; rows are stored from the top. A coordinate that is not finite counts as 0.
///
/// Where the formula lies: the colour of a pixel belongs to its middle, so pixel 0 is at half a pixel and not at 0.
pub fn texture_color(texture: &Texture, uv: Vec2) -> Vec3 {
    // <solution>
    // Large ones may overflow on the way.
    let finite = |share: f32, size: f32| if (share * size).is_finite() { share } else { 0.0 };
    let (width, height) = (texture.width as f32, texture.height as f32);
    // In pixels from the middle of the first one.
    let (x, y) = (finite(uv.x, width) * width - 0.5, (1.0 - finite(uv.y, height)) * height - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (right_share, lower_share) = (x - left, y - top);
    let pixel = |column: i64, row: i64| {
        let column = texel(column, texture.width, texture.wrap) as usize;
        let row = texel(row, texture.height, texture.wrap) as usize;
        texture.pixels[row * texture.width as usize + column]
    };
    let row = |row: i64| {
        let column = left as i64;
        pixel(column, row).lerp(pixel(column.saturating_add(1), row), right_share)
    };
    row(top as i64).lerp(row((top as i64).saturating_add(1)), lower_share)
    // <stub> todo!("find the four pixels around uv, and blend them by how near they are")
    // </solution>
}
