//! The checks of stage 12: speed.
//!
//! `flat` (flattened hierarchies) · `bins`, `splits`, `partitions` (the steps of the binned builder) · `builds`, `forks`
//! (whole trees, and their work and span) · `wide_trees` (eight children per node) · `slabs`, `blocks` (eight boxes and four
//! triangles at once) · `searches`, `visits` (what searches find, and what they cost) · `table` · `picture`. A bonus are
//! `places`, `reinsertions`, `moves` (trees that are improved), `orders` and `streams` (many rays at once). `trees`,
//! `wide_tables` and `scenes` make inputs; `bars` has the counts of the reference.
//!
//! No check reads a clock: speed is judged by the counts that decide it.

pub mod bars;
mod bins;
mod blocks;
mod builds;
mod flat;
pub mod forks;
mod moves;
mod orders;
mod partitions;
mod picture;
pub mod places;
pub mod reinsertions;
pub mod scenes;
mod searches;
mod slabs;
mod splits;
pub mod streams;
mod table;
pub mod trees;
pub mod visits;
pub mod wide_tables;
mod wide_trees;

use bins::{
    fill_bins_boxes_hold_their_primitives, fill_bins_counts_every_primitive, fill_bins_takes_special_numbers,
};
use blocks::{
    may_hit_keeps_hits_at_the_ends_of_the_range, may_hit_keeps_lanes_without_a_triangle,
    may_hit_keeps_what_is_hit, may_hit_loses_no_ray_at_an_edge, may_hit_of_any_size,
    may_hit_rejects_hits_outside_of_the_range, may_hit_rejects_rays_beside_a_triangle,
};
use builds::{
    build_binned_boxes_are_tight, build_binned_costs_little_more_than_a_sweep,
    build_binned_ends_where_centroids_are_equal, build_binned_holds_every_primitive_once,
    build_binned_is_not_too_deep, build_binned_isolates_what_is_not_a_number,
    build_binned_makes_leaves_that_pay,
};
use flat::{flatten_is_depth_first, flatten_of_one_leaf_and_of_nothing};
use forks::{
    build_parallel_gives_the_same_tree, build_parallel_has_a_fifth_of_the_span,
    build_parallel_has_a_third_of_the_span, build_parallel_has_an_eighth_of_the_span,
    build_parallel_logs_the_nodes_that_it_forks,
};
use moves::reinsert_makes_at_most_so_many_moves;
use orders::{
    stream_order_follows_the_curve_of_morton, stream_order_lists_every_ray_once, stream_order_of_flat_sets,
    stream_order_sorts_by_octant,
};
use partitions::{
    partition_bins_agrees_with_the_bins, partition_bins_of_one_side, partition_bins_puts_the_left_side_first,
};
use picture::picture_of_a_winding_ramp;
use places::{
    cheapest_place_has_the_smallest_increase, cheapest_place_opens_105_percent_of_the_nodes,
    cheapest_place_opens_150_percent_of_the_nodes, cheapest_place_returns_its_increase,
};
use reinsertions::{
    reinsert_ends_on_special_trees, reinsert_fits_the_boxes, reinsert_keeps_every_leaf,
    reinsert_never_costs_more, reinsert_of_any_size, reinsert_saves_half_as_much_as_the_reference,
    reinsert_saves_nine_tenths_as_much_as_the_reference,
};
use searches::{
    wide_any_hit_agrees_with_brute_force, wide_any_hit_enters_only_boxes_it_meets,
    wide_any_hit_stops_at_the_first, wide_closest_hit_agrees_with_brute_force,
    wide_closest_hit_enters_only_boxes_it_meets, wide_closest_hit_prefers_the_smaller_number,
};
use slabs::{
    enter_boxes_agrees_with_one_box_at_a_time, enter_boxes_enters_no_empty_place,
    enter_boxes_hits_the_corners_it_is_aimed_at, enter_boxes_of_any_size, enter_boxes_respects_the_range,
    enter_boxes_takes_zeros_and_faces,
};
use splits::{
    block_cost_counts_whole_blocks, cheapest_split_is_the_cheapest, cheapest_split_leaves_no_side_empty,
    cheapest_split_returns_its_cost,
};
use streams::{
    stream_closest_hits_agree_with_brute_force, stream_closest_hits_fetch_nothing_twice,
    stream_closest_hits_take_105_percent_of_the_calls, stream_closest_hits_take_130_percent_of_the_calls,
    stream_closest_hits_test_only_rays_that_enter,
};
use table::table_of_bins_and_trees;
use visits::{
    wide_closest_hit_skips_what_lies_behind, wide_closest_hit_takes_105_percent_of_the_calls,
    wide_closest_hit_takes_130_percent_of_the_calls, wide_closest_hit_takes_155_percent_of_the_calls,
    wide_closest_hit_takes_180_percent_of_the_calls,
};
use wide_trees::{
    collapse_fills_its_nodes, collapse_keeps_every_leaf, collapse_of_one_leaf_and_of_nothing,
    collapse_opens_the_largest_child,
};

