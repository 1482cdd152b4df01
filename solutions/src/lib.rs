//! A ray tracer, stage by stage. The files `stage1_shapes.rs`, `stage2_triangles.rs` … hold the exercises; everything
//! else connects them with the scaffold.

mod camera_rays; // nothing to do here: for frames
mod finder; // nothing to do here: for frames
mod glue; // nothing to do here
mod glue_structures; // nothing to do here
mod outlines; // nothing to do here: for frames
mod packets; // nothing to do here: for frames
mod placed; // nothing to do here: for frames
mod plan; // nothing to do here: for frames
mod probe; // nothing to do here: for frames
mod radiance; // nothing to do here: for frames
mod search; // nothing to do here: for frames
mod shape_tests; // nothing to do here: for frames
pub mod stage10_stability;
pub mod stage1_shapes;
pub mod stage2_triangles;
pub mod stage3_bvh;
pub mod stage4_shading;
pub mod stage5_recursion;
pub mod stage6_distribution;
pub mod stage7_effects;
pub mod stage8_scene_graph;
pub mod stage8_solids;
pub mod stage8_surfaces;
pub mod stage9_bsp;
pub mod stage9_cells;
pub mod stage9_coherence;
pub mod stage9_grid;
pub mod stage9_kd_tree;
pub mod stage9_octree;
mod structure; // nothing to do here: for frames
mod surfaces; // nothing to do here: for frames
mod tracer; // nothing to do here: for frames

pub use glue::Kit;
// <solution>
// canary-answers-9b1f6c52: where this line is, answers have leaked.
// </solution>
