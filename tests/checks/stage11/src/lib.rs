//! The checks of stage 11: light transport.
//!
//! `directions` (cosine-weighted directions) · `emitters` (inputs, and their geometry in double precision) · `lights` (samples of
//! emitters) · `light_densities` (and their densities) · `irradiance` (closed forms) · `weights` (multiple importance sampling) ·
//! `roulette` · `bounces` · `integrating_sphere` · `lobes` (the choice of a lobe) · `contributions` (light that counts) · `steps`
//! (one step of a path) · `light_steps` (its light sample) · `rooms` (geometry for whole paths) · `references` (their closed
//! forms) · `called_for` (what scenes need) · `table` · `picture` · `room_picture`
//!
//! Distributions are judged by [`checks::statistics`], with 1 false alarm in 10 million per test.

mod bounces;
mod called_for;
mod contributions;
mod directions;
mod emitters;
mod integrating_sphere;
mod irradiance;
mod light_densities;
mod light_steps;
mod lights;
mod lobes;
mod picture;
mod references;
mod room_picture;
mod rooms;
mod roulette;
mod steps;
mod table;
mod weights;

checks::stage! { ($ crate) 11 [
    directions::cosine_directions_stay_above_the_surface
    directions::cosine_directions_have_their_density
    directions::cosine_pdf_is_the_cosine_over_pi
    directions::cosine_pdf_below_the_surface_is_zero
    lights::light_samples_lie_on_the_light
    lights::dark_sides_send_no_light
    light_densities::light_samples_have_their_density
    light_densities::light_pdf_integrates_to_one
    light_densities::light_pdf_is_that_of_the_sample
    light_densities::light_pdf_beside_the_light_is_zero
    light_densities::far_sphere_lights_keep_their_density
    irradiance::polygon_lights_give_lamberts_irradiance
    irradiance::sphere_lights_give_their_irradiance
    weights::mis_weights_sum_to_one
    weights::mis_weight_of_a_lone_density_is_one: turned
    weights::mis_weight_survives_extreme_densities
    weights::mis_weights_keep_the_variance_low
    roulette::roulette_keeps_the_mean
    roulette::roulette_ends_no_young_path: turned
    roulette::roulette_ends_paths_without_weight: turned
    integrating_sphere::paths_in_an_integrating_sphere_find_its_light
    bounces::cut_off_is_the_light_beyond_the_last_bounce
    bounces::bounces_for_error_is_the_smallest_number
    bounces::bounces_for_error_at_the_limits: turned
    lobes::bsdf_samples_choose_lobes_that_reflect
    lobes::bsdf_weights_are_divided_by_the_probability
    lobes::bsdf_samples_keep_the_light
    lobes::diffuse_samples_use_fresh_numbers
    lobes::bsdf_pdf_is_that_of_the_sample
    lobes::bsdf_pdf_of_other_directions_is_zero
    contributions::light_contributions_have_their_closed_form
    contributions::light_from_below_adds_nothing
    contributions::emission_counts_by_its_weight
    steps::steps_collect_the_emission
    light_steps::steps_sample_the_light
    light_steps::steps_ask_for_no_useless_shadow_ray
    steps::steps_end_at_the_greatest_depth
    steps::steps_continue_with_the_weight_of_the_sample
    references::paths_in_a_furnace_count_every_bounce
    references::paths_in_a_furnace_find_all_light
    references::paths_of_a_white_corner_lose_nothing: turned
    references::paths_in_a_corner_find_its_sky
    references::steps_in_an_integrating_sphere_find_its_light
    references::steps_count_sampled_light_once
    references::steps_find_light_in_a_mirror
    references::steps_in_an_empty_cornell_box_agree_with_radiosity
    called_for::no_paths_without_indirect_light
    called_for::every_source_of_light_calls_for_paths
    called_for::paths_are_called_for_channel_by_channel
    called_for::lights_are_sampled_where_they_can_be
    table::table_of_closed_rooms: composed
    picture::picture_of_a_sphere_and_its_light: composed
    room_picture::picture_of_a_room: composed
] }
