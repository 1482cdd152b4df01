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

use picture::picture_of_a_sphere_on_a_plane;
use plane_equations::{
    plane_by_coefficients_agrees_with_double_precision, plane_by_coefficients_far_from_the_origin,
    plane_by_coefficients_is_missed_by_rays_along_it, plane_by_coefficients_takes_any_factor,
};
use planes::{
    face_forward_turns_the_normal_to_the_ray, plane_agrees_with_double_precision, plane_far_from_the_origin,
    plane_is_missed_by_rays_along_it,
};
use roots::{nearest_root_is_the_smaller_one_that_counts, nearest_root_of_nan_is_the_other_one};
use spheres::{
    sphere_algebraic_agrees_with_double_precision, sphere_algebraic_counts_lengths_of_the_direction,
    sphere_algebraic_far_away_and_tiny, sphere_algebraic_leaves_the_surface,
    sphere_algebraic_respects_the_range, sphere_algebraic_starts_inside,
    sphere_algebraic_survives_invalid_numbers, sphere_algebraic_touches,
    sphere_geometric_agrees_with_double_precision, sphere_geometric_counts_lengths_of_the_direction,
    sphere_geometric_far_away_and_tiny, sphere_geometric_leaves_the_surface,
    sphere_geometric_respects_the_range, sphere_geometric_starts_inside,
    sphere_geometric_survives_invalid_numbers, sphere_geometric_touches, sphere_normal_points_outwards,
};
use table::hit_table_of_a_sphere_on_a_plane;

checks::stage! { ($ crate) 1 [
    nearest_root_is_the_smaller_one_that_counts
    nearest_root_of_nan_is_the_other_one
    sphere_algebraic_agrees_with_double_precision
    sphere_algebraic_starts_inside
    sphere_algebraic_counts_lengths_of_the_direction
    sphere_algebraic_respects_the_range
    sphere_algebraic_far_away_and_tiny
    sphere_algebraic_touches: turned
    sphere_algebraic_leaves_the_surface: turned
    sphere_algebraic_survives_invalid_numbers: turned
    sphere_geometric_agrees_with_double_precision
    sphere_geometric_starts_inside
    sphere_geometric_counts_lengths_of_the_direction
    sphere_geometric_respects_the_range
    sphere_geometric_far_away_and_tiny
    sphere_geometric_touches: turned
    sphere_geometric_leaves_the_surface: turned
    sphere_geometric_survives_invalid_numbers: turned
    sphere_normal_points_outwards
    plane_agrees_with_double_precision
    plane_is_missed_by_rays_along_it: turned
    plane_far_from_the_origin
    plane_by_coefficients_agrees_with_double_precision
    plane_by_coefficients_takes_any_factor
    plane_by_coefficients_is_missed_by_rays_along_it: turned
    plane_by_coefficients_far_from_the_origin
    face_forward_turns_the_normal_to_the_ray
    hit_table_of_a_sphere_on_a_plane: composed
    picture_of_a_sphere_on_a_plane: composed
] }
