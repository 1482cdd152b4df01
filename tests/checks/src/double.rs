//! Reference answers in double precision, each with a tolerance. If single precision cannot decide between hit and
//! miss, no answer is judged. (Stage 10 uses exact verdicts instead.)

use crate::broken::{Broken, CheckResult};
use crate::judge::compare_formulas;
use crate::paste::Arguments;
use glam::{DVec3, Vec3};
use raykata::aabb::Aabb;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::shape::{Plane, PlaneEquation, Sphere, Triangle};
use std::fmt::Debug;

/// The largest relative error of one rounding to `f32`.
pub const U: f64 = f32::EPSILON as f64 / 2.0;

/// Fixed limits below which code takes a cosine, a determinant or another product for 0.
pub const LIMITS: [f64; 9] = [1e-12, 1e-9, 1e-8, f32::EPSILON as f64, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// The answers for `t` that a correct method in single precision may give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// No hit in the range of the ray.
    Miss,
    /// A hit at `t` ± `tolerance`.
    Hit {
        /// The `t` in double precision.
        t: f64,
        /// The largest error of a correct method in single precision.
        tolerance: f64,
    },
    /// Hit and miss are both accepted, because single precision cannot decide.
    Open,
}

/// An answer with its tolerance.
pub trait Tolerant<A: Debug> {
    /// Whether a correct method may give this answer.
    fn accepts(&self, answer: A) -> bool;
    /// Whether single precision cannot decide.
    fn is_open(&self) -> bool;
    /// The text for messages.
    fn words(&self) -> String;
    /// The text of an answer of the student.
    fn words_of(answer: A) -> String {
        format!("{answer:?}")
    }
}

impl Expected {
    /// Exactly this answer.
    pub fn exactly(t: Option<f32>) -> Self {
        t.map_or(Expected::Miss, |t| Expected::Hit { t: f64::from(t), tolerance: 0.0 })
    }
}

impl Tolerant<Option<f32>> for Expected {
    fn accepts(&self, t: Option<f32>) -> bool {
        match (self, t) {
            (Expected::Open, _) | (Expected::Miss, None) => true,
            (Expected::Hit { t: exact, tolerance }, Some(t)) => (f64::from(t) - exact).abs() <= *tolerance,
            _ => false,
        }
    }

    fn is_open(&self) -> bool {
        *self == Expected::Open
    }

    fn words(&self) -> String {
        match self {
            Expected::Miss => "None".into(),
            Expected::Hit { t, tolerance: 0.0 } => format!("{:?}", Some(*t as f32)),
            Expected::Hit { t, tolerance } => format!("Some({t}) ± {tolerance:.1e}"),
            Expected::Open => "either".into(),
        }
    }
}

