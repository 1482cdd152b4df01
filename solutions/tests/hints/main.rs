//! The third hints of stages 1 to 6 lead to code that passes: functions that contain the code of the hints, and otherwise what
//! a textbook prints, pass every check. The code in the third hints of the bonus of stage 12 is that of the reference.

#![allow(clippy::manual_range_contains)] // books write both comparisons

mod stage1_shapes;
mod stage2_triangles;
mod stage3_boxes;
mod stage3_build {
    pub use crate::textbook_build::*;
    pub use solutions::stage3_build::build;
}
#[path = "../textbook/stage3_traversal.rs"]
mod stage3_traversal;
mod stage4_shading;
mod stage5_recursion;
mod stage6_distribution;

/// The textbook, parts of which the modules above replace by the code of the third hints.
macro_rules! textbook {
    ($($name:ident $path:literal)*) => {
        $(
            #[allow(dead_code, unused_imports)]
            #[path = $path]
            mod $name;
        )*
    };
}

textbook! {
    textbook_triangles "../textbook/stage2_triangles.rs"
    textbook_boxes "../textbook/stage3_boxes.rs"
    textbook_build "../textbook/stage3_build.rs"
    textbook_shading "../textbook/stage4_shading.rs"
    textbook_recursion "../textbook/stage5_recursion.rs"
    textbook_distribution "../textbook/stage6_distribution.rs"
}

use solutions::*;

// Functions with the code of the hints; those of later stages are the reference's.
raykata::student_kit!(None);

