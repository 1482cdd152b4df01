//! Ray against closed cylinder and cone around any axis. The axis vector `w` is not of unit length, so everything is
//! multiplied by powers of `w·w`; positions count from the base of a cylinder and from the apex of a cone.

use super::ring::{Ring, cross, dot, minus};
use super::root::{Root, RootBits, Surd};
use super::scale::Frame;
use super::solid::Span;
use glam::Vec3;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cylinder};

/// The line between the planes `x·w = 0` and `x·w = w·w`: the two roots in order, or for a line along the planes
/// whether it runs between them.
enum Slab<R> {
    Lerp(Root<R>, Root<R>),
    Always,
    Never,
}

fn slab<R: Ring>(slope: R, height: R, full: R) -> Option<Slab<R>> {
    match slope.sign()? {
        0 if height.sign()? < 0 || (height - full).sign()? > 0 => Some(Slab::Never),
        0 => Some(Slab::Always),
        sign => {
            let (at_zero, at_full) = (Root::ratio(-height, slope)?, Root::ratio(full - height, slope)?);
            Some(if sign > 0 { Slab::Lerp(at_zero, at_full) } else { Slab::Lerp(at_full, at_zero) })
        }
    }
}

/// Joins the ends of the slab with those of the quadric.
fn joined<R>(slab: Slab<R>, entry: Option<Root<R>>, exit: Option<Root<R>>) -> Span<R> {
    match slab {
        Slab::Never => Span::Empty,
        Slab::Always => Span::Lerp([entry, None, None], [exit, None, None]),
        Slab::Lerp(low, high) => Span::Lerp([Some(low), entry, None], [Some(high), exit, None]),
    }
}

/// Inside is `|x × w|² <= r² |w|²` and `0 <= x·w <= w·w`. With `f = o - base` the first is `a t² - 2 p t + c <= 0`,
/// `a = |d × w|²`, `p = -(d × w)·(f × w)`, `c = |f × w|² - r² |w|²`, of degrees 4, 4 and 4, and
/// `p² - a c = |w|² (r² |d × w|² - (w·(d × f))²)`.
pub(super) fn cylinder<R: Ring>(ray: &Ray, cylinder: &Cylinder, frame: &Frame) -> Option<Span<R>> {
    if cylinder.radius <= 0.0 || cylinder.base == cylinder.top || ray.direction == Vec3::ZERO {
        return Some(Span::Empty);
    }
    let base = frame.point::<R>(cylinder.base);
    let (f, w) = (minus(frame.point(ray.origin), base), minus(frame.point(cylinder.top), base));
    let d = frame.direction::<R>(ray.direction);
    let r = R::input(cylinder.radius, frame.place);
    let (square, full) = (r * r, dot(w, w));
    let dw = cross(d, w);
    let a = dot(dw, dw);
    // Test the discriminant first, because most lines miss, and most of these miss the infinite surface.
    let apart = dot(w, cross(d, f));
    let disc = full * (square * a - apart * apart);
    let along_axis = a.sign()? == 0;
    if !along_axis && disc.sign()? < 0 {
        return Some(Span::Empty);
    }
    let slab = slab(dot(d, w), dot(f, w), full)?;
    let fw = cross(f, w);
    let c = dot(fw, fw) - square * full;
    if along_axis {
        // Inside for all t or for none.
        return Some(if c.sign()? > 0 { Span::Empty } else { joined(slab, None, None) });
    }
    let p = -dot(dw, fw);
    let [near, far] = [-1, 1].map(|sign| Some(Root { p, a, surd: Some(Surd { sign, disc, c }) }));
    Some(joined(slab, near, far))
}

/// Bits of the roots for coordinates of these bits, and of their comparison with the ends.
pub(super) fn cylinder_bits(place: u32, direction: u32) -> (RootBits, u32) {
    let (p, a) = (direction + 3 * place + 4, 2 * direction + 2 * place + 4);
    let side = RootBits { p, a, disc: 2 * direction + 6 * place + 10 };
    let end = RootBits { p: 2 * place + 3, a: direction + place + 2, disc: 0 };
    (side, side.bits_to_compare(end).max(end.bits_to_compare(end)).max(4 * place + 6))
}

/// Inside is `|w|² |x × w|² <= r² (x·w)²` and `0 <= x·w <= w·w` with `w = base - apex`; the slab cuts off the mirror
/// nappe. With `q = o - apex`, `s = d·w`, `g = q·w` the first is `A t² - 2 P t + C <= 0`,
/// `A = |w|² |d × w|² - r² s²`, `P = r² s g - |w|² (d × w)·(q × w)`, `C = |w|² |q × w|² - r² g²`, each of degree 6, and
/// `P² - A C = |w|⁴ (r² |w × n|² - |w|² (w·n)²)` with `n = d × q`.
pub(super) fn cone<R: Ring>(ray: &Ray, cone: &Cone, frame: &Frame) -> Option<Span<R>> {
    if cone.radius <= 0.0 || cone.base == cone.apex || ray.direction == Vec3::ZERO {
        return Some(Span::Empty);
    }
    let apex = frame.point::<R>(cone.apex);
    let (q, w) = (minus(frame.point(ray.origin), apex), minus(frame.point(cone.base), apex));
    let d = frame.direction::<R>(ray.direction);
    let r = R::input(cone.radius, frame.place);
    let (square, full) = (r * r, dot(w, w));
    let slope = dot(d, w);
    let dw = cross(d, w);
    let a = full * dot(dw, dw) - square * slope * slope;
    // As for the cylinder, test first whether the line misses both nappes.
    let n = cross(d, q);
    let (across, apart) = (cross(w, n), dot(w, n));
    let disc = full * full * (square * dot(across, across) - full * apart * apart);
    let a_sign = a.sign()?;
    if a_sign != 0 && disc.sign()? < 0 {
        return Some(Span::Empty);
    }
    let height = dot(q, w);
    let slab = slab(slope, height, full)?;
    let qw = cross(q, w);
    let p = square * slope * height - full * dot(dw, qw);
    let c = full * dot(qw, qw) - square * height * height;
    if a_sign == 0 {
        // Along a generator the quadratic term is 0: -2 p t + c <= 0.
        return Some(match p.sign()? {
            0 if c.sign()? > 0 => Span::Empty,
            0 => joined(slab, None, None),
            sign => {
                let crossing = Some(Root::ratio(c, p + p)?);
                if sign > 0 { joined(slab, crossing, None) } else { joined(slab, None, crossing) }
            }
        });
    }
    if a_sign > 0 {
        let [near, far] = [-1, 1].map(|sign| Some(Root { p, a, surd: Some(Surd { sign, disc, c }) }));
        return Some(joined(slab, near, far));
    }
    // Steeper than the surface: inside beyond either root, once for each nappe. The line comes to this nappe at the
    // end where x·w grows.
    let beyond = |sign| Some(Root { p: -p, a: -a, surd: Some(Surd { sign, disc, c: -c }) });
    Some(if slope.sign()? > 0 { joined(slab, beyond(1), None) } else { joined(slab, None, beyond(-1)) })
}

/// Bits of the roots for coordinates of these bits, and of their comparison with the ends.
pub(super) fn cone_bits(place: u32, direction: u32) -> (RootBits, u32) {
    let (p, a) = (direction + 5 * place + 8, 2 * direction + 4 * place + 7);
    let side = RootBits { p, a, disc: 2 * direction + 10 * place + 14 };
    let end = RootBits { p: 2 * place + 3, a: direction + place + 2, disc: 0 };
    (side, side.bits_to_compare(end).max(end.bits_to_compare(end)).max(6 * place + 7))
}