/// Judges the answers of the function `name` by their tolerance, with this source of the expected ones. `observations` are what a
/// wrong answer shows, and `formulas` also get whether the answer is right. Where single precision cannot decide, each formula
/// may give each answer.
pub fn compare_tolerant<Q: Copy + Arguments, A: Copy + Debug + PartialEq, E: Tolerant<A>, const N: usize>(
    cases: &[(Q, E)],
    (name, source): (&str, &'static str),
    ask: impl Fn(&[Q]) -> Vec<A>,
    observations: impl Fn(&Q, A) -> [(bool, &'static str); N],
    formulas: impl Fn(&Q, A, bool) -> Vec<(bool, &'static str)>,
) -> Vec<CheckResult> {
    let answers = ask(&cases.iter().map(|case| case.0).collect::<Vec<Q>>());
    let judge = |(query, expected): &(Q, E), yours: A| match expected.accepts(yours) {
        true => Ok(()),
        false => Err(Broken::with_texts(query.call(name), E::words_of(yours), expected.words(), source)),
    };
    // Many formulas give no hit to many queries. A method that has one answer for a large batch is none of them.
    let is_constant = cases.len() > 100 && answers.iter().all(|answer| *answer == answers[0]);
    let given = |(query, expected): &(Q, E), yours: &A| {
        let given = formulas(query, *yours, expected.accepts(*yours)).into_iter();
        given.map(|(gives, text)| ((gives || expected.is_open()) && !is_constant, text)).collect()
    };
    let outcomes = compare_formulas(cases, answers.clone(), judge, given).into_iter();
    let show = |((outcome, (query, _)), yours): ((CheckResult, &(Q, E)), A)| {
        outcome.map_err(|broken| broken.explained_by(observations(query, yours)))
    };
    outcomes.zip(cases).zip(answers).map(show).collect()
}

/// Both roots of a line and a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roots {
    /// The smaller `t`.
    pub near: f64,
    /// The larger `t`.
    pub far: f64,
    /// The largest error of a correct method in single precision.
    pub tolerance: f64,
}

/// The roots of a line and a sphere; `Err(true)` if the line clearly misses, `Err(false)` if single precision cannot
/// decide.
pub fn sphere_roots(ray: &Ray, sphere: &Sphere) -> Result<Roots, bool> {
    let direction = ray.direction.as_dvec3();
    let f = ray.origin.as_dvec3() - sphere.center.as_dvec3();
    let radius = f64::from(sphere.radius);
    let along = -f.dot(direction) / direction.length_squared();
    let distance = (f + along * direction).length();
    // Allow sixteen roundings of |f|: f is rounded, and so is each step of its component perpendicular to the ray.
    let slack = 16.0 * U * (f.length() + radius);
    if distance > radius + slack {
        return Err(true);
    }
    if distance > radius - slack {
        return Err(false);
    }
    let half = (radius * radius - distance * distance).sqrt();
    let length = direction.length();
    // The half chord changes by distance / half per unit of distance, which is large near the rim.
    let tolerance = 2.0 * slack * (1.0 + distance / half) / length;
    Ok(Roots { near: along - half / length, far: along + half / length, tolerance })
}

/// The first hit of a ray with a sphere.
pub fn sphere(ray: &Ray, sphere: &Sphere) -> Expected {
    match sphere_roots(ray, sphere) {
        Err(true) => Expected::Miss,
        Err(false) => Expected::Open,
        Ok(Roots { near, far, tolerance }) => first_in_range(ray, &[near, far], tolerance),
    }
}

/// The first of ascending roots that lies in the range of the ray; open if one of them is nearer to an end of the range than
/// the tolerance.
pub fn first_in_range(ray: &Ray, roots: &[f64], tolerance: f64) -> Expected {
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
    for &t in roots {
        if (t - t_min).abs() <= tolerance || (t - t_max).abs() <= tolerance {
            return Expected::Open;
        }
        if t_min < t && t < t_max {
            return Expected::Hit { t, tolerance };
        }
    }
    Expected::Miss
}

/// The hit of a ray with a plane.
pub fn plane(ray: &Ray, plane: &Plane) -> Expected {
    let (normal, direction) = (plane.normal.as_dvec3(), ray.direction.as_dvec3());
    let offset = plane.point.as_dvec3() - ray.origin.as_dvec3();
    let (distance, slope) = (offset.dot(normal), direction.dot(normal));
    // Products that are all 0 stay 0 for any length of the vectors. Those that cancel do not, if the normal is scaled to unit
    // length first.
    if slope == 0.0 && normal * direction == DVec3::ZERO {
        return Expected::Miss;
    }
    // Bound the error of each dot product by a few roundings of its largest term.
    let distance_slack = 8.0 * U * (offset.abs().dot(normal.abs()));
    at_a_slope(ray, normal, distance, distance_slack)
}

/// How a method may round the sum of D and n·o.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sum {
    /// In single precision: the error is a few roundings of the largest term.
    Single,
    /// In double precision, rounded once at the end: the error is a few roundings of the sum.
    Double,
}

/// The hit of a ray with a plane that coefficients give.
pub fn plane_equation(ray: &Ray, plane: &PlaneEquation, sum: Sum) -> Expected {
    let (normal, d) = (plane.normal.as_dvec3(), f64::from(plane.d));
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (distance, slope) = (-d - normal.dot(origin), direction.dot(normal));
    // Products that are all 0 stay 0 for any length of the vectors.
    if slope == 0.0 && normal * direction == DVec3::ZERO {
        return Expected::Miss;
    }
    // Bound the error of the sum and of the dot product. In double precision each product is exact, and each of three
    // sums has an error of half an `f64::EPSILON`.
    let terms = d.abs() + normal.abs().dot(origin.abs());
    let distance_slack = match sum {
        Sum::Single => 8.0 * U * terms,
        Sum::Double => 4.0 * f64::EPSILON * terms + 8.0 * U * distance.abs(),
    };
    at_a_slope(ray, normal, distance, distance_slack)
}

/// The hit where a ray has gone `distance` ± `distance_slack` along `normal`, which is not perpendicular to it.
fn at_a_slope(ray: &Ray, normal: DVec3, distance: f64, distance_slack: f64) -> Expected {
    let direction = ray.direction.as_dvec3();
    let slope = direction.dot(normal);
    let slope_slack = 8.0 * U * direction.abs().dot(normal.abs());
    if slope.abs() <= 16.0 * slope_slack {
        return Expected::Open;
    }
    let t = distance / slope;
    let tolerance = 2.0 * (distance_slack + t.abs() * slope_slack) / slope.abs();
    first_in_range(ray, &[t], tolerance)
}

/// The answers for a triangle that a correct method in single precision may give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleExpected {
    /// Hit, miss or open, and `t`.
    pub t: Expected,
    /// The barycentric coordinate of `b`.
    pub beta: f64,
    /// The barycentric coordinate of `c`.
    pub gamma: f64,
    /// The largest error of `beta` and `gamma`.
    pub tolerance: f64,
}

impl TriangleExpected {
    /// Exactly this answer.
    pub fn exactly(hit: Option<TriangleHit>) -> Self {
        let [beta, gamma] = hit.map_or([0.0; 2], |hit| [hit.beta, hit.gamma].map(f64::from));
        TriangleExpected { t: Expected::exactly(hit.map(|hit| hit.t)), beta, gamma, tolerance: 0.0 }
    }
}

impl Tolerant<Option<TriangleHit>> for TriangleExpected {
    fn accepts(&self, hit: Option<TriangleHit>) -> bool {
        let near = |value: f32, exact: f64| (f64::from(value) - exact).abs() <= self.tolerance;
        self.t.accepts(hit.map(|hit| hit.t))
            && (self.is_open()
                || hit.is_none_or(|hit| near(hit.beta, self.beta) && near(hit.gamma, self.gamma)))
    }

    fn is_open(&self) -> bool {
        self.t.is_open()
    }

    fn words(&self) -> String {
        let TriangleExpected { beta, gamma, tolerance, .. } = self;
        match self.t {
            Expected::Hit { t, tolerance: 0.0 } => {
                format!("t = {:?}, beta = {:?}, gamma = {:?}", t as f32, *beta as f32, *gamma as f32)
            }
            Expected::Hit { t, .. } => {
                format!("t = {t:.7}, beta = {beta:.6}, gamma = {gamma:.6} (± {tolerance:.0e})")
            }
            other => other.words(),
        }
    }

    fn words_of(hit: Option<TriangleHit>) -> String {
        hit.map_or("None".into(), |hit| {
            format!("t = {:?}, beta = {:?}, gamma = {:?}", hit.t, hit.beta, hit.gamma)
        })
    }
}

/// The hit of a ray with a triangle, by Cramer's rule in double precision. The tolerance covers the rounding errors of
/// all methods that students may choose in single precision.
pub fn triangle(ray: &Ray, triangle: &Triangle) -> TriangleExpected {
    let [a, b, c, o, d] = [triangle.a, triangle.b, triangle.c, ray.origin, ray.direction].map(Vec3::as_dvec3);
    let (u, v, s) = (b - a, c - a, o - a);
    let normal = u.cross(v);
    let slope = -d.dot(normal);
    let miss = |t| TriangleExpected { t, beta: 0.0, gamma: 0.0, tolerance: 0.0 };
    if slope == 0.0 {
        return miss(Expected::Miss);
    }
    let t = s.dot(normal) / slope;
    let beta = -d.dot(s.cross(v)) / slope;
    let gamma = -d.dot(u.cross(s)) / slope;

    // Compute how much a rounding error of the size of the inputs changes the results: the sizes of all terms divided
    // by the size of the sum. `thin` enters twice, because some methods divide by |u × v|².
    let thin = u.length() * v.length() / normal.length();
    let steep = d.length() * normal.length() / slope.abs();
    let reach = s.length().max(t.abs() * d.length()) + u.length().max(v.length());
    let size = u.length().min(v.length());
    let tolerance = 64.0 * U * thin * thin * steep * (1.0 + reach / size);
    if !(tolerance < 0.02) {
        return miss(Expected::Open);
    }
    let least = beta.min(gamma).min(1.0 - beta - gamma);
    let t_tolerance = 64.0 * U * thin * steep * reach / d.length();
    let verdict = if least < -tolerance {
        Expected::Miss
    } else if least < tolerance {
        Expected::Open
    } else {
        first_in_range(ray, &[t], t_tolerance)
    };
    TriangleExpected { t: verdict, beta, gamma, tolerance }
}

/// The point of a triangle with the barycentric coordinates `(β, γ)`.
pub fn triangle_point(triangle: &Triangle, beta: f64, gamma: f64) -> DVec3 {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);
    a + beta * (b - a) + gamma * (c - a)
}

