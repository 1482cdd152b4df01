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

use checks::nasty::unit;
use checks::prelude::*;

/// A direction that leaves a surface, and the normal on the side to which it goes.
fn unit_arrival() -> impl Strategy<Value = (Vec3, Vec3)> + Clone {
    (unit(), unit())
        .prop_map(|(ideal, normal)| (ideal, if normal.dot(ideal) < 0.0 { -normal } else { normal }))
}

checks::stage! { ($ crate) 6 [
    pixels::jittered_samples_stay_in_their_cells
    pixels::jittered_samples_cover_the_pixel_evenly
    pixels::each_sampler_has_its_places
    pixels::gaussian_weight_is_a_bell_that_ends
    pixels::filter_pixel_is_the_weighted_mean
    pixels::filter_pixel_of_no_samples_is_black
    lens::places_on_the_disk_are_places
    lens::places_on_the_disk_are_even
    lens::lens_without_width_is_a_pinhole
    lens::lens_rays_start_on_the_lens
    lens::focal_plane_is_sharp
    lens::lens_is_as_sharp_a_million_units_away
    area_lights::places_on_a_rectangle_are_even
    area_lights::places_on_a_round_light_are_even
    area_lights::directions_to_a_sphere_are_even
    area_lights::a_far_sphere_is_still_a_sphere
    area_lights::from_inside_a_sphere_it_is_everywhere
    area_lights::half_a_sphere_makes_half_a_shadow
    rough::smooth_surfaces_stay_sharp
    rough::phong_lobe_falls_with_the_power_of_the_cosine
    rough::slightly_rough_is_not_a_few_angles
    rough::phong_lobe_stays_on_its_side
    motion::temporal_table_has_each_time_once
    motion::times_lie_in_their_slots
    motion::times_are_even
    motion::lerp_is_exact_where_it_must
    motion::lerp_stays_on_the_way
    motion::motion_bounds_covers_the_way_and_no_more
    table::table_of_the_samples_of_a_pixel: composed
    picture::picture_of_soft_edges: composed
] }
