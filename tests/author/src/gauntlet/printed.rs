//! Intersection methods with errors that are printed in lectures or commonly used. They stay unchanged, so that the
//! gauntlet can show their cost.

use super::methods::single::{
    edge_forms, gram_weights, in_range, moeller_trumbore, numbers, on_plane, plane_sides, t_of_plane,
};
use glam::Vec3;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// A common error: it treats a determinant below a fixed number as parallel, for triangles of any size.
pub(super) fn moeller_trumbore_cut_off(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let det = (triangle.b - triangle.a).dot(ray.direction.cross(triangle.c - triangle.a));
    if det.abs() < 1e-6 { None } else { moeller_trumbore(ray, triangle) }
}

/// Lecture 002 prints terms of another numerator in the determinant.
pub(super) fn cramer(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let [o, direction, corner, second, third] = numbers(ray, triangle);
    let (first, other, rhs) = (second - corner, third - corner, o - corner);
    let [a, e, i] = first.to_array();
    let [b, f, j] = other.to_array();
    let [c, g, k] = (-direction).to_array();
    let [d, h, l] = rhs.to_array();
    let det = a * (f * k - g * j) + b * (g * l - h * k) + c * (h * j - f * l);
    let beta = (d * (f * k - g * j) + b * (g * l - h * k) + c * (h * j - f * l)) / det;
    let gamma = (a * (h * k - g * l) + d * (g * i - e * k) + c * (e * l - h * i)) / det;
    let t = (a * (f * l - h * j) + b * (h * i - e * l) + d * (e * j - f * i)) / det;
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    if inside { in_range(ray, t) } else { None }
}

/// Lecture 001 tests only the sum of the barycentric coordinates.
pub(super) fn gram_sum_only(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let (beta, gamma, t) = gram_weights(ray, triangle);
    if (0.0..=1.0).contains(&(beta + gamma)) { in_range(ray, t) } else { None }
}

/// Lecture 003 returns a miss at the first negative distance, which is right for one winding only.
pub(super) fn by_planes_of_one_winding(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let (t, sides) = plane_sides(ray, triangle);
    if sides.iter().any(|&side| side < 0.0) { None } else { in_range(ray, t) }
}

/// Lecture 003 uses areas without a sign.
pub(super) fn by_unsigned_areas(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let [_, _, a, b, c] = numbers(ray, triangle);
    let (t, point, n) = on_plane(ray, triangle);
    let share = |from: Vec3, to: Vec3| (from - point).cross(to - point).length() / n.length();
    let (alpha, beta) = (share(b, c), share(c, a));
    if alpha + beta <= 1.0 { in_range(ray, t) } else { None }
}

/// Edges widened by a rounding error of the whole area: it leaks less, but hits where it should miss.
pub(super) fn pluecker_with_a_band(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let forms = edge_forms(ray, triangle);
    let sum: f32 = forms.iter().sum();
    let band = f32::EPSILON * sum.abs();
    let inside = forms.iter().all(|&form| form >= -band) || forms.iter().all(|&form| form <= band);
    if inside && sum != 0.0 { in_range(ray, t_of_plane(ray, triangle)) } else { None }
}
