//! The shapes that the oracle knows, and the questions about them.

use super::ring::{Ring, Vector, dot, minus};
use super::root::{Root, RootBits, Rounded, in_range};
use super::scale::{Frame, Scale};
use super::{Contact, Question, aabb, quadric, solid, sphere, triangle};
use glam::Vec3;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Plane, Sphere, Triangle};
use std::cmp::Ordering;

/// A shape whose first hit can be computed exactly. A solid is hit where the ray enters or leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // the names are those of `raykata::shape`
pub enum Body {
    Triangle(Triangle),
    Plane(Plane),
    Disk(Disk),
    Sphere(Sphere),
    Cuboid(Cuboid),
    Cylinder(Cylinder),
    Cone(Cone),
}

/// The first root in the range of the ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit<R> {
    pub root: Root<R>,
    /// Whether the ray only touches.
    pub touches: bool,
}

impl<R> Hit<R> {
    fn verdict(&self) -> Contact {
        if self.touches { Contact::On } else { Contact::In }
    }
}

impl Body {
    /// Whether every number of the shape is finite.
    #[inline(always)]
    pub(super) fn is_finite(&self) -> bool {
        match self {
            Body::Triangle(t) => t.a.is_finite() && t.b.is_finite() && t.c.is_finite(),
            Body::Plane(p) => p.point.is_finite() && p.normal.is_finite(),
            Body::Disk(d) => d.center.is_finite() && d.normal.is_finite() && d.radius.is_finite(),
            Body::Sphere(s) => s.center.is_finite() && s.radius.is_finite(),
            Body::Cuboid(c) => c.min.is_finite() && c.max.is_finite(),
            Body::Cylinder(c) => c.base.is_finite() && c.top.is_finite() && c.radius.is_finite(),
            Body::Cone(c) => c.base.is_finite() && c.apex.is_finite() && c.radius.is_finite(),
        }
    }

    /// Points, a length (or 0), and a normal (or 0).
    fn groups(&self) -> ([Vec3; 3], f32, Vec3) {
        match *self {
            Body::Triangle(t) => ([t.a, t.b, t.c], 0.0, Vec3::ZERO),
            Body::Plane(p) => ([p.point; 3], 0.0, p.normal),
            Body::Disk(d) => ([d.center; 3], d.radius, d.normal),
            Body::Sphere(s) => ([s.center; 3], s.radius, Vec3::ZERO),
            Body::Cuboid(c) => ([c.min, c.max, c.max], 0.0, Vec3::ZERO),
            Body::Cylinder(c) => ([c.base, c.top, c.top], c.radius, Vec3::ZERO),
            Body::Cone(c) => ([c.base, c.apex, c.apex], c.radius, Vec3::ZERO),
        }
    }

    /// The frame of a question about this shape alone.
    #[inline(always)]
    pub(super) fn frame(&self, ray: &Ray, fine: bool) -> Frame {
        // The polynomials of a triangle have degree three, so they neither overflow nor underflow in doubles.
        if !fine && matches!(self, Body::Triangle(_)) {
            return Frame::UNSCALED;
        }
        if let Body::Triangle(t) = self {
            let places = [t.a, t.b, t.c, ray.origin].map(|p| p.to_array());
            let place = Scale::fine(places.as_flattened().iter().copied());
            return Frame { place, direction: Scale::fine(ray.direction.to_array()), normal: Scale::NONE };
        }
        joint_frame(ray, self, self, fine)
    }

    /// Bits of the largest root, and of all other integers that are computed for it.
    fn bits(&self, frame: &Frame) -> (RootBits, u32) {
        let (place, direction, normal) =
            (frame.place.bits() + 1, frame.direction.bits(), frame.normal.bits());
        match self {
            Body::Triangle(_) => triangle::bits(place, direction),
            Body::Plane(_) | Body::Disk(_) => {
                let ratio = RootBits { p: place + normal + 2, a: direction + normal + 2, disc: 0 };
                // The rim: |a f + p d|² against r² a².
                (ratio, 2 * (place + direction + normal + 3) + 3)
            }
            Body::Sphere(_) => sphere::bits(place, direction),
            Body::Cuboid(_) => {
                let ratio = RootBits { p: place, a: direction, disc: 0 };
                (ratio, ratio.bits_to_compare(ratio))
            }
            Body::Cylinder(_) => quadric::cylinder_bits(place, direction),
            Body::Cone(_) => quadric::cone_bits(place, direction),
        }
    }

