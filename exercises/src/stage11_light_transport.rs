//! Stage 11 · light transport: the parts of a path tracer. Light reaches the camera by any number
//! of reflections, and each path is a random sample of one way that it takes.
//!
//! Slides: `slides/stage11.md`, which go beyond the lectures. Sources: Kajiya, "The Rendering
//! Equation" (1986), Veach, "Robust Monte Carlo Methods for Light Transport Simulation" (1997), and
//! the book "Physically Based Rendering" (pbr-book.org).
//!
//! These functions draw no random numbers: random numbers are arguments, `u` in `0.0..1.0` each. A
//! density (pdf) is per steradian, the unit of solid angle. Any formula passes whose samples have
//! the density that it states, unless the doc comment gives the formula. Sizes and distances of
//! emitters are between 1e-4 and 1e4.

use glam::{Vec2, Vec3};
use raykata::emitter::{AreaEmitter, EmitterSample, EmitterShape};

/// A random direction around `normal` with the density `cos θ / π`, where θ is the angle between
/// both. Malley's method projects a uniform point of the unit disk up to the hemisphere. In a
/// closed white room wrong directions look right: where do they not?
///
/// `normal` has any direction; both vectors have unit length. `direction·normal` is at least -1e-6:
/// never below the surface, except for rounding.
///
/// Source: Malley's method, in "Physically Based Rendering".
pub fn cosine_direction(normal: Vec3, u: Vec2) -> Vec3 {
    todo!("sample a disk uniformly, and project the point up to the hemisphere around normal")
}

/// The density of [`cosine_direction`]: `cos θ / π`, because `cos θ` has the integral π over the
/// hemisphere. What sign has it below the surface?
///
/// Both vectors have unit length. The density of a direction below the surface is 0.
pub fn cosine_pdf(normal: Vec3, direction: Vec3) -> f32 {
    todo!("divide the cosine by π, and return 0 below the surface")
}

/// A random point of `emitter`, seen from `from`. A piece dA of the light fills the solid angle
/// `cos θ dA / d²`, so uniform points of the area A have the density `d² / (A cos θ)`. A sphere of
/// radius R fills a cone: `2π (1 - cos θ)` with `sin θ = R / d`. What is `1 - cos θ` far away?
///
/// Exactly:
///
/// 1. `None` if the radiance is 0, if `from` is behind an emitter that is not two-sided (for a
///    sphere: inside), or in the plane of a triangle or parallelogram.
/// 2. Otherwise every `u` gives a sample, with the emitter's `radiance`.
/// 3. `distance` is that of the point that a ray from `from` hits first.
/// 4. Samples reach each point that is seen; inside a two-sided sphere these are all directions.
/// 5. `pdf` is the density of their directions at `from`.
///
/// Source: "Area Lights"; "Physically Based Rendering", chapter "Light Sources".
pub fn sample_light(emitter: &AreaEmitter, from: Vec3, u: Vec2) -> Option<EmitterSample> {
    todo!("sample a point of the emitter, and return the density of its direction per steradian")
}

/// The density with which [`sample_light`] samples `direction`, a unit vector. Is it the same as
/// the density of the point per area?
///
/// Exactly:
///
/// 1. 0 if a ray from `from` in this direction does not meet the emitter (its edge or rim may count
///    either way), or if `sample_light` returns `None`.
/// 2. For a direction of `sample_light` it is the sample's `pdf`, up to rounding.
pub fn light_pdf(emitter: &AreaEmitter, from: Vec3, direction: Vec3) -> f32 {
    todo!("find the point that the direction meets, and return its density per steradian")
}

/// The weight of a sample in multiple importance sampling. Two techniques find the same light,
/// which must count once. The one with the larger density has less noise, so it gets more:
/// `p₁ / (p₁ + p₂)` (balance heuristic) or `p₁² / (p₁² + p₂²)` (power heuristic). What is 1e30²?
///
/// The sample was taken with density `own`; the other technique has density `other` for it, both
/// 0 to ∞; a mirror has ∞. If both are 0 or both ∞, only item 1 counts.
///
/// Exactly:
///
/// 1. The weight is in `0..=1`.
/// 2. Both weights sum to 1.
/// 3. The larger density has the larger weight.
/// 4. It is 1 if `other` is 0 or `own` is ∞, and 0 if `own` is 0 or `other` is ∞.
/// 5. One sample of each technique has a variance of at most a quarter of the squared mean, for
///    square lights of side 0.02 to 2 at distance 1 and lobes `cosⁿ θ`, n from 1 to 10,000, as with
///    both heuristics.
///
/// Source: Veach and Guibas, SIGGRAPH 1995.
pub fn mis_weight(own: f32, other: f32) -> f32 {
    todo!("compare the two densities: balance heuristic or power heuristic")
}

/// Russian roulette: a path survives with probability q, and its weight is divided by q. So the
/// mean stays right, and dim paths cost less. What if bright paths end as well?
///
/// Returns the factor for the weight of the path; 0 ends it. `bounce` counts the surfaces that the
/// path has met. Each channel of `weight` is 0 or more; w is the largest.
///
/// Exactly:
///
/// 1. If w is 0, the factor is 0.
/// 2. If w is above 0 and `bounce` is below 3, it is 1.
/// 3. Otherwise it is `1 / q` with probability q, and else 0.
/// 4. q is at least `min(w, 0.95)`, and at most `(1 + w) / 2` and 1. Any such rule passes.
///
/// Source: Arvo and Kirk, "Particle Transport and Image Synthesis" (1990).
pub fn survives(weight: Vec3, bounce: u32, u: f32) -> f32 {
    todo!("let the path survive with a probability, and divide by this probability")
}

/// The fraction of the light that is missing if paths end after n `bounces`. In a closed room whose
/// surfaces all emit `Le` and have albedo ρ, the light is `Le (1 + ρ + ρ² + …)`. Without the terms
/// after `ρⁿ` the fraction `ρⁿ⁺¹` is missing.
///
/// `albedo` is in `0..=1`; `bounces` is any number, also the largest. The relative error is at most
/// 1e-4, or the absolute error at most 1e-6.
pub fn cut_off(albedo: f32, bounces: u32) -> f32 {
    todo!("raise the albedo to the power bounces + 1")
}

/// The smallest number of bounces n with `albedo^(n + 1) <= error`: see [`cut_off`]. What are the
/// logarithms of 0 and 1?
///
/// `albedo` and `error` are in `0..=1`. The powers are computed in double precision. The result is
/// `u32::MAX` if no n that fits is enough: at an albedo of 1 with an error below 1, and at an
/// albedo above 0 with an error of 0.
pub fn bounces_for_error(albedo: f32, error: f32) -> u32 {
    todo!("solve albedo^(n + 1) = error for n, and round up")
}
