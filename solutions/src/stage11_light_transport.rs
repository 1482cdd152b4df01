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
// <solution>
use crate::stage6_distribution::around;
use raykata::shape::{Sphere, Triangle};
use std::f32::consts::{PI, TAU};
// </solution>

/// A random direction around `normal` with the density `cos θ / π`, where θ is the angle between
/// both. Malley's method projects a uniform point of the unit disk up to the hemisphere. In a
/// closed white room wrong directions look right: where do they not?
///
/// `normal` has any direction; both vectors have unit length. `direction·normal` is at least -1e-6:
/// never below the surface, except for rounding.
///
/// Source: Malley's method, in "Physically Based Rendering".
pub fn cosine_direction(normal: Vec3, u: Vec2) -> Vec3 {
    // <solution>
    // Sample a disk uniformly: radius² is uniform. Project the point up to the hemisphere: cos² θ =
    // 1 - radius².
    let radius = u.x.sqrt();
    let cos_theta = (1.0 - u.x).sqrt();
    // Turn the direction from the z axis to the normal.
    let (x, y) = normal.any_orthonormal_pair();
    let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
    (radius * (cos_phi * x + sin_phi * y) + cos_theta * normal).normalize()
    // <stub> todo!("sample a disk uniformly, and project the point up to the hemisphere around normal")
    // </solution>
}

/// The density of [`cosine_direction`]: `cos θ / π`, because `cos θ` has the integral π over the
/// hemisphere. What sign has it below the surface?
///
/// Both vectors have unit length. The density of a direction below the surface is 0.
pub fn cosine_pdf(normal: Vec3, direction: Vec3) -> f32 {
    // <solution>
    normal.dot(direction).max(0.0) / PI
    // <stub> todo!("divide the cosine by π, and return 0 below the surface")
    // </solution>
}

// <solution>
/// A triangle or parallelogram: the points `corner + s edges.0 + t edges.1`.
struct Flat {
    corner: Vec3,
    edges: (Vec3, Vec3),
    is_triangle: bool,
}

impl Flat {
    fn from(Triangle { a, b, c }: Triangle) -> Flat {
        Flat { corner: a, edges: (b - a, c - a), is_triangle: true }
    }

    /// The unit normal on the front, and the area.
    fn normal_and_area(&self) -> (Vec3, f32) {
        let cross = self.edges.0.cross(self.edges.1);
        let area = cross.length();
        (cross / area, if self.is_triangle { 0.5 * area } else { area })
    }

    /// The density per steradian of points that are uniform over the area:
    /// `distance² / (area · |cos θ|)`, with the angle θ between the direction and the normal of the
    /// emitter. `None` if the side that is seen emits no light.
    fn pdf(&self, to_point: Vec3, two_sided: bool) -> Option<f32> {
        let (normal, area) = self.normal_and_area();
        // cos θ · distance: positive on the front.
        let facing = -to_point.dot(normal);
        let pdf = to_point.length_squared() * to_point.length() / (area * facing.abs());
        (pdf.is_finite() && pdf > 0.0 && (two_sided || facing > 0.0)).then_some(pdf)
    }

    /// A uniformly distributed point.
    fn sample(&self, u: Vec2) -> Vec3 {
        // For a triangle the lines of constant s get shorter towards a corner. So 1 - s is the root
        // of a uniform number.
        let (s, t) = match self.is_triangle {
            true => (1.0 - u.x.sqrt(), u.x.sqrt() * u.y),
            false => (u.x, u.y),
        };
        self.corner + s * self.edges.0 + t * self.edges.1
    }

    /// The vector from `from` to the point that a ray of this direction hits.
    fn hit(&self, from: Vec3, direction: Vec3) -> Option<Vec3> {
        let normal = self.edges.0.cross(self.edges.1);
        // Hit the plane of the emitter.
        let distance = (self.corner - from).dot(normal) / direction.dot(normal);
        // Find s and t of the hit by ratios of areas.
        let offset = from + distance * direction - self.corner;
        let s = offset.cross(self.edges.1).dot(normal) / normal.length_squared();
        let t = self.edges.0.cross(offset).dot(normal) / normal.length_squared();
        let inside =
            s >= 0.0 && t >= 0.0 && if self.is_triangle { s + t <= 1.0 } else { s <= 1.0 && t <= 1.0 };
        (distance > 0.0 && distance.is_finite() && inside).then_some(distance * direction)
    }
}

/// The cone of directions in which a sphere is seen: `1 - cos θ` of its rim; 2, all directions,
/// from inside.
fn one_minus_cos_of_rim(sphere: &Sphere, from: Vec3) -> f32 {
    // 1 - cos θ = sin² θ / (1 + cos θ), in which nothing cancels for a far sphere.
    let sin_squared = sphere.radius * sphere.radius / (sphere.center - from).length_squared();
    if sin_squared < 1.0 { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) } else { 2.0 }
}

