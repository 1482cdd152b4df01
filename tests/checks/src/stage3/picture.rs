//! What stage 3 can show.

use super::stadium::stadium;
use crate::broken::Outcome;
use crate::{Trial, picture, tree};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::SearchQuery;

pub(super) fn picture_of_depth(trial: &Trial<'_>) -> Outcome {
    let spheres = stadium();
    let boxes: Vec<Aabb> = spheres.iter().map(tree::sphere_box).collect();
    let bvh = tree::build(&boxes, 2);
    let rays = picture::rays(vec3(4.0, 5.0, 6.0), vec3(1.0, 1.0, 0.3));
    let queries: Vec<SearchQuery> = rays.iter().map(|ray| tree::search_query(&bvh, &spheres, ray)).collect();
    let depths = trial
        .kit
        .closest_hit(&queries)
        .into_iter()
        .map(|answer| answer.hit.map_or(0.0, |hit| 1.0 / (1.0 + 0.05 * hit.t * hit.t)));
    // The answers come from a table, so no pixel may differ.
    picture::compare("stage3_depth", &picture::develop(depths.map(Vec3::splat).collect()), &rays, 0.0)
}
