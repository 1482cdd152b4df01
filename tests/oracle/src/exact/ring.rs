//! The numbers in which the oracle's polynomials are evaluated: the same code runs in doubles with an error bound, in
//! `i128`, and in wide integers. Doubles may answer "undecided"; integers always decide.

use super::scale::{Scale, over_power, split};
use super::wide::Wide;
use std::ops::{Add, Mul, Neg, Sub};

/// A ring with signs: what polynomials of the inputs are computed in.
pub(super) trait Ring:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// Whether results are exact.
    const EXACT: bool;

    /// An input in units of its group.
    fn input(x: f32, scale: Scale) -> Self;

    /// `(n, d)` with `n / d = t * 2^-unit` and `d` a power of two: the value `t` in units of the integers.
    fn fraction(t: f64, unit: i32) -> (Self, Self);

    /// The sign of the number, `None` if undecided.
    fn sign(&self) -> Option<i32>;

    /// The number as a double; `None` if its error would be too large.
    fn approx(&self) -> Option<Approx>;
}

/// The number `m * 2^e` with a relative error of at most `error`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approx {
    pub m: f64,
    pub e: i32,
    pub error: f64,
}

impl Approx {
    /// The same number with `1 <= |m| < 2`, so that chains of products stay in range.
    fn tidy(self) -> Self {
        if self.m == 0.0 {
            return Approx { m: 0.0, e: 0, error: 0.0 };
        }
        // Doubles that come here are normal: filters refuse values below 2^-700.
        let shift = (self.m.to_bits() >> 52 & 0x7ff) as i32 - 1023;
        let one = f64::from_bits(self.m.to_bits() & !(0x7ff << 52) | 0x3ff << 52);
        Approx { m: one, e: self.e + shift, error: self.error }
    }

    /// The quotient; the divisor is not zero.
    pub fn over(self, divisor: Approx) -> Self {
        let (a, b) = (self.tidy(), divisor.tidy());
        // (1 + x) / (1 - y) with x, y below 2^-19, and one rounding.
        Approx { m: a.m / b.m, e: a.e - b.e, error: 1.01 * (a.error + b.error) + f64::EPSILON }
    }

    /// The square root of a number that is not negative.
    pub fn sqrt(self) -> Self {
        let a = self.tidy();
        let odd = a.e & 1;
        Approx { m: (a.m * power(odd)).max(0.0).sqrt(), e: (a.e - odd) / 2, error: a.error + f64::EPSILON }
    }

    /// The sum of two numbers of one sign (or zero).
    pub fn plus_alike(self, other: Approx) -> Self {
        let (mut a, mut b) = (self.tidy(), other.tidy());
        if a.m == 0.0 || (b.m != 0.0 && a.e < b.e) {
            (a, b) = (b, a);
        }
        let error = a.error.max(b.error) + f64::EPSILON;
        Approx { m: a.m + b.m * power((b.e - a.e).max(-1000)), e: a.e, error }
    }

    /// The number with its sign turned.
    pub fn negated(self) -> Self {
        Approx { m: -self.m, ..self }
    }

    /// The value times `2^unit` as a double. It is infinite or zero outside of the range of doubles, where an
    /// `f32` is rounded to the same.
    pub fn value(self, unit: i32) -> f64 {
        let a = self.tidy();
        let e = a.e + unit;
        if e > 1000 {
            return a.m * f64::INFINITY;
        }
        if e < -1000 { 0.0 * a.m } else { a.m * power(e) }
    }
}

/// `2^e` for a normal double.
pub(super) fn power(e: i32) -> f64 {
    debug_assert!((-1022..=1023).contains(&e));
    f64::from_bits(((e + 1023) as u64) << 52)
}

/// A double with the sum of the absolute values of all terms that went into it.
///
/// Every operation rounds by at most `u = 2^-53` of its result. By induction over the operations,
/// `|value - exact| <= ((1 + u)^n - 1) * size`, where a sum makes `n = max(n1, n2) + 1` and a product
/// `n = n1 + n2 + 1` (Higham 2002, lemma 3.1). `size` itself is computed with as many roundings. The deepest sign, in
/// the order of two cones, has `n = 148`, and a test counts that no `n` is above 250, so `256 u * size` bounds the error.
///
/// Underflow adds less than `2^-700`: inputs are scaled to 1 at most and fractions to `2^130`, a fraction enters at
/// most squared, so each of a few hundred losses of `2^-1074` is magnified by less than `2^330`. (Triangles and boxes
/// are not scaled: of degree 4 at most, they do not underflow.) Overflow makes the size infinite, and infinite or NaN
/// sizes decide nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub value: f64,
    pub size: f64,
}

