//! Integers of a fixed width, wide enough for every polynomial of the oracle over every finite `f32`.

use std::ops::{Add, Mul, Neg, Sub};

/// A two's-complement integer of `64 * N` bits, the lowest limb first.
///
/// The caller counts bits before it chooses `N`, because nothing may overflow. Debug builds check that, so
/// the tests prove the counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wide<const N: usize>([u64; N]);

impl<const N: usize> Wide<N> {
    /// Zero.
    pub const ZERO: Self = Wide([0; N]);

    /// The number `value * 2^shift`.
    pub fn shifted(value: i64, shift: u32) -> Self {
        let (limb, bit) = ((shift / 64) as usize, shift % 64);
        let magnitude = u128::from(value.unsigned_abs()) << bit;
        let mut wide = Wide::ZERO;
        wide.0[limb] = magnitude as u64;
        if let Some(next) = wide.0.get_mut(limb + 1) {
            *next = (magnitude >> 64) as u64;
        }
        if value < 0 { -wide } else { wide }
    }

    /// Whether the number lies below zero.
    pub fn is_negative(&self) -> bool {
        self.0[N - 1] >> 63 == 1
    }

    /// -1, 0 or 1.
    pub fn signum(&self) -> i32 {
        match self.0.iter().all(|&limb| limb == 0) {
            true => 0,
            false if self.is_negative() => -1,
            false => 1,
        }
    }

    /// `(m, e)` such that `m * 2^e` is the number with a relative error below `2^-51`; `m` has the sign.
    pub fn rounded(&self) -> (f64, i32) {
        let magnitude = self.magnitude();
        let used = magnitude.used();
        let limb = |back: usize| if used >= back { magnitude.0[used - back] } else { 0 };
        // The top two limbs hold 65 leading bits or more; the rest is less than 2^-64 of them.
        let top = (u128::from(limb(1)) << 64) | u128::from(limb(2));
        let value = top as f64;
        (if self.is_negative() { -value } else { value }, 64 * (used as i32 - 2))
    }

    fn magnitude(self) -> Self {
        if self.is_negative() { -self } else { self }
    }

    /// The number of limbs in use, for a number that is not negative.
    fn used(&self) -> usize {
        self.0.iter().rposition(|&limb| limb != 0).map_or(0, |top| top + 1)
    }
}

impl<const N: usize> Add for Wide<N> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let mut sum = self;
        let mut carry = false;
        for (limb, &more) in sum.0.iter_mut().zip(&other.0) {
            let (partial, over) = limb.overflowing_add(more);
            let (total, over_again) = partial.overflowing_add(u64::from(carry));
            (*limb, carry) = (total, over | over_again);
        }
        debug_assert!(self.is_negative() != other.is_negative() || sum.is_negative() == self.is_negative());
        sum
    }
}

impl<const N: usize> Neg for Wide<N> {
    type Output = Self;

    fn neg(self) -> Self {
        let mut negative = self;
        let mut carry = true;
        for limb in &mut negative.0 {
            (*limb, carry) = (!*limb).overflowing_add(u64::from(carry));
        }
        negative
    }
}

impl<const N: usize> Sub for Wide<N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Mul for Wide<N> {
    type Output = Self;

    /// Long multiplication of the magnitudes, over the limbs in use.
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.magnitude(), other.magnitude());
        let (a_used, b_used) = (a.used(), b.used());
        let mut product = Wide::ZERO;
        for i in 0..a_used {
            let mut carry = 0u128;
            for j in 0..=b_used {
                let Some(limb) = product.0.get_mut(i + j) else {
                    debug_assert!(carry == 0 && (j == b_used || b.0[j] == 0), "too narrow for a product");
                    break;
                };
                let b_limb = if j < b_used { b.0[j] } else { 0 };
                carry += u128::from(*limb) + u128::from(a.0[i]) * u128::from(b_limb);
                *limb = carry as u64;
                carry >>= 64;
            }
        }
        debug_assert!(!product.is_negative(), "too narrow for a product");
        if self.is_negative() != other.is_negative() { -product } else { product }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_integers_count_like_narrow_ones() {
        let numbers = [0, 1, -1, 2, -7, 1 << 40, i64::MAX, i64::MIN + 1, -(1 << 62) + 3];
        let wide = |x: i64| Wide::<4>::shifted(x, 0);
        for &x in &numbers {
            for &y in &numbers {
                let (a, b) = (i128::from(x), i128::from(y));
                assert_eq!((wide(x) * wide(y)).signum(), (a * b).signum() as i32);
                assert_eq!((wide(x) - wide(y)).signum(), (a - b).signum() as i32);
                let (m, e) = (wide(x) * wide(y) + wide(x)).rounded();
                let value = m * f64::from(e).exp2();
                assert!((value - (a * b + a) as f64).abs() <= 1e-15 * value.abs(), "{x} {y}");
            }
        }
        let two_to_200 = Wide::<4>::shifted(1, 200);
        assert_eq!(two_to_200, Wide::shifted(1, 100) * Wide::shifted(1, 100));
        assert_eq!((-two_to_200).signum(), -1);
        assert_eq!((-two_to_200 - two_to_200).signum(), -1);
    }
}
