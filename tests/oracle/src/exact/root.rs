//! Values of `t` at hits, kept as exact numbers `(p ± √D) / a`, and their comparison.

use super::ring::{Approx, Ring};
use super::scale::Frame;
use std::cmp::Ordering;

/// `t = (p + sign √disc) / a` with `a > 0`; without a surd `t = p / a`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root<R> {
    pub p: R,
    pub a: R,
    pub surd: Option<Surd<R>>,
}

/// The irrational part of a root of `a t² - 2 p t + c = 0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surd<R> {
    /// 1 or -1.
    pub sign: i32,
    /// `p² - a c`, not negative.
    pub disc: R,
    /// The constant term.
    pub c: R,
}

/// How many bits the integers of a root have at most, signs not counted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RootBits {
    pub p: u32,
    pub a: u32,
    pub disc: u32,
}

impl RootBits {
    /// Bits that suffice for [`Root::compare_to`] with a fraction of these bits.
    pub fn against(self, (numerator, denominator): (u32, u32)) -> u32 {
        let p = (self.p + denominator).max(self.a + numerator) + 1;
        // Without a surd nothing is squared.
        if self.disc == 0 { p + 1 } else { (2 * p).max(self.disc + 2 * denominator) + 2 }
    }

    /// Bits that suffice for [`Root::compare`].
    pub fn bits_to_compare(self, other: RootBits) -> u32 {
        let p = (self.p + other.a).max(other.p + self.a) + 1;
        let square = 2 * p;
        let discs = (self.disc + 2 * other.a).max(other.disc + 2 * self.a);
        if self.disc == 0 && other.disc == 0 {
            return p + 2;
        }
        if self.disc == 0 || other.disc == 0 {
            return square.max(discs) + 2;
        }
        let sum = square.max(discs) + 2;
        (2 * sum).max(square + 2 + discs) + 2
    }
}

/// The sign of `p + s √d` for `s` of 1 or -1 and `d >= 0`, without a square root.
fn surd_sign<R: Ring>(p: R, s: i32, d: R) -> Option<i32> {
    let (p_sign, d_sign) = (p.sign()?, d.sign()?);
    if d_sign == 0 || p_sign == s {
        return Some(p_sign);
    }
    if p_sign == 0 {
        return Some(s);
    }
    // The terms have opposite signs: the one with the larger square decides.
    Some(p_sign * (p * p - d).sign()?)
}

impl<R: Ring> Root<R> {
    /// The root `p / a` for any `a` but zero.
    pub fn ratio(p: R, a: R) -> Option<Self> {
        Some(if a.sign()? > 0 { Root { p, a, surd: None } } else { Root { p: -p, a: -a, surd: None } })
    }

    /// The sign of `t - n / d` for a positive `d`.
    pub fn compare_to(&self, (n, d): (R, R)) -> Option<i32> {
        let p = self.p * d - self.a * n;
        match self.surd {
            None => p.sign(),
            Some(surd) => surd_sign(p, surd.sign, surd.disc * d * d),
        }
    }

    /// The sign of `t - other.t`.
    pub fn compare(&self, other: &Self) -> Option<i32> {
        // Over the common positive denominator: p + s1 √d1 - s2 √d2.
        let p = self.p * other.a - other.p * self.a;
        match (self.surd, other.surd) {
            (None, None) => p.sign(),
            (Some(surd), None) => surd_sign(p, surd.sign, surd.disc * other.a * other.a),
            (None, Some(surd)) => surd_sign(p, -surd.sign, surd.disc * self.a * self.a),
            (Some(one), Some(two)) => {
                let (d1, s1) = (one.disc * other.a * other.a, one.sign);
                let (d2, s2) = (two.disc * self.a * self.a, -two.sign);
                let left = surd_sign(p, s1, d1)?;
                let right = s2 * d2.sign()?;
                if right == 0 || left == right {
                    return Some(left);
                }
                if left == 0 {
                    return Some(right);
                }
                // (p + s1 √d1)² - d2 = (p² + d1 - d2) + 2 p s1 √d1.
                let rational = p * p + d1 - d2;
                let mixed = p * p * d1;
                let mixed = mixed + mixed + mixed + mixed;
                Some(left * surd_sign(rational, s1 * p.sign()?, mixed)?)
            }
        }
    }

    /// `t` as a double with a bound on its relative error.
    pub fn approx(&self) -> Option<Approx> {
        let (p, a) = (self.p.approx()?, self.a.approx()?);
        let Some(surd) = self.surd else {
            return Some(p.over(a));
        };
        let root = surd.disc.approx()?.sqrt();
        let root = if surd.sign < 0 { root.negated() } else { root };
        // If p and the root have the same sign, add them, which cancels nothing. The other root is c / (a t).
        if p.m * root.m >= 0.0 {
            return Some(p.plus_alike(root).over(a));
        }
        Some(surd.c.approx()?.over(p.plus_alike(root.negated())))
    }
}

/// `t` rounded, or the two neighbours between which only an exact comparison can choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rounded {
    Known(f32),
    /// The lower neighbour and the upper one.
    Lerp(f32, f32),
}

impl Rounded {
    /// The rounding of a `t` with this double value and relative error; `None` if the error is too large to decide.
    pub fn new(approx: Approx, frame_unit: i32) -> Option<Self> {
        let t = approx.value(frame_unit);
        // One more rounding in each product and sum.
        let slack = t.abs() * (approx.error + 2.0 * f64::EPSILON);
        let (low, high) =
            if t.is_finite() { ((t - slack) as f32, (t + slack) as f32) } else { (t as f32, t as f32) };
        if low == high {
            return Some(Rounded::Known(t as f32));
        }
        (low.next_up() == high).then_some(Rounded::Lerp(low, high))
    }
}

/// The number half-way between two neighbouring `f32`, where rounding changes from one to the other.
pub(super) fn half_way(low: f32, high: f32) -> f64 {
    // The neighbour of the largest number would be 2^128.
    let wide = |x: f32| if x.is_infinite() { x.signum() as f64 * 128f64.exp2() } else { f64::from(x) };
    (wide(low) + wide(high)) / 2.0
}

/// The neighbour to which a number is rounded, by its comparison with the half-way point; ties go to the even one.
pub(super) fn nearest(low: f32, high: f32, to_half_way: Ordering) -> f32 {
    match to_half_way {
        Ordering::Less => low,
        Ordering::Greater => high,
        Ordering::Equal if low.to_bits() & 1 == 0 => low,
        Ordering::Equal => high,
    }
}

/// How far `t` lies from the exact value, in ulps of the `f32` that the exact value is rounded to.
pub(super) fn ulps(t: f32, exact: f64, rounded: f32) -> f64 {
    let exponent = ((rounded.to_bits() >> 23 & 0xff) as i32).clamp(1, 254) - 127;
    (f64::from(t) - exact) / super::ring::power(exponent - 23)
}

/// Whether `t` lies in the open range of the ray, compared without rounding.
pub(super) fn in_range<R: Ring>(root: &Root<R>, t_min: f32, t_max: f32, frame: &Frame) -> Option<bool> {
    Some(beyond(root, t_min, frame)? > 0 && beyond(root, t_max, frame)? < 0)
}

/// The sign of `t - end`; the end may be infinite.
pub(super) fn beyond<R: Ring>(root: &Root<R>, end: f32, frame: &Frame) -> Option<i32> {
    if end.is_infinite() {
        return Some(if end > 0.0 { -1 } else { 1 });
    }
    if end == 0.0 && root.surd.is_none() {
        return root.p.sign();
    }
    root.compare_to(R::fraction(f64::from(end), frame.unit::<R>()))
}