impl Estimate {
    const ROUNDINGS: f64 = 256.0 * (f64::EPSILON / 2.0);
    const UNDERFLOW: f64 = f64::from_bits((1023 - 700) << 52);
    const UNKNOWN: Estimate = Estimate { value: 0.0, size: f64::INFINITY };

    fn exactly(value: f64) -> Self {
        Estimate { value, size: value.abs() }
    }
}

impl Add for Estimate {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Estimate { value: self.value + other.value, size: self.size + other.size }
    }
}

impl Sub for Estimate {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Estimate { value: self.value - other.value, size: self.size + other.size }
    }
}

impl Mul for Estimate {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Estimate { value: self.value * other.value, size: self.size * other.size }
    }
}

impl Neg for Estimate {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Estimate { value: -self.value, size: self.size }
    }
}

impl Ring for Estimate {
    const EXACT: bool = false;

    #[inline(always)]
    fn input(x: f32, scale: Scale) -> Self {
        // Exact: 2^-149 scaled down by 2^128 is a normal double.
        Estimate::exactly(f64::from(x) * power(-scale.high))
    }

    #[inline(always)]
    fn fraction(t: f64, unit: i32) -> (Self, Self) {
        // Exact: the unit is at most 2^277 and t at least 2^-150.
        let scaled = t * power(-unit);
        let fits = scaled.abs() < power(130);
        (if fits { Estimate::exactly(scaled) } else { Estimate::UNKNOWN }, Estimate::exactly(1.0))
    }

    #[inline(always)]
    fn sign(&self) -> Option<i32> {
        if self.value.abs() > Estimate::ROUNDINGS * self.size + Estimate::UNDERFLOW {
            return Some(if self.value > 0.0 { 1 } else { -1 });
        }
        // Zero is never certain, because sizes underflow as well.
        None
    }

    #[inline(always)]
    fn approx(&self) -> Option<Approx> {
        self.sign()?;
        let error = (Estimate::ROUNDINGS * self.size + Estimate::UNDERFLOW) / self.value.abs();
        (error < 1e-6).then_some(Approx { m: self.value, e: 0, error: 1.01 * error })
    }
}

/// Built-in integers; nothing overflows, because bits are counted first.
macro_rules! ring_of_integers {
    ($int:ty) => {
        impl Ring for $int {
            const EXACT: bool = true;

            #[inline]
            fn input(x: f32, scale: Scale) -> Self {
                let (m, shift) = over_power(x, scale.low);
                (m as $int) << shift
            }

            #[inline]
            fn fraction(t: f64, unit: i32) -> (Self, Self) {
                let (m, e) = split(t);
                let shift = if m == 0 { 0 } else { e - unit };
                ((m as $int) << shift.max(0), 1 << (-shift).max(0))
            }

            #[inline]
            fn sign(&self) -> Option<i32> {
                Some(self.signum() as i32)
            }

            #[inline]
            fn approx(&self) -> Option<Approx> {
                Some(Approx { m: *self as f64, e: 0, error: f64::EPSILON })
            }
        }
    };
}
ring_of_integers!(i64);
ring_of_integers!(i128);

impl<const N: usize> Ring for Wide<N> {
    const EXACT: bool = true;

    fn input(x: f32, scale: Scale) -> Self {
        let (m, shift) = over_power(x, scale.low);
        Wide::shifted(m, shift)
    }

    fn fraction(t: f64, unit: i32) -> (Self, Self) {
        let (m, e) = split(t);
        let shift = if m == 0 { 0 } else { e - unit };
        (Wide::shifted(m, shift.max(0) as u32), Wide::shifted(1, (-shift).max(0) as u32))
    }

    fn sign(&self) -> Option<i32> {
        Some(self.signum())
    }

    fn approx(&self) -> Option<Approx> {
        let (m, e) = self.rounded();
        Some(Approx { m, e, error: 4.0 * f64::EPSILON })
    }
}

/// A vector over a ring.
pub(super) type Vector<R> = [R; 3];

/// The product of two numbers of vectors, term by term.
#[inline(always)]
pub(super) fn dot<R: Ring>(a: Vector<R>, b: Vector<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
#[inline(always)]
pub(super) fn cross<R: Ring>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The difference of two vectors.
#[inline(always)]
pub(super) fn minus<R: Ring>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
