//! Ray and closed triangle: with the corners `A`, `B`, `C` relative to the origin of the ray, the point at
//! `t` has the barycentric coordinates `U : V : W` with `U = d·(B × C)`, `V = d·(C × A)`, `W = d·(A × B)`,
//! and `t = A·(B × C) / (U + V + W)`.

use super::body::{Body, Hit};
use super::ring::{Estimate, Ring, cross, dot, minus};
use super::root::{Root, RootBits, in_range};
use super::scale::Frame;
use super::{Question, Tier, decide, is_finite, order, verdict};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use std::cmp::Ordering;

/// `[U, V, W]` and `A·(B × C)`.
#[inline(always)]
fn forms<R: Ring>(ray: &Ray, triangle: &Triangle, frame: &Frame) -> ([R; 3], R) {
    let o = frame.point::<R>(ray.origin);
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|p| minus(frame.point(p), o));
    let d = frame.direction::<R>(ray.direction);
    let bc = cross(b, c);
    ([dot(d, bc), dot(d, cross(c, a)), dot(d, cross(a, b))], dot(a, bc))
}

#[inline(always)]
pub(super) fn first<R: Ring>(ray: &Ray, triangle: &Triangle, frame: &Frame) -> Option<Option<Hit<R>>> {
    let ([u, v, w], volume) = forms::<R>(ray, triangle, frame);
    let signs = [u.sign(), v.sign(), w.sign()];
    // Two coordinates of different signs are a miss for any third one.
    if signs.contains(&Some(1)) && signs.contains(&Some(-1)) {
        return Some(None);
    }
    let [u_sign, v_sign, w_sign] = [signs[0]?, signs[1]?, signs[2]?];
    // All have the same sign or are zero, and so has their sum, the determinant.
    let sign = (u_sign + v_sign + w_sign).signum();
    if sign == 0 {
        return Some(None);
    }
    let (p, det) = (volume, u + v + w);
    let root = if sign > 0 { Root { p, a: det, surd: None } } else { Root { p: -p, a: -det, surd: None } };
    let touches = u_sign == 0 || v_sign == 0 || w_sign == 0;
    Some(in_range(&root, ray.t_min, ray.t_max, frame)?.then_some(Hit { root, touches }))
}

/// Bits of the root for coordinates of these bits.
pub(super) fn bits(place: u32, direction: u32) -> (RootBits, u32) {
    let root = RootBits { p: 3 * place + 3, a: 2 * place + direction + 5, disc: 0 };
    (root, root.p.max(root.a))
}

/// How far the verdict is from flipping: the least `|form| / (2^-24 * sum of the absolute values of its terms)` over
/// the three edge forms, to `1e-6` absolute; zero on an edge and for a form without terms. A stable method in
/// single precision is wrong only where this is small. `None` for inputs that are not finite.
pub fn margin(ray: &Ray, triangle: &Triangle) -> Option<f64> {
    if !is_finite(ray, &Body::Triangle(*triangle)) {
        return None;
    }
    let (forms, _) = forms::<Estimate>(ray, triangle, &Frame::UNSCALED);
    let margins = forms.map(|form| match form.sign() {
        Some(_) => form.value.abs() / form.size * 24f64.exp2(),
        // Below 256 * 2^-53 of the size: nothing at this scale.
        None => 0.0,
    });
    Some(margins.into_iter().fold(f64::INFINITY, f64::min))
}

struct Weights<'a> {
    ray: &'a Ray,
    triangle: &'a Triangle,
}

impl Question for Weights<'_> {
    type Answer = Option<[f64; 2]>;

    fn frame(&self, fine: bool) -> Frame {
        Body::Triangle(*self.triangle).frame(self.ray, fine)
    }

    fn bits(&self, frame: &Frame) -> u32 {
        bits(frame.place.bits() + 1, frame.direction.bits()).1
    }

    fn ask<R: Ring>(&self, frame: &Frame) -> Option<Self::Answer> {
        let ([u, v, w], _) = forms::<R>(self.ray, self.triangle, frame);
        let det = u + v + w;
        if det.sign()? == 0 {
            return Some(None);
        }
        let det = det.approx()?;
        let [beta, gamma] = [v.approx()?.over(det), w.approx()?.over(det)];
        (beta.error.max(gamma.error) < 1e-14).then_some(Some([beta.value(0), gamma.value(0)]))
    }
}

/// The barycentric coordinates `(β, γ)` of `b` and `c` where the line of the ray hits the plane of the
/// triangle, inside or not, each with a relative error below `1e-14`. `Some(None)` if the determinant is
/// zero.
pub fn weights(ray: &Ray, triangle: &Triangle) -> Option<Option<[f64; 2]>> {
    if !is_finite(ray, &Body::Triangle(*triangle)) {
        return None;
    }
    decide(&Weights { ray, triangle }, Tier::Auto)
}

/// Whether exactly one barycentric coordinate is zero where the line of the ray hits the plane: on an edge,
/// but not at a corner.
pub(super) fn is_within_edge(ray: &Ray, triangle: &Triangle) -> bool {
    let on = weights(ray, triangle).flatten().map(|[beta, gamma]| (beta == 0.0, gamma == 0.0, triangle));
    let first_zero = || {
        let Triangle { a, b, c } = *triangle;
        weights(ray, &Triangle { a: b, b: a, c }).flatten().is_some_and(|[alpha, _]| alpha == 0.0)
    };
    on.is_some_and(|(b, c, _)| usize::from(b) + usize::from(c) + usize::from(first_zero()) == 1)
}

/// The indices of all triangles that the ray hits at the smallest exact `t`, ascending: the answers that a
/// search may give. Triangles that are not finite are never hit, and a ray that is not finite hits nothing.
pub fn tie_set(ray: &Ray, triangles: &[Triangle]) -> Vec<usize> {
    let mut nearest: Vec<usize> = Vec::new();
    for (index, triangle) in triangles.iter().enumerate() {
        let body = Body::Triangle(*triangle);
        if !verdict(ray, body).is_some_and(|verdict| verdict.is_hit()) {
            continue;
        }
        let to_best = nearest.first().map(|&best| order(ray, body, Body::Triangle(triangles[best])));
        match to_best {
            None | Some(Some(Ordering::Less)) => nearest = vec![index],
            Some(Some(Ordering::Equal)) => nearest.push(index),
            Some(_) => {}
        }
    }
    nearest
}
