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

checks::stage! { ($ crate) 5 [
    directions::reflect_keeps_the_angle
    directions::reflect_stays_of_unit_length_in_a_corridor: turned
    directions::refract_obeys_snell
    directions::refract_goes_straight_where_it_must
    directions::refract_beyond_the_critical_angle_is_none
    directions::refract_survives_rounded_directions
    fresnel::fresnel_schlick_agrees_with_double_precision
    fresnel::fresnel_exact_agrees_with_double_precision
    scatter::scatter_weighs_rays_by_the_material
    scatter::scatter_swaps_indices_when_leaving_glass: turned
    scatter::scatter_refracts_nothing_in_total_reflection
    scatter::scatter_skips_rays_without_weight: turned
    weights::scatter_tests_the_weight_of_each_ray
    spawn::secondary_rays_leave_their_surface
    trees::tree_ends_at_its_depth: turned
    trees::tree_ends_below_min_contribution: turned
    trees::facing_mirrors_end: turned
    trees::tree_of_a_glass_sphere: composed
    picture::picture_of_a_mirror_and_glass: composed
] }
