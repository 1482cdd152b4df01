//! Ray–triangle intersection methods: as printed in the lectures, as commonly used, and corrected. All are in single
//! precision, some also in double.

use glam::{DVec3, Vec3};
use oracle::exact::{Body, meet};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use single::{
    edge_forms, gram_weights, in_range, moeller_trumbore, numbers, on_plane, plane_sides, t_of_plane,
};

/// An intersection method: its name, for the head of a row, and what returns the `t` of the hit.
type TriangleTest = (&'static str, fn(&Ray, &Triangle) -> Option<f32>);

/// All methods.
pub const METHODS: [TriangleTest; 25] = [
    ("Möller–Trumbore", single::moeller_trumbore),
    ("  cut off at |det| < 1e-6", moeller_trumbore_cut_off),
    ("  in double", double::moeller_trumbore),
    ("Cramer", single::cramer),
    ("  as printed in 002", cramer_as_printed),
    ("  in double", double::cramer),
    ("plane and Gram", single::gram),
    ("  0 <= s + t <= 1 as printed in 001", gram_sum_only),
    ("  in double", double::gram),
    ("inside test I, planes", single::by_planes),
    ("  one winding, as printed", by_planes_of_one_winding),
    ("  in double", double::by_planes),
    ("inside test II, directions", single::by_direction),
    ("  in double", double::by_direction),
    ("inside test III, areas", single::by_areas),
    ("  in double", double::by_areas),
    ("  without signs, as printed", by_unsigned_areas),
    ("Plücker", single::pluecker),
    ("  with a band of one step", pluecker_with_a_band),
    ("  in double", double::pluecker),
    ("Woop", single::woop),
    ("  t from the plane", single::woop_with_plane),
    ("  in double", double::woop),
    ("  in double, t from the plane", double::woop_with_plane),
    ("exact", exactly),
];

fn exactly(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    meet(ray, Body::Triangle(*triangle))?.t
}

/// Defines the methods for one precision.
macro_rules! precision {
    ($module:ident, $Float:ty, $Vector:ty, $convert:expr) => {
        mod $module {
            use super::*;

            /// Returns origin, direction and the three corners.
            pub(crate) fn numbers(ray: &Ray, triangle: &Triangle) -> [$Vector; 5] {
                [ray.origin, ray.direction, triangle.a, triangle.b, triangle.c].map($convert)
            }

            pub(crate) fn in_range(ray: &Ray, t: $Float) -> Option<f32> {
                let t = t as f32;
                ray.contains(t).then_some(t)
            }

            pub(crate) fn determinant(x: $Vector, y: $Vector, z: $Vector) -> $Float {
                x.dot(y.cross(z))
            }

            pub(crate) fn moeller_trumbore(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let [o, d, a, b, c] = numbers(ray, triangle);
                let (u, v) = (b - a, c - a);
                let p = d.cross(v);
                let det = u.dot(p);
                if det == 0.0 {
                    return None;
                }
                let s = o - a;
                let beta = s.dot(p) / det;
                let q = s.cross(u);
                let gamma = d.dot(q) / det;
                let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
                if inside { in_range(ray, v.dot(q) / det) } else { None }
            }

            pub(crate) fn cramer(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let [o, d, a, b, c] = numbers(ray, triangle);
                let (u, v, r) = (b - a, c - a, o - a);
                let det = determinant(u, v, -d);
                let beta = determinant(r, v, -d) / det;
                let gamma = determinant(u, r, -d) / det;
                let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
                if inside { in_range(ray, determinant(u, v, r) / det) } else { None }
            }

            /// Returns `t` on the plane, the point there in world space as in the lectures, and the plane's normal.
            pub(crate) fn on_plane(ray: &Ray, triangle: &Triangle) -> ($Float, $Vector, $Vector) {
                let [o, d, a, b, c] = numbers(ray, triangle);
                let n = (b - a).cross(c - a);
                let t = (a.dot(n) - o.dot(n)) / d.dot(n);
                (t, o + t * d, n)
            }

            pub(crate) fn gram_weights(ray: &Ray, triangle: &Triangle) -> ($Float, $Float, $Float) {
                let [_, _, a, b, c] = numbers(ray, triangle);
                let (t, point, _) = on_plane(ray, triangle);
                let (u, v, w) = (b - a, c - a, point - a);
                let (uu, uv, vv, wu, wv) = (u.dot(u), u.dot(v), v.dot(v), w.dot(u), w.dot(v));
                let d = uv * uv - uu * vv;
                ((uv * wv - vv * wu) / d, (uv * wu - uu * wv) / d, t)
            }

            pub(crate) fn gram(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let (beta, gamma, t) = gram_weights(ray, triangle);
                let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
                if inside { in_range(ray, t) } else { None }
            }

            pub(crate) fn one_side(signs: [$Float; 3]) -> bool {
                signs.iter().all(|&sign| sign >= 0.0) || signs.iter().all(|&sign| sign <= 0.0)
            }

            pub(crate) fn plane_sides(ray: &Ray, triangle: &Triangle) -> ($Float, [$Float; 3]) {
                let [o, _, a, b, c] = numbers(ray, triangle);
                let (t, point, _) = on_plane(ray, triangle);
                let side = |from: $Vector, to: $Vector| (from - o).cross(to - o).dot(point - o);
                (t, [side(a, b), side(b, c), side(c, a)])
            }

            pub(crate) fn by_planes(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let (t, sides) = plane_sides(ray, triangle);
                if one_side(sides) { in_range(ray, t) } else { None }
            }

            pub(crate) fn by_direction(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let [_, d, a, b, c] = numbers(ray, triangle);
                let (t, point, _) = on_plane(ray, triangle);
                let side = |from: $Vector, to: $Vector| d.dot((to - point).cross(from - point));
                if one_side([side(a, b), side(b, c), side(c, a)]) { in_range(ray, t) } else { None }
            }

            /// Tests the signed areas of the three parts as shares of the whole area.
            pub(crate) fn by_areas(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let [_, _, a, b, c] = numbers(ray, triangle);
                let (t, point, n) = on_plane(ray, triangle);
                let share = |from: $Vector, to: $Vector| (from - point).cross(to - point).dot(n) / n.dot(n);
                let (alpha, beta) = (share(b, c), share(c, a));
                let inside = alpha >= 0.0 && beta >= 0.0 && alpha + beta <= 1.0;
                if inside { in_range(ray, t) } else { None }
            }

            /// Returns the three edge functions, relative to the ray's origin.
            pub(crate) fn edge_forms(ray: &Ray, triangle: &Triangle) -> [$Float; 3] {
                let [o, d, a, b, c] = numbers(ray, triangle);
                let [a, b, c] = [a, b, c].map(|corner| corner - o);
                // Use differences and sums, so that neighbours compute the same value for their shared edge, up to the
                // sign.
                let form = |p: $Vector, q: $Vector| (q - p).cross(q + p).dot(d);
                [form(b, c), form(c, a), form(a, b)]
            }

            pub(crate) fn t_of_plane(ray: &Ray, triangle: &Triangle) -> $Float {
                let [o, d, a, b, c] = numbers(ray, triangle);
                let n = (b - a).cross(c - a);
                (a - o).dot(n) / d.dot(n)
            }

            pub(crate) fn pluecker(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let forms = edge_forms(ray, triangle);
                if one_side(forms) { in_range(ray, t_of_plane(ray, triangle)) } else { None }
            }

            /// Returns Woop's edge functions, the sheared z of the corners, and the direction's z.
            fn sheared(ray: &Ray, triangle: &Triangle) -> ([$Float; 3], [$Float; 3], $Float) {
                // Choose the direction's largest component as the z axis.
                let [o, d, a, b, c] = numbers(ray, triangle);
                let z = d.abs().max_position();
                // Shear the corners so that the ray runs along z.
                let (x, y) = ((z + 1) % 3, (z + 2) % 3);
                let shear = [d[x] / d[z], d[y] / d[z]];
                let project = |corner: $Vector| {
                    let corner = corner - o;
                    [corner[x] - shear[0] * corner[z], corner[y] - shear[1] * corner[z], corner[z]]
                };
                let [a, b, c] = [a, b, c].map(project);
                let edge = |p: [$Float; 3], q: [$Float; 3]| p[0] * q[1] - p[1] * q[0];
                ([edge(b, c), edge(c, a), edge(a, b)], [a[2], b[2], c[2]], d[z])
            }

            pub(crate) fn woop(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let (edges, depths, length) = sheared(ray, triangle);
                let sum: $Float = edges.iter().sum();
                if !one_side(edges) || sum == 0.0 {
                    return None;
                }
                let depth: $Float = edges.iter().zip(depths).map(|(edge, depth)| edge * depth).sum();
                in_range(ray, depth / length / sum)
            }

            pub(crate) fn woop_with_plane(ray: &Ray, triangle: &Triangle) -> Option<f32> {
                let (edges, ..) = sheared(ray, triangle);
                let sum: $Float = edges.iter().sum();
                if !one_side(edges) || sum == 0.0 {
                    return None;
                }
                in_range(ray, t_of_plane(ray, triangle))
            }
        }
    };
}

precision!(single, f32, Vec3, |v: Vec3| v);
precision!(double, f64, DVec3, Vec3::as_dvec3);

// Methods with errors that are printed in lectures or commonly used. They stay unchanged, so that the gauntlet can show their cost.

/// A common error: it treats a determinant below a fixed number as parallel, for triangles of any size.
fn moeller_trumbore_cut_off(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let det = (triangle.b - triangle.a).dot(ray.direction.cross(triangle.c - triangle.a));
    if det.abs() < 1e-6 { None } else { moeller_trumbore(ray, triangle) }
}

/// Lecture 002 prints terms of another numerator in the determinant.
fn cramer_as_printed(ray: &Ray, triangle: &Triangle) -> Option<f32> {
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
fn gram_sum_only(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let (beta, gamma, t) = gram_weights(ray, triangle);
    if (0.0..=1.0).contains(&(beta + gamma)) { in_range(ray, t) } else { None }
}

/// Lecture 003 returns a miss at the first negative distance, which is right for one winding only.
fn by_planes_of_one_winding(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let (t, sides) = plane_sides(ray, triangle);
    if sides.iter().any(|&side| side < 0.0) { None } else { in_range(ray, t) }
}

/// Lecture 003 uses areas without a sign.
fn by_unsigned_areas(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let [_, _, a, b, c] = numbers(ray, triangle);
    let (t, point, n) = on_plane(ray, triangle);
    let share = |from: Vec3, to: Vec3| (from - point).cross(to - point).length() / n.length();
    let (alpha, beta) = (share(b, c), share(c, a));
    if alpha + beta <= 1.0 { in_range(ray, t) } else { None }
}

/// Edges widened by a rounding error of the whole area: it leaks less, but hits where it should miss.
fn pluecker_with_a_band(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let forms = edge_forms(ray, triangle);
    let sum: f32 = forms.iter().sum();
    let band = f32::EPSILON * sum.abs();
    let inside = forms.iter().all(|&form| form >= -band) || forms.iter().all(|&form| form <= band);
    if inside && sum != 0.0 { in_range(ray, t_of_plane(ray, triangle)) } else { None }
}
