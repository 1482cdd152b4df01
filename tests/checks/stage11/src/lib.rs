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

use bounces::{
    bounces_for_error_at_the_limits, bounces_for_error_is_the_smallest_number,
    cut_off_is_the_light_beyond_the_last_bounce,
};
use called_for::{
    every_source_of_light_calls_for_paths, lights_are_sampled_where_they_can_be,
    no_paths_without_indirect_light, paths_are_called_for_channel_by_channel,
};
use contributions::{
    emission_counts_by_its_weight, light_contributions_have_their_closed_form, light_from_below_adds_nothing,
};
use directions::{
    cosine_directions_have_their_density, cosine_directions_stay_above_the_surface,
    cosine_pdf_below_the_surface_is_zero, cosine_pdf_is_the_cosine_over_pi,
};
use integrating_sphere::paths_in_an_integrating_sphere_find_its_light;
use irradiance::{polygon_lights_give_lamberts_irradiance, sphere_lights_give_their_irradiance};
use light_densities::{
    far_sphere_lights_keep_their_density, light_pdf_beside_the_light_is_zero, light_pdf_integrates_to_one,
    light_pdf_is_that_of_the_sample, light_samples_have_their_density,
};
use light_steps::{steps_ask_for_no_useless_shadow_ray, steps_sample_the_light};
use lights::{dark_sides_send_no_light, light_samples_lie_on_the_light};
use lobes::{
    bsdf_pdf_is_that_of_the_sample, bsdf_pdf_of_other_directions_is_zero,
    bsdf_samples_choose_lobes_that_reflect, bsdf_samples_keep_the_light,
    bsdf_weights_are_divided_by_the_probability, diffuse_samples_use_fresh_numbers,
};
use picture::picture_of_a_sphere_and_its_light;
use references::{
    paths_in_a_corner_find_its_sky, paths_in_a_furnace_count_every_bounce, paths_in_a_furnace_find_all_light,
    paths_of_a_white_corner_lose_nothing, steps_count_sampled_light_once, steps_find_light_in_a_mirror,
    steps_in_an_empty_cornell_box_agree_with_radiosity, steps_in_an_integrating_sphere_find_its_light,
};
use room_picture::picture_of_a_room;
use roulette::{
    roulette_ends_no_bright_and_no_young_path, roulette_ends_paths_without_weight, roulette_keeps_the_mean,
};
use steps::{
    steps_collect_the_emission, steps_continue_with_the_weight_of_the_sample, steps_end_at_the_greatest_depth,
};
use table::table_of_closed_rooms;
use weights::{
    mis_weight_of_a_lone_density_is_one, mis_weight_survives_extreme_densities,
    mis_weights_keep_the_variance_low, mis_weights_sum_to_one,
};

checks::stage! { ($ crate) 11 [
    cosine_directions_stay_above_the_surface
    cosine_directions_have_their_density
    cosine_pdf_is_the_cosine_over_pi
    cosine_pdf_below_the_surface_is_zero
    light_samples_lie_on_the_light
    dark_sides_send_no_light
    light_samples_have_their_density
    light_pdf_integrates_to_one
    light_pdf_is_that_of_the_sample
    light_pdf_beside_the_light_is_zero
    far_sphere_lights_keep_their_density
    polygon_lights_give_lamberts_irradiance
    sphere_lights_give_their_irradiance
    mis_weights_sum_to_one
    mis_weight_of_a_lone_density_is_one
    mis_weight_survives_extreme_densities
    mis_weights_keep_the_variance_low
    roulette_keeps_the_mean
    roulette_ends_no_bright_and_no_young_path
    roulette_ends_paths_without_weight
    paths_in_an_integrating_sphere_find_its_light
    cut_off_is_the_light_beyond_the_last_bounce
    bounces_for_error_is_the_smallest_number
    bounces_for_error_at_the_limits
    bsdf_samples_choose_lobes_that_reflect
    bsdf_weights_are_divided_by_the_probability
    bsdf_samples_keep_the_light
    diffuse_samples_use_fresh_numbers
    bsdf_pdf_is_that_of_the_sample
    bsdf_pdf_of_other_directions_is_zero
    light_contributions_have_their_closed_form
    light_from_below_adds_nothing
    emission_counts_by_its_weight
    steps_collect_the_emission
    steps_sample_the_light
    steps_ask_for_no_useless_shadow_ray
    steps_end_at_the_greatest_depth
    steps_continue_with_the_weight_of_the_sample
    paths_in_a_furnace_count_every_bounce
    paths_in_a_furnace_find_all_light
    paths_of_a_white_corner_lose_nothing
    paths_in_a_corner_find_its_sky
    steps_in_an_integrating_sphere_find_its_light
    steps_count_sampled_light_once
    steps_find_light_in_a_mirror
    steps_in_an_empty_cornell_box_agree_with_radiosity
    no_paths_without_indirect_light
    every_source_of_light_calls_for_paths
    paths_are_called_for_channel_by_channel
    lights_are_sampled_where_they_can_be
    table_of_closed_rooms: composed
    picture_of_a_sphere_and_its_light: composed
    picture_of_a_room: composed
] }
