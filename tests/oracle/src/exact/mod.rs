//! Exact answers: the hits of a ray in single precision, decided by the signs of integer polynomials.
//!
//! Every finite `f32` is `m * 2^e`, so hit or miss, the order of hits and the two sides of a rounding are
//! signs of polynomials with integer coefficients; square roots are compared by squaring. Each question is
//! first evaluated in doubles with an error bound ([`Tier::Filter`]), then in `i64` and `i128` where a count
//! of bits shows that they suffice, and last in wide integers, which suffice for every finite input. These
//! are adaptive predicates as in Shewchuk 1997, with integers in place of expansions. Inputs that are not
//! finite have no answer (`None`), but the ends of a ray's range may be infinite.

pub mod aabb;
mod body;
pub mod polygon;
mod quadric;
mod ring;
mod root;
mod scale;
mod solid;
pub mod sphere;
#[cfg(test)]
mod tests;
pub mod triangle;
mod wide;

pub use body::Body;
pub use wide::Wide;

use body::{Against, Asked, First, InDouble, Meet, Order};
use raykata::ray::Ray;
use ring::{Estimate, Ring};
use root::Rounded;
use scale::Frame;
use std::cmp::Ordering;

/// How a ray meets a closed shape within the open range of the ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Contact {
    /// The ray passes through the inside.
    In,
    /// The ray only touches the shape: through an edge or corner of a triangle, along the rim, tangent to a sphere.
    On,
    /// The ray misses the shape.
    Out,
}

impl Contact {
    /// Whether a closed shape is hit.
    pub fn is_hit(self) -> bool {
        self != Contact::Out
    }
}

/// The first point in which a ray meets a shape within its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// How the shape is met.
    pub verdict: Contact,
    /// The exact `t` rounded to nearest, ties to even: the correctly rounded answer. `None` if missed.
    pub t: Option<f32>,
}

/// The numbers in which a question is evaluated. All tiers agree where they answer; tests can force each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// The cheapest tier that is certain.
    Auto,
    /// Doubles with an error bound only; `None` when that is too little.
    Filter,
    /// `i64` only; `None` when the numbers may not fit. Ties on small lattices do.
    Small,
    /// `i128` only; `None` when the numbers may not fit.
    Narrow,
    /// Integers of 512 bits only; `None` when the numbers may not fit.
    Wide,
    /// Integers of 1792 bits only; `None` when the numbers may not fit. Every triangle does.
    Wider,
    /// The widest integers.
    Widest,
}

impl Tier {
    /// Every tier, [`Tier::Auto`] first.
    pub const ALL: [Tier; 7] =
        [Tier::Auto, Tier::Filter, Tier::Small, Tier::Narrow, Tier::Wide, Tier::Wider, Tier::Widest];
}

/// A question that can be evaluated in any ring.
trait Question {
    type Answer;

    /// The scales of the inputs; a filter needs the upper ends only.
    fn frame(&self, fine: bool) -> Frame;

    /// An upper bound on the bits of the largest integer, without its sign.
    fn bits(&self, frame: &Frame) -> u32;

    /// The answer, `None` if undecided; integers always decide.
    fn ask<R: Ring>(&self, frame: &Frame) -> Option<Self::Answer>;
}

const WIDEST: usize = 96;

/// Evaluates a question in a tier. Integers of `64 * WIDEST` bits answer all questions about one shape. They
/// answer all orders except some of cylinders and cones of extreme scales, which are `None`.
fn decide<Q: Question>(question: &Q, tier: Tier) -> Option<Q::Answer> {
    if matches!(tier, Tier::Auto | Tier::Filter) {
        let answer = question.ask::<Estimate>(&question.frame(false));
        if answer.is_some() || tier == Tier::Filter {
            return answer;
        }
    }
    decide_exactly(question, tier)
}

