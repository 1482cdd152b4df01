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
    // <solution>
    if light.radiance() == Vec3::ZERO {
        return LightEffects::default();
    }
    let area = matches!(light.emitter, Emitter::Area { .. }) && quality.light_samples > 0;
    LightEffects { samples: if area { quality.light_samples } else { 1 }, area, shadows: light.shadows }
    // <stub> todo!("radiance zero: the default; an area light: quality.light_samples samples; else 1 sample")
    // </solution>
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
    // <solution>
    // Test in each channel whether diffuse or specular reflects the light.
    let matters = |light: &Light| {
        let radiance = light.radiance();
        radiance * material.diffuse != Vec3::ZERO || radiance * material.specular != Vec3::ZERO
    };
    // Find out which secondary rays the surface spawns.
    let goes_on = quality.max_depth > 0;
    let transmission = goes_on && material.transmission != Vec3::ZERO;
    let mirror =
        (goes_on && material.mirror != Vec3::ZERO) || (transmission && material.fresnel != Fresnel::None);
    let mirror = mirror || (goes_on && material.coat != 1.0);
    // Roughness matters only for secondary rays, an image only for the light that it multiplies.
    MaterialEffects {
        lights: (0..lights.len()).filter(|&light| matters(&lights[light])).collect(),
        mirror,
        transmission,
        glossy: material.roughness > 0.0 && (mirror || transmission),
        texture: material.texture.is_some()
            && (material.diffuse != Vec3::ZERO || material.ambient != Vec3::ZERO),
    }
    // <stub> todo!("find the lights that matter; then set mirror, transmission, glossy and texture")
    // </solution>
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
    // <solution>
    // List the shown shapes once, and analyse only their materials.
    let shown = scene.shown();
    let is_shown = |material: usize| shown.iter().any(|shape| shape.materials.contains(&material));
    let material = |(index, material)| match is_shown(index) {
        true => material_effects(material, &scene.lights, &scene.quality),
        false => MaterialEffects::default(),
    };
    // Combine the effects of camera, lights, materials and meshes.
    let shutter_moves = scene.camera.shutter.is_some_and(|shutter| shutter.close > shutter.open);
    let mut effects = Effects {
        lens: scene.camera.lens.is_some_and(|lens| lens.aperture > 0.0),
        motion: shutter_moves && shown.iter().any(|shape| shape.moves),
        indirect_light: scene.indirect_light,
        lights: scene.lights.iter().map(|light| light_effects(light, &scene.quality)).collect(),
        materials: scene.materials.iter().enumerate().map(material).collect(),
        smooth_meshes: (0..scene.meshes.len())
            .map(|mesh| scene.meshes[mesh].smooth && shown.iter().any(|shape| shape.mesh == Some(mesh)))
            .collect(),
    };
    // Leave out images that nothing lights.
    for (needs, material) in effects.materials.iter_mut().zip(&scene.materials) {
        needs.texture &= is_lit(material, scene);
    }
    // Find out whether any light can reach the camera.
    let shines = |(index, material): (usize, &Material)| {
        let is_bright = material.emission != Vec3::ZERO || scene.ambient * material.ambient != Vec3::ZERO;
        let shown = shown.iter().any(|shape| shape.materials.contains(&index));
        shown && (is_bright || !effects.materials[index].lights.is_empty())
    };
    match scene.background.is_black() && !scene.materials.iter().enumerate().any(shines) {
        true => Effects {
            lights: effects.lights,
            materials: vec![MaterialEffects::default(); scene.materials.len()],
            smooth_meshes: vec![false; scene.meshes.len()],
            ..Effects::default()
        },
        false => effects,
    }
    // <stub> todo!("list the shown shapes; then combine the effects of camera, lights, materials and meshes")
    // </solution>
}

// <solution>
/// Whether anything can light the colours that an image multiplies.
fn is_lit(material: &Material, scene: &Scene) -> bool {
    scene.lights.iter().any(|light| light.radiance() * material.diffuse != Vec3::ZERO)
        || scene.ambient * material.ambient != Vec3::ZERO
        || (scene.indirect_light && material.diffuse != Vec3::ZERO)
}
// </solution>

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
    // <solution>
    // Count the camera rays.
    let quality = &scene.quality;
    let film = &scene.film;
    let primary = u64::from(film.width) * u64::from(film.height) * u64::from(quality.samples_per_pixel);

    // Find the most secondary rays, the largest weights and the most shadow rays per hit over all
    // materials.
    let mut most = Branching::default();
    let mut most_shadows = 0;
    for (material, takes) in scene.materials.iter().zip(&effects.materials) {
        most = most.or(Branching::of(material, takes, quality));
        most_shadows = most_shadows.max(shadow_places(takes, &effects.lights));
    }

    // Add up the secondary rays bounce by bounce, until their weight is too small. With two
    // reflected rays and a refracted one per hit, the rays of a pixel are
    //
    //     1 primary ─ 3 ─ 9 ─ 27 …    (level: the rays of this bounce; hits: their sum so far)
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
    // Count the shadow rays of all hits.
    rays.shadow = hits.saturating_mul(most_shadows);
    rays
    // <stub> todo!("count camera rays; then secondary rays bounce by bounce; then shadow rays of all hits")
    // </solution>
}

// <solution>
/// The most secondary rays that a hit can spawn, and their largest weights.
#[derive(Clone, Copy, Default)]
struct Branching {
    /// The number of reflected rays per hit.
    reflected: u64,
    /// The number of refracted rays per hit.
    transmitted: u64,
    /// The number of reflected and refracted rays per hit.
    both: u64,
    /// The weight of all reflected or all refracted rays of a hit together, whichever is larger.
    image_weight: f32,
    /// The weight of one of these rays.
    ray_weight: f32,
}

