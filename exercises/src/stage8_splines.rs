//! Stage 8 · B-spline and NURBS surfaces: many control points with a low degree, and weights that
//! make arcs of circles exact.
//!
//! Slides: `slides/stage08.md`. Sources: Cox, "The Numerical Evaluation of B-Splines", 1972; de
//! Boor, "On Calculating with B-Splines", 1972; Piegl and Tiller, "The NURBS Book", 1997.
//!
//! Given: [`NurbsPatch`] with its degrees, knots, control points and weights.

use glam::{Vec2, Vec3};
use raykata::shape::NurbsPatch;

/// The B-spline basis function `N(i, p)` at `u` (`i = index`, `p = degree`) blends two functions of
/// one degree less (Cox, de Boor). What if knots are equal? And which span contains the last knot?
///
/// Knots are finite and never descend, and `index + degree + 1` is a valid index. `u` lies in the
/// domain `knots[p]..=knots[n]` of `n = knots.len() - p - 1` functions. There, ends included, they
/// are at least 0, and their sum is 1.
///
/// Exactly:
///
/// 1. `N(i, 0)(u)` is 1 in the span `knots[i] <= u < knots[i + 1]`, and 0 elsewhere. The last span
///    that is not empty also contains the last knot.
/// 2. `N(i, p)(u) = (u - k_i) / (k_{i+p} - k_i) N(i, p-1)(u) + (k_{i+p+1} - u) / (k_{i+p+1} -
///    k_{i+1}) N(i+1, p-1)(u)`, without a term whose denominator is 0.
///
/// Source: Cox 1972; de Boor 1972.
pub fn bspline_basis(knots: &[f32], degree: usize, index: usize, u: f32) -> f32 {
    todo!("return 1 or 0 for degree 0; else blend the basis functions index and index + 1 of one degree less")
}

/// A point of a NURBS surface: the mean of the control points `rows[j][i]` with the factors
/// `N(i)(u) · N(j)(v) · weights[j][i]`, where `N` is [`bspline_basis`]. The sum of the basis
/// functions is 1. What is the sum of the factors?
///
/// `u` runs along the rows and belongs to `degrees[0]` and `knots[0]`, `v` from row to row and
/// belongs to `degrees[1]` and `knots[1]`. Both lie in their domains, ends included. All weights
/// are above 0; equal ones give a B-spline. Three points with the weights `1, cos(α/2), 1` make an
/// exact arc of the angle α.
///
/// Source: Piegl and Tiller 1997, sections 4.2 and 7.3.
pub fn nurbs_point(patch: &NurbsPatch, uv: Vec2) -> Vec3 {
    todo!("sum basis · basis · weight · point, and divide by the sum of basis · basis · weight")
}
