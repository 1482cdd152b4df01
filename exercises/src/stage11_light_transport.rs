//! Stage 11 · light transport: the parts of a path tracer. Light reaches the camera by any number of reflections, and each
//! path is a random sample of one way that it takes.
//!
//! This stage goes beyond the slides, which end with "Next: Global Illumination". Its sources are Kajiya, "The Rendering
//! Equation" (1986), Veach, "Robust Monte Carlo Methods for Light Transport Simulation" (1997), and the book "Physically
//! Based Rendering" (pbr-book.org).
//!
//! These functions draw no random numbers: random numbers are arguments, `u` in `0.0..1.0` each. A density (pdf) is per
//! steradian, the unit of solid angle. Any formula passes whose samples have the density that it states, unless the doc
//! comment gives the formula.

use glam::{Vec2, Vec3};
use raykata::emitter::{AreaEmitter, EmitterSample, EmitterShape};

/// A random direction on the side of the surface to which `normal` points, with density `cos θ / π`: cosine-weighted
/// sampling of the hemisphere. θ is the angle between the direction and `normal`.
///
/// `normal` has unit length and any direction, and so has the result. It is never below the surface, except for rounding:
/// `direction·normal` is at least -1e-6.
///
/// Pitfall: with a uniform θ or a uniform `cos θ` the picture looks plausible, and in a closed white room it is even right.
/// A frame from the cross product with a fixed axis does not exist for a normal along that axis.
///
/// Malley's method, in "Physically Based Rendering".
pub fn cosine_direction(normal: Vec3, u: Vec2) -> Vec3 {
    todo!("sample a disk uniformly, and project the point up to the hemisphere around normal")
}

/// The probability density of [`cosine_direction`], per steradian: `cos θ / π`.
///
/// Both vectors have unit length. The density of a direction below the surface is 0.
///
/// Pitfall: below the surface `cos θ` is negative, and a negative density makes light that has to be added disappear.
pub fn cosine_pdf(normal: Vec3, direction: Vec3) -> f32 {
    todo!("divide the cosine by π, and return 0 below the surface")
}

/// A random point of `emitter` that sends light to the point `from`, with the density of its direction.
///
/// `None` if the emitter sends no light to `from`: its radiance is 0, `from` is behind an emitter that is not two-sided (for
/// a sphere: inside), or `from` lies in the plane of a triangle or parallelogram. Otherwise every `u` gives a sample. Its
/// `radiance` is that of the emitter; its `distance` is that of the point of the emitter that a ray from `from` hits first.
/// Samples reach each point that is seen from `from`, and `pdf` is the density of their directions at `from`, per
/// steradian. Sizes and distances are between 1e-4 and 1e4.
///
/// Uniform points of the area A of a triangle or parallelogram have the density `distance² / (A cos θ)`, with the angle θ
/// between the direction and the normal of the emitter. For a sphere sample the cone in which it is seen, whose solid angle
/// is `2π (1 - cos θ)` with `sin θ = radius / distance to the centre`. From inside a two-sided sphere all directions meet
/// it.
///
/// Pitfall: half of the points of a sphere are on its far side. `1 - cos θ` of a far sphere is rounded to 0; it is
/// `sin² θ / (1 + cos θ)`.
///
/// "Physically Based Rendering", "Area Lights".
pub fn sample_light(emitter: &AreaEmitter, from: Vec3, u: Vec2) -> Option<EmitterSample> {
    todo!("sample a point of the emitter, and return the density of its direction per steradian")
}

/// The probability density, per steradian, with which [`sample_light`] samples `direction`, a unit vector.
///
/// It is 0 if a ray from `from` in this direction does not meet the emitter, and if `sample_light` returns `None`. For a
/// direction that `sample_light` returns it is equal to the sample's `pdf` up to rounding. A direction that meets the edge
/// or rim may count either way.
///
/// Pitfall: the density is that of the direction, not of the point. With a density per area multiple importance sampling
/// gives a wrong picture, although each technique alone gives the right one.
pub fn light_pdf(emitter: &AreaEmitter, from: Vec3, direction: Vec3) -> f32 {
    todo!("find the point that the direction meets, and return its density per steradian")
}

