//! Random inputs that shrink to simple numbers.

use glam::Vec3;
use proptest::prelude::*;
use proptest::strategy::{NewTree, ValueTree};
use proptest::test_runner::TestRunner;
use raykata::ray::Ray;
use raykata::shape::{Sphere, Triangle};
use std::ops::{Range, RangeInclusive};

/// Random numbers of a range.
#[derive(Clone, Debug)]
struct Numbers<S> {
    drawn: S,
    range: Values,
}

/// Numbers from `low` to `high`, which are multiples of `step` if it is not 0.
#[derive(Clone, Copy, Debug)]
struct Values {
    low: f32,
    high: f32,
    step: f32,
}

/// A number that was drawn. Simpler ones are tried from the simplest on, until one breaks the law as well.
#[derive(Clone, Debug)]
struct Number {
    drawn: f32,
    range: Values,
    /// The place of the simpler number that is tried; the one that was drawn comes behind them.
    tried: Option<u8>,
}

impl<S: Strategy<Value = f32>> Strategy for Numbers<S> {
    type Tree = Number;
    type Value = f32;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        Ok(Number { drawn: self.drawn.new_tree(runner)?.current(), range: self.range, tried: None })
    }
}

impl Number {
    /// The simpler numbers of the range. They take longer than to draw, and are asked for only if a law is broken.
    fn simpler(&self) -> Vec<f32> {
        let size = f64::from(self.drawn.abs());
        let tens = |digits: f64| 10f64.powf(digits - 1.0 - size.log10().floor());
        let digits = |digits: f64| (tens(digits) * size).round() / tens(digits);
        let [ten, half] = [10f64.powf(size.log10().round()), (2.0 * size).round() / 2.0];
        let simple = [0.0, 1.0, 2.0, 3.0, 0.5, ten, digits(1.0), half, digits(2.0), digits(3.0)];
        let signed = simple.map(|number| self.drawn.signum() * number as f32 + 0.0).into_iter();
        let Values { low, high, step } = self.range;
        let is_on_grid = |number: f32| step == 0.0 || number % step == 0.0;
        signed.filter(|number| (low..=high).contains(number) && is_on_grid(*number)).collect()
    }
}

impl ValueTree for Number {
    type Value = f32;

    fn current(&self) -> f32 {
        let simpler = self.tried.and_then(|place| self.simpler().get(usize::from(place)).copied());
        simpler.unwrap_or(self.drawn)
    }

    fn simplify(&mut self) -> bool {
        let is_new = self.tried.is_none();
        self.tried.get_or_insert(0);
        is_new
    }

    fn complicate(&mut self) -> bool {
        let next =
            self.tried.map(|place| place + 1).filter(|&next| usize::from(next) <= self.simpler().len());
        self.tried = next.or(self.tried);
        next.is_some()
    }
}

/// A number in this range.
pub fn number(range: Range<f32>) -> impl Strategy<Value = f32> + Clone {
    let (low, high) = (range.start, range.end.next_down());
    Numbers { drawn: range, range: Values { low, high, step: 0.0 } }
}

/// A fraction with one of these numerators, such as a number of eighths. Such numbers are short in messages, and sums and products
/// of a few of them are exact.
pub fn fractions(numerators: RangeInclusive<i32>, denominator: f32) -> impl Strategy<Value = f32> + Clone {
    let fraction = move |numerator: i32| numerator as f32 / denominator;
    let [low, high] = [fraction(*numerators.start()), fraction(*numerators.end())];
    Numbers { drawn: numerators.prop_map(fraction), range: Values { low, high, step: 1.0 / denominator } }
}

/// A vector of three such numbers.
pub fn vector(coordinate: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = Vec3> + Clone {
    (coordinate.clone(), coordinate.clone(), coordinate).prop_map(Vec3::from)
}

/// A point on a grid of 1/8, each coordinate in `-reach..=reach`.
pub fn point(reach: i32) -> impl Strategy<Value = Vec3> + Clone {
    vector(fractions(-8 * reach..=8 * reach, 8.0))
}

/// A point with full mantissas, each coordinate in `-reach..reach`.
pub fn rough_point(reach: f32) -> impl Strategy<Value = Vec3> + Clone {
    vector(number(-reach..reach))
}

/// A direction on a grid of 1/8, of any length except zero.
pub fn direction() -> impl Strategy<Value = Vec3> + Clone {
    point(4).prop_map(|v| if v == Vec3::ZERO { Vec3::X } else { v })
}

/// A direction of length 1.
pub fn unit() -> impl Strategy<Value = Vec3> + Clone {
    direction().prop_map(Vec3::normalize)
}

/// A sphere near the origin.
pub fn sphere() -> impl Strategy<Value = Sphere> + Clone {
    (point(4), fractions(1..=32, 8.0)).prop_map(|(center, radius)| Sphere { center, radius })
}

/// A ray with a unit direction from a point near the origin.
pub fn ray() -> impl Strategy<Value = Ray> + Clone {
    (point(8), unit()).prop_map(|(origin, direction)| Ray::new(origin, direction))
}

/// A triangle near the origin, with an area.
pub fn triangle() -> impl Strategy<Value = Triangle> + Clone {
    let corners = (point(4), point(4), point(4));
    let has_area = |(a, b, c): &(Vec3, Vec3, Vec3)| (*b - *a).cross(*c - *a) != Vec3::ZERO;
    corners.prop_filter("no area", has_area).prop_map(|(a, b, c)| Triangle { a, b, c })
}

/// The triangle with all coordinates times `size`.
pub fn scaled(Triangle { a, b, c }: Triangle, size: f32) -> Triangle {
    Triangle { a: size * a, b: size * b, c: size * c }
}

/// A positive number between `10^low` and `10^high`, uniform in its logarithm.
pub fn magnitude(low: f32, high: f32) -> impl Strategy<Value = f32> + Clone {
    number(low..high).prop_map(|exponent| 10f32.powf(exponent))
}
