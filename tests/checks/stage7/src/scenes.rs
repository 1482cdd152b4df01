//! The scenes that the checks of stage 7 analyse.

use glam::{Affine3A, Vec2, Vec3, vec3};
use raykata::camera::{Camera, Lens, Shutter};
use raykata::effects::{Effect, LightEffects};
use raykata::material::{AreaShape, Emitter, Falloff, Light, Material, Texture, Wrap};
use raykata::mesh::Mesh;
use raykata::scene::{Node, Scene, SceneMesh};
use raykata::shape::{Shape, Sphere};
use std::sync::Arc;

pub(super) fn light(color: Vec3, intensity: f32) -> Light {
    let emitter = Emitter::Point { position: vec3(0.0, 5.0, 0.0), falloff: Falloff::None };
    Light { emitter, color, intensity, shadows: true, cone: None }
}

pub(super) fn sphere_light(color: Vec3) -> Light {
    let shape = AreaShape::Sphere(Sphere { center: vec3(0.0, 5.0, 0.0), radius: 1.0 });
    Light { emitter: Emitter::Area { shape, falloff: Falloff::None }, ..light(color, 1.0) }
}

/// What a light without an area needs if it casts shadows.
pub(super) const ONE_SAMPLE: LightEffects = LightEffects { samples: 1, area: false, shadows: true };

/// Adds a material that no shape has.
pub(super) fn add_material(scene: &mut Scene, name: &str, material: Material) {
    scene.materials.push(material);
    scene.material_names.push(name.into());
}

pub(super) fn camera() -> Camera {
    Camera::new(vec3(0.0, 1.0, 5.0), Vec3::NEG_Z, Vec3::Y, 40.0, 1.0).expect("a camera that looks along -z")
}

pub(super) fn sphere(material: usize) -> Node {
    let shape = Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
    Node { name: "sphere".into(), shape: Some(shape), material: Some(material), ..Node::default() }
}

/// A scene with one sphere of `material` and a light.
pub(super) fn one_sphere(material: Material) -> Scene {
    let mut scene = Scene::empty(camera());
    scene.lights.push(light(Vec3::ONE, 1.0));
    add_material(&mut scene, "sphere", material);
    scene.nodes.push(sphere(1));
    scene.roots.push(0);
    scene
}

/// A scene that needs every effect of [`BUILT`].
pub(super) fn everything() -> Scene {
    let mut scene = one_sphere(Material {
        mirror: Vec3::splat(0.3),
        roughness: 0.2,
        texture: Some(0),
        ..Material::default()
    });
    let frosted = Material { transmission: Vec3::ONE, roughness: 0.1, ..Material::default() };
    add_material(&mut scene, "glass", frosted);
    scene.textures.push(Texture {
        width: 1,
        height: 1,
        pixels: Arc::new(vec![Vec3::ONE]),
        wrap: Wrap::Repeat,
    });
    scene.lights.push(sphere_light(Vec3::ONE));
    scene.camera.lens = Some(Lens { aperture: 0.1, focal_distance: 4.0 });
    scene.camera.shutter = Some(Shutter { open: 0.0, close: 1.0 });
    let transform_end = Some(Affine3A::from_translation(Vec3::X));
    scene.nodes.push(Node { transform_end, ..sphere(2) });
    scene.meshes.push(SceneMesh { mesh: Arc::new(one_triangle()), smooth: true, ..SceneMesh::default() });
    scene.nodes.push(Node { shape: Some(Shape::Mesh(0)), ..Node::default() });
    scene.roots = vec![0, 1, 2];
    scene
}

pub(super) fn one_triangle() -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uvs: vec![Vec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    }
}

/// The effects that [`everything`] needs: all but indirect light, which is the last.
pub(super) const BUILT: [Effect; 9] = *Effect::ALL.first_chunk().expect("ten effects");
