//! Tables with the answers to all queries of a search, and the nodes that a search needs.

use crate::paste::Paste;
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents};
use raykata::kit::{SearchQuery, Table};
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// `(primitive, t)` of the smallest `t` in the table within the range of the ray; of equal ones the first.
pub fn closest_in_table(query: &SearchQuery) -> Option<(u32, f32)> {
    closest_of(&query.table.primitives, &query.ray)
}

/// The same as [`closest_in_table`], given the `t` of all primitives.
pub fn closest_of(primitives: &[f32], ray: &Ray) -> Option<(u32, f32)> {
    let hits = primitives.iter().enumerate().filter(|(_, t)| ray.contains(**t));
    hits.min_by(|(_, p), (_, q)| p.total_cmp(q)).map(|(primitive, t)| (primitive as u32, *t))
}

/// Moves hits apart that are nearer to each other than `step`, or equal. So a search need not choose between hits at the same
/// `t`; checks of their own judge that choice by [`tied`] queries.
pub fn move_apart(hits: &mut [f32], step: f32) {
    let mut order: Vec<usize> = (0..hits.len()).filter(|&i| hits[i].is_finite()).collect();
    order.sort_by(|&i, &j| hits[i].total_cmp(&hits[j]).then(i.cmp(&j)));
    for pair in order.windows(2) {
        hits[pair[1]] = hits[pair[1]].max((hits[pair[0]] + step).max(hits[pair[0]].next_up()));
    }
}

/// The same query with all hits at `t` = 5. In some of these queries all boxes begin there as well.
pub fn tied(mut query: SearchQuery) -> SearchQuery {
    query.ray = query.ray.with_range(0.5, f32::INFINITY);
    tie(&mut query.table, if query.bvh.nodes.len() % 4 == 1 { 1.0 } else { 5.0 });
    query
}

/// Moves all hits to `t` = 5, in boxes that begin at `near`.
pub fn tie(table: &mut Table, near: f32) {
    table.primitives.iter_mut().filter(|t| t.is_finite()).for_each(|t| *t = 5.0);
    table.boxes.iter_mut().filter(|(near, far)| near <= far).for_each(|entry| *entry = (near, 9.0));
}

/// The ray of a search and the primitives that it hits, in words.
pub fn hits_of(ray: &Ray, hits: &[f32]) -> String {
    let hits = hits.iter().enumerate().filter(|(_, t)| t.is_finite()).take(8);
    let hits: Vec<String> = hits.map(|(i, t)| format!("{i} at t = {t}")).collect();
    format!("{}, hits: {}", ray.paste(), hits.join(", "))
}

/// A box around a sphere, widened by 1e-4 of the radius for rounding.
pub fn sphere_box(sphere: &Sphere) -> Aabb {
    let reach = Vec3::splat(1.0001 * sphere.radius);
    Aabb::new(sphere.center - reach, sphere.center + reach)
}

/// The query for the closest of `spheres` along `ray`, with a table of all answers, computed in double precision.
pub fn search_query(bvh: &Bvh, spheres: &[Sphere], ray: &Ray) -> SearchQuery {
    let mut primitives: Vec<f32> = spheres.iter().map(|sphere| sphere_t(ray, sphere)).collect();
    move_apart(&mut primitives, 1.0 / 64.0);
    let mut boxes: Vec<(f32, f32)> = bvh.nodes.iter().map(|node| interval(ray, &node.bounds)).collect();
    // Go from the leaves up, because a parent comes before its children: widen each interval such that no box begins
    // behind its contents.
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

/// The nearest hit in front of the ray, rounded to a 64th.
fn sphere_t(ray: &Ray, sphere: &Sphere) -> f32 {
    match crate::double::sphere(&Ray::new(ray.origin, ray.direction), sphere) {
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

/// The nodes that every correct search visits: those whose boxes the ray enters before its closest hit or at it; and
/// the number of primitives in the leaves among them. A search that visits the nearer child first visits few other
/// nodes.
pub fn needed(query: &SearchQuery) -> (Vec<usize>, u64) {
    let end = closest_in_table(query).map_or(query.ray.t_max, |(_, t)| t);
    let mut nodes = overlapped(query);
    nodes.retain(|&node| query.table.boxes[node].0 <= end);
    let primitives = nodes.iter().map(|&node| match query.bvh.nodes[node].contents {
        Contents::Leaf { count, .. } => u64::from(count),
        Contents::Inner { .. } => 0,
    });
    let primitives = primitives.sum();
    (nodes, primitives)
}

/// The nodes whose boxes the ray enters if no node is skipped.
pub fn overlapped(query: &SearchQuery) -> Vec<usize> {
    let enters = |&(near, far): &(f32, f32)| near.max(query.ray.t_min) <= far && near < query.ray.t_max;
    (0..query.bvh.nodes.len()).filter(|&node| enters(&query.table.boxes[node])).collect()
}
