//! Stage 8 · B-spline and NURBS surfaces: many control points with a low degree, and weights that make arcs of circles
//! exact.
//!
//! Slides: "Types of primitives" (splines, NURBS). Cox, "The Numerical Evaluation of B-Splines", 1972; de Boor, "On
//! Calculating with B-Splines", 1972; Piegl and Tiller, "The NURBS Book", 1997.
//!
//! Given: [`NurbsPatch`] with its degrees, knots, control points and weights.

use glam::{Vec2, Vec3};
use raykata::shape::NurbsPatch;

/// Computes the B-spline basis function `N(i, p)` at `u` by the recursion of Cox and de Boor, for `i = index` and
/// `p = degree`.
///
/// - `N(i, 0)(u)` is 1 in the span `knots[i] <= u < knots[i + 1]`, and 0 elsewhere. At the last knot it is 1 in the
///   last span that is not empty, which is closed on both sides.
/// - `N(i, p)(u) = (u - k_i) / (k_{i+p} - k_i) N(i, p-1)(u) + (k_{i+p+1} - u) / (k_{i+p+1} - k_{i+1}) N(i+1, p-1)(u)`.
///   A term whose denominator is 0 is left out.
///
/// The knots are finite and never descend, and `index + degree + 1` is a valid index into them. `u` lies in the domain
/// `knots[p]..=knots[n]` of `n = knots.len() - p - 1` basis functions, both ends included. There they are at least 0, and
/// their sum is 1.
///
/// Pitfall: equal knots make both the numerator and the denominator 0, and 0 / 0 is NaN. If all spans are half open, all
/// basis functions are 0 at the end of the domain, and the surface lacks its last row of points.
///
/// Source: Cox 1972; de Boor 1972.
pub fn bspline_basis(knots: &[f32], degree: usize, index: usize, u: f32) -> f32 {
    todo!("return 1 or 0 for degree 0; else blend the basis functions index and index + 1 of one degree less")
}

/// Computes a point of a NURBS surface (non-uniform rational B-spline): the mean of the control points `rows[j][i]` with
/// the factors `N(i)(u) · N(j)(v) · weights[j][i]`.
///
/// `u` runs along the rows and belongs to `degrees[0]` and `knots[0]`; `v` runs from row to row and belongs to `degrees[1]`
/// and `knots[1]`. `N` are the functions of [`bspline_basis`]. Both parameters lie in their domains, ends included. All
/// weights are above 0. With equal weights the surface is a B-spline surface.
///
/// Weights make conics exact: the points `(1, 0)`, `(1, 1)`, `(0, 1)` with the weights `1, √½, 1` and the knots
/// `0, 0, 0, 1, 1, 1` of degree 2 give a quarter of a circle. In general the middle weight is the cosine of half the angle of
/// the arc. No B-spline without weights is an arc.
///
/// Pitfall: divide by the sum of the factors *with* the weights. The basis functions alone have the sum 1, so without
/// weights the division seems unnecessary.
///
/// Source: Piegl and Tiller 1997, sections 4.2 and 7.3.
pub fn nurbs_point(patch: &NurbsPatch, uv: Vec2) -> Vec3 {
    todo!("sum basis · basis · weight · point, and divide by the sum of basis · basis · weight")
}
