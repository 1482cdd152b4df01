//! Makes a scene of triangles, so that whole frames search them.

use glam::Vec3;
use raykata::camera::Camera;
use raykata::kit::{RenderJob, View};
use raykata::mesh::Mesh;
use raykata::scene::{Node, Quality, Scene, SceneMesh, TriangleMethod};
use raykata::shape::{Shape, Triangle};
use std::sync::Arc;

/// Returns a job for a scene of these triangles, rendered on one thread with this quality. The triangles keep their
/// indices.
pub fn job(triangles: &[Triangle], quality: Quality) -> RenderJob {
    let camera =
        Camera::new(Vec3::Z, Vec3::NEG_Z, Vec3::Y, 45.0, 1.0).unwrap_or_else(|error| panic!("{error:?}"));
    let mut scene = Scene::empty(camera);
    scene.quality = Quality { triangle_method: TriangleMethod::Watertight, ..quality };
    if !triangles.is_empty() {
        let mesh = Mesh {
            positions: triangles.iter().flat_map(|triangle| [triangle.a, triangle.b, triangle.c]).collect(),
            triangles: (0..triangles.len() as u32)
                .map(|index| [3 * index, 3 * index + 1, 3 * index + 2])
                .collect(),
            ..Mesh::default()
        };
        scene.meshes = vec![SceneMesh { mesh: Arc::new(mesh), ..SceneMesh::default() }];
        scene.nodes = vec![Node { shape: Some(Shape::Mesh(0)), ..Node::default() }];
        scene.roots = vec![0];
    }
    RenderJob { scene, view: View::Shaded, seed: 0, threads: 1, count: false, reuse: false }
}