    /// Bits that the first hit takes, its comparison with both ends of the range included.
    fn first_bits(&self, ray: &Ray, frame: &Frame) -> (RootBits, u32) {
        let (root, mut most) = self.bits(frame);
        for end in [ray.t_min, ray.t_max] {
            if end.is_finite() {
                most = most.max(root.against(frame.fraction_bits(f64::from(end))));
            }
        }
        (root, most)
    }

    /// The first hit in the range of the ray.
    #[inline(always)]
    pub(super) fn first<R: Ring>(&self, ray: &Ray, frame: &Frame) -> Option<Option<Hit<R>>> {
        match self {
            Body::Triangle(t) => triangle::first(ray, t, frame),
            Body::Plane(p) => flat(ray, p, None, frame),
            Body::Disk(d) => flat(ray, &Plane { point: d.center, normal: d.normal }, Some(d.radius), frame),
            Body::Sphere(s) => solid::first(sphere::span(ray, s, frame)?, ray, frame),
            Body::Cuboid(c) => solid::first(aabb::span(ray, c, frame)?, ray, frame),
            Body::Cylinder(c) => solid::first(quadric::cylinder(ray, c, frame)?, ray, frame),
            Body::Cone(c) => solid::first(quadric::cone(ray, c, frame)?, ray, frame),
        }
    }
}

/// One frame for two shapes, so that their `t` have the same unit.
fn joint_frame(ray: &Ray, one: &Body, other: &Body, fine: bool) -> Frame {
    let scale = |numbers: &[f32]| {
        let numbers = numbers.iter().copied();
        if fine { Scale::fine(numbers) } else { Scale::rough(numbers) }
    };
    let ((p, r, n), (p2, r2, n2)) = (one.groups(), other.groups());
    let mut places = [0.0; 23];
    for (slot, point) in places.chunks_exact_mut(3).zip([ray.origin].iter().chain(&p).chain(&p2)) {
        slot.copy_from_slice(&point.to_array());
    }
    places[21..].copy_from_slice(&[r, r2]);
    let normals = [n.to_array(), n2.to_array()];
    Frame {
        place: scale(&places),
        direction: scale(&ray.direction.to_array()),
        normal: scale(normals.as_flattened()),
    }
}

/// A plane, or the part of it within `radius` of its point.
fn flat<R: Ring>(ray: &Ray, plane: &Plane, radius: Option<f32>, frame: &Frame) -> Option<Option<Hit<R>>> {
    let f = minus(frame.point::<R>(ray.origin), frame.point(plane.point));
    let d: Vector<R> = frame.direction(ray.direction);
    let n = plane.normal.to_array().map(|x| R::input(x, frame.normal));
    let slope = dot(d, n);
    if plane.normal == Vec3::ZERO || ray.direction == Vec3::ZERO || radius.is_some_and(|r| r <= 0.0) {
        return Some(None);
    }
    if slope.sign()? == 0 {
        return Some(None);
    }
    let root = Root::ratio(-dot(f, n), slope)?;
    if !in_range(&root, ray.t_min, ray.t_max, frame)? {
        return Some(None);
    }
    let Some(radius) = radius else {
        return Some(Some(Hit { root, touches: false }));
    };
    let offset = [0, 1, 2].map(|i| root.a * f[i] + root.p * d[i]);
    let reach = root.a * R::input(radius, frame.place);
    let outside = (dot(offset, offset) - reach * reach).sign()?;
    Some((outside <= 0).then_some(Hit { root, touches: outside == 0 }))
}

