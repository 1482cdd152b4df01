//! The checks of stage 12: speed.
//!
//! `flat` (flattened hierarchies) · `bins`, `splits`, `partitions` (the steps of the binned builder) · `builds`, `forks`
//! (whole trees, and their work and span) · `wide_trees` (eight children per node) · `slabs`, `blocks` (eight boxes and eight
//! triangles at once) · `searches`, `visits` (what searches find, and what they cost) · `table` · `picture`. `trees`, `wide_tables` and `scenes` make
//! inputs; `bars` has the counts of the reference.
//!
//! No check reads a clock: speed is judged by the counts that decide it.

pub mod bars;
mod bins;
mod blocks;
mod builds;
mod flat;
pub mod forks;
mod partitions;
mod picture;
pub mod scenes;
mod searches;
mod slabs;
mod splits;
mod table;
pub mod trees;
pub mod visits;
pub mod wide_tables;
mod wide_trees;

checks::stage! { ($ crate) 12 [
    flat::flatten_is_depth_first
    flat::flatten_of_one_leaf_and_of_nothing
    bins::fill_bins_counts_every_primitive
    bins::fill_bins_boxes_hold_their_primitives
    bins::fill_bins_takes_special_numbers
    splits::block_cost_counts_whole_blocks
    splits::cheapest_split_is_the_cheapest
    splits::cheapest_split_returns_its_cost
    splits::cheapest_split_leaves_no_side_empty
    partitions::partition_bins_puts_the_left_side_first => judge_all(&[], partitions::queries(true, 0..=0))
    partitions::partition_bins_agrees_with_the_bins
    partitions::partition_bins_of_one_side
    builds::build_binned_holds_every_primitive_once
    builds::build_binned_boxes_are_tight
    builds::build_binned_makes_leaves_that_pay
    builds::build_binned_costs_little_more_than_a_sweep: turned
    builds::build_binned_ends_where_centroids_are_equal
    builds::build_binned_is_not_too_deep
    forks::build_parallel_gives_the_same_tree
    forks::build_parallel_logs_the_nodes_that_it_forks
    forks::build_parallel_has_a_third_of_the_span => judge_span(30_000, 3)
    forks::build_parallel_has_a_fifth_of_the_span => judge_span(100_000, 5)
    wide_trees::collapse_keeps_every_leaf
    wide_trees::collapse_of_one_leaf_and_of_nothing
    wide_trees::collapse_costs_least
    wide_trees::collapse_fills_its_leaves
    slabs::enter_boxes_agrees_with_one_box_at_a_time
    slabs::enter_boxes_takes_zeros_and_faces
    slabs::enter_boxes_hits_the_corners_it_is_aimed_at
    slabs::enter_boxes_of_any_size
    slabs::enter_boxes_respects_the_range
    slabs::enter_boxes_enters_no_empty_place
    blocks::may_hit_keeps_what_is_hit
    blocks::may_hit_keeps_hits_at_the_ends_of_the_range
    blocks::may_hit_loses_no_ray_at_an_edge
    blocks::may_hit_of_any_size
    blocks::may_hit_keeps_lanes_without_a_triangle
    blocks::may_hit_rejects_rays_beside_a_triangle
    blocks::may_hit_rejects_hits_outside_of_the_range
    searches::wide_closest_hit_agrees_with_brute_force
    searches::wide_closest_hit_prefers_the_smaller_number
    searches::wide_closest_hit_enters_only_boxes_it_meets
    visits::wide_closest_hit_skips_what_lies_behind: turned
    visits::wide_closest_hit_takes_180_percent_of_the_calls => judge_calls(180): turned
    visits::wide_closest_hit_takes_155_percent_of_the_calls => judge_calls(155): turned
    visits::wide_closest_hit_takes_130_percent_of_the_calls => judge_calls(130): turned
    visits::wide_closest_hit_takes_105_percent_of_the_calls => judge_calls(105): turned
    searches::wide_any_hit_agrees_with_brute_force
    searches::wide_any_hit_stops_at_the_first
    searches::wide_any_hit_enters_only_boxes_it_meets
    table::table_of_bins_and_trees: composed
    picture::picture_of_a_winding_ramp: composed
    forks::build_parallel_has_an_eighth_of_the_span
] }
