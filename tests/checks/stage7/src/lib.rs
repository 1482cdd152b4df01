//! Checks of stage 7: effects.
//!
//! `lights` · `materials` · `whole` (scenes) · `dark` (scenes without light) ·
//! `filmed` (lens and shutter) · `rays` (the bound on rays) · `hits` (rays of
//! known hits, number of samples) · `texels` · `images` (textures) · `scenes` (test scenes) ·
//! `table` · `picture`

mod dark;
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

checks::stage! { ($ crate) 7 [
    lights::lights_take_what_they_are
    materials::materials_take_what_they_show
    whole::a_plain_scene_takes_nothing_special
    whole::what_is_not_shown_takes_nothing
    dark::what_nothing_lights_needs_nothing
    filmed::lens_and_time_matter_only_where_they_are_seen
    whole::every_subset_of_effects_is_recognised
    rays::shadow_arithmetic_of_the_lecture
    rays::bound_follows_the_bounces
    rays::bound_stays_at_the_largest_number
    hits::rays_of_hits_are_exact
    hits::samples_reach_the_error_that_is_asked_for
    texels::texels_wrap_as_they_should
    images::middles_of_pixels_show_the_pixel
    images::images_are_blended
    table::table_of_effects: composed
    picture::picture_of_an_image_on_spheres: composed
] }
