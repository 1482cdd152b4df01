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

checks::stage! { ($ crate) 2 [
    meet::triangle_cramer_agrees_with_double_precision => triangle_agrees(method::CRAMER)
    meet::triangle_cramer_knows_inside_from_outside => triangle_regions(method::CRAMER): turned
    meet::triangle_cramer_is_hit_from_either_side => triangle_windings(method::CRAMER)
    meet::triangle_cramer_respects_the_range => triangle_in_range(method::CRAMER): turned
    meet::triangle_cramer_owns_its_edges => triangle_edges(method::CRAMER): turned
    meet::triangle_cramer_has_no_smallest_size => triangle_sizes(method::CRAMER)
    meet::triangle_cramer_far_from_the_origin => triangle_far(method::CRAMER)
    meet::triangle_cramer_misses_degenerate_triangles => triangle_missed(method::CRAMER): turned
    meet::triangle_gram_agrees_with_double_precision => triangle_agrees(method::GRAM)
    meet::triangle_gram_knows_inside_from_outside => triangle_regions(method::GRAM): turned
    meet::triangle_gram_is_hit_from_either_side => triangle_windings(method::GRAM)
    meet::triangle_gram_respects_the_range => triangle_in_range(method::GRAM): turned
    meet::triangle_gram_owns_its_edges => triangle_edges(method::GRAM): turned
    meet::triangle_gram_has_no_smallest_size => triangle_sizes(method::GRAM)
    meet::triangle_gram_far_from_the_origin => triangle_far(method::GRAM)
    meet::triangle_gram_misses_degenerate_triangles => triangle_missed(method::GRAM): turned
    meet::triangle_choice_agrees_with_double_precision => triangle_agrees(method::CHOICE)
    meet::triangle_choice_knows_inside_from_outside => triangle_regions(method::CHOICE): turned
    meet::triangle_choice_is_hit_from_either_side => triangle_windings(method::CHOICE)
    meet::triangle_choice_respects_the_range => triangle_in_range(method::CHOICE): turned
    meet::triangle_choice_owns_its_edges => triangle_edges(method::CHOICE): turned
    meet::triangle_choice_has_no_smallest_size => triangle_sizes(method::CHOICE)
    meet::triangle_choice_far_from_the_origin => triangle_far(method::CHOICE)
    meet::triangle_choice_misses_degenerate_triangles => triangle_missed(method::CHOICE): turned
    gram::gram_scalars_of_thin_triangles_keep_their_sign
    inside::inside_by_planes_agrees_with_double_precision
    inside::inside_by_direction_agrees_with_double_precision => judge_inside("inside_by_direction", |kit, queries| kit.inside_by_direction(queries), &[])
    inside::inside_by_areas_gives_barycentric_coordinates
    backfaces::backfacing_is_the_sign_of_n_dot_d
    backfaces::backfacing_is_false_for_what_is_seen_edge_on: turned
    backfaces::backfacing_has_no_smallest_size
    attributes::interpolation_weighs_the_corners
    attributes::face_normal_has_unit_length_at_any_size
    vertex_normals::vertex_normals_average_their_faces
    vertex_normals::vertex_normals_that_cancel_are_still_normals: turned
    closest::brute_force_finds_the_closest_of_all
    closest::brute_force_prefers_the_smaller_number: turned
    golden::hit_table_of_a_fan: composed
    golden::picture_of_an_octahedron: composed
] }