/// The `t` at which an infinite line along `ray` enters and leaves a closed box; `(inf, -inf)` if it misses the box.
pub fn box_interval(ray: &Ray, bounds: &Aabb) -> (f64, f64) {
    let (near, far) = slabs_interval(ray, bounds);
    if near <= far { (near, far) } else { (f64::INFINITY, f64::NEG_INFINITY) }
}

/// The largest `t` at which an infinite line enters a slab of a box, and the smallest at which it leaves one. If the
/// entry is larger than the exit, the line misses the box, and their difference is a measure of the distance.
pub fn slabs_interval(ray: &Ray, bounds: &Aabb) -> (f64, f64) {
    let slabs = [0, 1, 2].map(|axis| slab_interval(ray, bounds, axis));
    slabs.into_iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(near, far), (enter, leave)| {
        (near.max(enter), far.min(leave))
    })
}

/// The `t` at which an infinite line enters and leaves one slab of a box; `(inf, -inf)` if it is parallel to it and outside.
pub fn slab_interval(ray: &Ray, bounds: &Aabb, axis: usize) -> (f64, f64) {
    let [low, high, origin, direction] =
        [bounds.min[axis], bounds.max[axis], ray.origin[axis], ray.direction[axis]].map(f64::from);
    let (first, last) = ((low - origin) / direction, (high - origin) / direction);
    match direction == 0.0 {
        true if low <= origin && origin <= high => (f64::NEG_INFINITY, f64::INFINITY),
        true => (f64::INFINITY, f64::NEG_INFINITY),
        false => (first.min(last), first.max(last)),
    }
}
