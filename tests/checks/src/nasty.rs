//! Random inputs that break code that only works for ordinary ones. Each generator mixes ordinary inputs with special ones:
//! parallel to an axis (with zeros of either sign), diagonal, almost parallel to an axis or to a surface, very large, very
//! small, different on each axis, and exactly equal. All of them shrink to the simplest kind.
//!
//! A check that draws its inputs here sees a function with every orientation of a frame, and cannot pass by a special case:
//! that shading normal and geometric normal are equal, that errors are the same on all axes, or that a coordinate is not 0.

use crate::double::U;
use crate::generate;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use raykata::kit::Surface;
use std::ops::RangeInclusive;

/// 1 or -1.
pub fn sign() -> impl Strategy<Value = f32> + Clone {
    any::<bool>().prop_map(|negative| if negative { -1.0 } else { 1.0 })
}

/// A power of two with an exponent in this range. A product with it is exact unless it overflows or underflows, so a formula
/// without fixed constants gives the same digits at each scale.
pub fn scale(exponents: RangeInclusive<i32>) -> impl Strategy<Value = f32> + Clone {
    // Draw the distance from exponent 0, so that exponents shrink to 0. A small scale shrinks to no large one.
    let (low, high) = exponents.into_inner();
    (0..=high.max(-low), any::<bool>().no_shrink())
        .prop_map(move |(size, down)| 2f32.powi(if down { -size } else { size }.clamp(low, high)))
}

/// A scale that is 1 half of the time, and otherwise a power of two between 2⁻⁶⁰ and 2⁶⁰, whose square is still a normal
/// number.
pub fn any_scale() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![2 => Just(1.0f32), 1 => scale(-16..=16), 1 => scale(-60..=60)]
}

/// The direction with 1/8 in place of 0: rays along an axis and within a face belong to checks of their own.
pub fn slanted(direction: Vec3) -> Vec3 {
    Vec3::select(direction.cmpeq(Vec3::ZERO), Vec3::splat(0.125), direction)
}

/// A unit vector: parallel to an axis, with zeros of either sign (1 of 8); diagonal (1 of 8); at an angle between 1 and 10⁻⁶
/// to an axis (1 of 8); on a coarse grid (3 of 8); with full mantissas (2 of 8).
pub fn unit() -> impl Strategy<Value = Vec3> + Clone {
    let signs = || generate::vector(sign());
    let parallel = (0..3usize, signs()).prop_map(|(axis, signs)| AXES[axis] * signs);
    let diagonal = (0..4usize, signs()).prop_map(|(axis, signs)| {
        let diagonal = Vec3::ONE - AXES.get(axis).copied().unwrap_or_default();
        rounded(signs.as_dvec3() * diagonal.as_dvec3())
    });
    let slanted =
        (0..3usize, signs(), generate::point(1), 0..=20i32).prop_map(|(axis, signs, lean, halvings)| {
            let small = 0.25 * lean * 2f32.powi(-halvings);
            rounded((AXES[axis] * signs).as_dvec3() + small.as_dvec3())
        });
    let rough = generate::rough_point(1.0)
        .prop_map(|v| if v == Vec3::ZERO { Vec3::X } else { rounded(v.as_dvec3()) });
    prop_oneof![1 => parallel, 1 => diagonal, 1 => slanted, 3 => generate::unit(), 2 => rough]
}

const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// The unit vector in the direction of `v`, each coordinate rounded once.
fn rounded(v: DVec3) -> Vec3 {
    v.normalize().as_vec3()
}

