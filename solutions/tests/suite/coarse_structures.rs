//! Frames over triangles that are hard to divide: the structures stay small, the picture is right, and a note says which
//! structure is coarser than the scene asks for.

use super::adversarial::hard_lists;
use crate::scene::{render_by, scene};
use raykata::mesh::Mesh;
use raykata::partition::MOST_REFERENCES;
use raykata::scene::{Accelerator, Scene};
use std::sync::Arc;

/// A small picture of the `n` triangles with this name.
fn picture_of(name: &str, n: usize) -> Scene {
    let mut scene = scene(
        r#"
film = { width = 12, height = 8 }
camera = { position = [1, 2, 6], look_at = [0, 0, 0] }
[[lights]]
point = { position = [4, 6, 5] }
[meshes.hard]
file = "meshes/cube.obj"
smooth = false
[[nodes]]
shape = { mesh = "hard" }
"#,
    );
    let hard = hard_lists(n).into_iter().find(|hard| hard.name == name).expect("a list with this name");
    scene.meshes[0].mesh = Arc::new(Mesh {
        positions: hard.triangles.iter().flat_map(|t| [t.a, t.b, t.c]).collect(),
        triangles: (0..hard.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Mesh::default()
    });
    scene
}

#[test]
fn structures_over_hard_triangles_are_small_and_right() {
    let n = 2000;
    for name in ["short needles", "needles along the axes", "coincident", "nested in a corner", "flat sheets"]
    {
        let scene = picture_of(name, n);
        let expected = render_by(&scene, Accelerator::BruteForce);
        let needs_none = [Accelerator::Auto, Accelerator::BruteForce];
        for accelerator in Accelerator::ALL.into_iter().filter(|one| !needs_none.contains(one)) {
            let found = render_by(&scene, accelerator);
            let references = found.structure.map_or(0, |size| size.references);
            let most = (MOST_REFERENCES * n) as u64;
            assert!(references <= most, "{accelerator:?} over {name}: {references} references");
            // A ray tests each reference at most once.
            let tests = found.counts.primitive_tests;
            let most = expected.counts.primitive_tests * MOST_REFERENCES as u64;
            assert!(tests <= most, "{accelerator:?} over {name}: {tests} primitive tests, more than {most}");
            assert_eq!(found.film, expected.film, "{accelerator:?} over {name}");
        }
    }
}

#[test]
fn a_note_says_which_structure_is_coarse() {
    let scene = picture_of("needles", 12_000);
    for (accelerator, says) in [
        (Accelerator::Grid, Some("the grid has ")),
        (Accelerator::Octree, Some("the octree has up to ")),
        (Accelerator::OctreeByCells, Some("the octree has up to ")),
        (Accelerator::KdTree, Some("the kd-tree has up to ")),
        (Accelerator::Bsp, Some("the BSP tree has up to ")),
        (Accelerator::Bvh, None),
        (Accelerator::BruteForce, None),
    ] {
        let notes = render_by(&scene, accelerator).notes;
        match says {
            Some(says) => {
                assert!(notes.len() == 1 && notes[0].starts_with(says), "{accelerator:?}: {notes:?}")
            }
            None => assert_eq!(notes, [""; 0], "{accelerator:?}"),
        }
    }
}

#[test]
fn the_cells_of_a_scene_are_taken_as_they_are_unless_memory_runs_out() {
    let mut scene = picture_of("short needles", 2000);
    scene.quality.grid_resolution = 20;
    let found = render_by(&scene, Accelerator::Grid);
    assert_eq!(found.structure.map(|size| size.nodes), Some(20 * 20 * 20));
    assert_eq!(found.notes, [""; 0]);
    // 2000 triangles in each of 256³ cells would be 134 GB.
    let mut scene = picture_of("coincident", 2000);
    scene.quality.grid_resolution = 256;
    let found = render_by(&scene, Accelerator::Grid);
    let references = found.structure.map_or(0, |size| size.references);
    assert!(references <= 1 << 26, "{references} references");
    assert!(found.notes[0].contains("256 × 256 × 256"), "{:?}", found.notes);
}