/// A question about the first hit of a ray.
pub(super) struct Asked<'a, A> {
    pub ray: &'a Ray,
    pub body: Body,
    pub of: A,
}

/// What a question asks of the first hit.
pub(super) trait OfFirst {
    type Answer;

    /// The bits that the answer takes, from those of the root and those that the hit takes.
    fn bits(&self, _: &Frame, (_, most): (RootBits, u32)) -> u32 {
        most
    }

    fn of<R: Ring>(&self, hit: Option<Hit<R>>, frame: &Frame) -> Option<Self::Answer>;
}

impl<A: OfFirst> Question for Asked<'_, A> {
    type Answer = A::Answer;

    #[inline(always)]
    fn frame(&self, fine: bool) -> Frame {
        self.body.frame(self.ray, fine)
    }

    fn bits(&self, frame: &Frame) -> u32 {
        self.of.bits(frame, self.body.first_bits(self.ray, frame))
    }

    #[inline(always)]
    fn ask<R: Ring>(&self, frame: &Frame) -> Option<A::Answer> {
        self.of.of(self.body.first::<R>(self.ray, frame)?, frame)
    }
}

/// Asks for the verdict only.
pub(super) struct First;

impl OfFirst for First {
    type Answer = Contact;

    fn of<R: Ring>(&self, hit: Option<Hit<R>>, _: &Frame) -> Option<Contact> {
        Some(hit.map_or(Contact::Out, |hit| hit.verdict()))
    }
}

/// Asks for verdict and `t`.
pub(super) struct Meet;

impl OfFirst for Meet {
    type Answer = Option<(Contact, Rounded)>;

    fn of<R: Ring>(&self, hit: Option<Hit<R>>, frame: &Frame) -> Option<Self::Answer> {
        let Some(hit) = hit else { return Some(None) };
        Some(Some((hit.verdict(), Rounded::new(hit.root.approx()?, frame.unit::<R>())?)))
    }
}

/// Asks for the first `t` as a double.
pub(super) struct InDouble;

impl OfFirst for InDouble {
    type Answer = Option<f64>;

    fn of<R: Ring>(&self, hit: Option<Hit<R>>, frame: &Frame) -> Option<Option<f64>> {
        let Some(hit) = hit else { return Some(None) };
        let t = hit.root.approx()?;
        (t.error < 1e-13).then_some(Some(t.value(frame.unit::<R>())))
    }
}

/// Compares the first `t` of a ray that hits with a number.
pub(super) struct Against(pub f64);

impl OfFirst for Against {
    type Answer = Ordering;

    fn bits(&self, frame: &Frame, (root, most): (RootBits, u32)) -> u32 {
        most.max(root.against(frame.fraction_bits(self.0)))
    }

    fn of<R: Ring>(&self, hit: Option<Hit<R>>, frame: &Frame) -> Option<Ordering> {
        Some(hit?.root.compare_to(R::fraction(self.0, frame.unit::<R>()))?.cmp(&0))
    }
}

/// Asks which of two shapes is hit first; `None` if one is missed.
pub(super) struct Order<'a> {
    pub ray: &'a Ray,
    pub one: Body,
    pub other: Body,
}

impl Question for Order<'_> {
    type Answer = Option<Ordering>;

    fn frame(&self, fine: bool) -> Frame {
        joint_frame(self.ray, &self.one, &self.other, fine)
    }

    fn bits(&self, frame: &Frame) -> u32 {
        let (one, most) = self.one.first_bits(self.ray, frame);
        let (other, most_other) = self.other.first_bits(self.ray, frame);
        most.max(most_other).max(one.bits_to_compare(other))
    }

    fn ask<R: Ring>(&self, frame: &Frame) -> Option<Self::Answer> {
        let (Some(one), Some(other)) =
            (self.one.first::<R>(self.ray, frame)?, self.other.first::<R>(self.ray, frame)?)
        else {
            return Some(None);
        };
        Some(Some(one.root.compare(&other.root)?.cmp(&0)))
    }
}
