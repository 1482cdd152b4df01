//! Small scenes that checks render. Made here and not read, so that no file can be missing.

use glam::{Affine3A, Vec3};
use raykata::camera::Camera;
use raykata::material::Material;
use raykata::scene::{Encoding, FilmSettings, Node, Quality, Scene};
use raykata::shape::{Plane, Shape, Sphere};

/// A scene of 80 × 60 pixels with these shapes, seen from `eye`, with default material and no light.
pub fn scene(eye: Vec3, target: Vec3, shapes: Vec<Shape>) -> Scene {
    let film = FilmSettings { width: 80, height: 60, encoding: Encoding::Gamma2 };
    let camera =
        Camera::new(eye, target - eye, Vec3::Y, 45.0, 4.0 / 3.0).expect("the camera looks somewhere");
    Scene {
        film,
        camera,
        background: Vec3::new(0.2, 0.3, 0.5),
        ambient: Vec3::splat(0.1),
        indirect_light: false,
        lights: Vec::new(),
        materials: vec![Material::default()],
        material_names: vec!["default".into()],
        textures: Vec::new(),
        meshes: Vec::new(),
        roots: (0..shapes.len()).collect(),
        nodes: shapes
            .into_iter()
            .map(|shape| Node { transform: Affine3A::IDENTITY, shape: Some(shape), ..Node::default() })
            .collect(),
        quality: Quality::default(),
    }
}

/// A ball in front of a floor.
pub fn ball_on_a_plane() -> Scene {
    let floor = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let ball = Shape::Sphere(Sphere { center: Vec3::Y, radius: 1.0 });
    scene(Vec3::new(2.0, 2.5, 5.0), Vec3::new(0.0, 0.8, 0.0), vec![floor, ball])
}