checks::stage! { ($ crate) 12 [
    flatten_is_depth_first
    flatten_of_one_leaf_and_of_nothing
    fill_bins_counts_every_primitive
    fill_bins_boxes_hold_their_primitives
    fill_bins_takes_special_numbers
    block_cost_counts_whole_blocks
    cheapest_split_is_the_cheapest
    cheapest_split_returns_its_cost
    cheapest_split_leaves_no_side_empty
    partition_bins_puts_the_left_side_first
    partition_bins_agrees_with_the_bins
    partition_bins_of_one_side
    build_binned_holds_every_primitive_once
    build_binned_boxes_are_tight
    build_binned_makes_leaves_that_pay
    build_binned_costs_little_more_than_a_sweep: turned
    build_binned_ends_where_centroids_are_equal
    build_binned_is_not_too_deep
    build_binned_isolates_what_is_not_a_number
    build_parallel_gives_the_same_tree
    build_parallel_logs_the_nodes_that_it_forks
    build_parallel_has_a_third_of_the_span
    build_parallel_has_a_fifth_of_the_span
    collapse_keeps_every_leaf
    collapse_of_one_leaf_and_of_nothing
    collapse_opens_the_largest_child
    collapse_fills_its_nodes
    enter_boxes_agrees_with_one_box_at_a_time
    enter_boxes_takes_zeros_and_faces
    enter_boxes_hits_the_corners_it_is_aimed_at
    enter_boxes_of_any_size
    enter_boxes_respects_the_range
    enter_boxes_enters_no_empty_place
    may_hit_keeps_what_is_hit
    may_hit_keeps_hits_at_the_ends_of_the_range
    may_hit_loses_no_ray_at_an_edge
    may_hit_of_any_size
    may_hit_keeps_lanes_without_a_triangle
    may_hit_rejects_rays_beside_a_triangle
    may_hit_rejects_hits_outside_of_the_range
    wide_closest_hit_agrees_with_brute_force
    wide_closest_hit_prefers_the_smaller_number
    wide_closest_hit_enters_only_boxes_it_meets
    wide_closest_hit_skips_what_lies_behind: turned
    wide_closest_hit_takes_180_percent_of_the_calls: turned
    wide_closest_hit_takes_155_percent_of_the_calls: turned
    wide_closest_hit_takes_130_percent_of_the_calls: turned
    wide_closest_hit_takes_105_percent_of_the_calls: turned
    wide_any_hit_agrees_with_brute_force
    wide_any_hit_stops_at_the_first
    wide_any_hit_enters_only_boxes_it_meets
    table_of_bins_and_trees: composed
    picture_of_a_winding_ramp: composed
    build_parallel_has_an_eighth_of_the_span
    cheapest_place_has_the_smallest_increase
    cheapest_place_returns_its_increase
    cheapest_place_opens_150_percent_of_the_nodes: turned
    cheapest_place_opens_105_percent_of_the_nodes: turned
    reinsert_keeps_every_leaf
    reinsert_fits_the_boxes
    reinsert_never_costs_more
    reinsert_makes_at_most_so_many_moves
    reinsert_saves_half_as_much_as_the_reference: turned
    reinsert_saves_nine_tenths_as_much_as_the_reference: turned
    reinsert_ends_on_special_trees
    reinsert_of_any_size
    stream_order_lists_every_ray_once
    stream_order_sorts_by_octant
    stream_order_follows_the_curve_of_morton
    stream_order_of_flat_sets
    stream_closest_hits_agree_with_brute_force
    stream_closest_hits_fetch_nothing_twice
    stream_closest_hits_test_only_rays_that_enter
    stream_closest_hits_take_130_percent_of_the_calls: turned
    stream_closest_hits_take_105_percent_of_the_calls: turned
] }