/// The density per steradian of directions that are uniform over this cone: 1 / its solid angle.
/// `None` if the side of the sphere that is seen emits no light.
fn sphere_pdf(sphere: &Sphere, two_sided: bool, from: Vec3) -> Option<f32> {
    let one_minus_cos = one_minus_cos_of_rim(sphere, from);
    let pdf = 1.0 / (TAU * one_minus_cos);
    (pdf.is_finite() && (two_sided || one_minus_cos < 2.0)).then_some(pdf)
}
// </solution>

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
    // <solution>
    let AreaEmitter { shape, radiance, two_sided } = *emitter;
    if radiance == Vec3::ZERO {
        return None;
    }
    // Sample the area of a flat emitter uniformly, and convert the density to solid angle.
    let of_area = |flat: Flat| {
        let to_point = flat.sample(u) - from;
        let pdf = flat.pdf(to_point, two_sided)?;
        let (direction, distance) = (to_point.normalize(), to_point.length());
        Some(EmitterSample { direction, distance, radiance, pdf })
    };
    match shape {
        EmitterShape::Triangle(triangle) => of_area(Flat::from(triangle)),
        EmitterShape::Parallelogram { corner, edges } => of_area(Flat { corner, edges, is_triangle: false }),
        EmitterShape::Sphere(sphere) => {
            let pdf = sphere_pdf(&sphere, two_sided, from)?;
            // Choose 1 - cos θ uniformly, because slices of a sphere of equal height have equal
            // area (Archimedes).
            let to_center = sphere.center - from;
            let one_minus_cos_max = one_minus_cos_of_rim(&sphere, from);
            let direction = around(to_center.normalize_or(Vec3::Y), u.x * one_minus_cos_max, u.y);
            // Find the hit: half a chord before the middle of the chord; from inside behind it.
            let middle = to_center.dot(direction);
            let beside = (to_center - middle * direction).length_squared();
            let half = (sphere.radius * sphere.radius - beside).max(0.0).sqrt();
            let distance = if one_minus_cos_max < 2.0 { middle - half } else { middle + half };
            Some(EmitterSample { direction, distance, radiance, pdf })
        }
    }
    // <stub> todo!("sample a point of the emitter, and return the density of its direction per steradian")
    // </solution>
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
    // <solution>
    let AreaEmitter { shape, radiance, two_sided } = *emitter;
    if radiance == Vec3::ZERO {
        return 0.0;
    }
    let of_area = |flat: Flat| flat.pdf(flat.hit(from, direction)?, two_sided);
    let pdf = match shape {
        EmitterShape::Triangle(triangle) => of_area(Flat::from(triangle)),
        EmitterShape::Parallelogram { corner, edges } => of_area(Flat { corner, edges, is_triangle: false }),
        EmitterShape::Sphere(sphere) => {
            // From outside, directions in the cone pass the centre at less than the radius, and go
            // to its side.
            let to_center = sphere.center - from;
            let is_inside = one_minus_cos_of_rim(&sphere, from) >= 2.0;
            let hits = to_center.cross(direction).length() <= sphere.radius && to_center.dot(direction) > 0.0;
            sphere_pdf(&sphere, two_sided, from).filter(|_| is_inside || hits)
        }
    };
    pdf.unwrap_or(0.0)
    // <stub> todo!("find the point that the direction meets, and return its density per steradian")
    // </solution>
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
    // <solution>
    // Use the power heuristic as 1 / (1 + (other / own)²), whose ratio does not overflow to ∞ / ∞.
    if own == 0.0 || other == f32::INFINITY {
        return 0.0;
    }
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
    // <stub> todo!("compare the two densities: balance heuristic or power heuristic")
    // </solution>
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
    // <solution>
    let survival = weight.max_element();
    if survival <= 0.0 {
        return 0.0;
    }
    if survival >= 1.0 || bounce < 3 {
        return 1.0;
    }
    // Divide by the probability to survive, so that the mean stays right.
    if u < survival { 1.0 / survival } else { 0.0 }
    // <stub> todo!("let the path survive with a probability, and divide by this probability")
    // </solution>
}

/// The fraction of the light that is missing if paths end after n `bounces`. In a closed room whose
/// surfaces all emit `Le` and have albedo ρ, the light is `Le (1 + ρ + ρ² + …)`. Without the terms
/// after `ρⁿ` the fraction `ρⁿ⁺¹` is missing.
///
/// `albedo` is in `0..=1`; `bounces` is any number, also the largest. The relative error is at most
/// 1e-4, or the absolute error at most 1e-6.
pub fn cut_off(albedo: f32, bounces: u32) -> f32 {
    // <solution>
    // Add 1 in double precision: `bounces + 1` does not fit `u32` for the largest number.
    f64::from(albedo).powf(f64::from(bounces) + 1.0) as f32
    // <stub> todo!("raise the albedo to the power bounces + 1")
    // </solution>
}

/// The smallest number of bounces n with `albedo^(n + 1) <= error`: see [`cut_off`]. What are the
/// logarithms of 0 and 1?
///
/// `albedo` and `error` are in `0..=1`. The powers are computed in double precision. The result is
/// `u32::MAX` if no n that fits is enough: at an albedo of 1 with an error below 1, and at an
/// albedo above 0 with an error of 0.
pub fn bounces_for_error(albedo: f32, error: f32) -> u32 {
    // <solution>
    let (albedo, error) = (f64::from(albedo), f64::from(error));
    // Return the cases in which a logarithm below would be 0 or infinite.
    if albedo <= error {
        return 0;
    }
    if error == 0.0 || albedo == 1.0 {
        return u32::MAX;
    }
    // Solve albedo^(n + 1) = error for n. `as` converts a number that is too large to u32::MAX.
    let n = ((error.ln() / albedo.ln()).ceil() - 1.0) as u32;
    // The quotient is rounded, so n may be off by one where the power is equal to the error.
    let is_enough = |n: u32| albedo.powf(f64::from(n) + 1.0) <= error;
    match is_enough(n) {
        true if is_enough(n - 1) => n - 1,
        true => n,
        false => n.saturating_add(1),
    }
    // <stub> todo!("solve albedo^(n + 1) = error for n, and round up")
    // </solution>
}
