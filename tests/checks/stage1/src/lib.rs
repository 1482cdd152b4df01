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
    spheres::sphere_algebraic_agrees_with_double_precision => sphere_agrees(sphere_method::ALGEBRAIC)
    spheres::sphere_algebraic_starts_inside => sphere_from_inside(sphere_method::ALGEBRAIC)
    spheres::sphere_algebraic_counts_lengths_of_the_direction => sphere_scaled(sphere_method::ALGEBRAIC)
    spheres::sphere_algebraic_respects_the_range => sphere_in_range(sphere_method::ALGEBRAIC): turned
    spheres::sphere_algebraic_far_away_and_tiny => sphere_far(sphere_method::ALGEBRAIC)
    spheres::sphere_algebraic_touches => sphere_tangent(sphere_method::ALGEBRAIC): turned
    spheres::sphere_algebraic_leaves_the_surface => sphere_on_surface(sphere_method::ALGEBRAIC): turned
    spheres::sphere_geometric_agrees_with_double_precision => sphere_agrees(sphere_method::GEOMETRIC)
    spheres::sphere_geometric_starts_inside => sphere_from_inside(sphere_method::GEOMETRIC)
    spheres::sphere_geometric_counts_lengths_of_the_direction => sphere_scaled(sphere_method::GEOMETRIC)
    spheres::sphere_geometric_respects_the_range => sphere_in_range(sphere_method::GEOMETRIC): turned
    spheres::sphere_geometric_far_away_and_tiny => sphere_far(sphere_method::GEOMETRIC)
    spheres::sphere_geometric_touches => sphere_tangent(sphere_method::GEOMETRIC): turned
    spheres::sphere_geometric_leaves_the_surface => sphere_on_surface(sphere_method::GEOMETRIC): turned
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
