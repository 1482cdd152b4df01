//! The third hints of stages 1 to 3 lead to code that passes: functions that contain the code of the hints, and otherwise what
//! a textbook prints, pass every check. The code in the third hints of the bonus of stage 12 is that of the reference.

#![allow(clippy::manual_range_contains)] // books write both comparisons

mod stage1_shapes;
mod stage2_triangles;
mod stage3_boxes;
#[path = "../textbook/stage3_build.rs"]
mod stage3_build;
#[path = "../textbook/stage3_traversal.rs"]
mod stage3_traversal;
#[expect(
    dead_code,
    reason = "`stage3_boxes` replaces the functions whose third hints differ from the textbook"
)]
#[path = "../textbook/stage3_boxes.rs"]
mod textbook_boxes;
#[expect(
    dead_code,
    reason = "`stage2_triangles` replaces the functions whose third hints differ from the textbook"
)]
#[path = "../textbook/stage2_triangles.rs"]
mod textbook_triangles;

use solutions::{
    stage4_shading, stage5_recursion, stage6_distribution, stage7_effects, stage8_child_cache,
    stage8_scene_graph, stage8_solids, stage8_splines, stage8_surfaces, stage9_bsp, stage9_cells,
    stage9_coherence, stage9_grid, stage9_kd_tree, stage9_neighbours, stage9_octree, stage9_polygon_bsp,
    stage10_stability, stage11_light_transport, stage11_paths, stage12_build, stage12_search, stage12_simd,
    stage12_wide,
};

/// Functions with the code of the hints; those of later stages are the reference's.
#[derive(Clone, Copy)]
pub struct Kit;

mod functions {
    #[allow(unused_imports)]
    use raykata::kit::types::*;
    raykata::student_functions! { raykata::implement_student_functions }
}

impl raykata::kit::StudentKit for Kit {
    fn renderer() -> Option<&'static dyn raykata::kit::Frames> {
        None
    }
}

/// Code in the third hint of a check, which the functions of this test contain.
const HINTS: [(u8, &str, &str); 30] = [
    (
        1,
        "nearest_root_is_the_smaller_one_that_counts",
        "Return the first of `[near, far]` for which `ray.contains(t)` is true",
    ),
    (1, "sphere_algebraic_agrees_with_double_precision", "With f = o - c: a = d·d, b = -f·d, c = f·f - r²"),
    (1, "sphere_algebraic_starts_inside", "Give both roots to `nearest_root`"),
    (1, "sphere_algebraic_far_away_and_tiny", "f⊥ = f + (b / a) d"),
    (
        1,
        "sphere_algebraic_far_away_and_tiny",
        "q = b + sign(b) √(a (r² - |f⊥|²)) gives the roots q / a and c / q",
    ),
    (1, "sphere_algebraic_survives_invalid_numbers", "`if !(discriminant >= 0.0 && radius > 0.0)`"),
    (1, "sphere_geometric_agrees_with_double_precision", "With L = c - o: t_ca = L·d / (d·d)"),
    (1, "sphere_geometric_far_away_and_tiny", "N = L - t_ca d"),
    (1, "sphere_geometric_far_away_and_tiny", "The product of the two roots is (|L|² - r²) / (d·d)"),
    (1, "sphere_geometric_survives_invalid_numbers", "`if !(discriminant >= 0.0 && radius > 0.0)`"),
    (1, "sphere_normal_points_outwards", "Subtract the centre from the point, in this order, and normalize"),
    (1, "plane_agrees_with_double_precision", "t = n·(p₀ - o) / (n·d), returned if `ray.contains(t)`"),
    (1, "face_forward_turns_the_normal_to_the_ray", "One `if` with one dot product"),
    (2, "triangle_cramer_agrees_with_double_precision", "D = a(fk - gj) + b(gi - ek) + c(ej - fi)"),
    (2, "triangle_cramer_knows_inside_from_outside", "β ≥ 0, γ ≥ 0 and β + γ ≤ 1"),
    (2, "triangle_cramer_far_from_the_origin", "Use a - o, a - b and a - c"),
    (
        2,
        "triangle_gram_agrees_with_double_precision",
        "s = (UV (I·v) - VV (I·u)) / D is β, and its t = (UV (I·u) - UU (I·v)) / D is γ",
    ),
    (2, "triangle_gram_far_from_the_origin", "I = t d - (a - o)"),
    (
        2,
        "triangle_choice_agrees_with_double_precision",
        "With q = s × (b - a): γ = d·q / det and t = (c - a)·q / det",
    ),
    (
        2,
        "gram_scalars_of_thin_triangles_keep_their_sign",
        "(u·v)² - (u·u)(v·v) = -|u × v|². Compute it from the cross product",
    ),
    (
        2,
        "inside_by_areas_gives_barycentric_coordinates",
        "((T₁ - P) × (T₂ - P))·N / (N·N) with N = (b - a) × (c - a)",
    ),
    (2, "face_normal_has_unit_length_at_any_size", "Divide each edge by its largest component first"),
    (2, "face_normal_has_unit_length_at_any_size", "`try_normalize` returns None for 0"),
    (
        2,
        "vertex_normals_that_cancel_are_still_normals",
        "Store the normal of one face with an area for each vertex",
    ),
    (3, "union_holds_both_boxes", "The empty box is (inf, -inf). With min and max it changes nothing"),
    (3, "surface_area_counts_six_faces", "The empty box has a size of -inf. Return 0 for it"),
    (3, "slab_agrees_with_double_precision", "Raise near to each entry and lower far to each exit"),
    (3, "slab_is_hit_by_rays_within_a_face", "`if enter > near { near = enter }`"),
    (
        3,
        "slab_hits_the_corners_it_is_aimed_at",
        "Multiply the t of each far plane by 1 + 2 γ₃, where γ₃ = 3u / (1 - 3u) and u = 2⁻²⁴",
    ),
    (
        3,
        "build_isolates_what_is_not_a_number",
        "Build the union with `f32::min` and `f32::max` on each axis, and compare centroids with `total_cmp`",
    ),
];

#[test]
fn the_code_of_the_third_hints_passes() {
    for (stage, name, code) in HINTS {
        let hint = &checks::rubric::entry(stage, name).hints[2];
        assert!(hint.contains(code), "the third hint of `{name}` changed: apply it in this test\n{hint}");
    }
    let kit = checks::linked(Kit);
    for stage in 1..=3 {
        let mut failed = Vec::new();
        for check in all_checks::of_stage(stage) {
            if let checks::Verdict::Failed(message) = checks::run(check, &kit, 0) {
                println!("{message}");
                failed.push(check.name);
            }
        }
        assert!(failed.is_empty(), "stage {stage}: the code of the hints fails {failed:?}");
    }
}
