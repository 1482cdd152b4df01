//! Shapes in object spaces of their own, in whole frames: instances look like copies, there is no shadow
//! acne, transforms that reflect keep the outside outside, and every accelerator makes the same picture.

use crate::scene::{differing, job, render, render_by, rendered, scene, small};
use glam::Vec3;
use raykata::count::Counts;
use raykata::kit::{RenderJob, Rendering, View};
use raykata::scene::{Accelerator, Scene};

#[test]
fn every_accelerator_makes_the_same_picture() {
    for (name, width, height) in [("stage8", 64, 36), ("effects", 32, 20), ("graph", 48, 32)] {
        let scene = small(name, width, height);
        let expected = render_by(&scene, Accelerator::BruteForce);
        for accelerator in Accelerator::ALL {
            let frame = render_by(&scene, accelerator);
            assert_eq!(frame.film, expected.film, "{name}, {accelerator:?}");
            assert_eq!(rays(&frame.counts), rays(&expected.counts), "{name}, {accelerator:?}");
            // Instances and round shapes are no polygons, so this tree may list them all in large leaves.
            let is_coarse = |note: &String| note.contains("primitives per leaf");
            let expected = accelerator == Accelerator::PolygonBsp && frame.notes.iter().all(is_coarse);
            assert!(expected || frame.notes.is_empty(), "{name}, {accelerator:?}: {:?}", frame.notes);
        }
    }
}

fn rays(counts: &Counts) -> [u64; 5] {
    [counts.primary, counts.shadow, counts.reflection, counts.transmission, counts.hits]
}

#[test]
fn any_number_of_threads_asks_the_same_questions() {
    let mut scene = small("stage8", 64, 36);
    for accelerator in [
        Accelerator::CachedBvh,
        Accelerator::CachedBoundingBoxes,
        Accelerator::PacketBvh,
        Accelerator::WideBvh,
        Accelerator::Grid,
    ] {
        scene.quality.accelerator = accelerator;
        let with = |threads: usize| {
            let frame = rendered(&RenderJob { threads, ..job(&scene) });
            (frame.film, frame.counts)
        };
        assert_eq!(with(1), with(3), "{accelerator:?}");
    }
}

#[test]
fn instances_look_like_copies_and_take_less() {
    let mut scene = small("stage3", 120, 75);
    scene.quality.copies = true;
    let copies = render(&scene);
    scene.quality.copies = false;
    let instances = render(&scene);
    assert_eq!(instances.primitives, 226); // 225 vases and the floor
    assert_eq!(copies.primitives, 225 * 1568 + 1);
    // Rounding cannot move a pixel by more than a hundredth: such a pixel shows another surface. A transformed ray is rounded and
    // may hit the other side of an edge, in one of 9,000 pixels. A misplaced vase would change dozens of pixels.
    let off = differing(&instances.film, &copies.film, 0.01);
    assert!(off < 9, "{off}");
    let bytes = |frame: &Rendering| frame.bytes_of_parts + frame.structure.map_or(0, |size| size.bytes);
    // One mesh and 225 instances take 196 times less memory than 225 copies.
    assert!(150 * bytes(&instances) < bytes(&copies), "{} {}", bytes(&instances), bytes(&copies));
}

#[test]
fn a_hundred_thousand_trees_take_the_memory_of_one_and_their_places() {
    let scene = small("forest", 48, 27);
    let frame = render(&scene);
    assert_eq!(frame.primitives, 100_001); // the trees and the ground
    let bytes = frame.bytes_of_parts + frame.structure.map_or(0, |size| size.bytes);
    // A node has 40 bytes, and there are at most two nodes per instance; the shared tree takes half a megabyte.
    assert!(bytes < 9_000_000, "{bytes}");
}

/// One shape alone, which `steps` bring to `middle`, lit from above the camera: every visible point that faces the light must be lit.
fn lone(shape: &str, steps: &str, size: f32, middle: f32) -> Scene {
    let at = middle + 4.0 * size;
    scene(&format!(
        "[film]\nwidth = 60\nheight = 60\n[camera]\nposition = [{at}, {at}, {at}]\nlook_at = [{middle}, {middle}, {middle}]\n\
         vertical_fov = 30\n[[lights]]\ndirectional = {{ direction = [-1, -1.1, -0.9] }}\n\
         [[nodes]]\nshape = {{ {shape} }}\n\
         transform = [{steps}{{ scale = {size} }}, {{ translate = [{middle}, {middle}, {middle}] }}]\n"
    ))
}

