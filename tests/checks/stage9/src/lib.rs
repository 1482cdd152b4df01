//! The checks of stage 9: partitions of space.
//!
//! `resolutions` (and the interval of a ray in a cell) · `grids` · `octrees` · `kd_trees` · `heuristics` · `bsps` ·
//! `bsp_searches` · `polygon_bsps` · `polygon_bsp_searches` · `coherence` · `table` · `picture`. Shared modules: `scenes`
//! (primitives and rays), `structures` (simple builders), `searches` (calls a search and judges its answer), `search_mistakes`,
//! `plane_mistakes` and `octant_mistakes` (searches with one mistake each), `parts` (the interval of a ray in each
//! node), `lists` (judges the lists of cells), `hulls` (judges trees over hulls).

mod bsp_searches;
mod bsps;
mod coherence;
mod grids;
mod heuristics;
mod hulls;
mod kd_trees;
mod lists;
mod octant_mistakes;
mod octrees;
mod parts;
mod picture;
mod plane_mistakes;
mod polygon_bsp_searches;
mod polygon_bsps;
mod resolutions;
mod scenes;
mod search_mistakes;
mod searches;
mod structures;
mod table;

use bsp_searches::{
    bsp_planes_behind_and_beyond_do_not_end_the_search, bsp_search_agrees_with_brute_force,
    bsp_search_visits_what_the_ray_enters_before_its_hit, bsp_takes_rays_on_and_along_planes,
};
use bsps::{bsp_build_ends, bsp_cuts_along_polygons, bsp_lists_what_reaches_into_leaves};
use coherence::{
    cached_hit_changes_no_answer, cached_hit_saves_tests, packet_finds_what_single_rays_find,
    packet_opens_a_node_once,
};
use grids::{
    grid_hit_beyond_its_cell_waits, grid_lists_what_reaches_into_cells, grid_search_agrees_with_brute_force,
    grid_steps_do_not_add_up_roundings, grid_takes_rays_through_corners_and_faces,
    grid_visits_cells_in_order_and_stops,
};
use heuristics::{
    kd_avoids_straddlers, kd_balances_counts, kd_cuts_across_the_longest_side, kd_cuts_off_empty_space,
    kd_stops_at_overlap,
};
use kd_trees::{
    hits_at_a_face_are_compared_with_each_other, kd_finds_a_wall_on_the_face_of_the_box,
    kd_hit_beyond_its_leaf_waits, kd_rays_in_the_plane_search_both_sides, kd_search_agrees_with_brute_force,
    kd_search_visits_what_the_ray_enters_before_its_hit, kd_tree_build_ends,
    kd_tree_lists_what_reaches_into_leaves,
};
use octrees::{
    octree_build_ends, octree_by_cells_agrees_with_brute_force, octree_by_cells_goes_along_edges,
    octree_by_neighbours_agrees_with_brute_force, octree_by_neighbours_goes_along_edges,
    octree_by_neighbours_visits_no_node_again, octree_divides_where_there_is_much,
    octree_hit_beyond_its_octant_waits, octree_lists_what_reaches_into_leaves,
    octree_search_agrees_with_brute_force, octree_sorts_octants_that_are_entered_at_one_t,
    octree_visits_what_the_ray_enters_before_its_hit,
};
use picture::picture_searched_in_six_structures;
use polygon_bsp_searches::{
    polygon_bsp_search_agrees_with_brute_force, polygon_bsp_takes_rays_on_and_along_planes,
    polygon_bsp_visits_what_the_ray_enters_before_its_hit,
};
use polygon_bsps::{
    polygon_bsp_build_ends, polygon_bsp_puts_polygons_on_planes, polygon_bsp_splits_few_polygons,
};
use resolutions::{
    grid_resolution_makes_cubes, grid_resolution_of_flat_and_empty_boxes,
    spans_of_cells_agree_with_double_precision,
};
use table::map_of_the_cells_on_the_way;

checks::stage! { ($ crate) 9 [
    spans_of_cells_agree_with_double_precision
    grid_resolution_makes_cubes
    grid_resolution_of_flat_and_empty_boxes: turned
    grid_lists_what_reaches_into_cells
    grid_search_agrees_with_brute_force
    grid_hit_beyond_its_cell_waits: turned
    grid_visits_cells_in_order_and_stops
    grid_steps_do_not_add_up_roundings: turned
    grid_takes_rays_through_corners_and_faces: turned
    octree_lists_what_reaches_into_leaves
    octree_divides_where_there_is_much
    octree_build_ends: turned
    octree_by_cells_agrees_with_brute_force
    octree_by_cells_goes_along_edges: turned
    octree_by_neighbours_agrees_with_brute_force
    octree_by_neighbours_goes_along_edges: turned
    octree_by_neighbours_visits_no_node_again: turned
    octree_search_agrees_with_brute_force
    octree_sorts_octants_that_are_entered_at_one_t: turned
    octree_hit_beyond_its_octant_waits: turned
    octree_visits_what_the_ray_enters_before_its_hit: turned
    kd_tree_lists_what_reaches_into_leaves
    kd_tree_build_ends: mirrored
    kd_cuts_across_the_longest_side: mirrored
    kd_balances_counts: mirrored
    kd_avoids_straddlers: mirrored
    kd_cuts_off_empty_space: mirrored
    kd_stops_at_overlap: mirrored
    kd_search_agrees_with_brute_force
    kd_finds_a_wall_on_the_face_of_the_box: turned
    hits_at_a_face_are_compared_with_each_other: turned
    kd_hit_beyond_its_leaf_waits: turned
    kd_rays_in_the_plane_search_both_sides: turned
    kd_search_visits_what_the_ray_enters_before_its_hit: turned
    bsp_lists_what_reaches_into_leaves
    bsp_build_ends: turned
    bsp_cuts_along_polygons: turned
    bsp_search_agrees_with_brute_force
    bsp_planes_behind_and_beyond_do_not_end_the_search: turned
    bsp_takes_rays_on_and_along_planes: turned
    bsp_search_visits_what_the_ray_enters_before_its_hit: turned
    polygon_bsp_puts_polygons_on_planes
    polygon_bsp_build_ends: turned
    polygon_bsp_splits_few_polygons: turned
    polygon_bsp_search_agrees_with_brute_force
    polygon_bsp_takes_rays_on_and_along_planes: turned
    polygon_bsp_visits_what_the_ray_enters_before_its_hit: turned
    cached_hit_changes_no_answer
    cached_hit_saves_tests: turned
    packet_finds_what_single_rays_find
    packet_opens_a_node_once: turned
    map_of_the_cells_on_the_way: composed
    picture_searched_in_six_structures: composed
] }
