//! Ray and sphere: `|o + t d - c|² = r²`.

use super::ring::{Ring, cross, dot, minus};
use super::root::{Root, RootBits, Surd, in_range};
use super::scale::Frame;
use super::solid::Span;
use super::{Question, body::Body, is_finite};
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// Both roots as `a t² - 2 p t + c = 0` with `a = d·d`, `p = -f·d`, `c = f·f - r²`, `f = o - c`; Lagrange's identity
/// turns `p² - a c` into `r² a - |f × d|²`, which cancels less in the filter.
pub(super) fn span<R: Ring>(ray: &Ray, sphere: &Sphere, frame: &Frame) -> Option<Span<R>> {
    if sphere.radius <= 0.0 || ray.direction == glam::Vec3::ZERO {
        return Some(Span::Empty);
    }
    let f = minus(frame.point::<R>(ray.origin), frame.point(sphere.center));
    let d = frame.direction::<R>(ray.direction);
    let r = R::input(sphere.radius, frame.place);
    let (a, square, across) = (dot(d, d), r * r, cross(f, d));
    let disc = square * a - dot(across, across);
    if disc.sign()? < 0 {
        return Some(Span::Empty);
    }
    let (p, c) = (-dot(f, d), dot(f, f) - square);
    let [near, far] = [-1, 1].map(|sign| Some(Root { p, a, surd: Some(Surd { sign, disc, c }) }));
    Some(Span::Lerp([near, None, None], [far, None, None]))
}

/// Bits of the roots for coordinates of these bits.
pub(super) fn bits(place: u32, direction: u32) -> (RootBits, u32) {
    let root = RootBits { p: place + direction + 2, a: 2 * direction + 2, disc: 2 * (place + direction) + 5 };
    (root, root.disc.max(2 * place + 3))
}

/// Facts about both roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Roots {
    /// The sign of the discriminant: -1 for a miss, 0 for a touch, 1 for a hit; -1 for a sphere without size.
    pub discriminant: i32,
    /// Whether the smaller root lies in the open range of the ray.
    pub near_counts: bool,
    /// Whether the larger root lies in the open range of the ray.
    pub far_counts: bool,
}

/// The sign of the discriminant and which roots lie in the range. `None` for inputs that are not finite.
pub fn roots(ray: &Ray, sphere: &Sphere) -> Option<Roots> {
    let body = Body::Sphere(*sphere);
    if !is_finite(ray, &body) {
        return None;
    }
    super::decide(
        &Both { ray, sphere, first: super::Asked { ray, body, of: super::First } },
        super::Tier::Auto,
    )
}

struct Both<'a> {
    ray: &'a Ray,
    sphere: &'a Sphere,
    first: super::Asked<'a, super::First>,
}

impl Question for Both<'_> {
    type Answer = Roots;

    fn frame(&self, fine: bool) -> Frame {
        self.first.frame(fine)
    }

    fn bits(&self, frame: &Frame) -> u32 {
        self.first.bits(frame)
    }

    fn ask<R: Ring>(&self, frame: &Frame) -> Option<Roots> {
        let Span::Lerp([Some(near), ..], [Some(far), ..]) = span::<R>(self.ray, self.sphere, frame)? else {
            return Some(Roots { discriminant: -1, near_counts: false, far_counts: false });
        };
        let counts = |root| in_range(root, self.ray.t_min, self.ray.t_max, frame);
        let discriminant = near.surd.map_or(Some(0), |surd| surd.disc.sign())?;
        Some(Roots { discriminant, near_counts: counts(&near)?, far_counts: counts(&far)? })
    }
}
