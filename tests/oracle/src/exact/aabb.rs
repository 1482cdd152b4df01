//! Ray and box: slabs whose ends are compared by cross-multiplication.

use super::ring::{Ring, minus};
use super::root::{Root, RootBits, beyond};
use super::scale::{Frame, Scale};
use super::solid::Span;
use super::{Contact, Question, Tier, decide, is_ray_finite};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::shape::Cuboid;

/// Entries and exits of the three slabs. A line parallel to a slab is inside for all `t` or for none.
#[inline(always)]
pub(super) fn span<R: Ring>(ray: &Ray, cuboid: &Cuboid, frame: &Frame) -> Option<Span<R>> {
    let (min, max, o) = (cuboid.min, cuboid.max, ray.origin);
    if !min.cmple(max).all() || ray.direction == Vec3::ZERO {
        return Some(Span::Empty);
    }
    let (mut entries, mut exits) = ([None; 3], [None; 3]);
    let origin = frame.point::<R>(o);
    let low = minus(frame.point(min), origin);
    let high = minus(frame.point(max), origin);
    let d = frame.direction::<R>(ray.direction);
    for axis in 0..3 {
        let slope = ray.direction[axis];
        if slope == 0.0 {
            if o[axis] < min[axis] || o[axis] > max[axis] {
                return Some(Span::Empty);
            }
        } else if slope > 0.0 {
            entries[axis] = Some(Root { p: low[axis], a: d[axis], surd: None });
            exits[axis] = Some(Root { p: high[axis], a: d[axis], surd: None });
        } else {
            entries[axis] = Some(Root { p: -high[axis], a: -d[axis], surd: None });
            exits[axis] = Some(Root { p: -low[axis], a: -d[axis], surd: None });
        }
    }
    Some(Span::Lerp(entries, exits))
}

/// How the segment `t_min <= t <= t_max` of a ray meets a closed box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// `On` if they have common points, but two slabs, or a slab and an end of the segment, only touch.
    pub verdict: Contact,
    /// The least `|difference| / (2^-24 * sum of absolute values of its terms)` over the comparisons that decide, to
    /// `1e-6` absolute; infinite if no comparison is rounded.
    pub margin: f64,
}

/// How the closed segment of a ray meets a closed box. Flat boxes and points are boxes; an empty box is
/// missed. `None` for other inputs that are not finite; the ends of the segment may be infinite.
pub fn overlap(ray: &Ray, bounds: &Aabb) -> Option<Overlap> {
    let question = match ask(ray, bounds)? {
        Some(question) => question,
        None => return Some(Overlap { verdict: Contact::Out, margin: f64::INFINITY }),
    };
    Some(Overlap { verdict: decide(&question, Tier::Auto)?, margin: question.margin() })
}

/// The verdict alone, from one tier only.
pub fn verdict_with(tier: Tier, ray: &Ray, bounds: &Aabb) -> Option<Contact> {
    match ask(ray, bounds)? {
        Some(question) => decide(&question, tier),
        None => Some(Contact::Out),
    }
}

/// The verdict alone.
#[inline]
pub fn verdict(ray: &Ray, bounds: &Aabb) -> Option<Contact> {
    verdict_with(Tier::Auto, ray, bounds)
}

/// The question, or `Some(None)` if the box or the segment is empty, which is a miss.
#[inline(always)]
fn ask<'a>(ray: &'a Ray, bounds: &Aabb) -> Option<Option<Segment<'a>>> {
    let numbers = is_ray_finite(ray) && !bounds.min.is_nan() && !bounds.max.is_nan();
    if !numbers {
        return None;
    }
    if bounds.is_empty() || !(ray.t_min <= ray.t_max) {
        return Some(None);
    }
    (bounds.min.is_finite() && bounds.max.is_finite())
        .then_some(Some(Segment { ray, cuboid: Cuboid { min: bounds.min, max: bounds.max } }))
}

struct Segment<'a> {
    ray: &'a Ray,
    cuboid: Cuboid,
}

impl Segment<'_> {
    fn margin(&self) -> f64 {
        use super::ring::Estimate;
        let span = span::<Estimate>(self.ray, &self.cuboid, &Frame::UNSCALED);
        let Some(Span::Lerp(entries, exits)) = span else {
            return f64::INFINITY;
        };
        let mut least = f64::INFINITY;
        let mut see = |form: Estimate| {
            if form.size > 0.0 {
                least = least.min(form.value.abs() / form.size * 24f64.exp2());
            }
        };
        for (i, entry) in entries.iter().enumerate() {
            for (j, exit) in exits.iter().enumerate() {
                if let (Some(entry), Some(exit), true) = (entry, exit, i != j) {
                    see(exit.p * entry.a - entry.p * exit.a);
                }
            }
        }
        let ends = [(entries, self.ray.t_max), (exits, self.ray.t_min)];
        for (roots, end) in ends.into_iter().filter(|(_, end)| end.is_finite()) {
            for root in roots.iter().flatten() {
                let (t, _) = Estimate::fraction(f64::from(end), 0);
                see(root.p - root.a * t);
            }
        }
        least
    }
}

impl Question for Segment<'_> {
    type Answer = Contact;

    #[inline(always)]
    fn frame(&self, fine: bool) -> Frame {
        if !fine {
            return Frame::UNSCALED;
        }
        let places = [self.cuboid.min, self.cuboid.max, self.ray.origin].map(|p| p.to_array());
        Frame {
            place: Scale::fine(places.as_flattened().iter().copied()),
            direction: Scale::fine(self.ray.direction.to_array()),
            normal: Scale::NONE,
        }
    }

    fn bits(&self, frame: &Frame) -> u32 {
        let root = RootBits { p: frame.place.bits() + 1, a: frame.direction.bits(), disc: 0 };
        let ends = [self.ray.t_min, self.ray.t_max].into_iter().filter(|end| end.is_finite());
        let rational = |(n, d): (u32, u32)| (root.p + d).max(root.a + n) + 1;
        ends.map(|end| rational(frame.fraction_bits(f64::from(end))))
            .fold(root.bits_to_compare(root), u32::max)
    }

    #[inline(always)]
    fn ask<R: Ring>(&self, frame: &Frame) -> Option<Contact> {
        if self.ray.direction == Vec3::ZERO {
            // The segment is its origin, which is inside for each t of a segment that is not empty.
            let inside = Aabb::new(self.cuboid.min, self.cuboid.max).contains(self.ray.origin);
            return Some(if inside { Contact::In } else { Contact::Out });
        }
        let Span::Lerp(entries, exits) = span::<R>(self.ray, &self.cuboid, frame)? else {
            return Some(Contact::Out);
        };
        // The sign of "later than": 1 is a miss, 0 a touch. One miss decides, even if other comparisons are
        // undecided.
        let (mut undecided, mut touches) = (false, false);
        let mut misses = |order: Option<i32>| {
            undecided |= order.is_none();
            touches |= order == Some(0);
            order == Some(1)
        };
        for i in 0..3 {
            let (Some(entry), Some(exit)) = (&entries[i], &exits[i]) else {
                continue;
            };
            if misses(beyond(entry, self.ray.t_max, frame)) {
                return Some(Contact::Out);
            }
            if misses(beyond(exit, self.ray.t_min, frame).map(|sign| -sign)) {
                return Some(Contact::Out);
            }
            for j in (0..3).filter(|&j| j != i) {
                if let Some(other) = &exits[j]
                    && misses(entry.compare(other))
                {
                    return Some(Contact::Out);
                }
            }
        }
        if undecided {
            return None;
        }
        Some(if touches { Contact::On } else { Contact::In })
    }
}