/// A fixed list of unit vectors of all kinds, for checks that go through a list: along each axis in both directions, with
/// zeros of either sign; almost parallel to an axis; diagonal; and in between.
pub fn directions() -> Vec<Vec3> {
    let mut all = Vec::new();
    for axis in AXES {
        for sign in [1.0, -1.0] {
            all.extend([
                sign * axis,
                axis * Vec3::splat(sign) + Vec3::ZERO,
                rounded(f64::from(sign) * axis.as_dvec3() + DVec3::new(1e-4, -2e-4, 1e-4)),
                rounded(f64::from(sign) * axis.as_dvec3() + DVec3::new(0.05, 0.04, -0.03)),
            ]);
        }
    }
    let slanted = [(1.0, 1.0, 1.0), (-1.0, 1.0, 1.0), (1.0, 0.0, -1.0), (0.0, -1.0, -1.0)];
    let others = [(0.3, 0.8, -0.5), (-0.7, 0.2, 0.6), (0.1, -0.9, 0.3), (0.48, 0.6, -0.64)];
    all.extend(slanted.into_iter().chain(others).map(|(x, y, z)| rounded(DVec3::new(x, y, z))));
    all
}

/// The coordinates of a point of a small integer lattice, in `-reach..=reach`. Sums and products of a few of them are exact,
/// so points often lie exactly on a line, in a plane or on a bound.
pub fn lattice(reach: i32) -> impl Strategy<Value = Vec3> + Clone {
    generate::vector(generate::fractions(-reach..=reach, 1.0))
}

/// A point that is not the origin: on a lattice or with full mantissas, at any scale, and often with a coordinate that is 0
/// or far smaller than the others.
pub fn point() -> impl Strategy<Value = Vec3> + Clone {
    let ordinary = prop_oneof![lattice(4), generate::rough_point(4.0)];
    let shrunk = prop_oneof![3 => Just(1.0f32), 1 => Just(0.0f32), 1 => scale(-20..=0)];
    (ordinary, 0..3usize, shrunk, any_scale()).prop_map(|(point, axis, factor, scale)| {
        let mut point = point;
        point[axis] *= factor;
        scale * if point == Vec3::ZERO { Vec3::ONE } else { point }
    })
}

/// A unit vector at an angle to the unit vector `axis`, turned around it by the fraction `turn` of a full turn.
pub fn tilted(axis: Vec3, angle: f64, turn: f64) -> Vec3 {
    let axis = axis.as_dvec3().normalize();
    let (x, y) = axis.any_orthonormal_pair();
    let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
    rounded(angle.cos() * axis + angle.sin() * (cos * x + sin * y))
}

/// An angle in `0..π/2` and a fraction of a turn, for [`tilted`]. A quarter of the angles are within 0.3 of a right angle,
/// down to 0.001 (grazing).
pub fn tilt() -> impl Strategy<Value = (f64, f64)> + Clone {
    let angle = prop_oneof![
        1 => Just(0.0f64),
        2 => (1..=12i32).prop_map(|n| f64::from(n) / 10.0),
        1 => (0..=8i32).prop_map(|halvings| std::f64::consts::FRAC_PI_2 - (0.3 * 0.5f64.powi(halvings)).max(1e-3)),
    ];
    (angle, 0..=15i32).prop_map(|(angle, turn)| (angle, f64::from(turn) / 16.0 + 0.01))
}

/// A geometric and a shading normal, of unit length, at an angle below 1. They are equal in one of eight pairs.
pub fn normals() -> impl Strategy<Value = (Vec3, Vec3)> + Clone {
    (unit(), 0..8i32, 0..=15i32).prop_map(|(geometric, eighths, turn)| match eighths {
        0 => (geometric, geometric),
        _ => (geometric, tilted(geometric, f64::from(eighths) / 8.0, f64::from(turn) / 16.0 + 0.01)),
    })
}

/// A bound on the rounding error of `point` along each axis, as intersection functions compute it: at least one rounding of
/// the coordinate, at most a thousand, different on each axis. The error of a coordinate that is 0 may be 0.
pub fn error(point: Vec3, roundings: [i32; 3]) -> Vec3 {
    let of_axis = |axis: usize| U as f32 * point[axis].abs() * roundings[axis] as f32;
    Vec3::new(of_axis(0), of_axis(1), of_axis(2))
}

