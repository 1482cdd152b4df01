//! Finds edges and corners at which a surface is closed as seen from one point.

use glam::{DVec3, Vec3};
use oracle::exact::Body;
use oracle::splitmix::Random;
use raykata::shape::Triangle;
use std::collections::HashMap;

/// A target on the surface, and the triangles around it, which close the surface there as seen from the camera.
pub struct Aim {
    pub target: Vec3,
    pub around: Vec<u32>,
}

/// The triangles at each corner.
pub struct Surface<'a> {
    bodies: &'a [Body],
    fans: HashMap<[u32; 3], Vec<u32>>,
}

/// A key for a position; adding 0 makes -0 equal to 0.
fn name(corner: Vec3) -> [u32; 3] {
    (corner + 0.0).to_array().map(f32::to_bits)
}

impl<'a> Surface<'a> {
    pub fn of(bodies: &'a [Body]) -> Surface<'a> {
        let mut fans: HashMap<[u32; 3], Vec<u32>> = HashMap::new();
        for (index, body) in bodies.iter().enumerate() {
            let Body::Triangle(Triangle { a, b, c }) = body else { continue };
            for corner in [a, b, c] {
                fans.entry(name(*corner)).or_default().push(index as u32);
            }
        }
        Surface { bodies, fans }
    }

    fn corners(&self, index: u32) -> [Vec3; 3] {
        match self.bodies[index as usize] {
            Body::Triangle(Triangle { a, b, c }) => [a, b, c],
            _ => unreachable!("fans are of triangles"),
        }
    }

    /// A target on an edge of this triangle and one at a corner, each if the surface is closed there.
    pub fn aims(&self, eye: Vec3, index: u32, random: &mut Random) -> Vec<Aim> {
        let corners = self.corners(index);
        let first = random.below(3) as usize;
        let (p, q) = (corners[first], corners[(first + 1) % 3]);
        let target = p.lerp(q, random.unit());
        let at_edge = self.closes(eye, p, q).map(|pair| Aim { target, around: pair.to_vec() });
        let fan = &self.fans[&name(p)];
        let closed = fan
            .iter()
            .flat_map(|&index| self.corners(index))
            .all(|other| name(other) == name(p) || self.closes(eye, p, other).is_some());
        at_edge.into_iter().chain(closed.then(|| Aim { target: p, around: fan.clone() })).collect()
    }

    /// The two triangles at an edge, if the camera sees one on each side of it.
    fn closes(&self, eye: Vec3, p: Vec3, q: Vec3) -> Option<[u32; 2]> {
        let (at_p, at_q) = (self.fans.get(&name(p))?, self.fans.get(&name(q))?);
        let both: Vec<u32> = at_p.iter().copied().filter(|index| at_q.contains(index)).collect();
        let [one, other] = both[..] else { return None };
        let [eye, p, q] = [eye, p, q].map(Vec3::as_dvec3);
        let across = (p - eye).cross(q - eye).normalize_or_zero();
        let side = |index: u32| {
            let third = self.corners(index).map(Vec3::as_dvec3).into_iter();
            let third = third.filter(|&corner| corner != p && corner != q);
            let far = third.map(|corner: DVec3| (corner - eye).normalize_or_zero().dot(across));
            far.fold(0.0, |most: f64, side| if side.abs() > most.abs() { side } else { most })
        };
        // A triangle that is seen edge-on lies on neither side.
        let (left, right) = (side(one), side(other));
        (left * right < 0.0 && left.abs().min(right.abs()) > 1e-6).then_some([one, other])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of four triangles around its middle, seen from above, in front of the camera.
    fn square(middle: Vec3) -> Vec<Body> {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
        let side = |n: usize| Triangle { a: middle, b: corners[n], c: corners[(n + 1) % 4] };
        (0..4).map(side).map(Body::Triangle).collect()
    }

    #[test]
    fn a_surface_is_closed_within_and_open_at_its_rim() {
        let (bodies, eye) = (square(Vec3::ZERO), Vec3::new(0.1, 0.2, 5.0));
        let surface = Surface::of(&bodies);
        let [middle, one, next] = surface.corners(0);
        assert_eq!(surface.closes(eye, middle, one), Some([0, 3]));
        assert_eq!(surface.closes(eye, one, next), None, "there is no triangle beyond the rim");
        let mut random = Random::new(1, 1);
        let aims: Vec<Aim> = (0..40).flat_map(|_| surface.aims(eye, 0, &mut random)).collect();
        assert!(aims.iter().any(|aim| aim.target == middle && aim.around.len() == 4));
        assert!(aims.iter().any(|aim| aim.around.len() == 2));
        assert!(aims.iter().all(|aim| aim.target.x.abs() < 1.0 && aim.target.y.abs() < 1.0));
    }

    #[test]
    fn an_edge_at_which_a_surface_turns_away_is_open() {
        // A tent: from above both sides are seen, from far to the right only one.
        let bodies = square(Vec3::new(0.0, 0.0, 1.0));
        let surface = Surface::of(&bodies);
        let [top, corner, _] = surface.corners(0);
        assert!(surface.closes(Vec3::new(0.0, 0.0, 5.0), top, corner).is_some());
        assert!(surface.closes(Vec3::new(5.0, 0.0, 0.5), top, corner).is_none());
    }
}
