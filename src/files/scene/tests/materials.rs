//! Materials and lights, and the examples in `format.md`.

use super::scene_with;
use crate::files::scene::parse;
use crate::material::{AreaShape, Emitter, Falloff, Light, Material};
use crate::scene::VisibleLight;
use crate::shape::{Disk, Sphere};
use glam::Vec3;
use std::path::Path;

#[test]
fn materials_keep_their_order_and_default_comes_first() {
    let scene = scene_with(
        "[materials.red]\ndiffuse = [1, 0, 0]\nexponent = 5\n\
         [materials.glass]\ntransmission = 0.9\nindex_of_refraction = 1.5\nambient = 0\nroughness = 1\n\
         mirror = 0.1\nspecular = 2\nemission = 3\n\
         [materials.default]\ndiffuse = 0.25\n",
    );
    assert_eq!(scene.material_names, ["default", "red", "glass"]);
    let grey = Vec3::splat(0.25);
    assert_eq!(scene.materials[0], Material { ambient: grey, diffuse: grey, ..Material::default() });
    assert_eq!(
        scene.materials[1],
        Material { ambient: Vec3::X, diffuse: Vec3::X, exponent: 5.0, ..Material::default() }
    );
    let glass = Material {
        ambient: Vec3::ZERO,
        transmission: Vec3::splat(0.9),
        index_of_refraction: 1.5,
        roughness: 1.0,
        mirror: Vec3::splat(0.1),
        specular: Vec3::splat(2.0),
        emission: Vec3::splat(3.0),
        ..Material::default()
    };
    assert_eq!(scene.materials[2], glass);
}

#[test]
fn lights_arrive_as_written() {
    let scene = scene_with(
        "[[lights]]\npoint = { position = [1, 2, 3], falloff = 'inverse_square' }\nintensity = 2\n\
         [[lights]]\ndirectional = { direction = [0, -5, 0] }\ncolor = [1, 0, 0]\n\
         [[lights]]\narea = { rectangle = { corner = [0, 0, 0], edges = [[1, 0, 0], [0, 0, 1]] } }\n\
         [[lights]]\narea = { disk = { center = [0, 1, 0], normal = [0, 0, 2], radius = 3 } }\n\
         [[lights]]\narea = { sphere = { center = [0, 1, 0], radius = 3 }, falloff = 'inverse_square' }\n",
    );
    let light = |emitter| Light { emitter, color: Vec3::ONE, intensity: 1.0, shadows: true, cone: None };
    let (center, radius, none, square) = (Vec3::Y, 3.0, Falloff::None, Falloff::InverseSquare);
    let point = Emitter::Point { position: Vec3::new(1.0, 2.0, 3.0), falloff: square };
    assert_eq!(scene.lights[0], Light { intensity: 2.0, ..light(point) });
    let directional = Emitter::Directional { direction: Vec3::NEG_Y };
    assert_eq!(scene.lights[1], Light { color: Vec3::X, ..light(directional) });
    let shape = AreaShape::Rectangle { corner: Vec3::ZERO, edges: (Vec3::X, Vec3::Z) };
    assert_eq!(scene.lights[2], light(Emitter::Area { shape, falloff: none }));
    let shape = AreaShape::Disk(Disk { center, normal: Vec3::Z, radius });
    assert_eq!(scene.lights[3], light(Emitter::Area { shape, falloff: none }));
    let shape = AreaShape::Sphere(Sphere { center, radius });
    assert_eq!(scene.lights[4], light(Emitter::Area { shape, falloff: square }));
}

#[test]
fn a_visible_light_is_a_node_with_a_black_material_that_emits() {
    let text = "[[lights]]\npoint = { position = [1, 2, 3] }\n\
                [[lights]]\narea = { disk = { center = [0, 1, 0], normal = [0, 1, 0], radius = 2 }, \
                falloff = 'inverse_square' }\nintensity = 8\ncolor = [1, 0.5, 0]\nvisible = true\n\
                [[nodes]]\nname = 'one'\nshape = { sphere = { center = [0, 0, 0], radius = 1 } }\n";
    let scene = scene_with(text);
    assert_eq!(scene.visible_lights, [VisibleLight { light: 1, material: 1 }]);
    assert_eq!((scene.roots.as_slice(), scene.nodes[1].material), ([0, 1].as_slice(), Some(1)));
    assert_eq!(
        scene.nodes[1].shape.as_ref().and_then(|shape| shape.bounds(&[])).map(|b| b.max.x > 1.9),
        Some(true)
    );
    let material = &scene.materials[1];
    assert_eq!((material.diffuse, material.ambient), (Vec3::ZERO, Vec3::ZERO));
    assert!((material.emission - Vec3::new(2.0, 1.0, 0.0)).length() < 1e-6);
    assert_eq!((scene.emitters(), scene.material_names[1].as_str()), (vec![1], "light 2"));
    let hidden = scene_with(&text.replace("visible = true", ""));
    assert!(hidden.visible_lights.is_empty() && hidden.nodes.len() == 1 && hidden.emitters().is_empty());
}

#[test]
fn the_examples_of_the_reference_can_be_read() {
    let reference = include_str!("../format.md");
    let examples: Vec<&str> =
        reference.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!examples.is_empty());
    for example in examples {
        if let Err(error) = parse(Path::new("format.md"), example) {
            panic!("{error}");
        }
    }
}
