//! The checks of stage 6: distributed ray tracing.
//!
//! `pixels` (samples and the filter), `lens` (depth of field), `area_lights`, `rough` (glossy reflection), `motion`
//! (times and motion blur), `table`, `picture`.
//!
//! Distributions are judged by [`checks::statistics`], with 1 false alarm in 10 million per test.

mod area_lights;
mod lens;
mod motion;
mod picture;
mod pixels;
mod rough;
mod table;

use area_lights::{
    a_far_sphere_is_still_a_sphere, directions_to_a_sphere_are_even, from_inside_a_sphere_it_is_everywhere,
    half_a_sphere_makes_half_a_shadow, places_on_a_rectangle_are_even, places_on_a_round_light_are_even,
};
use checks::nasty::unit;
use glam::Vec3;
use lens::{
    focal_plane_is_sharp, lens_is_as_sharp_a_million_units_away, lens_rays_start_on_the_lens,
    lens_without_width_is_a_pinhole, places_on_the_disk_are_even, places_on_the_disk_are_places,
};
use motion::{
    lerp_is_exact_where_it_must, lerp_stays_on_the_way, motion_bounds_covers_the_way_and_no_more,
    temporal_table_has_each_time_once, times_are_even, times_lie_in_their_slots,
};
use picture::picture_of_soft_edges;
use pixels::{
    each_sampler_has_its_places, filter_pixel_is_the_weighted_mean, filter_pixel_of_no_samples_is_black,
    gaussian_weight_is_a_bell_that_ends, jittered_samples_cover_the_pixel_evenly,
    jittered_samples_stay_in_their_cells,
};
use proptest::prelude::Strategy;
use rough::{
    phong_lobe_falls_with_the_power_of_the_cosine, phong_lobe_stays_on_its_side,
    slightly_rough_is_not_a_few_angles, smooth_surfaces_stay_sharp,
};
use table::table_of_the_samples_of_a_pixel;

/// A direction that leaves a surface, and the normal on the side to which it goes.
fn unit_arrival() -> impl Strategy<Value = (Vec3, Vec3)> + Clone {
    (unit(), unit())
        .prop_map(|(ideal, normal)| (ideal, if normal.dot(ideal) < 0.0 { -normal } else { normal }))
}

checks::stage! { ($ crate) 6 [
    jittered_samples_stay_in_their_cells
    jittered_samples_cover_the_pixel_evenly
    each_sampler_has_its_places
    gaussian_weight_is_a_bell_that_ends
    filter_pixel_is_the_weighted_mean
    filter_pixel_of_no_samples_is_black
    places_on_the_disk_are_places
    places_on_the_disk_are_even
    lens_without_width_is_a_pinhole
    lens_rays_start_on_the_lens
    focal_plane_is_sharp
    lens_is_as_sharp_a_million_units_away
    places_on_a_rectangle_are_even
    places_on_a_round_light_are_even
    directions_to_a_sphere_are_even
    a_far_sphere_is_still_a_sphere
    from_inside_a_sphere_it_is_everywhere
    half_a_sphere_makes_half_a_shadow
    smooth_surfaces_stay_sharp
    phong_lobe_falls_with_the_power_of_the_cosine
    slightly_rough_is_not_a_few_angles
    phong_lobe_stays_on_its_side
    temporal_table_has_each_time_once
    times_lie_in_their_slots
    times_are_even
    lerp_is_exact_where_it_must
    lerp_stays_on_the_way
    motion_bounds_covers_the_way_and_no_more
    table_of_the_samples_of_a_pixel: composed
    picture_of_soft_edges: composed
] }
