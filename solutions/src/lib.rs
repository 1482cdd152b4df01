//! A ray tracer, stage by stage: one module per exercise file. The macro call below connects the
//! modules with the kit.

pub mod stage10_stability;
pub mod stage11_light_transport;
pub mod stage11_paths;
pub mod stage12_build;
pub mod stage12_search;
pub mod stage12_simd;
pub mod stage12_wide;
pub mod stage1_shapes;
pub mod stage2_triangles;
pub mod stage3_boxes;
pub mod stage3_build;
pub mod stage3_traversal;
pub mod stage4_shading;
pub mod stage5_recursion;
pub mod stage6_distribution;
pub mod stage7_effects;
pub mod stage8_child_cache;
pub mod stage8_scene_graph;
pub mod stage8_solids;
pub mod stage8_splines;
pub mod stage8_surfaces;
pub mod stage9_bsp;
pub mod stage9_cells;
pub mod stage9_coherence;
pub mod stage9_grid;
pub mod stage9_kd_tree;
pub mod stage9_neighbours;
pub mod stage9_octree;
pub mod stage9_polygon_bsp;

raykata::student_kit!();
// <solution>
/// The functions as a kit. It is compiled once, here, and not again in each program and test that
/// calls it.
pub fn kit() -> std::sync::Arc<dyn raykata::kit::Kit + Send + Sync> {
    raykata::kit::StudentKit::door(Kit)
}

// canary-answers-9b1f6c52: a text that contains this line contains leaked answers.
// </solution>