#[test]
fn no_shape_shadows_itself_from_a_thousandth_to_a_hundred_thousand() {
    let shapes = [
        "sphere = { center = [0, 0, 0], radius = 1 }",
        "box = { min = [-1, -0.8, -0.6], max = [0.7, 0.9, 1] }",
        "cylinder = { base = [0, -1, 0], top = [0.2, 1, 0.1], radius = 0.7 }",
        "cone = { base = [0, -1, 0], apex = [0.1, 1.2, 0], radius = 0.9 }",
        "disk = { center = [0, 0, 0], normal = [1, 1, 1], radius = 1 }",
        "polygon = { corners = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }",
        "triangle = { a = [1, 0, 0], b = [0, 1, 0], c = [0, 0, 1] }",
    ];
    let turn = "{ scale = [1.2, 0.7, 0.9] }, { rotate = { axis = [1, 2, 3], degrees = 40 } }, ";
    let sizes = [1e-3f32, 0.1, 1.0, 1e3, 1e5].into_iter().flat_map(|size| [(size, 0.0), (size, 30.0 * size)]);
    for (size, middle) in sizes {
        for (shape, steps) in shapes.into_iter().flat_map(|shape| [(shape, ""), (shape, turn)]) {
            let scene = lone(shape, steps, size, middle);
            let frame = render(&scene);
            let normals = rendered(&RenderJob { view: View::Normals, ..job(&scene) }).film;
            let light = Vec3::new(1.0, 1.1, 0.9).normalize();
            let mut lit = 0;
            for (pixel, normal) in frame.film.pixels.iter().zip(&normals.pixels) {
                let facing = (2.0 * *normal - 1.0).dot(light);
                // On a convex shape every point that faces the light is lit. Leave out small cosines, at the
                // edge of the lit side.
                if *normal != Vec3::ZERO && facing > 0.1 {
                    assert!(pixel.max_element() > 0.0, "{shape} of size {size} at {middle} shadows itself");
                    lit += 1;
                }
            }
            // The polygon has the fewest lit pixels, 210 at every size; with none the test would prove nothing.
            assert!(lit > 200, "{shape} of size {size} at {middle}: {lit} pixels");
        }
    }
}

#[test]
fn a_mirrored_glass_vase_is_glass_inside() {
    let glass = |mirror: &str, copies: bool| {
        let mut scene = scene(&format!(
            "[film]\nwidth = 48\nheight = 48\n[camera]\nposition = [0, 1.2, 5]\nlook_at = [0, 0.9, 0]\nvertical_fov = 30\n\
             [environment]\nbackground = [0.3, 0.6, 0.9]\n[materials.glass]\ndiffuse = 0\ntransmission = 1\n\
             index_of_refraction = 1.5\n[meshes.cube]\nfile = \"meshes/cube.obj\"\nsmooth = false\n\
             [[nodes]]\nname = \"cube\"\nmaterial = \"glass\"\nshape = {{ mesh = \"cube\" }}\n\
             [[nodes]]\nchildren = [\"cube\"]\ntransform = [{{ scale = [{mirror}1, 1.6, 1] }}, {{ translate = [0, 0.9, 0] }}]\n"
        ));
        (scene.quality.max_depth, scene.quality.copies) = (6, copies);
        render(&scene)
    };
    // A cube is its own mirror image, so both pictures must be the same, for copies and for instances.
    for copies in [false, true] {
        let [plain, mirrored] = ["", "-"].map(|mirror| glass(mirror, copies));
        // A change of sign is exact, so no outline moves.
        assert_eq!(differing(&plain.film, &mirrored.film, 0.01), 0, "copies {copies}");
        // Two refracted rays for each pixel of the cube, 1,124 in all, prove that the pictures are not empty.
        assert!(plain.counts.transmission > 1000, "{}", plain.counts.transmission);
    }
}
