//! Stage 3: bounding volume hierarchies.
//!
//! `boxes` · `slabs` · `splits` · `cuts` (`divided` judges the answers of both) · `builds` · `searches` · `stadium`
//! (counted costs) · `picture`

mod boxes;
mod builds;
mod cuts;
mod divided;
mod picture;
mod search_mistakes;
mod searches;
mod slab_mistakes;
mod slabs;
mod splits;
mod stadium;

use boxes::{
    bounds_of_a_sphere_hold_it, bounds_of_a_triangle_are_tight, centroid_is_the_middle,
    surface_area_counts_six_faces, union_holds_both_boxes,
};
use builds::{
    build_ends_where_all_centroids_are_one, build_holds_every_primitive_once,
    build_isolates_what_is_not_a_number, build_of_nothing_and_of_one, object_median_is_balanced,
    trees_of_eight_boxes,
};
use cuts::surface_area_heuristic_finds_the_cheapest_cut;
use picture::picture_of_depth;
use searches::{
    any_hit_agrees_with_brute_force, any_hit_stops_at_the_first, closest_hit_agrees_with_brute_force,
    closest_hit_both_agrees_with_brute_force, closest_hit_both_enters_only_boxes_it_meets,
};
use slabs::{
    slab_agrees_with_double_precision, slab_hits_the_corners_it_is_aimed_at,
    slab_is_entered_at_once_from_inside, slab_is_hit_by_rays_within_a_face, slab_misses_the_empty_box,
    slab_of_a_flat_box_is_hit, slab_respects_the_range, slab_takes_zeros_of_either_sign,
};
use splits::{
    object_median_makes_equal_halves, spatial_median_cuts_in_the_middle,
    spatial_median_never_leaves_a_side_empty, surface_area_heuristic_survives_zero_area,
};
use stadium::{
    closest_hit_skips_what_lies_behind, each_split_strategy_is_worth_its_cost,
    surface_area_heuristic_is_cheap_in_a_stadium,
};

checks::stage! { ($ crate) 3 [
    bounds_of_a_triangle_are_tight
    bounds_of_a_sphere_hold_it
    union_holds_both_boxes
    centroid_is_the_middle
    surface_area_counts_six_faces
    slab_agrees_with_double_precision
    slab_is_entered_at_once_from_inside
    slab_takes_zeros_of_either_sign: turned
    slab_is_hit_by_rays_within_a_face: turned
    slab_of_a_flat_box_is_hit: turned
    slab_respects_the_range: turned
    slab_misses_the_empty_box: turned
    slab_hits_the_corners_it_is_aimed_at
    object_median_makes_equal_halves
    spatial_median_cuts_in_the_middle
    spatial_median_never_leaves_a_side_empty: turned
    surface_area_heuristic_finds_the_cheapest_cut
    surface_area_heuristic_survives_zero_area: turned
    build_holds_every_primitive_once
    build_ends_where_all_centroids_are_one: turned
    build_of_nothing_and_of_one: turned
    build_isolates_what_is_not_a_number: turned
    object_median_is_balanced: turned
    surface_area_heuristic_is_cheap_in_a_stadium: turned
    trees_of_eight_boxes: composed
    closest_hit_both_agrees_with_brute_force
    closest_hit_both_enters_only_boxes_it_meets
    closest_hit_agrees_with_brute_force
    closest_hit_skips_what_lies_behind: turned
    any_hit_agrees_with_brute_force
    any_hit_stops_at_the_first
    each_split_strategy_is_worth_its_cost: turned
    picture_of_depth: composed
] }
