//! The checks of stage 11: light transport.
//!
//! `directions` (cosine-weighted directions), `emitters` (inputs, and their geometry in double precision), `lights` (samples of
//! emitters), `irradiance` (closed forms), `weights` (multiple importance sampling), `roulette`, `bounces`,
//! `integrating_sphere`, `table`, `picture`.
//!
//! Distributions are judged by [`checks::statistics`], with 1 false alarm in 10 million per test.

mod bounces;
mod directions;
mod emitters;
mod integrating_sphere;
mod irradiance;
mod lights;
mod picture;
mod roulette;
mod table;
mod weights;

use bounces::{
    bounces_for_error_at_the_limits, bounces_for_error_is_the_smallest_number,
    cut_off_is_the_light_beyond_the_last_bounce,
};
use directions::{
    cosine_directions_have_their_density, cosine_directions_stay_above_the_surface,
    cosine_pdf_below_the_surface_is_zero, cosine_pdf_is_the_cosine_over_pi,
};
use integrating_sphere::paths_in_an_integrating_sphere_find_its_light;
use irradiance::{polygon_lights_give_lamberts_irradiance, sphere_lights_give_their_irradiance};
use lights::{
    dark_sides_send_no_light, far_sphere_lights_keep_their_density, light_pdf_beside_the_light_is_zero,
    light_pdf_integrates_to_one, light_pdf_is_that_of_the_sample, light_samples_have_their_density,
    light_samples_lie_on_the_light,
};
use picture::picture_of_a_sphere_and_its_light;
use roulette::{
    roulette_ends_no_bright_and_no_young_path, roulette_ends_paths_without_weight, roulette_keeps_the_mean,
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
    table_of_closed_rooms: composed
    picture_of_a_sphere_and_its_light: composed
] }
