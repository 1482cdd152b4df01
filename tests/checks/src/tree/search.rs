//! A reference search, and tables that answer whatever a search may ask.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::kit::{SearchQuery, Table};
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// `(primitive, t)` of the smallest `t` in the table that counts; of equal ones the first.
pub fn closest_in_table(query: &SearchQuery) -> Option<(u32, f32)> {
    closest_of(&query.table.primitives, &query.ray)
}

/// The same for the `t` of all primitives.
pub fn closest_of(primitives: &[f32], ray: &Ray) -> Option<(u32, f32)> {
    let hits = primitives.iter().enumerate().filter(|(_, t)| ray.contains(**t));
    hits.min_by(|(_, p), (_, q)| p.total_cmp(q)).map(|(primitive, t)| (primitive as u32, *t))
}

/// A box around a sphere, with room for rounding.
pub fn sphere_box(sphere: &Sphere) -> Aabb {
    let reach = Vec3::splat(1.0001 * sphere.radius);
    Aabb::new(sphere.center - reach, sphere.center + reach)
}

/// The question for the closest of `spheres` along `ray`, with all answers worked out in double precision.
pub fn search_query(bvh: &Bvh, spheres: &[Sphere], ray: &Ray) -> SearchQuery {
    let primitives: Vec<f32> = spheres.iter().map(|sphere| sphere_t(ray, sphere)).collect();
    let mut boxes: Vec<(f32, f32)> = bvh.nodes.iter().map(|node| interval(ray, &node.bounds)).collect();
    // A parent comes before its children, so this goes from the leaves up: no box begins after what it holds.
    for node in (0..bvh.nodes.len()).rev() {
        let within: Vec<(f32, f32)> = match bvh.nodes[node].contents {
            Contents::Inner { left, right } => vec![boxes[left as usize], boxes[right as usize]],
            Contents::Leaf { first, count } => {
                let hits = bvh.primitives(first, count).iter().map(|&id| primitives[id as usize]);
                hits.filter(|t| t.is_finite()).map(|t| (t, t)).collect()
            }
        };
        for (near, far) in within {
            boxes[node] = (boxes[node].0.min(near), boxes[node].1.max(far));
        }
    }
    SearchQuery { bvh: bvh.clone(), ray: *ray, table: Table { boxes, primitives } }
}

/// The nearest hit in front of the ray, rounded to a 64th, so that ties are common.
fn sphere_t(ray: &Ray, sphere: &Sphere) -> f32 {
    match crate::double::sphere(&Ray::new(ray.origin, ray.dir), sphere) {
        crate::double::Expected::Hit { t, .. } => ((64.0 * t).ceil() / 64.0) as f32,
        _ => f32::INFINITY,
    }
}

fn interval(ray: &Ray, bounds: &Aabb) -> (f32, f32) {
    let (near, far) = crate::double::box_interval(ray, bounds);
    if near <= far {
        ((near as f32).next_down(), (far as f32).next_up())
    } else {
        (f32::INFINITY, f32::NEG_INFINITY)
    }
}

/// The reference search: nearer child first, and nothing beyond the best hit.
pub fn search(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    let mut ray = *ray;
    let mut best: Option<PrimitiveHit> = None;
    let root = bvh.root()?;
    let mut waiting = vec![(probe.enter(root, &ray)?, root)];
    while let Some((enter, node)) = waiting.pop() {
        if enter >= ray.t_max {
            continue;
        }
        match probe.open(node) {
            Contents::Inner { left, right } => {
                let mut children: Vec<(f32, u32)> = [left, right]
                    .into_iter()
                    .filter_map(|child| Some((probe.enter(child, &ray)?, child)))
                    .collect();
                children.sort_by(|p, q| q.0.total_cmp(&p.0));
                waiting.extend(children);
            }
            Contents::Leaf { first, count } => {
                for &primitive in bvh.primitives(first, count) {
                    let Some(t) = probe.hit(primitive, &ray) else { continue };
                    if best.is_none_or(|best| (t, primitive) < (best.t, best.primitive)) {
                        best = Some(PrimitiveHit { t, primitive });
                    }
                    ray.t_max = ray.t_max.min(t.next_up());
                }
            }
        }
    }
    best
}

/// Nodes whose boxes the ray enters when nothing is skipped.
pub fn overlapped(query: &SearchQuery) -> Vec<usize> {
    let enters = |&(near, far): &(f32, f32)| near.max(query.ray.t_min) <= far && near < query.ray.t_max;
    (0..query.bvh.nodes.len()).filter(|&node| enters(&query.table.boxes[node])).collect()
}
