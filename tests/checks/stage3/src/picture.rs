//! The picture of stage 3.

use checks::picture::{self, Composed, LARGE};
use checks::prelude::*;
use checks::tree;
use std::f32::consts::TAU;

const TARGET: Vec3 = vec3(1.0, 1.0, 0.3);

/// A spiral of spheres: two turns for `pitch` 1. It has few spheres, because each query contains the whole tree and all answers.
fn spiral(pitch: f32, radius: f32) -> Vec<Sphere> {
    let sphere = |i: u8| {
        let turns = f32::from(i) / 12.0;
        let (sin, cos) = (TAU * turns * pitch).sin_cos();
        Sphere { center: TARGET + vec3(1.8 * cos, 1.8 * (turns - 1.0), 1.8 * sin), radius }
    };
    (0..24).map(sphere).collect()
}

pub(super) fn picture_of_depth(trial: &Trial<'_>) -> CheckResult {
    let (pitch, radius) = trial.composed((1.0, 0.42), (0.6..1.4f32, 0.3..0.5f32));
    let spheres = spiral(pitch, radius);
    let boxes: Vec<Aabb> = spheres.iter().map(tree::sphere_box).collect();
    let bvh = tree::joined(&boxes, 2);
    let rays = picture::rays(trial, LARGE, vec3(4.0, 5.0, 6.0), TARGET);
    let queries: Vec<SearchQuery> = rays.iter().map(|ray| tree::search_query(&bvh, &spheres, ray)).collect();
    // White is near the camera, black is the background.
    let depths = |kit: &dyn Kit| {
        let depth = |answer: raykata::kit::SearchAnswer| {
            answer.hit.map_or(0.0, |hit| ((11.0 - hit.t) / 6.0).clamp(0.0, 1.0))
        };
        kit.closest_hit(&queries).into_iter().map(depth).map(Vec3::splat).collect()
    };
    // The answers come from a table, so no pixel may differ.
    let composed = Composed { name: "stage3_depth", size: LARGE, rays: &rays, may_differ: 0.0 };
    composed.check(trial, depths)
}
