//! Nothing to do here: this connects the functions of the stage files with the door through which the kit calls them.
//! It is one list, as long as that of the functions; what has to do with spaces and cells is in glue_structures.rs.

use crate::{
    stage1_shapes, stage2_triangles, stage3_bvh, stage4_shading, stage5_recursion, stage6_distribution,
    stage7_effects, stage10_stability, tracer,
};
use glam::{Vec2, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, PrimitiveHit};
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::frame::Watch;
use raykata::kit::*;
use raykata::mesh::Mesh;
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::scene::{Sampler, Scene, Split};
use raykata::shape::{Disk, Sphere, Triangle};

/// The code in this folder, as the kit sees it.
pub struct Kit;

/// A plain loop: iterators that are mapped and collected the compiler would have to write out for each of a hundred
/// functions, and it compiles this file for every submission that is graded.
pub fn each<Q, A>(queries: &[Q], mut answer: impl FnMut(&Q) -> A) -> Vec<A> {
    let mut answers = Vec::with_capacity(queries.len());
    for query in queries {
        answers.push(answer(query));
    }
    answers
}

impl Shapes for Kit {
    fn nearest_root(&self, queries: &[RootQuery]) -> Vec<Option<f32>> {
        each(queries, |q| stage1_shapes::nearest_root(q.roots, &q.ray))
    }
    fn sphere_algebraic(&self, queries: &[SphereQuery]) -> Vec<Option<f32>> {
        each(queries, |q| stage1_shapes::sphere_algebraic(&q.ray, q.sphere.center, q.sphere.radius))
    }
    fn sphere_geometric(&self, queries: &[SphereQuery]) -> Vec<Option<f32>> {
        each(queries, |q| stage1_shapes::sphere_geometric(&q.ray, q.sphere.center, q.sphere.radius))
    }
    fn sphere_normal(&self, queries: &[(Sphere, Vec3)]) -> Vec<Vec3> {
        each(queries, |(sphere, point)| stage1_shapes::sphere_normal(sphere.center, *point))
    }
    fn plane(&self, queries: &[PlaneQuery]) -> Vec<Option<f32>> {
        each(queries, |q| stage1_shapes::plane(&q.ray, q.plane.point, q.plane.normal))
    }
    fn face_viewer(&self, queries: &[(Vec3, Vec3)]) -> Vec<Vec3> {
        each(queries, |(normal, dir)| stage1_shapes::face_viewer(*normal, *dir))
    }
}

impl Triangles for Kit {
    fn triangle_cramer(&self, queries: &[TriangleQuery]) -> Vec<Option<TriangleHit>> {
        each(queries, |q| stage2_triangles::triangle_cramer(&q.ray, &q.triangle))
    }
    fn gram_scalars(&self, queries: &[Triangle]) -> Vec<GramScalars> {
        each(queries, stage2_triangles::gram_scalars)
    }
    fn triangle_gram(&self, queries: &[TriangleQuery]) -> Vec<Option<TriangleHit>> {
        each(queries, |q| {
            let scalars = stage2_triangles::gram_scalars(&q.triangle);
            stage2_triangles::triangle_gram(&q.ray, &q.triangle, &scalars)
        })
    }
    fn triangle_choice(&self, queries: &[TriangleQuery]) -> Vec<Option<TriangleHit>> {
        each(queries, |q| stage2_triangles::triangle_choice(&q.ray, &q.triangle))
    }
    fn inside_by_planes(&self, queries: &[InsideQuery]) -> Vec<bool> {
        each(queries, |q| stage2_triangles::inside_by_planes(&q.ray, q.point, &q.triangle))
    }
    fn inside_by_direction(&self, queries: &[InsideQuery]) -> Vec<bool> {
        each(queries, |q| stage2_triangles::inside_by_direction(&q.ray, q.point, &q.triangle))
    }
    fn inside_by_areas(&self, queries: &[InsideQuery]) -> Vec<Option<Vec3>> {
        each(queries, |q| stage2_triangles::inside_by_areas(q.point, &q.triangle))
    }
    fn interpolate(&self, queries: &[InterpolateQuery]) -> Vec<Vec3> {
        each(queries, |q| stage2_triangles::interpolate(q.weights, q.corners))
    }
    fn face_normal(&self, queries: &[Triangle]) -> Vec<Option<Vec3>> {
        each(queries, stage2_triangles::face_normal)
    }
    fn vertex_normals(&self, queries: &[Mesh]) -> Vec<Vec<Vec3>> {
        each(queries, stage2_triangles::vertex_normals)
    }
    fn brute_force(&self, queries: &[SearchQuery]) -> Vec<SearchAnswer> {
        each(queries, |q| {
            let n_primitives = q.table.primitives.len() as u32;
            search(q, |probe| stage2_triangles::brute_force(n_primitives, probe, &q.ray))
        })
    }
}

