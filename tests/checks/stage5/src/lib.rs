//! The checks of stage 5: mirrors and glass.
//!
//! `directions` (reflection and refraction), `fresnel` (reflectance), `scatter` (secondary rays and their weights),
//! `weights` (the limit on the weight), `spawn` (origins of secondary rays), `trees` (whole ray trees, counted).

mod directions;
mod fresnel;
mod scatter;
mod spawn;
mod trees;
mod weights;

use directions::{
    reflect_keeps_the_angle, reflect_stays_of_unit_length_in_a_corridor,
    refract_beyond_the_critical_angle_is_nothing, refract_goes_straight_where_it_must, refract_obeys_snell,
    refract_survives_rounded_directions,
};
use fresnel::{fresnel_exact_agrees_with_double_precision, fresnel_schlick_agrees_with_double_precision};
use scatter::{
    scatter_are_not_traced_in_vain, scatter_leave_glass_as_they_entered,
    scatter_totally_reflected_are_not_refracted, scatter_weigh_what_the_surface_says,
};
use spawn::rays_that_go_on_leave_their_surface;
use trees::{
    facing_mirrors_end, tree_ends_at_its_depth, tree_ends_where_children_count_too_little,
    tree_of_a_glass_sphere,
};
use weights::scatter_count_by_their_own_weight;

checks::stage! { ($ crate) 5 [
    reflect_keeps_the_angle
    reflect_stays_of_unit_length_in_a_corridor
    refract_obeys_snell
    refract_goes_straight_where_it_must
    refract_beyond_the_critical_angle_is_nothing
    refract_survives_rounded_directions
    fresnel_schlick_agrees_with_double_precision
    fresnel_exact_agrees_with_double_precision
    scatter_weigh_what_the_surface_says
    scatter_leave_glass_as_they_entered
    scatter_totally_reflected_are_not_refracted
    scatter_are_not_traced_in_vain
    scatter_count_by_their_own_weight
    rays_that_go_on_leave_their_surface
    tree_ends_at_its_depth
    tree_ends_where_children_count_too_little
    facing_mirrors_end
    tree_of_a_glass_sphere
] }
