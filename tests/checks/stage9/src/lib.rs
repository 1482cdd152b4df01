//! The checks of stage 9: partitions of space.
//!
//! `resolutions` (and the interval of a ray in a cell) · `grids` · `octrees` · `kd_trees` · `heuristics` · `bsps` ·
//! `bsp_searches` · `polygon_bsps` · `polygon_bsp_searches` · `coherence` · `table` · `picture`. Shared modules: `scenes`
//! (primitives and rays), `structures` (simple builders), `searches` (calls a search and judges its answer), `visits`
//! (judges its visits), `search_mistakes`, `plane_mistakes` and `octant_mistakes` (searches with one mistake each), `parts`
//! (the interval of a ray in each node), `lists` (judges the lists of cells), `hulls` (judges trees over hulls).

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
mod visits;

checks::stage! { ($ crate) 9 [
    resolutions::spans_of_cells_agree_with_double_precision
    resolutions::grid_resolution_makes_cubes
    resolutions::grid_resolution_of_flat_and_empty_boxes: turned
    grids::grid_lists_what_reaches_into_cells
    searches::grid_search_agrees_with_brute_force => agrees(&searches::GRID)
    grids::grid_hit_beyond_its_cell_waits: turned
    grids::grid_visits_cells_in_order_and_stops
    grids::grid_steps_do_not_add_up_roundings: turned
    grids::grid_takes_rays_through_corners_and_faces: turned
    octrees::octree_lists_what_reaches_into_leaves
    octrees::octree_divides_where_there_is_much
    octrees::octree_build_ends: turned
    searches::octree_by_cells_agrees_with_brute_force => agrees(&searches::OCTREE_BY_CELLS)
    octrees::octree_by_cells_goes_along_edges => along_edges(&searches::OCTREE_BY_CELLS): turned
    searches::octree_by_neighbours_agrees_with_brute_force => agrees(&searches::OCTREE_BY_NEIGHBOURS)
    octrees::octree_by_neighbours_goes_along_edges => along_edges(&searches::OCTREE_BY_NEIGHBOURS): turned
    octrees::octree_by_neighbours_visits_no_node_again: turned
    searches::octree_search_agrees_with_brute_force => agrees(&searches::OCTREE)
    octrees::octree_sorts_octants_that_are_entered_at_one_t => along_edges(&searches::OCTREE): turned
    octrees::octree_hit_beyond_its_octant_waits: turned
    octrees::octree_visits_what_the_ray_enters_before_its_hit: turned
    kd_trees::kd_tree_lists_what_reaches_into_leaves
    kd_trees::kd_tree_build_ends: mirrored
    heuristics::kd_cuts_across_the_longest_side: mirrored
    heuristics::kd_balances_counts: mirrored
    heuristics::kd_avoids_straddlers: mirrored
    heuristics::kd_cuts_off_empty_space: mirrored
    heuristics::kd_stops_at_overlap: mirrored
    searches::kd_search_agrees_with_brute_force => agrees(&searches::KD_TREE)
    kd_trees::kd_finds_a_wall_on_the_face_of_the_box: turned
    kd_trees::hits_at_a_face_are_compared_with_each_other: turned
    kd_trees::hits_at_one_t_in_cells_prefer_the_smaller_number: turned
    kd_trees::kd_hit_beyond_its_leaf_waits: turned
    kd_trees::kd_rays_in_the_plane_search_both_sides: turned
    kd_trees::kd_search_visits_what_the_ray_enters_before_its_hit: turned
    bsps::bsp_lists_what_reaches_into_leaves
    bsps::bsp_build_ends: turned
    bsps::bsp_cuts_along_polygons: turned
    bsp_searches::bsp_search_agrees_with_brute_force
    bsp_searches::bsp_planes_behind_and_beyond_do_not_end_the_search: turned
    bsp_searches::bsp_takes_rays_on_and_along_planes: turned
    bsp_searches::bsp_search_visits_what_the_ray_enters_before_its_hit: turned
    polygon_bsps::polygon_bsp_puts_polygons_on_planes
    polygon_bsps::polygon_bsp_build_ends: turned
    polygon_bsps::polygon_bsp_splits_few_polygons: turned
    polygon_bsp_searches::polygon_bsp_search_agrees_with_brute_force
    polygon_bsp_searches::polygon_bsp_takes_rays_on_and_along_planes: turned
    polygon_bsp_searches::polygon_bsp_visits_what_the_ray_enters_before_its_hit: turned
    coherence::cached_hit_changes_no_answer
    coherence::cached_hit_saves_tests: turned
    coherence::packet_finds_what_single_rays_find
    coherence::packet_opens_a_node_once: turned
    table::map_of_the_cells_on_the_way: composed
    picture::picture_searched_in_six_structures: composed
] }
