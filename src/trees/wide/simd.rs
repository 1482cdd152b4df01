//! Vectors of eight numbers, on which one instruction works at once (SIMD).
//!
//! Code that uses them is generic over the [`Level`], the set of instructions of the processor. [`Instructions::run`]
//! chooses the level while the program runs, so that one program runs fast on old and new processors. The choice costs a
//! few nanoseconds. So it is made once per ray or once per frame, and never in a loop over nodes: measured, 68 ns per node
//! in place of 2.7. For the same reason every function that gets a level is `#[inline(always)]`: a function that is not
//! inlined is compiled for the oldest processor.
//!
//! Sums, differences, products, comparisons, `min` and `max` give the same result at every level. [`F32x8::mul_add`] does
//! not: use it only where a rounding error changes no hit. So a wide tree finds the same hits on every processor, but may visit
//! a few other nodes.

use fearless_simd::{SimdBase, SimdFloat, SimdMask};
use std::ops::{Add, BitAnd, BitOr, Mul, Sub};

pub use fearless_simd::Simd as Level;

/// Eight numbers in single precision.
#[derive(Clone, Copy, Debug)]
pub struct F32x8<L: Level>(fearless_simd::f32x8<L>);

impl<L: Level> F32x8<L> {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn splat(level: L, number: f32) -> Self {
        F32x8(fearless_simd::f32x8::splat(level, number))
    }

    /// The numbers of an array, lane 0 first.
    #[inline(always)]
    pub fn load(level: L, lanes: &[f32; 8]) -> Self {
        F32x8(fearless_simd::f32x8::from_slice(level, lanes))
    }

    /// The lanes as an array, lane 0 first.
    #[inline(always)]
    pub fn to_array(self) -> [f32; 8] {
        self.0.into()
    }

    /// Per lane the smaller number: `self` if `self < other`, and otherwise `other`. So a NaN in `self` gives
    /// `other`.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        // The instruction of x86 has this rule. Other processors return NaN for a NaN in either operand.
        if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
            return F32x8(self.0.min(other.0));
        }
        let (a, b) = (self.to_array(), other.to_array());
        let lanes = std::array::from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] });
        Self::load(self.0.simd, &lanes)
    }

    /// Per lane the larger number: `self` if `self > other`, and otherwise `other`. So a NaN in `self` gives
    /// `other`.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
            return F32x8(self.0.max(other.0));
        }
        let (a, b) = (self.to_array(), other.to_array());
        let lanes = std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] });
        Self::load(self.0.simd, &lanes)
    }

    /// Per lane the absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        F32x8(self.0.abs())
    }

    /// Per lane the absolute value of `self` with the sign of `sign`.
    #[inline(always)]
    pub fn copysign(self, sign: Self) -> Self {
        F32x8(self.0.copysign(sign.0))
    }

    /// Per lane `self * factor + summand`, with one or two roundings, depending on the processor.
    #[inline(always)]
    pub fn mul_add(self, factor: Self, summand: Self) -> Self {
        F32x8(self.0.mul_add(factor.0, summand.0))
    }

    /// Per lane `self * factor - subtrahend`, with one or two roundings, depending on the processor.
    #[inline(always)]
    pub fn mul_sub(self, factor: Self, subtrahend: Self) -> Self {
        F32x8(self.0.mul_sub(factor.0, subtrahend.0))
    }

    /// Per lane whether `self <= other`; false for a NaN.
    #[inline(always)]
    pub fn le(self, other: Self) -> Mask8<L> {
        Mask8(self.0.simd_le(other.0))
    }

    /// Per lane whether `self < other`; false for a NaN.
    #[inline(always)]
    pub fn lt(self, other: Self) -> Mask8<L> {
        Mask8(self.0.simd_lt(other.0))
    }
}

impl<L: Level> Add for F32x8<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        F32x8(self.0 + other.0)
    }
}

impl<L: Level> Sub for F32x8<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        F32x8(self.0 - other.0)
    }
}

impl<L: Level> Mul for F32x8<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        F32x8(self.0 * other.0)
    }
}

/// The answers of a comparison of eight numbers.
#[derive(Clone, Copy, Debug)]
pub struct Mask8<L: Level>(fearless_simd::mask32x8<L>);

impl<L: Level> Mask8<L> {
    /// The answers as bits: bit `i` is set if lane `i` is true.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.0.to_bitmask() as u32
    }
}

impl<L: Level> BitAnd for Mask8<L> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Mask8(self.0 & other.0)
    }
}

impl<L: Level> BitOr for Mask8<L> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Mask8(self.0 | other.0)
    }
}
/// Work that is compiled once for each [`Level`].
pub trait Vectorized {
    /// The result of the work.
    type Output;

    /// Does the work with the instructions of `level`. Implementations are `#[inline(always)]`.
    fn run<L: Level>(self, level: L) -> Self::Output;
}

/// The instructions that the processor has.
#[derive(Clone, Copy, Debug)]
pub struct Instructions(fearless_simd::Level);

impl Instructions {
    /// Asks the processor. The answer should be kept, because asking takes time.
    pub fn detect() -> Instructions {
        Instructions(fearless_simd::Level::new())
    }

    /// Does the work with the best instructions of this processor.
    ///
    /// On x86 it is compiled twice, for AVX2 (processors since 2013) and for SSE2 (all 64-bit processors).
    #[inline(always)]
    pub fn run<V: Vectorized>(self, work: V) -> V::Output {
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(level) = self.0.as_avx2() {
                return level.vectorize(
                    #[inline(always)]
                    || work.run(level),
                );
            }
            if let Some(level) = self.0.as_sse2() {
                return level.vectorize(
                    #[inline(always)]
                    || work.run(level),
                );
            }
            unreachable!("every x86-64 processor has SSE2")
        }
        #[cfg(not(target_arch = "x86_64"))]
        fearless_simd::dispatch!(self.0, level => work.run(level))
    }
}
