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

use bounding_spheres::{
    enter_bounding_sphere_finds_what_is_met, enter_bounding_sphere_passes_what_is_missed,
    sphere_holds_all_points, sphere_is_small,
};
use boxes::{boxes_have_little_room_after_transforms, boxes_hold_what_they_should_after_transforms};
use child_cache::{
    child_cache_changes_no_answer, child_cache_goes_first, child_cache_stores_the_way_to_the_hit,
};
use flat::{disk_agrees_with_exact_arithmetic, polygon_at_edges_and_corners};
use graph::{
    graph_asks_for_everything_without_savings, graph_asks_for_volumes_first, graph_finds_the_closest_hit,
    graph_looks_into_the_nearest_first, graph_skips_what_begins_beyond_the_hit,
};
use hard::{
    cone_at_its_tip_and_rim, cone_is_not_its_mirror_image, cone_seen_along_its_side,
    cuboid_seen_along_its_faces, cylinder_at_its_rim, cylinder_seen_along_its_axis,
};
use loop_weights::{loop_borders_depend_on_borders, loop_places_vertices_by_the_rule};
use picture::picture_of_placed_solids;
use placements::{placement_multiplies_in_the_right_order, placement_refuses_what_cannot_be_undone};
use solids::{
    cone_agrees_with_exact_arithmetic, cone_keeps_to_the_rules, cone_normals_point_outwards,
    cuboid_agrees_with_exact_arithmetic, cuboid_keeps_to_the_rules, cuboid_normals_point_outwards,
    cylinder_agrees_with_exact_arithmetic, cylinder_keeps_to_the_rules, cylinder_normals_point_outwards,
    disk_keeps_to_the_rules, polygon_agrees_with_exact_arithmetic, polygon_keeps_to_the_rules,
};
use spaces::{
    normals_are_at_right_angles_to_the_surface, normals_stay_outside_in_a_mirror,
    rays_keep_their_t_in_every_space, rays_pass_the_same_points_in_every_space,
};
use splines::{
    bspline_basis_follows_the_recursion, bspline_basis_sums_to_one, nurbs_arcs_are_exact,
    nurbs_point_is_the_weighted_mean_of_its_net,
};
use subdivision::loop_makes_four_triangles_of_each;
use surfaces::{bezier_point_is_the_mean_of_its_net, bezier_starts_and_ends_at_its_corners};
use table::table_of_curved_surfaces;

checks::stage! { ($ crate) 8 [
    rays_pass_the_same_points_in_every_space
    rays_keep_their_t_in_every_space
    normals_are_at_right_angles_to_the_surface
    normals_stay_outside_in_a_mirror
    placement_multiplies_in_the_right_order
    placement_refuses_what_cannot_be_undone
    boxes_hold_what_they_should_after_transforms
    boxes_have_little_room_after_transforms
    sphere_holds_all_points
    sphere_is_small
    enter_bounding_sphere_finds_what_is_met
    enter_bounding_sphere_passes_what_is_missed
    graph_finds_the_closest_hit
    graph_asks_for_everything_without_savings
    graph_asks_for_volumes_first
    graph_skips_what_begins_beyond_the_hit
    graph_looks_into_the_nearest_first
    child_cache_changes_no_answer
    child_cache_goes_first
    child_cache_stores_the_way_to_the_hit
    cuboid_agrees_with_exact_arithmetic
    cuboid_normals_point_outwards
    cuboid_keeps_to_the_rules
    cuboid_seen_along_its_faces
    cylinder_agrees_with_exact_arithmetic
    cylinder_normals_point_outwards
    cylinder_keeps_to_the_rules
    cylinder_seen_along_its_axis: turned
    cylinder_at_its_rim
    cone_agrees_with_exact_arithmetic
    cone_normals_point_outwards
    cone_keeps_to_the_rules
    cone_is_not_its_mirror_image: turned
    cone_seen_along_its_side: turned
    cone_at_its_tip_and_rim
    disk_agrees_with_exact_arithmetic
    disk_keeps_to_the_rules
    polygon_agrees_with_exact_arithmetic
    polygon_keeps_to_the_rules
    polygon_at_edges_and_corners
    bezier_starts_and_ends_at_its_corners
    bezier_point_is_the_mean_of_its_net
    bspline_basis_follows_the_recursion
    bspline_basis_sums_to_one
    nurbs_point_is_the_weighted_mean_of_its_net
    nurbs_arcs_are_exact
    loop_makes_four_triangles_of_each
    loop_places_vertices_by_the_rule
    loop_borders_depend_on_borders
    table_of_curved_surfaces: composed
    picture_of_placed_solids: composed
] }
