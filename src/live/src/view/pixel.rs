//! The rays of a pixel and the boxes that are tested for them, as lines on the picture.

use glam::Vec3;
use raykata::camera::Camera;
use raykata::kit::{RayKind, RayVisits, TracedRay};
use raykata::partition::edges;
use raykata::scene::Scene;
use raykata::world::camera_for;
use raykata_cli::compare::projected;
use raykata_cli::tree::label;
use serde_json::{Value, json};

/// The most boxes per ray, and the most lines of a level: with more, the picture is a blot.
const MOST_BOXES: usize = 400;
const MOST_LINES: usize = 40_000;

/// The rays with their parents, labels, lines on the picture and visits.
pub fn rays(scene: &Scene, rays: &[(TracedRay, RayVisits)]) -> Vec<Value> {
    let camera = camera_for(scene);
    // A ray that hits nothing is drawn as long as the longest one that hits something.
    let longest = rays.iter().filter_map(|(ray, _)| Some(ray.hit.as_ref()?.0 * ray.direction.length()));
    let longest = longest.filter(|length| length.is_finite()).fold(1.0, f32::max);
    let ray = |(ray, visits): &(TracedRay, RayVisits)| {
        let length = match &ray.hit {
            Some((t, _)) if ray.kind != RayKind::Shadow => t * ray.direction.length(),
            _ => longest,
        };
        let end = ray.origin + length * ray.direction.normalize_or_zero();
        let boxes = visits.boxes.iter().take(MOST_BOXES).map(|one| {
            let lines: Vec<Value> =
                edges(&one.bounds).into_iter().filter_map(|edge| line(&camera, scene, edge)).collect();
            json!({ "hit": one.hit, "lines": lines })
        });
        json!({
            "label": label(ray), "kind": ray.kind, "parent": ray.parent, "depth": ray.depth,
            "origin": ray.origin.to_array(), "direction": ray.direction.to_array(),
            "line": line(&camera, scene, [ray.origin, end]), "node_visits": visits.node_visits,
            "box_tests": visits.box_tests, "primitive_tests": visits.primitive_tests,
            "boxes": boxes.collect::<Vec<_>>(),
        })
    };
    rays.iter().map(ray).collect()
}

/// Line segments of the scene on the picture.
pub fn lines(scene: &Scene, edges: &[[Vec3; 2]]) -> Vec<Value> {
    let camera = camera_for(scene);
    edges.iter().take(MOST_LINES).filter_map(|edge| line(&camera, scene, *edge)).collect()
}

/// A line segment on the picture, in pixels, rounded to a tenth; `None` if it is not seen.
fn line(camera: &Camera, scene: &Scene, ends: [Vec3; 2]) -> Option<Value> {
    let [p, q] = projected(camera, (scene.film.width, scene.film.height), ends)?;
    let tenths = [p.x, p.y, q.x, q.y].map(|x| f64::from((10.0 * x).round()) / 10.0);
    Some(json!(tenths))
}
