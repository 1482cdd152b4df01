//! The checks of stage 5: mirrors and glass.
//!
//! `directions` (reflection and refraction), `fresnel` (reflectance), `scatter` (secondary rays and their weights),
//! `weights` (the limit on the weight), `spawn` (origins of secondary rays), `trees` (whole ray trees, counted), `picture`.

mod directions;
mod fresnel;
mod picture;
mod scatter;
mod spawn;
mod trees;
mod weights;

use directions::{
    reflect_keeps_the_angle, reflect_stays_of_unit_length_in_a_corridor,
    refract_beyond_the_critical_angle_is_none, refract_goes_straight_where_it_must, refract_obeys_snell,
    refract_survives_rounded_directions,
};
use fresnel::{fresnel_exact_agrees_with_double_precision, fresnel_schlick_agrees_with_double_precision};
use picture::picture_of_a_mirror_and_glass;
use scatter::{
    scatter_refracts_nothing_in_total_reflection, scatter_skips_rays_without_weight,
    scatter_swaps_indices_when_leaving_glass, scatter_weighs_rays_by_the_material,
};
use spawn::secondary_rays_leave_their_surface;
use trees::{
    facing_mirrors_end, tree_ends_at_its_depth, tree_ends_below_min_contribution, tree_of_a_glass_sphere,
};
use weights::scatter_tests_the_weight_of_each_ray;

checks::stage! { ($ crate) 5 [
    reflect_keeps_the_angle
    reflect_stays_of_unit_length_in_a_corridor: turned
    refract_obeys_snell
    refract_goes_straight_where_it_must
    refract_beyond_the_critical_angle_is_none
    refract_survives_rounded_directions
    fresnel_schlick_agrees_with_double_precision
    fresnel_exact_agrees_with_double_precision
    scatter_weighs_rays_by_the_material
    scatter_swaps_indices_when_leaving_glass
    scatter_refracts_nothing_in_total_reflection
    scatter_skips_rays_without_weight
    scatter_tests_the_weight_of_each_ray
    secondary_rays_leave_their_surface
    tree_ends_at_its_depth: turned
    tree_ends_below_min_contribution: turned
    facing_mirrors_end: turned
    tree_of_a_glass_sphere: composed
    picture_of_a_mirror_and_glass: composed
] }
