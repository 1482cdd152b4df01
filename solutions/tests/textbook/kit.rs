use solutions::{
    stage7_effects, stage8_child_cache, stage8_scene_graph, stage8_solids, stage8_splines, stage8_surfaces,
    stage9_bsp, stage9_cells, stage9_coherence, stage9_grid, stage9_kd_tree, stage9_neighbours,
    stage9_octree, stage9_polygon_bsp, stage10_stability, stage11_light_transport, stage11_paths,
    stage12_build, stage12_search, stage12_simd, stage12_wide,
};

/// The functions of stages 1 to 6 of this test; those of later stages are the reference's.
#[derive(Clone, Copy)]
pub struct Kit;

mod functions {
    #[allow(unused_imports)]
    use raykata::kit::types::*;
    raykata::student_functions! { raykata::implement_student_functions }
}

impl raykata::kit::StudentKit for Kit {
    fn renderer() -> Option<&'static dyn raykata::kit::Frames> {
        None
    }
}