impl Branching {
    /// The secondary rays of a hit of `material`, whose effects are `takes`.
    fn of(material: &Material, takes: &MaterialEffects, quality: &Quality) -> Branching {
        // Count the rays of each kind.
        let parts = if takes.glossy { quality.glossy_samples } else { 1 };
        let count = |sent: bool| if sent { u64::from(parts) } else { 0 };
        // Compute the largest weight of a reflection; with fresnel it can contain all transmitted
        // light.
        let through = if takes.transmission { material.transmission } else { Vec3::ZERO };
        let mirrored = match material.fresnel {
            Fresnel::None => material.mirror,
            Fresnel::Schlick | Fresnel::Exact => material.mirror + through,
        };
        let mirrored = if material.coat == 1.0 { mirrored } else { mirrored.max(Vec3::ONE) };
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

    /// The larger of each number.
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

/// The most shadow rays of a hit: the samples of all lights that matter and cast shadows.
fn shadow_places(takes: &MaterialEffects, lights: &[LightEffects]) -> u64 {
    let casting = takes.lights.iter().map(|&light| &lights[light]).filter(|light| light.shadows);
    casting.map(|light| u64::from(light.samples)).sum()
}
// </solution>

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
    // <solution>
    let mut rays = RayCounts::default();
    for MaterialHits { material, hits, in_front } in hits {
        // Look up the effects of the material.
        let takes = &effects.materials[*material];
        let parts = if takes.glossy { u64::from(quality.glossy_samples) } else { 1 };
        // Add the camera rays and the shadow rays of this row.
        rays.primary += hits;
        rays.shadow += takes
            .lights
            .iter()
            .filter(|&&light| effects.lights[light].shadows)
            .map(|&light| in_front[light])
            .sum::<u64>();
        // Add its secondary rays.
        rays.reflection += if takes.mirror { hits * parts } else { 0 };
        rays.transmission += if takes.transmission { hits * parts } else { 0 };
    }
    rays
    // <stub> todo!("add up the rays row by row, as the effects of the row's material say")
    // </solution>
}

/// The standard error of the mean of n random samples is `deviation / √n`. How many more samples
/// does half the error need?
///
/// Returns the smallest n of at least 1 with `deviation / √n <= error`, in double precision; both
/// numbers are 0 or more. It is 1 if `deviation` is 0, also with an `error` of 0, and `u32::MAX` if
/// n does not fit `u32` or no n is large enough.
pub fn samples_for_error(deviation: f32, error: f32) -> u32 {
    // <solution>
    // Solve deviation / √n = error for n.
    let ratio = f64::from(deviation) / f64::from(error);
    // Round up. `as` converts numbers that are too large to u32::MAX, and NaN (0 / 0) to 0.
    ((ratio * ratio).ceil() as u32).max(1)
    // <stub> todo!("solve deviation / √n = error for n, and round up")
    // </solution>
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
    // <solution>
    // Map the index into 0..size, in i64 because it can be negative.
    let size = i64::from(size);
    let inside = match wrap {
        // The remainder by a power of two is the lowest bits, also of a negative number, and most
        // images have such a size: a division would take longer than the rest of a read.
        Wrap::Repeat if size & (size - 1) == 0 => index & (size - 1),
        // `%` of a negative number is negative or 0; rem_euclid is never negative.
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Clamp => index.clamp(0, size - 1),
        Wrap::Mirror => {
            let back_and_forth = index.rem_euclid(2 * size);
            back_and_forth.min(2 * size - 1 - back_and_forth)
        }
    };
    inside as u32
    // <stub> todo!("map the index into 0..size, as the wrap mode says")
    // </solution>
}

/// The colour of the texture at `uv`, by bilinear interpolation of the four nearest pixels.
/// `(0, 0)` is the lower left corner and `(1, 1)` the upper right one, but rows are stored from the
/// top. A pixel's colour belongs to its centre. At which u is the centre of the first column?
///
/// Exactly:
///
/// 1. [`texel`] with `texture.wrap` gives the column and row of each pixel.
pub fn texture_color(texture: &Texture, uv: Vec2) -> Vec3 {
    // <solution>
    // Replace a coordinate by 0 if it is NaN or infinite, or if its product with the size
    // overflows.
    let finite = |coordinate: f32, size: f32| if (coordinate * size).is_finite() { coordinate } else { 0.0 };
    let (width, height) = (texture.width as f32, texture.height as f32);
    // Convert uv to pixels, counted from the centre of the upper left pixel.
    let (x, y) = (finite(uv.x, width) * width - 0.5, (1.0 - finite(uv.y, height)) * height - 0.5);
    // Split the coordinates into the upper left pixel and the distances from its centre.
    let (left, top) = (raykata::rounding::floor(x), raykata::rounding::floor(y));
    let (dx, dy) = (x - left, y - top);
    // Find the columns and rows of the four pixels by the wrap mode.
    let both = |first: f32, size: u32| {
        let (first, wrap) = (first as i64, texture.wrap);
        [texel(first, size, wrap) as usize, texel(first.saturating_add(1), size, wrap) as usize]
    };
    let ([left, right], [top, bottom]) = (both(left, texture.width), both(top, texture.height));
    let pixel = |column: usize, row: usize| texture.pixels[row * texture.width as usize + column];
    // Interpolate along x in both rows, then along y.
    let upper = pixel(left, top).lerp(pixel(right, top), dx);
    let lower = pixel(left, bottom).lerp(pixel(right, bottom), dx);
    upper.lerp(lower, dy)
    // <stub> todo!("find the four pixels around uv and interpolate between them")
    // </solution>
}
