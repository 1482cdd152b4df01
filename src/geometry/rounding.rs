//! Bounds on rounding errors in single precision (Higham, "Accuracy and Stability of Numerical Algorithms", 2002,
//! section 3.1; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, section 6.8).
//!
//! ```
//! use raykata::rounding::{UNIT_ROUNDOFF, gamma};
//!
//! let (x, y) = (0.1f32, 0.7f32);
//! let exact = f64::from(x) * f64::from(y) * f64::from(y);
//! let error = (f64::from(x * y * y) - exact).abs();
//! assert!(error <= f64::from(gamma(2)) * exact);
//! assert_eq!(UNIT_ROUNDOFF, 2f32.powi(-24));
//! ```

/// The unit roundoff `u = 2⁻²⁴`: the largest relative error of one rounding to `f32`, if nothing overflows or underflows.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// `γₙ = n u / (1 - n u)`, a bound on the relative error of a product or quotient of `n` roundings.
///
/// `n` is small: below `1 / u`.
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}

/// The largest whole number that is not above `x`, as [`f32::floor`] returns it. Processors before SSE 4.1 have no instruction
/// for it, and programs for all of them call a library function, which takes several times as long.
///
/// ```
/// use raykata::rounding::floor;
///
/// let numbers = [-2.5, -2.0, 0.5, 8_388_607.5, -8_388_607.5, 1e30, f32::MIN, f32::INFINITY];
/// assert_eq!(numbers.map(floor), numbers.map(f32::floor));
/// ```
#[inline]
pub fn floor(x: f32) -> f32 {
    // A number from 2²³ on has no fraction, and neither have infinity and NaN.
    if !(x.abs() < 8_388_608.0) {
        return x;
    }
    let toward_zero = x as i32 as f32;
    if toward_zero > x { toward_zero - 1.0 } else { toward_zero }
}

/// The sum of `terms`, as if it were computed exactly and rounded at the end: its sign is right, and its relative error is
/// at most 2⁻⁵². The terms need not have similar sizes. The sum is NaN or infinite if a term is, or if a partial sum
/// overflows.
///
/// The algorithm keeps partial sums that do not overlap, so that no digit is lost (Shewchuk 1997, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates"; it is also Python's `math.fsum`).
///
/// ```
/// use raykata::rounding::exact_sum;
///
/// assert_eq!(1e100 + 1.0 - 1e100, 0.0);
/// assert_eq!(exact_sum([1e100, 1.0, -1e100]), 1.0);
/// ```
pub fn exact_sum(terms: impl IntoIterator<Item = f64>) -> f64 {
    // The partial sums, the smallest first. No two have a binary digit in the same place.
    let mut partials: Vec<f64> = Vec::with_capacity(8);
    for term in terms {
        let mut sum = term;
        let mut kept = 0;
        // Add each partial sum to the term, and keep in its place the rounding error, which is a double.
        for index in 0..partials.len() {
            let (rounded, error) = two_sum(sum, partials[index]);
            sum = rounded;
            if error != 0.0 {
                partials[kept] = error;
                kept += 1;
            }
        }
        partials.truncate(kept);
        partials.push(sum);
    }
    partials.into_iter().sum()
}

/// The rounded sum of two numbers, and its rounding error: together they are exactly `a + b`, if the sum does not overflow
/// (Knuth, "The Art of Computer Programming", volume 2, section 4.2.2).
///
/// ```
/// use raykata::rounding::two_sum;
///
/// assert_eq!(two_sum(1e100, 1.0), (1e100, 1.0));
/// ```
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_rounded = sum - a;
    let a_rounded = sum - b_rounded;
    (sum, (a - a_rounded) + (b - b_rounded))
}