impl Hierarchies for Kit {
    fn triangle_bounds(&self, queries: &[Triangle]) -> Vec<Aabb> {
        each(queries, stage3_bvh::triangle_bounds)
    }
    fn sphere_bounds(&self, queries: &[Sphere]) -> Vec<Aabb> {
        each(queries, stage3_bvh::sphere_bounds)
    }
    fn union(&self, queries: &[(Aabb, Aabb)]) -> Vec<Aabb> {
        each(queries, |(first, second)| stage3_bvh::union(first, second))
    }
    fn centroid(&self, queries: &[Aabb]) -> Vec<Vec3> {
        each(queries, stage3_bvh::centroid)
    }
    fn surface_area(&self, queries: &[Aabb]) -> Vec<f32> {
        each(queries, stage3_bvh::surface_area)
    }
    fn slab(&self, queries: &[SlabQuery]) -> Vec<Option<(f32, f32)>> {
        each(queries, |q| stage3_bvh::slab(&q.ray, q.ray.dir.recip(), &q.bounds))
    }
    fn split(&self, queries: &[SplitQuery]) -> Vec<SplitAnswer> {
        each(queries, |q| {
            let mut primitives = q.primitives.clone();
            let middle = match q.split {
                Split::ObjectMedian => Some(stage3_bvh::split_object_median(&mut primitives)),
                Split::SpatialMedian => Some(stage3_bvh::split_spatial_median(&mut primitives)),
                Split::SurfaceArea => stage3_bvh::split_surface_area(&mut primitives),
            };
            SplitAnswer { order: each(&primitives, |primitive| primitive.id), middle }
        })
    }
    fn build(&self, queries: &[BuildQuery]) -> Vec<Bvh> {
        each(queries, |q| stage3_bvh::build(&q.bounds, q.split, q.leaf_size))
    }
    fn closest_hit_both(&self, queries: &[SearchQuery]) -> Vec<SearchAnswer> {
        each(queries, |q| search(q, |probe| stage3_bvh::closest_hit_both(&q.bvh, probe, &q.ray)))
    }
    fn closest_hit(&self, queries: &[SearchQuery]) -> Vec<SearchAnswer> {
        each(queries, |q| search(q, |probe| stage3_bvh::closest_hit(&q.bvh, probe, &q.ray)))
    }
    fn any_hit(&self, queries: &[SearchQuery]) -> Vec<(bool, SearchAnswer)> {
        each(queries, |q| {
            let mut found = false;
            let answer = search(q, |probe| {
                found = stage3_bvh::any_hit(&q.bvh, probe, &q.ray);
                None
            });
            (found, answer)
        })
    }
}

