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
