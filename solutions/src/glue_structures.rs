//! Nothing to do here: this connects the functions of stages 8 and 9 with the door.

use crate::glue::{Kit, each};
use crate::{
    stage8_scene_graph, stage8_solids, stage8_surfaces, stage9_bsp, stage9_cells, stage9_coherence,
    stage9_grid, stage9_kd_tree, stage9_octree,
};
use glam::{Affine3A, UVec3, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::graph::Placement;
use raykata::kit::*;
use raykata::mesh::Mesh;
use raykata::partition::{Bsp, Cell, Grid, KdTree, Octree};
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon, Sphere};

impl SceneGraph for Kit {
    fn ray_to_object(&self, queries: &[ObjectRayQuery]) -> Vec<Ray> {
        each(queries, |q| stage8_scene_graph::ray_to_object(&q.ray, &q.to_object))
    }
    fn normal_to_world(&self, queries: &[NormalQuery]) -> Vec<Vec3> {
        each(queries, |q| stage8_scene_graph::normal_to_world(q.normal, &q.to_object))
    }
    fn placement(&self, queries: &[Vec<Affine3A>]) -> Vec<Option<Placement>> {
        each(queries, |path| stage8_scene_graph::placement(path))
    }
    fn bounds_to_world(&self, queries: &[BoundsQuery]) -> Vec<Aabb> {
        each(queries, |q| stage8_scene_graph::bounds_to_world(&q.to_world, &q.bounds))
    }
    fn bounding_ball(&self, queries: &[Vec<Vec3>]) -> Vec<Sphere> {
        each(queries, |points| stage8_scene_graph::bounding_ball(points))
    }
    fn enter_ball(&self, queries: &[BallEntryQuery]) -> Vec<Option<f32>> {
        each(queries, |q| stage8_scene_graph::enter_ball(&q.ray, &q.ball))
    }
    fn closest_hit_in_graph(&self, queries: &[GraphQuery]) -> Vec<GraphAnswer> {
        each(queries, |q| {
            let mut probe = TableProbe::without_hierarchy(&q.table);
            let hit = stage8_scene_graph::closest_hit_in_graph(&q.graph, &mut probe, &q.ray, q.savings);
            GraphAnswer { search: probe.answer(hit), asked: probe.asked }
        })
    }
    fn cuboid(&self, queries: &[SolidQuery<Cuboid>]) -> Vec<Option<SolidHit>> {
        each(queries, |q| stage8_solids::cuboid(&q.ray, &q.solid))
    }
    fn cylinder(&self, queries: &[SolidQuery<Cylinder>]) -> Vec<Option<SolidHit>> {
        each(queries, |q| stage8_solids::cylinder(&q.ray, &q.solid))
    }
    fn cone(&self, queries: &[SolidQuery<Cone>]) -> Vec<Option<SolidHit>> {
        each(queries, |q| stage8_solids::cone(&q.ray, &q.solid))
    }
    fn disk(&self, queries: &[SolidQuery<Disk>]) -> Vec<Option<SolidHit>> {
        each(queries, |q| stage8_solids::disk(&q.ray, &q.solid))
    }
    fn polygon(&self, queries: &[SolidQuery<Polygon>]) -> Vec<Option<SolidHit>> {
        each(queries, |q| stage8_solids::polygon(&q.ray, &q.solid))
    }
    fn bezier_point(&self, queries: &[PatchQuery]) -> Vec<Vec3> {
        each(queries, |q| stage8_surfaces::bezier_point(&q.patch, q.uv))
    }
    fn loop_subdivide(&self, queries: &[Mesh]) -> Vec<Mesh> {
        each(queries, stage8_surfaces::loop_subdivide)
    }
}

impl Partitions for Kit {
    fn cell_span(&self, queries: &[SlabQuery]) -> Vec<Option<(f64, f64)>> {
        each(queries, |q| stage9_cells::span(&q.ray, &Cell::new(&q.bounds)))
    }
    fn grid_resolution(&self, queries: &[ResolutionQuery]) -> Vec<UVec3> {
        each(queries, |q| stage9_grid::resolution(&q.bounds, q.n_primitives, q.density))
    }
    fn grid_build(&self, queries: &[GridQuery]) -> Vec<Grid> {
        each(queries, |q| stage9_grid::build(&q.bounds, q.resolution))
    }
    fn grid_search(&self, queries: &[CellsQuery<Grid>]) -> Vec<CellsAnswer> {
        each(queries, |q| look(q, |probe| stage9_grid::closest_hit(&q.cells, probe, &q.ray)))
    }
    fn octree_build(&self, queries: &[OctreeQuery]) -> Vec<Octree> {
        each(queries, |q| stage9_octree::build(&q.bounds, q.leaf_size, q.max_depth))
    }
    fn octree_by_cells(&self, queries: &[CellsQuery<Octree>]) -> Vec<CellsAnswer> {
        each(queries, |q| look(q, |probe| stage9_octree::closest_hit_by_cells(&q.cells, probe, &q.ray)))
    }
    fn octree_search(&self, queries: &[CellsQuery<Octree>]) -> Vec<CellsAnswer> {
        each(queries, |q| look(q, |probe| stage9_octree::closest_hit(&q.cells, probe, &q.ray)))
    }
    fn kd_build(&self, queries: &[KdQuery]) -> Vec<KdTree> {
        each(queries, |q| stage9_kd_tree::build(&q.bounds, &q.heuristics, q.leaf_size))
    }
    fn kd_search(&self, queries: &[CellsQuery<KdTree>]) -> Vec<CellsAnswer> {
        each(queries, |q| look(q, |probe| stage9_kd_tree::closest_hit(&q.cells, probe, &q.ray)))
    }
    fn bsp_build(&self, queries: &[BspQuery]) -> Vec<Bsp> {
        each(queries, |q| stage9_bsp::build(&q.hulls, q.leaf_size, q.max_depth))
    }
    fn bsp_search(&self, queries: &[CellsQuery<Bsp>]) -> Vec<CellsAnswer> {
        each(queries, |q| look(q, |probe| stage9_bsp::closest_hit(&q.cells, probe, &q.ray)))
    }
    fn cached_search(&self, queries: &[CachedQuery]) -> Vec<CellsAnswer> {
        each(queries, |q| {
            let mut probe = CellsProbe::new(&q.hits);
            let search = |probe: &mut CellsProbe<'_>, ray: &Ray| q.search(probe, ray);
            let hit = stage9_coherence::closest_hit_cached(q.last, &mut probe, &q.ray, search);
            CellsAnswer { hit, ..probe.answer }
        })
    }
    fn packet_search(&self, queries: &[PacketQuery]) -> Vec<PacketAnswer> {
        each(queries, |q| {
            let mut probe = PacketProbe::new(q);
            let hits = stage9_coherence::closest_hit_packet(&q.bvh, &mut probe, &q.rays);
            PacketAnswer { hits, ..probe.answer }
        })
    }
}

/// Runs a search of cells on a table; gives its answer with what it did.
fn look<S>(
    query: &CellsQuery<S>,
    find: impl FnOnce(&mut CellsProbe<'_>) -> Option<PrimitiveHit>,
) -> CellsAnswer {
    let mut probe = CellsProbe::new(&query.hits);
    let hit = find(&mut probe);
    CellsAnswer { hit, ..probe.answer }
}
