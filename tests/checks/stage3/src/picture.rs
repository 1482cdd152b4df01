//! The picture of stage 3.

use checks::broken::CheckResult;
use checks::{Trial, picture, tree};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::SearchQuery;
use raykata::shape::Sphere;
use std::f32::consts::TAU;

const TARGET: Vec3 = vec3(1.0, 1.0, 0.3);

/// Two turns of a spiral of spheres. It has few spheres, because each query contains the whole tree and all answers.
fn spiral() -> Vec<Sphere> {
    let sphere = |i: u8| {
        let turns = f32::from(i) / 12.0;
        let (sin, cos) = (TAU * turns).sin_cos();
        Sphere { center: TARGET + vec3(1.8 * cos, 1.8 * (turns - 1.0), 1.8 * sin), radius: 0.42 }
    };
    (0..24).map(sphere).collect()
}

pub(super) fn picture_of_depth(trial: &Trial<'_>) -> CheckResult {
    let spheres = spiral();
    let boxes: Vec<Aabb> = spheres.iter().map(tree::sphere_box).collect();
    let bvh = tree::joined(&boxes, 2);
    let rays = picture::rays(trial, vec3(4.0, 5.0, 6.0), TARGET);
    let queries: Vec<SearchQuery> = rays.iter().map(|ray| tree::search_query(&bvh, &spheres, ray)).collect();
    // White is near the camera, black is the background.
    let depths = trial
        .kit
        .closest_hit(&queries)
        .into_iter()
        .map(|answer| answer.hit.map_or(0.0, |hit| ((11.0 - hit.t) / 6.0).clamp(0.0, 1.0)));
    // The answers come from a table, so no pixel may differ.
    picture::compare(trial, "stage3_depth", &picture::film_of(depths.map(Vec3::splat).collect()), &rays, 0.0)
}
