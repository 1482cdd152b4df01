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

checks::stage! { ($ crate) 3 [
    boxes::bounds_of_a_triangle_are_tight
    boxes::bounds_of_a_sphere_hold_it
    boxes::union_holds_both_boxes
    boxes::centroid_is_the_middle
    boxes::surface_area_counts_six_faces
    slabs::slab_agrees_with_double_precision
    slabs::slab_is_entered_at_once_from_inside
    slabs::slab_takes_zeros_of_either_sign: turned
    slabs::slab_is_hit_by_rays_within_a_face: turned
    slabs::slab_of_a_flat_box_is_hit: turned
    slabs::slab_respects_the_range: turned
    slabs::slab_misses_the_empty_box: turned
    slabs::slab_hits_the_corners_it_is_aimed_at: turned
    splits::object_median_makes_equal_halves
    splits::spatial_median_cuts_in_the_middle
    splits::spatial_median_never_leaves_a_side_empty: turned
    cuts::surface_area_heuristic_finds_the_cheapest_cut
    splits::surface_area_heuristic_survives_zero_area: turned
    cuts::surface_area_heuristic_joins_no_side_again: turned
    builds::build_holds_every_primitive_once
    builds::build_ends_where_all_centroids_are_one: turned
    builds::build_of_nothing_and_of_one: turned
    builds::object_median_is_balanced: turned
    stadium::surface_area_heuristic_is_cheap_in_a_stadium: turned
    builds::trees_of_eight_boxes: composed
    searches::closest_hit_both_agrees_with_brute_force => agrees(|kit, queries| kit.closest_hit_both(queries))
    searches::closest_hit_both_enters_only_boxes_it_meets: turned
    searches::closest_hit_agrees_with_brute_force => agrees(|kit, queries| kit.closest_hit(queries))
    stadium::closest_hit_skips_what_lies_behind: turned
    searches::hits_at_one_t_prefer_the_smaller_number
    searches::any_hit_agrees_with_brute_force
    searches::any_hit_stops_at_the_first: turned
    stadium::each_split_strategy_is_worth_its_cost: turned
    picture::picture_of_depth: composed
] }
