//! Stage 2: triangles and meshes.
//!
//! `meet` (checks for all three methods; `method` judges the answers, `triangle_mistakes` names mistakes) · `gram` · `inside` · `backfaces` · `attributes` · `vertex_normals` ·
//! `closest` · `golden`

mod attributes;
mod backfaces;
mod closest;
mod golden;
mod gram;
mod inside;
mod meet;
mod method;
mod triangle_mistakes;
mod vertex_normals;

use attributes::{face_normal_has_unit_length_at_any_size, interpolation_weighs_the_corners};
use backfaces::{
    backfacing_has_no_smallest_size, backfacing_is_false_for_what_is_seen_edge_on,
    backfacing_is_the_sign_of_n_dot_d,
};
use closest::brute_force_finds_the_closest_of_all;
use golden::{hit_table_of_a_fan, picture_of_an_octahedron};
use gram::gram_scalars_of_thin_triangles_keep_their_sign;
use inside::{
    inside_by_areas_gives_barycentric_coordinates, inside_by_direction_agrees_with_double_precision,
    inside_by_planes_agrees_with_double_precision,
};
use meet::{
    triangle_choice_agrees_with_double_precision, triangle_choice_far_from_the_origin,
    triangle_choice_has_no_smallest_size, triangle_choice_is_hit_from_either_side,
    triangle_choice_knows_inside_from_outside, triangle_choice_misses_degenerate_triangles,
    triangle_choice_owns_its_edges, triangle_choice_respects_the_range,
    triangle_cramer_agrees_with_double_precision, triangle_cramer_far_from_the_origin,
    triangle_cramer_has_no_smallest_size, triangle_cramer_is_hit_from_either_side,
    triangle_cramer_knows_inside_from_outside, triangle_cramer_misses_degenerate_triangles,
    triangle_cramer_owns_its_edges, triangle_cramer_respects_the_range,
    triangle_gram_agrees_with_double_precision, triangle_gram_far_from_the_origin,
    triangle_gram_has_no_smallest_size, triangle_gram_is_hit_from_either_side,
    triangle_gram_knows_inside_from_outside, triangle_gram_misses_degenerate_triangles,
    triangle_gram_owns_its_edges, triangle_gram_respects_the_range,
};
use vertex_normals::{vertex_normals_average_their_faces, vertex_normals_that_cancel_are_still_normals};

checks::stage! { ($ crate) 2 [
    triangle_cramer_agrees_with_double_precision
    triangle_cramer_knows_inside_from_outside: turned
    triangle_cramer_is_hit_from_either_side
    triangle_cramer_respects_the_range
    triangle_cramer_owns_its_edges: turned
    triangle_cramer_has_no_smallest_size
    triangle_cramer_far_from_the_origin
    triangle_cramer_misses_degenerate_triangles: turned
    triangle_gram_agrees_with_double_precision
    triangle_gram_knows_inside_from_outside: turned
    triangle_gram_is_hit_from_either_side
    triangle_gram_respects_the_range
    triangle_gram_owns_its_edges: turned
    triangle_gram_has_no_smallest_size
    triangle_gram_far_from_the_origin
    triangle_gram_misses_degenerate_triangles: turned
    triangle_choice_agrees_with_double_precision
    triangle_choice_knows_inside_from_outside: turned
    triangle_choice_is_hit_from_either_side
    triangle_choice_respects_the_range
    triangle_choice_owns_its_edges: turned
    triangle_choice_has_no_smallest_size
    triangle_choice_far_from_the_origin
    triangle_choice_misses_degenerate_triangles: turned
    gram_scalars_of_thin_triangles_keep_their_sign
    inside_by_planes_agrees_with_double_precision
    inside_by_direction_agrees_with_double_precision
    inside_by_areas_gives_barycentric_coordinates
    backfacing_is_the_sign_of_n_dot_d
    backfacing_is_false_for_what_is_seen_edge_on: turned
    backfacing_has_no_smallest_size
    interpolation_weighs_the_corners
    face_normal_has_unit_length_at_any_size
    vertex_normals_average_their_faces
    vertex_normals_that_cancel_are_still_normals: turned
    brute_force_finds_the_closest_of_all
    hit_table_of_a_fan: composed
    picture_of_an_octahedron: composed
] }