/// The weight of a sample in multiple importance sampling. A sample was taken with density `own`; the other technique would
/// take the same sample with density `other`.
///
/// Densities are 0 or more, as large as `f32` allows. A density of infinity means that a technique always takes this sample,
/// as a mirror does. The weight is in `0..=1`, and the weights of both techniques sum to 1:
/// `mis_weight(a, b) + mis_weight(b, a) = 1`, except for `a = b = 0` and `a = b = ∞`, where any weight in `0..=1` passes.
/// A weight is 1 if `other` is 0 or `own` is infinite, and 0 if `own` is 0 or `other` is infinite. The weights must keep the
/// variance low: if a square light with sides from 0.02 to 2 at distance 1 illuminates a lobe `cosⁿ θ` with n from 1 to
/// 10,000, one sample of each technique has a variance of at most a quarter of the squared mean. This is true for the balance
/// heuristic `own / (own + other)` and for the power heuristic `own² / (own² + other²)`.
///
/// Pitfall: with weights of 1/2 both techniques keep half of their noise, also where one of them is useless. 1e30² is
/// infinite in `f32`, and ∞ / ∞ is NaN.
///
/// Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering" (1995).
pub fn mis_weight(own: f32, other: f32) -> f32 {
    todo!("compare the two densities: balance heuristic or power heuristic")
}

/// Russian roulette: the factor by which the weight of a path is multiplied. 0 means that the path ends here.
///
/// `weight` is the factor per channel with which light that the path finds from here on contributes to the pixel; each
/// channel is 0 or more. `bounce` counts the surfaces that the path has met. `u` is uniform in `0..1`. Let w be the largest
/// channel of `weight`.
///
/// - If w is 0, the factor is 0: the path can add nothing.
/// - If w is above 0 and `bounce` is below 3, the factor is 1.
/// - Otherwise the path survives with a probability q, and the factor is `1 / q`; with probability `1 - q` it is 0. So the
///   mean of the factor is 1. q is at least `min(w, 0.95)`, and at most `(1 + w) / 2` and 1. `q = min(w, 1)` and
///   `q = min(w, 0.95)` pass, and so does any other rule in this range.
///
/// Pitfall: without the division by q the picture is too dark. With q = 1/2 for all paths bright ones are ended, and noise is
/// added where there was none.
///
/// Arvo and Kirk, "Particle Transport and Image Synthesis" (1990).
pub fn survives(weight: Vec3, bounce: u32, u: f32) -> f32 {
    todo!("let the path survive with a probability, and divide by this probability")
}

/// The fraction of the light that a picture lacks if paths end after `bounces` bounces, in a closed room whose surfaces all
/// emit the same light and have this albedo: `albedo^(bounces + 1)`.
///
/// `albedo`, the fraction of light that a surface reflects, is in `0..=1`; `bounces` is any number. The relative error of
/// the result is at most 1e-4, or its absolute error at most 1e-6.
///
/// The radiance in the room is `Le (1 + ρ + ρ² + …) = Le / (1 - ρ)`, and paths with at most n bounces find
/// `Le (1 - ρⁿ⁺¹) / (1 - ρ)` of it. At albedo 0.8 and 5 bounces a quarter of the light is missing.
///
/// Pitfall: `bounces + 1` does not fit `u32` for the largest number.
pub fn cut_off(albedo: f32, bounces: u32) -> f32 {
    todo!("raise the albedo to the power bounces + 1")
}

/// The smallest number of bounces n with `albedo^(n + 1) <= error`: see [`cut_off`].
///
/// `albedo` and `error` are in `0..=1`. The powers are computed in double precision. The result is `u32::MAX` if no n that
/// fits is enough: at an albedo of 1 with an error below 1, and at an albedo above 0 with an error of 0.
///
/// Pitfall: the power n + 1 is one more than the number of bounces. The logarithm of 0 is infinite, and that of 1 is 0.
pub fn bounces_for_error(albedo: f32, error: f32) -> u32 {
    todo!("solve albedo^(n + 1) = error for n, and round up")
}
