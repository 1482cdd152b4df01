//! Inputs as integers: every finite `f32` is `m * 2^e`, and each group of inputs (points, the direction, a normal)
//! shares one exponent, because signs of homogeneous polynomials do not change when a group is scaled.

use super::ring::{Ring, Vector};
use glam::Vec3;

/// `x = m * 2^e` with an odd `m`, or zeros.
pub(super) fn split(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (m, e) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    if m == 0 {
        return (0, 0);
    }
    let zeros = m.trailing_zeros();
    (if x < 0.0 { -(m >> zeros) } else { m >> zeros }, e + zeros as i32)
}

/// `x / 2^low` for an `x` that is a multiple of `2^low`, as `m * 2^shift`: `m` holds all bits if the shift is zero.
#[inline(always)]
pub(super) fn over_power(x: f32, low: i32) -> (i64, u32) {
    let bits = x.to_bits();
    let (exponent, fraction) = ((bits >> 23 & 0xff) as i32, i64::from(bits & 0x7f_ffff));
    let normal = i32::from(exponent != 0);
    let m = fraction | i64::from(normal) << 23;
    // A zero has the smallest exponent, so it is shifted to the right.
    let shift = exponent - normal - 149 - low;
    // Avoid branches, which are hard to predict: below `low` there are only zeros, and a shift by 31 clears them.
    let m = m >> (-shift).clamp(0, 31);
    let negative = -i64::from(bits >> 31);
    ((m ^ negative) - negative, shift.max(0) as u32)
}

/// The exponents that a group of inputs spans: all are multiples of `2^low` and below `2^high` in absolute value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scale {
    pub low: i32,
    pub high: i32,
}

impl Scale {
    /// The scale of a group of zeros.
    pub const NONE: Scale = Scale { low: 0, high: 0 };

    /// The scale of groups that a filter need not scale.
    pub const ONE: Scale = Scale::NONE;

    /// The upper end only, which is all that a filter needs.
    pub fn rough(numbers: impl IntoIterator<Item = f32>) -> Scale {
        let top = numbers.into_iter().fold(0, |top, x| top.max(x.to_bits() & 0x7fff_ffff));
        // Numbers whose exponent field is f lie below 2^(f - 126); denormals below 2^-126.
        Scale { low: 0, high: (top >> 23) as i32 - 126 }
    }

    /// Both ends.
    pub fn fine(numbers: impl IntoIterator<Item = f32>) -> Scale {
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        for x in numbers {
            // Avoid branches, which are hard to predict.
            let bits = x.to_bits() & 0x7fff_ffff;
            let exponent = (bits >> 23) as i32;
            let normal = i32::from(exponent != 0);
            let m = (bits & 0x7f_ffff) | (normal as u32) << 23;
            let e = exponent - normal - 149;
            // A zero changes neither end.
            low = low.min(if bits == 0 { i32::MAX } else { e + m.trailing_zeros() as i32 });
            high = high.max(if bits == 0 { i32::MIN } else { e + 32 - m.leading_zeros() as i32 });
        }
        if low == i32::MAX { Scale::NONE } else { Scale { low, high } }
    }

    /// The number of bits of the integers in the group.
    pub fn bits(self) -> u32 {
        (self.high - self.low) as u32
    }
}

/// The scales of all groups of a question.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Points and lengths.
    pub place: Scale,
    /// The direction of the ray.
    pub direction: Scale,
    /// A normal, if there is one.
    pub normal: Scale,
}

impl Frame {
    /// The frame in which nothing is scaled, for filters of a degree too low for underflow.
    pub const UNSCALED: Frame = Frame { place: Scale::ONE, direction: Scale::ONE, normal: Scale::ONE };

    /// `t` in units of this frame counts `2^unit`.
    pub fn unit<R: Ring>(&self) -> i32 {
        if R::EXACT { self.place.low - self.direction.low } else { self.place.high - self.direction.high }
    }

    /// A point as integers.
    #[inline(always)]
    pub fn point<R: Ring>(&self, p: Vec3) -> Vector<R> {
        p.to_array().map(|x| R::input(x, self.place))
    }

    /// The direction as integers.
    #[inline(always)]
    pub fn direction<R: Ring>(&self, d: Vec3) -> Vector<R> {
        d.to_array().map(|x| R::input(x, self.direction))
    }

    /// The numbers of bits of the two integers of [`Ring::fraction`] for this `t`.
    pub fn fraction_bits(&self, t: f64) -> (u32, u32) {
        let (m, e) = split(t);
        if m == 0 {
            return (0, 1);
        }
        let shift = e - self.unit::<i128>();
        (64 - m.unsigned_abs().leading_zeros() + shift.max(0) as u32, 1 + (-shift).max(0) as u32)
    }
}
