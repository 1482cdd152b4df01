//! Stage 1: spheres and planes.
//!
//! `roots` · `spheres` (checks for both methods; `sphere_method` judges the answers, `sphere_mistakes` names mistakes) · `planes` · `plane_equations` · `table` · `picture`

mod picture;
mod plane_equations;
mod planes;
mod roots;
mod sphere_method;
mod sphere_mistakes;
mod spheres;
mod table;

checks::stage! { ($ crate) 1 [
    roots::nearest_root_is_the_smaller_one_that_counts
    roots::nearest_root_of_nan_is_the_other_one
    spheres::sphere_algebraic_agrees_with_double_precision
    spheres::sphere_algebraic_starts_inside
    spheres::sphere_algebraic_counts_lengths_of_the_direction
    spheres::sphere_algebraic_respects_the_range
    spheres::sphere_algebraic_far_away_and_tiny
    spheres::sphere_algebraic_touches: turned
    spheres::sphere_algebraic_leaves_the_surface: turned
    spheres::sphere_algebraic_survives_invalid_numbers: turned
    spheres::sphere_geometric_agrees_with_double_precision
    spheres::sphere_geometric_starts_inside
    spheres::sphere_geometric_counts_lengths_of_the_direction
    spheres::sphere_geometric_respects_the_range
    spheres::sphere_geometric_far_away_and_tiny
    spheres::sphere_geometric_touches: turned
    spheres::sphere_geometric_leaves_the_surface: turned
    spheres::sphere_geometric_survives_invalid_numbers: turned
    spheres::sphere_normal_points_outwards
    planes::plane_agrees_with_double_precision
    planes::plane_is_missed_by_rays_along_it: turned
    planes::plane_far_from_the_origin
    plane_equations::plane_by_coefficients_agrees_with_double_precision
    plane_equations::plane_by_coefficients_takes_any_factor
    plane_equations::plane_by_coefficients_is_missed_by_rays_along_it: turned
    plane_equations::plane_by_coefficients_far_from_the_origin
    planes::face_forward_turns_the_normal_to_the_ray
    table::hit_table_of_a_sphere_on_a_plane: composed
    picture::picture_of_a_sphere_on_a_plane: composed
] }