/// Numbers of roundings for [`error`].
pub fn roundings() -> impl Strategy<Value = [i32; 3]> + Clone {
    let of_axis = || prop::sample::select(vec![1, 2, 7, 30, 200, 1000]);
    (of_axis(), of_axis(), of_axis()).prop_map(|(x, y, z)| [x, y, z])
}

/// A point of a surface with different normals and an error that differs per axis, at any scale.
pub fn surface() -> impl Strategy<Value = Surface> + Clone {
    (point(), roundings(), normals()).prop_map(|(point, roundings, (geometric_normal, shading_normal))| {
        Surface { point, error: error(point, roundings), geometric_normal, shading_normal }
    })
}

/// Open ranges of a ray around a hit at `t > 0`, each with whether the hit counts: a range that ends exactly at `t` or one
/// float before or after it, and the same for the beginning.
pub fn ranges(t: f32) -> [((f32, f32), bool); 6] {
    [
        ((0.0, t), false),
        ((0.0, t.next_down()), false),
        ((0.0, t.next_up()), true),
        ((t, f32::INFINITY), false),
        ((t.next_up(), f32::INFINITY), false),
        ((t.next_down(), f32::INFINITY), true),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;

    fn draw<S: Strategy>(inputs: S) -> Vec<S::Value> {
        let mut runner = TestRunner::deterministic();
        (0..4000).map(|_| inputs.new_tree(&mut runner).expect("an input").current()).collect()
    }

    #[test]
    fn unit_vectors_have_unit_length_and_are_of_all_kinds() {
        let units = draw(unit());
        assert!(units.iter().all(|v| (v.as_dvec3().length() - 1.0).abs() < 4.0 * U));
        for axis in AXES {
            assert!(units.contains(&axis) && units.contains(&-axis));
            let slanted = |v: &&Vec3| (1e-6..1e-4).contains(&v.cross(axis).length());
            assert!(units.iter().filter(slanted).count() > 4);
        }
        assert!(units.iter().any(|v| v.x == 0.0 && v.x.is_sign_negative()));
    }

    #[test]
    fn surfaces_are_not_special() {
        let surfaces = draw(surface());
        let share = |of: &dyn Fn(&Surface) -> bool| {
            surfaces.iter().filter(|surface| of(surface)).count() * 100 / surfaces.len()
        };
        let large = |s: &Surface| s.point.abs().max_element() > 1e12;
        let small = |s: &Surface| s.point.abs().max_element() < 1e-12;
        let shares = [
            share(&|s| s.geometric_normal != s.shading_normal),
            share(&|s| s.error.max_element() > 4.0 * s.error.min_element()),
            share(&large),
            share(&small),
        ];
        assert!(shares.iter().zip([80, 70, 2, 2]).all(|(share, least)| *share >= least), "{shares:?}");
        assert!(
            surfaces.iter().all(|s| s.geometric_normal.dot(s.shading_normal) > 0.6 && s.point != Vec3::ZERO)
        );
        assert!(surfaces.iter().all(|s| s.point.is_finite() && s.error.is_finite()));
    }

    #[test]
    fn tilted_vectors_are_at_their_angle() {
        for (axis, (angle, turn)) in draw((unit(), tilt())) {
            let found = tilted(axis, angle, turn).as_dvec3().dot(axis.as_dvec3());
            assert!((found - angle.cos()).abs() < 4.0 * U, "{axis} {angle}");
            assert!(found > 0.0 && angle < std::f64::consts::FRAC_PI_2);
        }
    }

    #[test]
    fn ranges_count_what_a_ray_counts() {
        for t in [1.0f32, 0.1, 3e20] {
            for ((t_min, t_max), counts) in ranges(t) {
                let ray = raykata::ray::Ray::new(Vec3::ZERO, Vec3::X).with_range(t_min, t_max);
                assert_eq!(ray.contains(t), counts);
            }
        }
    }
}