/// Runs a search on a table; gives its answer with what it asked.
fn search(
    query: &SearchQuery,
    find: impl FnOnce(&mut TableProbe<'_>) -> Option<PrimitiveHit>,
) -> SearchAnswer {
    let mut probe = TableProbe::new(query);
    let hit = find(&mut probe);
    probe.answer(hit)
}

impl Shading for Kit {
    fn diffuse_term(&self, queries: &[TermQuery]) -> Vec<f32> {
        each(queries, |q| stage4_shading::diffuse_term(q.normal, q.to_light))
    }
    fn specular_term(&self, queries: &[TermQuery]) -> Vec<f32> {
        each(queries, |q| stage4_shading::specular_term(q.normal, q.to_light, q.to_viewer, q.exponent))
    }
    fn shadow_ray(&self, queries: &[ShadowQuery]) -> Vec<Option<Ray>> {
        each(queries, |q| stage4_shading::shadow_ray(&q.surface, &q.light))
    }
    fn shading_normal(&self, queries: &[(Vec3, Option<Vec3>, Vec3)]) -> Vec<Vec3> {
        each(queries, |(geometric, smooth, dir)| stage4_shading::shading_normal(*geometric, *smooth, *dir))
    }
    fn shade(&self, queries: &[ShadeQuery]) -> Vec<ShadeAnswer> {
        each(queries, |q| {
            let mut traced = Vec::new();
            let visible = |light: usize, _: &Ray| {
                traced.push(light);
                q.visible[light]
            };
            let color =
                stage4_shading::shade(&q.surface, q.to_viewer, &q.material, q.ambient, &q.lights, visible);
            ShadeAnswer { color, traced }
        })
    }
    fn encode_gamma(&self, queries: &[f32]) -> Vec<u8> {
        each(queries, |linear| stage4_shading::encode_gamma(*linear))
    }
    fn decode_gamma(&self, queries: &[u8]) -> Vec<f32> {
        each(queries, |byte| stage4_shading::decode_gamma(*byte))
    }
}

impl Recursion for Kit {
    fn mirror(&self, queries: &[(Vec3, Vec3)]) -> Vec<Vec3> {
        each(queries, |(dir, normal)| stage5_recursion::mirror(*dir, *normal))
    }
    fn refract(&self, queries: &[RefractQuery]) -> Vec<Option<Vec3>> {
        each(queries, |q| stage5_recursion::refract(q.dir, q.normal, q.n1, q.n2))
    }
    fn fresnel_schlick(&self, queries: &[FresnelQuery]) -> Vec<f32> {
        each(queries, |q| stage5_recursion::fresnel_schlick(q.cos_theta, q.n1, q.n2))
    }
    fn fresnel_exact(&self, queries: &[FresnelQuery]) -> Vec<f32> {
        each(queries, |q| stage5_recursion::fresnel_exact(q.cos_theta, q.n1, q.n2))
    }
    fn children(&self, queries: &[ChildrenQuery]) -> Vec<Vec<Child>> {
        each(queries, |q| {
            stage5_recursion::children(q.dir, q.normal, q.entering, &q.material, q.weight, q.depth, &q.limits)
        })
    }
    fn leave(&self, queries: &[(Surface, Child)]) -> Vec<Ray> {
        each(queries, |(surface, child)| stage5_recursion::leave(surface, child))
    }
}

impl Distribution for Kit {
    fn jittered(&self, queries: &[Stratum]) -> Vec<Vec2> {
        each(queries, stage6_distribution::jittered)
    }
    fn pixel_position(&self, queries: &[(Sampler, Stratum)]) -> Vec<Vec2> {
        each(queries, |(sampler, stratum)| stage6_distribution::pixel_position(*sampler, stratum))
    }
    fn gaussian_weight(&self, queries: &[Vec2]) -> Vec<f32> {
        each(queries, |offset| stage6_distribution::gaussian_weight(*offset))
    }
    fn develop(&self, queries: &[Vec<WeightedColor>]) -> Vec<Vec3> {
        each(queries, |samples| stage6_distribution::develop(samples))
    }
    fn on_disk(&self, queries: &[Vec2]) -> Vec<Vec2> {
        each(queries, |u| stage6_distribution::on_disk(*u))
    }
    fn lens_ray(&self, queries: &[LensQuery]) -> Vec<Ray> {
        each(queries, |q| stage6_distribution::lens_ray(&q.camera, &q.pinhole, &q.lens, q.on_lens))
    }
    fn on_rectangle(&self, queries: &[RectangleQuery]) -> Vec<Vec3> {
        each(queries, |q| stage6_distribution::on_rectangle(q.corner, q.edges, q.u))
    }
    fn on_lamp_disk(&self, queries: &[(Disk, Vec2)]) -> Vec<Vec3> {
        each(queries, |(disk, u)| stage6_distribution::on_lamp_disk(disk, *u))
    }
    fn toward_ball(&self, queries: &[BallQuery]) -> Vec<Vec3> {
        each(queries, |q| stage6_distribution::toward_ball(&q.ball, q.from, q.u))
    }
    fn gloss(&self, queries: &[GlossQuery]) -> Vec<Vec3> {
        each(queries, |q| stage6_distribution::gloss(q.ideal, q.normal, q.roughness, q.u))
    }
    fn temporal_slot(&self, queries: &[(u32, u32)]) -> Vec<u32> {
        each(queries, |(x, y)| stage6_distribution::temporal_slot(*x, *y))
    }
    fn time_in_shutter(&self, queries: &[TimeQuery]) -> Vec<f32> {
        each(queries, |q| stage6_distribution::time_in_shutter(&q.shutter, q.slot, q.slots, q.u))
    }
    fn between(&self, queries: &[(Vec3, Vec3, f32)]) -> Vec<Vec3> {
        each(queries, |(start, end, time)| stage6_distribution::between(*start, *end, *time))
    }
    fn sweep(&self, queries: &[(Aabb, Aabb)]) -> Vec<Aabb> {
        each(queries, |(start, end)| stage6_distribution::sweep(start, end))
    }
}

impl Economy for Kit {
    fn light_effects(&self, queries: &[LightQuery]) -> Vec<LightEffects> {
        each(queries, |q| stage7_effects::light_effects(&q.light, &q.quality))
    }
    fn material_effects(&self, queries: &[MaterialQuery]) -> Vec<MaterialEffects> {
        each(queries, |q| stage7_effects::material_effects(&q.material, &q.lights, &q.quality))
    }
    fn effects(&self, queries: &[Scene]) -> Vec<Effects> {
        each(queries, stage7_effects::effects)
    }
    fn most_rays(&self, queries: &[BoundQuery]) -> Vec<RayCounts> {
        each(queries, |q| stage7_effects::most_rays(&q.scene, &q.effects))
    }
    fn rays_of_hits(&self, queries: &[HitsQuery]) -> Vec<RayCounts> {
        each(queries, |q| stage7_effects::rays_of_hits(&q.hits, &q.effects, &q.quality))
    }
    fn samples_for_error(&self, queries: &[(f32, f32)]) -> Vec<u32> {
        each(queries, |(deviation, error)| stage7_effects::samples_for_error(*deviation, *error))
    }
    fn texel(&self, queries: &[TexelQuery]) -> Vec<u32> {
        each(queries, |q| stage7_effects::texel(q.index, q.size, q.wrap))
    }
    fn texture_color(&self, queries: &[TextureQuery]) -> Vec<Vec3> {
        each(queries, |q| stage7_effects::texture_color(&q.texture, q.uv))
    }
}

impl Stability for Kit {
    fn stable_roots(&self, queries: &[[f32; 3]]) -> Vec<Option<[f32; 2]>> {
        each(queries, |[a, b, c]| stage10_stability::stable_roots(*a, *b, *c))
    }
    fn watertight(&self, queries: &[TriangleQuery]) -> Vec<Option<TriangleHit>> {
        each(queries, |q| stage10_stability::watertight(&q.ray, &q.triangle))
    }
    fn conservative_slab(&self, queries: &[SlabQuery]) -> Vec<Option<(f32, f32)>> {
        each(queries, |q| stage10_stability::conservative_slab(&q.ray, q.ray.dir.recip(), &q.bounds))
    }
    fn offset_origin(&self, queries: &[OffsetQuery]) -> Vec<Vec3> {
        each(queries, |q| stage10_stability::offset_origin(q.point, q.error, q.normal, q.direction))
    }
    fn safe_normalize(&self, queries: &[Vec3]) -> Vec<Option<Vec3>> {
        each(queries, |v| stage10_stability::safe_normalize(*v))
    }
    fn triangle_in_double(&self, queries: &[TriangleQuery]) -> Vec<Option<TriangleHit>> {
        each(queries, |q| stage10_stability::triangle_in_double(&q.ray, &q.triangle))
    }
    fn sphere_in_double(&self, queries: &[SphereQuery]) -> Vec<Option<f32>> {
        each(queries, |q| stage10_stability::sphere_in_double(&q.ray, q.sphere.center, q.sphere.radius))
    }
}

impl Frames for Kit {
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
        tracer::render(job, watch)
    }
    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
        tracer::trace(job, x, y)
    }
    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]> {
        tracer::outlines(job, depth)
    }
    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
        tracer::first_hits(job, rays)
    }
}
