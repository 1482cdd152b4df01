//! A landscape of hills with a given number of triangles, for the headline.

use anyhow::Result;
use glam::{Affine3A, Vec3, vec3};
use raykata::camera::Camera;
use raykata::mesh::Mesh;
use raykata::scene::{Node, Scene, SceneMesh, Split};
use raykata::shape::Shape;
use std::sync::Arc;

/// The number of squares along both sides of a landscape; each square has two triangles. The number of
/// triangles is exact if it has a suitable pair of factors, and approximate otherwise.
pub fn sides(triangles: u64) -> (u32, u32) {
    let squares = (triangles / 2).max(1);
    let root = (squares as f64).sqrt();
    let divides = |side: &u64| squares.is_multiple_of(*side);
    match (1..=root as u64).rev().find(divides) {
        Some(side) if squares / side <= 2 * side => (side as u32, (squares / side) as u32),
        _ => (root.round() as u32, root.round() as u32),
    }
}

/// A landscape with this many squares, seen from above one of its edges: it fills the lower two thirds of the
/// picture.
pub fn scene(screen: (u32, u32), sides: (u32, u32)) -> Result<Scene> {
    let eye = vec3(0.0, 0.55, 1.25);
    let aspect = screen.0 as f32 / screen.1 as f32;
    let camera = Camera::new(eye, vec3(0.0, -0.42, -1.0), Vec3::Y, 45.0, aspect)?;
    let mut scene = Scene::empty(camera);
    let mesh = Arc::new(landscape(sides));
    scene.meshes.push(SceneMesh { mesh, ..SceneMesh::default() });
    scene.nodes.push(Node {
        name: "landscape".into(),
        transform: Affine3A::IDENTITY,
        shape: Some(Shape::Mesh(0)),
        ..Node::default()
    });
    scene.roots.push(0);
    scene.quality.split = Split::SurfaceArea;
    Ok(scene)
}

fn landscape((across, along): (u32, u32)) -> Mesh {
    let coordinate = |i: u32, of: u32| 2.0 * i as f32 / of as f32 - 1.0;
    let corner = |i: u32, j: u32| {
        let (x, z) = (coordinate(i, across), coordinate(j, along));
        vec3(x, height(x, z), z)
    };
    let positions = (0..=along).flat_map(|j| (0..=across).map(move |i| corner(i, j))).collect();
    let square = |i: u32, j: u32| {
        let row = across + 1;
        let [a, b] = [j * row + i, j * row + i + 1];
        let [c, d] = [a + row, b + row];
        [[a, c, b], [b, c, d]]
    };
    let triangles = (0..along).flat_map(|j| (0..across).flat_map(move |i| square(i, j))).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}

/// A sum of octaves: each is half as high and twice as narrow as the one before.
fn height(x: f32, z: f32) -> f32 {
    let octave = |k: i32| {
        let (frequency, k) = (2.0 * 2f32.powi(k), k as f32);
        let (u, v) = (frequency * (x + 0.31 * k), frequency * (z - 0.17 * k));
        ((1.7 * u + 0.6 * v).sin() * (1.3 * v - 0.8 * u).cos()) / frequency
    };
    0.28 * (0..7).map(octave).sum::<f32>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_landscape_has_two_triangles_a_square_that_face_up() {
        assert_eq!([12_000_000, 1_200, 50, 14].map(sides), [(2400, 2500), (24, 25), (5, 5), (3, 3)]);
        let mesh = landscape((5, 6));
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (42, 60));
        for index in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(index);
            assert!((b - a).cross(c - a).y > 0.0, "{index}");
        }
    }
}