#[inline(never)]
fn decide_exactly<Q: Question>(question: &Q, tier: Tier) -> Option<Q::Answer> {
    let frame = question.frame(true);
    let bits = question.bits(&frame);
    let allowed = |only: Tier| tier == Tier::Auto || tier == only;
    if bits < 64 && allowed(Tier::Small) {
        return question.ask::<i64>(&frame);
    }
    if bits < 128 && allowed(Tier::Narrow) {
        return question.ask::<i128>(&frame);
    }
    if bits < 512 && allowed(Tier::Wide) {
        return ask_wide::<8, Q>(question, &frame);
    }
    if bits < 1792 && allowed(Tier::Wider) {
        return ask_wide::<28, Q>(question, &frame);
    }
    (bits < 64 * WIDEST as u32 && allowed(Tier::Widest)).then(|| ask_wide::<WIDEST, Q>(question, &frame))?
}

/// A separate function, so that narrow integers do not need the stack space of wide ones.
#[inline(never)]
fn ask_wide<const N: usize, Q: Question>(question: &Q, frame: &Frame) -> Option<Q::Answer> {
    question.ask::<Wide<N>>(frame)
}

/// How and where a ray meets a shape first. `None` for inputs that are not finite.
pub fn meet(ray: &Ray, body: Body) -> Option<Meeting> {
    meet_with(Tier::Auto, ray, body)
}

/// The same from one tier only; `None` also if the tier cannot decide.
pub fn meet_with(tier: Tier, ray: &Ray, body: Body) -> Option<Meeting> {
    if !is_finite(ray, &body) {
        return None;
    }
    let Some((verdict, rounded)) = decide(&Asked { ray, body, of: Meet }, tier)? else {
        return Some(Meeting { verdict: Contact::Out, t: None });
    };
    let t = match rounded {
        Rounded::Known(t) => t,
        Rounded::Lerp(low, high) => {
            let half_way = root::half_way(low, high);
            root::nearest(low, high, decide(&Asked { ray, body, of: Against(half_way) }, tier)?)
        }
    };
    Some(Meeting { verdict, t: Some(t) })
}

/// Hit, touch or miss alone, which costs a little less than [`meet`].
pub fn verdict(ray: &Ray, body: Body) -> Option<Contact> {
    verdict_with(Tier::Auto, ray, body)
}

/// The same from one tier only; `None` also if the tier cannot decide.
pub fn verdict_with(tier: Tier, ray: &Ray, body: Body) -> Option<Contact> {
    if !is_finite(ray, &body) {
        return None;
    }
    decide(&Asked { ray, body, of: First }, tier)
}

/// The first `t` as a double with a relative error below `2^-40`: `Some(None)` if missed.
pub fn t_in_double(ray: &Ray, body: Body) -> Option<Option<f64>> {
    if !is_finite(ray, &body) {
        return None;
    }
    decide(&Asked { ray, body, of: InDouble }, Tier::Auto)
}

/// How far a computed `t` lies above the exact one, in ulps of the correctly rounded `t` (good to `1e-4` ulps where
/// that is below 64). `None` if the ray misses.
pub fn t_error_in_ulps(ray: &Ray, body: Body, t: f32) -> Option<f64> {
    let exact = t_in_double(ray, body)??;
    Some(root::ulps(t, exact, meet(ray, body)?.t?))
}

/// Which of two shapes the ray meets first. `None` if it misses one, and for inputs that are not finite.
pub fn order(ray: &Ray, one: Body, other: Body) -> Option<Ordering> {
    order_with(Tier::Auto, ray, one, other)
}

/// The same from one tier only; `None` also if the tier cannot decide.
pub fn order_with(tier: Tier, ray: &Ray, one: Body, other: Body) -> Option<Ordering> {
    if !is_finite(ray, &one) || !is_finite(ray, &other) {
        return None;
    }
    decide(&Order { ray, one, other }, tier)?
}

/// Whether all inputs are numbers; the ends of the range may be infinite.
fn is_finite(ray: &Ray, body: &Body) -> bool {
    is_ray_finite(ray) && body.is_finite()
}

#[inline]
fn is_ray_finite(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.direction.is_finite() && !ray.t_min.is_nan() && !ray.t_max.is_nan()
}
