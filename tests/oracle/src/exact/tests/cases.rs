//! Inputs with hard exact answers: rays at edges and corners, shapes on lattices, slivers, far, tiny, with
//! any exponent.

use super::Random;
use glam::{Vec3, vec3};
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Plane, Sphere, Triangle};

/// Draws numbers of a style.
trait Styled {
    fn vector(&mut self, style: Style) -> Vec3;
    fn number(&mut self, style: Style) -> f32;
}

impl Styled for Random {
    fn vector(&mut self, style: Style) -> Vec3 {
        vec3(self.number(style), self.number(style), self.number(style))
    }

    fn number(&mut self, style: Style) -> f32 {
        match style {
            Style::Unit => self.signed(),
            Style::Lattice => self.below(17) as f32 - 8.0,
            Style::Fine => self.below(2_000_001) as f32 - 1e6,
            Style::Far => 148_376.0 + self.signed(),
            Style::Tiny => 1.0 + 1e-6 * self.signed(),
            Style::Scales => self.signed() * (self.below(200) as f32 - 100.0).exp2(),
            Style::Any => match self.below(8) {
                0 => 0.0,
                1 => -0.0,
                2 => f32::MAX,
                3 => f32::from_bits(self.below(8) as u32),
                _ => loop {
                    let x = f32::from_bits(self.bits() as u32);
                    if x.is_finite() {
                        break x;
                    }
                },
            },
        }
    }
}

/// The size of random numbers, and how many bits they have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Style {
    /// In `-1..1`.
    Unit,
    /// Whole numbers, which give many exact ties.
    Lattice,
    /// Whole numbers up to a million, whose ties have more bits.
    Fine,
    /// Of size one, far from the origin.
    Far,
    /// A few ulps around one.
    Tiny,
    /// From `2^-100` to `2^100`.
    Scales,
    /// Any finite number, denormals, zeros and the largest included.
    Any,
}

/// A ray and one shape of every kind.
#[derive(Clone, Copy, Debug)]
pub struct ComparedCase {
    pub ray: Ray,
    pub triangle: Triangle,
    pub plane: Plane,
    pub disk: Disk,
    pub sphere: Sphere,
    pub cuboid: Cuboid,
    pub cylinder: Cylinder,
    pub cone: Cone,
}

/// A case of any kind.
pub fn any(seed: u64, case: u64) -> ComparedCase {
    let mut random = Random::new(seed, case);
    let styles =
        [Style::Unit, Style::Lattice, Style::Far, Style::Tiny, Style::Scales, Style::Any, Style::Fine];
    let style = styles[random.below(7) as usize];
    let aim = random.below(8);
    make(&mut random, style, aim)
}

fn make(random: &mut Random, style: Style, aim: u64) -> ComparedCase {
    let mut p = || random.vector(style);
    let (o, a, b, mut c, q) = (p(), p(), p(), p(), p());
    let clamp = |v: Vec3| v.clamp(Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX));
    match random.below(12) {
        0 => c = clamp(a.lerp(b, random.unit()) + 1e-5 * random.vector(style)), // a sliver
        1 => c = clamp(b + 1e-3 * (b - a).any_orthogonal_vector().normalize_or_zero()), // a needle
        2 => c = [a, b][random.below(2) as usize],
        _ => {}
    }
    let size = match style {
        Style::Far => 1.0,
        Style::Tiny => 1e-6,
        _ => random.number(style).abs(),
    };
    let radius = if random.below(20) == 0 { -size } else { size };
    let l = random.unit();
    let target = match aim {
        1 | 2 => a.lerp(b, l),
        3 => [a, b, c][random.below(3) as usize],
        4 => a + radius * (b - a).any_orthogonal_vector().normalize_or_zero(), // the rim, or a tangent point
        5 => a.lerp(b, l).lerp(c, random.unit()),
        _ => q,
    };
    let mut direction = clamp(if aim == 0 { q - o } else { target - o });
    if !direction.is_finite() {
        direction = q;
    }
    if aim == 6 || aim == 7 {
        direction = random.vector(style);
        for axis in 0..3 {
            if random.below(2) == 0 {
                direction[axis] = if random.below(2) == 0 { 0.0 } else { -0.0 };
            }
        }
    }
    // Sometimes start in a plane of the box, or on the far side of the shape.
    let mut o = o;
    match random.below(10) {
        0 => o.x = a.x.min(b.x),
        1 => o = a,
        2 => direction = -direction,
        _ => {}
    }
    let mut ray = Ray::new(o, direction);
    match random.below(8) {
        0 => ray = ray.with_range(random.number(style), random.number(style).abs()),
        1 => ray = ray.with_range(f32::NEG_INFINITY, 1.0),
        2 => ray = ray.with_range(-1.0, f32::MAX),
        3 => ray = ray.with_range(1e-4, 1e30),
        _ => {}
    }
    let finite = |v: Vec3| if v.is_finite() { v } else { q };
    let mut case = shapes(ray, [a, b, finite(c)], q, radius);
    let Cuboid { min, max } = &mut case.cuboid;
    if random.below(6) == 0 {
        min.z = max.z;
    }
    if random.below(30) == 0 {
        std::mem::swap(min, max);
    }
    case
}

/// One shape of every kind from a few points.
fn shapes(ray: Ray, [a, b, c]: [Vec3; 3], q: Vec3, radius: f32) -> ComparedCase {
    let finite = |v: Vec3| if v.is_finite() { v } else { q };
    ComparedCase {
        ray,
        triangle: Triangle { a, b, c },
        plane: Plane { point: a, normal: finite(b - c) },
        disk: Disk { center: a, normal: finite(b - a), radius },
        sphere: Sphere { center: a, radius },
        cuboid: Cuboid { min: a.min(b), max: a.max(b) },
        cylinder: Cylinder { base: a, top: b, radius },
        cone: Cone { base: a, apex: b, radius },
    }
}
