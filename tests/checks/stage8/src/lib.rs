//! Checks of stage 8: scene graph, solids and curved surfaces.
//!
//! `spaces` (rays, normals) · `placements` · `boxes` (after transforms) · `bounding_spheres` (around points) · `graph`
//! (searches; `child_cache`: with a cache in each node) · `solid` (one description per solid) · `solids` (laws for all
//! solids) · `mistakes` (known mistakes in them) · `hard`, `flat` (pitfalls of their formulas) · `surfaces` (patches) ·
//! `splines` (B-spline and NURBS surfaces) · `subdivision` (meshes; `quarters`: their triangles; `loop_weights`: where
//! vertices go) · `table` · `picture`

mod bounding_spheres;
mod boxes;
mod child_cache;
mod flat;
mod graph;
mod hard;
mod loop_weights;
mod mistakes;
mod picture;
mod placements;
mod quarters;
mod solid;
mod solids;
mod spaces;
mod splines;
mod subdivision;
mod surfaces;
mod table;

checks::stage! { ($ crate) 8 [
    spaces::rays_pass_the_same_points_in_every_space
    spaces::rays_keep_their_t_in_every_space
    spaces::normals_are_at_right_angles_to_the_surface
    spaces::normals_stay_outside_in_a_mirror
    placements::placement_multiplies_in_the_right_order
    placements::placement_refuses_what_cannot_be_undone
    boxes::boxes_hold_what_they_should_after_transforms => judge_contents(boxes::ROUNDINGS)
    boxes::boxes_have_little_room_after_transforms
    bounding_spheres::sphere_holds_all_points
    bounding_spheres::sphere_is_small
    bounding_spheres::enter_bounding_sphere_finds_what_is_met
    bounding_spheres::enter_bounding_sphere_passes_what_is_missed
    boxes::volumes_are_rounded_outwards
    graph::graph_finds_the_closest_hit
    graph::graph_asks_for_everything_without_savings
    graph::graph_asks_for_volumes_first
    graph::graph_skips_what_begins_beyond_the_hit
    graph::graph_looks_into_the_nearest_first
    graph::graph_prefers_the_smaller_number
    child_cache::child_cache_changes_no_answer
    child_cache::child_cache_goes_first
    child_cache::child_cache_stores_the_way_to_the_hit
    solids::cuboid_agrees_with_exact_arithmetic
    solids::cuboid_normals_point_outwards
    solids::cuboid_keeps_to_the_rules
    hard::cuboid_seen_along_its_faces
    solids::cylinder_agrees_with_exact_arithmetic
    solids::cylinder_normals_point_outwards
    solids::cylinder_keeps_to_the_rules
    hard::cylinder_seen_along_its_axis: turned
    hard::cylinder_at_its_rim: turned
    solids::cone_agrees_with_exact_arithmetic
    solids::cone_normals_point_outwards
    solids::cone_keeps_to_the_rules
    hard::cone_is_not_its_mirror_image: turned
    hard::cone_seen_along_its_side: turned
    hard::cone_at_its_tip_and_rim: turned
    flat::disk_agrees_with_exact_arithmetic
    solids::disk_keeps_to_the_rules
    solids::polygon_agrees_with_exact_arithmetic
    solids::polygon_keeps_to_the_rules
    flat::polygon_at_edges_and_corners
    surfaces::bezier_starts_and_ends_at_its_corners
    surfaces::bezier_point_is_the_mean_of_its_net
    splines::bspline_basis_follows_the_recursion
    splines::bspline_basis_sums_to_one
    splines::nurbs_point_is_the_weighted_mean_of_its_net
    splines::nurbs_arcs_are_exact
    subdivision::loop_makes_four_triangles_of_each
    loop_weights::loop_places_vertices_by_the_rule => judge_weights(false)
    loop_weights::loop_borders_depend_on_borders => judge_weights(true)
    table::table_of_curved_surfaces: composed
    picture::picture_of_placed_solids: composed
] }
