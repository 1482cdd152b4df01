//! Checks of stage 7: effects.
//!
//! `lights` · `materials` · `whole` (scenes) · `filmed` (lens and shutter) · `rays` (the bound on rays) · `hits` (rays of
//! known hits, number of samples) · `texels` · `images` (textures) · `scenes` (test scenes) ·
//! `table` · `picture`

mod filmed;
mod hits;
mod images;
mod lights;
mod materials;
mod picture;
mod rays;
mod scenes;
mod table;
mod texels;
mod whole;

use filmed::lens_and_time_matter_only_where_they_are_seen;
use hits::{rays_of_hits_are_exact, samples_reach_the_error_that_is_asked_for};
use images::{images_are_blended, images_survive_invalid_numbers, middles_of_pixels_show_the_pixel};
use lights::lights_take_what_they_are;
use materials::materials_take_what_they_show;
use picture::picture_of_an_image_on_spheres;
use rays::{bound_follows_the_bounces, bound_stays_at_the_largest_number, shadow_arithmetic_of_the_lecture};
use table::table_of_effects;
use texels::texels_wrap_as_they_should;
use whole::{
    a_plain_scene_takes_nothing_special, every_subset_of_effects_is_recognised,
    what_is_not_shown_takes_nothing,
};

checks::stage! { ($ crate) 7 [
    lights_take_what_they_are
    materials_take_what_they_show
    a_plain_scene_takes_nothing_special
    what_is_not_shown_takes_nothing
    lens_and_time_matter_only_where_they_are_seen
    every_subset_of_effects_is_recognised
    shadow_arithmetic_of_the_lecture
    bound_follows_the_bounces
    bound_stays_at_the_largest_number
    rays_of_hits_are_exact
    samples_reach_the_error_that_is_asked_for
    texels_wrap_as_they_should
    middles_of_pixels_show_the_pixel
    images_are_blended
    images_survive_invalid_numbers
    table_of_effects: composed
    picture_of_an_image_on_spheres: composed
] }
