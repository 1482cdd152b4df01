//! Hidden inputs for checks whose inputs are fixed: the same scene, turned about the axes by right angles and scaled by a
//! power of two. The list of a stage marks such a check with `: turned`, or with `: mirrored` if its law names the axes.
//!
//! Both change only signs, exponents and the order of coordinates, so no number is rounded. The check judges the answers
//! after they are turned back, and stays a law about the scene that it describes.
//!
//! `cells` (partitions of space) · `requests` (the requests that are turned)

mod cells;
mod requests;

pub(crate) use requests::TurnedKit;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::ray::Ray;

/// A rotation that maps axes to axes, followed by a scale.
///
/// Directions are not scaled. So a direction keeps its length, and every `t` is scaled as lengths are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetry {
    /// Coordinate `i` of the result is `signs[i]` times coordinate `axes[i]`.
    axes: [usize; 3],
    signs: [f32; 3],
    scale: f32,
}

/// The symmetries from which the hidden inputs of a check are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Symmetries {
    /// None: the check itself draws inputs, or its inputs are fixed.
    None,
    /// The 23 rotations of a cube that are not the identity, with a scale.
    Turned,
    /// Each axis is mapped to itself, at least one of them in the other direction, with a scale.
    Mirrored,
    /// None if the check draws a scene, whose expected text or picture comes from the reference; as `Turned` if there is no
    /// reference to ask.
    Composed,
}

impl Symmetries {
    /// Whether hidden inputs are the public ones in another frame.
    pub fn turn_public_inputs(self) -> bool {
        matches!(self, Symmetries::Turned | Symmetries::Mirrored)
    }

    /// Each symmetry exchanges or reverses an axis, because directions are not scaled.
    ///
    /// The scale is between 2⁻³ and 2³ and not 1. A larger scale would fail a solution with a fixed tolerance in all checks
    /// and not only in those about tolerances.
    pub(crate) fn strategy(self) -> impl Strategy<Value = Symmetry> + Clone {
        let scale = prop::sample::select(vec![0.125f32, 0.25, 0.5, 2.0, 4.0, 8.0]);
        let all = (0..3usize, any::<bool>(), any::<[bool; 3]>(), scale).prop_map(
            move |(first, swapped, negative, scale)| {
                let [x, y, z] = negative.map(|negative| if negative { -1.0 } else { 1.0 });
                let next = if swapped { first + 2 } else { first + 1 };
                match self {
                    Symmetries::None => Symmetry::IDENTITY,
                    // The third sign makes the determinant 1. An exchange of two axes has the determinant -1.
                    Symmetries::Turned | Symmetries::Composed => Symmetry {
                        axes: [first, next % 3, (2 * next - first) % 3],
                        signs: [x, y, if swapped { -x * y } else { x * y }],
                        scale,
                    },
                    Symmetries::Mirrored => Symmetry { signs: [x, y, z], scale, ..Symmetry::IDENTITY },
                }
            },
        );
        all.prop_filter("some axis changes", move |symmetry| {
            let Symmetry { axes, signs, .. } = Symmetry::IDENTITY;
            self == Symmetries::None || (symmetry.axes, symmetry.signs) != (axes, signs)
        })
    }
}

impl Symmetry {
    /// The symmetry that changes nothing.
    pub const IDENTITY: Symmetry = Symmetry { axes: [0, 1, 2], signs: [1.0; 3], scale: 1.0 };

    /// The symmetry that undoes this one.
    pub(crate) fn inverse(&self) -> Symmetry {
        let mut inverse = Symmetry { scale: self.scale.recip(), ..*self };
        for (axis, &from) in self.axes.iter().enumerate() {
            (inverse.axes[from], inverse.signs[from]) = (axis, self.signs[axis]);
        }
        inverse
    }

    /// The axis to which `axis` is mapped.
    fn axis(&self, axis: usize) -> usize {
        self.inverse().axes[axis]
    }

    /// A vector that is turned and not scaled: a direction or a normal. Zeros keep their sign, because only some checks
    /// are about the sign of a zero.
    pub fn direction(&self, v: Vec3) -> Vec3 {
        let coordinate = |from: f32, sign: f32| if from == 0.0 { from } else { sign * from };
        Vec3::from_array([0, 1, 2].map(|i| coordinate(v[self.axes[i]], self.signs[i])))
    }

    /// A direction in double precision.
    fn wide_direction(&self, v: DVec3) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|i| f64::from(self.signs[i]) * v[self.axes[i]]))
    }

    /// A point.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.scale * self.direction(p)
    }

    /// A length, or the `t` of a ray.
    pub fn length(&self, length: f32) -> f32 {
        self.scale * length
    }

    /// A ray, whose range is scaled.
    pub fn ray(&self, ray: &Ray) -> Ray {
        let (origin, direction) = (self.point(ray.origin), self.direction(ray.direction));
        let (t_min, t_max) = (self.length(ray.t_min), self.length(ray.t_max));
        Ray { origin, direction, t_min, t_max, ..*ray }
    }

    /// A box. The empty box remains empty.
    pub fn bounds(&self, bounds: &Aabb) -> Aabb {
        let (mut min, mut max) = (self.point(bounds.min), self.point(bounds.max));
        for axis in (0..3).filter(|&axis| self.signs[axis] < 0.0) {
            (min[axis], max[axis]) = (max[axis], min[axis]);
        }
        Aabb::new(min, max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;

    #[test]
    fn symmetries_are_rotations_and_can_be_undone() {
        let mut runner = TestRunner::deterministic();
        let mut all: Vec<Symmetry> = Vec::new();
        for _ in 0..4000 {
            let drawn = Symmetries::Turned.strategy().new_tree(&mut runner).expect("a symmetry").current();
            let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| drawn.direction(axis));
            assert_eq!(x.cross(y), z, "{drawn:?}");
            let (p, inverse) = (Vec3::new(1.1, -2.3, 3.7), drawn.inverse());
            assert_eq!(inverse.point(drawn.point(p)), p);
            assert_eq!(drawn.direction(Vec3::AXES[1]).abs(), Vec3::AXES[drawn.axis(1)]);
            let bounds = Aabb::new(p, p + 1.5);
            assert_eq!(inverse.bounds(&drawn.bounds(&bounds)), bounds);
            assert!(drawn.bounds(&Aabb::EMPTY).is_empty() && drawn.bounds(&bounds).contains(drawn.point(p)));
            if !all.contains(&drawn) {
                all.push(drawn);
            }
        }
        assert_eq!(all.len(), 23 * 6);
    }
}