/// Checks, and the code in the third hint of each, which the functions of this test contain.
const HINTS: &str = "\
nearest_root_is_the_smaller_one_that_counts: Return the first of `[near, far]` for which `ray.contains(t)` is true
sphere_algebraic_agrees_with_double_precision: With f = o - c: a = d·d, b = -f·d, c = f·f - r²
sphere_algebraic_starts_inside: Give both roots to `nearest_root`
sphere_algebraic_far_away_and_tiny: f⊥ = f + (b / a) d
sphere_algebraic_far_away_and_tiny: q = b + sign(b) √(a (r² - |f⊥|²)) gives the roots q / a and c / q
sphere_algebraic_survives_invalid_numbers: `if !(discriminant >= 0.0 && radius > 0.0)`
sphere_geometric_agrees_with_double_precision: With L = c - o: t_ca = L·d / (d·d)
sphere_geometric_far_away_and_tiny: N = L - t_ca d
sphere_geometric_far_away_and_tiny: The product of the two roots is (|L|² - r²) / (d·d)
sphere_geometric_survives_invalid_numbers: `if !(discriminant >= 0.0 && radius > 0.0)`
sphere_normal_points_outwards: Subtract the centre from the point, in this order, and normalize
plane_agrees_with_double_precision: t = n·(p₀ - o) / (n·d), returned if `ray.contains(t)`
face_forward_turns_the_normal_to_the_ray: One `if` with one dot product
triangle_cramer_agrees_with_double_precision: D = a(fk - gj) + b(gi - ek) + c(ej - fi)
triangle_cramer_knows_inside_from_outside: β ≥ 0, γ ≥ 0 and β + γ ≤ 1
triangle_cramer_far_from_the_origin: Use a - o, a - b and a - c
triangle_gram_agrees_with_double_precision: s = (UV (I·v) - VV (I·u)) / D is β, and its t = (UV (I·u) - UU (I·v)) / D is γ
triangle_gram_far_from_the_origin: I = t d - (a - o)
triangle_choice_agrees_with_double_precision: With q = s × (b - a): γ = d·q / det and t = (c - a)·q / det
gram_scalars_of_thin_triangles_keep_their_sign: (u·v)² - (u·u)(v·v) = -|u × v|². Compute it from the cross product
inside_by_areas_gives_barycentric_coordinates: ((T₁ - P) × (T₂ - P))·N / (N·N) with N = (b - a) × (c - a)
face_normal_has_unit_length_at_any_size: Divide each edge by its largest component first
face_normal_has_unit_length_at_any_size: `try_normalize` returns None for 0
vertex_normals_that_cancel_are_still_normals: Store the normal of one face with an area for each vertex
union_holds_both_boxes: The empty box is (inf, -inf). With min and max it changes nothing
surface_area_counts_six_faces: The empty box has a size of -inf. Return 0 for it
slab_agrees_with_double_precision: Raise near to each entry and lower far to each exit
slab_is_hit_by_rays_within_a_face: `if enter > near { near = enter }`
slab_hits_the_corners_it_is_aimed_at: Multiply the t of each far plane by 1 + 2 γ₃, where γ₃ = 3u / (1 - 3u) and u = 2⁻²⁴
build_isolates_what_is_not_a_number: Build the union with `f32::min` and `f32::max` on each axis, and compare centroids with `total_cmp`
shading_normal_falls_back_to_flat: `try_normalize` returns None for 0 and NaN
diffuse_term_is_the_cosine: max(n·l, 0)
specular_term_is_the_mirrored_cosine: if both n·l and cos φ are above 0, and 0 otherwise
shadow_ray_reaches_just_short_of_the_light: t_max = 0.9999 * light.distance
shadow_ray_leaves_its_own_surface_at_any_scale: with `next_up` or `next_down`
gamma_is_two: Add 0.5 before `as u8`
gamma_survives_invalid_numbers: Clamp to 0..=1 before you take the root
reflect_keeps_the_angle: d - n (d·n) removes the part along n. Subtract it twice
reflect_stays_of_unit_length_in_a_corridor: Normalize the direction that you return
refract_obeys_snell: along = (n1 / n2) (d + n cos θ1), with cos θ1 = -d·n. The result is along - n √(1 - |along|²)
refract_beyond_the_critical_angle_is_none: Return None unless 1 - |along|² >= 0
fresnel_schlick_agrees_with_double_precision: If n1 > n2, use the cosine of the refracted ray
fresnel_exact_agrees_with_double_precision: cos θ2 = √(1 - (n1 / n2)² (1 - cos² θ1))
secondary_rays_leave_their_surface: point + error·|n| n, then move each coordinate one float further
tree_ends_at_its_depth: if depth >= limits.max_depth
jittered_samples_stay_in_their_cells: 1 - f32::EPSILON / 2
each_sampler_has_its_places: 0.5 + FILTER_RADIUS * (2 * jittered - 1)
gaussian_weight_is_a_bell_that_ends: bell(x) = max(0, e^(-2x²) - e^(-2R²))
lens_rays_start_on_the_lens: position + aperture / 2 * (x * right + y * up)
focal_plane_is_sharp: focal_distance / (pinhole.direction · camera.towards) * pinhole.direction
places_on_a_rectangle_are_even: corner + u.x * edges.0 + u.y * edges.1
a_far_sphere_is_still_a_sphere: 1 - cos θ = sin²θ / (1 + cos θ); and sin²θ = x (2 - x)
slightly_rough_is_not_a_few_angles: x = -exp_m1(ln(u.x) / (n + 1))
temporal_table_has_each_time_once: TABLE[y % 4][x % 4]
times_are_even: open + share * (close - open)
lerp_is_exact_where_it_must: (1 - t) start + t end, and clamp each coordinate";

#[test]
fn the_code_of_the_third_hints_passes() {
    let entries = checks::rubric::RUBRIC.values().flat_map(|stage| stage.in_order());
    let entries: std::collections::BTreeMap<_, _> = entries.collect();
    for (name, code) in HINTS.lines().filter_map(|line| line.split_once(": ")) {
        let hint = &entries[name].hints[2];
        assert!(hint.contains(code), "the third hint of `{name}` changed: apply it in this test\n{hint}");
    }
    let kit = checks::linked(Kit);
    for stage in 1..=6 {
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
