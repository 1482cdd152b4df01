//! Finds the exact first hit of a ray among many bodies.

use super::ExactRay;
use glam::Vec3;
use oracle::STABLE;
use oracle::exact::{Body, aabb, meet, triangle};
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::shape::Shape;
use raykata::world::{Geometry, World};

/// The number of bodies in a group, which are tested one by one if the ray hits the box of the group.
const GROUP: usize = 64;

/// The box of unbounded bodies.
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// The primitives followed by the planes, numbered as in a kit.
pub fn bodies(world: &World) -> Vec<Body> {
    let primitives = world.primitives.iter().map(|primitive| match primitive.geometry {
        Geometry::Sphere(sphere) => Body::Sphere(sphere),
        Geometry::Triangle(triangle) => Body::Triangle(triangle),
        Geometry::OneSided(_) | Geometry::Solid(_) | Geometry::Instance(_) => {
            unreachable!("a plain world has none of them")
        }
    });
    primitives.chain(world.planes.iter().map(|plane| Body::Plane(plane.plane))).collect()
}

/// Finds the exact first hit of a ray.
pub struct Search<'a> {
    bodies: &'a [Body],
    /// Groups of neighbouring bodies, each with its box.
    groups: Vec<(Aabb, Vec<u32>)>,
}

impl<'a> Search<'a> {
    /// A search over `bodies`. The first `n_bounded` of them are bounded, the others are not.
    pub fn over(bodies: &'a [Body], n_bounded: usize) -> Search<'a> {
        let boxes: Vec<Aabb> = bodies[..n_bounded].iter().map(bounds).collect();
        let mut groups = Vec::new();
        let mut waiting = vec![(0..n_bounded as u32).collect::<Vec<u32>>()];
        while let Some(mut group) = waiting.pop() {
            let around = group
                .iter()
                .map(|&index| boxes[index as usize])
                .fold(Aabb::EMPTY, |all, one| Aabb::new(all.min.min(one.min), all.max.max(one.max)));
            if group.len() <= GROUP {
                groups.push((around, group));
                continue;
            }
            let axis = (around.max - around.min).max_position();
            let middle =
                |index: &u32| boxes[*index as usize].min[axis] / 2.0 + boxes[*index as usize].max[axis] / 2.0;
            let half = group.len() / 2;
            group.select_nth_unstable_by(half, |p, q| middle(p).total_cmp(&middle(q)));
            waiting.push(group.split_off(half));
            waiting.push(group);
        }
        groups.push((EVERYWHERE, (n_bounded as u32..bodies.len() as u32).collect()));
        Search { bodies, groups }
    }

    /// The index of the body that the ray hits first, and the ray with the `t` of that hit.
    pub fn asked(&self, ray: Ray) -> (Option<u32>, ExactRay) {
        let is_met = |around: &Aabb| {
            *around == EVERYWHERE
                || aabb::overlap(&ray, around).is_none_or(|overlap| overlap.verdict.is_hit())
        };
        let met = self.groups.iter().filter(|(around, _)| is_met(around)).flat_map(|(_, group)| group);
        let hit = |&index: &u32| Some((meet(&ray, self.bodies[index as usize])?.t?, index));
        let best = met.filter_map(hit).min_by(|(p, _), (q, _)| p.total_cmp(q));
        // Count the surface as closed well inside a triangle only: near the rim of a sphere rounding decides,
        // and the distance from the rim is not measured.
        let closed = best.is_some_and(|(_, index)| match self.bodies[index as usize] {
            Body::Triangle(triangle) => {
                triangle::margin(&ray, &triangle).is_some_and(|margin| margin > STABLE)
            }
            _ => false,
        });
        (best.map(|(_, index)| index), ExactRay { ray, first: best.map(|(t, _)| t), closed })
    }
}

/// A box that contains the body.
fn bounds(body: &Body) -> Aabb {
    let around = match body {
        Body::Triangle(triangle) => Shape::Triangle(*triangle).bounds(&[]),
        Body::Sphere(sphere) => Shape::Sphere(*sphere).bounds(&[]),
        _ => None,
    };
    // Enlarge the box by one float, because it is rounded to nearest.
    around.map_or(EVERYWHERE, |Aabb { min, max }| Aabb::new(min.map(f32::next_down), max.map(f32::next_up)))
}
