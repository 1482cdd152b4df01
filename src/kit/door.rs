//! The traits themselves, and the same calls as messages. One list makes both, so they cannot drift apart; it is as long as
//! the kit has functions.

use super::*;
use crate::aabb::Aabb;
use crate::bvh::{Bvh, PrimitiveHit};
use crate::effects::{Effects, LightEffects, MaterialEffects};
use crate::frame::Watch;
use crate::graph::Placement;
use crate::mesh::Mesh;
use crate::partition::{Bsp, Grid, KdTree, Octree};
use crate::random::Stratum;
use crate::ray::Ray;
use crate::scene::{Sampler, Scene};
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Polygon, Sphere, Triangle};
use glam::{Affine3A, UVec3, Vec2, Vec3};

/// Carries a request to where the student's code lives and brings the answer back.
///
/// A call that cannot be answered (student code that panics, loops or crashes) unwinds with a [`Mishap`], as a panic
/// of linked student code does; [`mishap::catch`] catches both.
pub trait Transport: Sync {
    /// Asks.
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer;
}

/// A kit at the other end of a transport.
pub struct Door<T>(pub T);

/// Everything that students write.
pub trait Kit:
    Shapes
    + Triangles
    + Hierarchies
    + Shading
    + Recursion
    + Distribution
    + Economy
    + SceneGraph
    + Partitions
    + Stability
    + Frames
    + Sync
{
}
impl<T> Kit for T where
    T: Shapes
        + Triangles
        + Hierarchies
        + Shading
        + Recursion
        + Distribution
        + Economy
        + SceneGraph
        + Partitions
        + Stability
        + Frames
        + Sync
{
}

/// Whole frames, rendered where the student's code lives, so that no ray crosses a process boundary.
pub trait Frames {
    /// Renders `job`. `None` if `watch` cancelled it.
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering>;

    /// The rays behind the first sample of the pixel in column `x` and row `y` of `job`, the very ones that a frame
    /// traces, parents before children.
    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay>;

    /// The edges of the boxes or cells of the structure over the scene at this depth, the root being at depth 0, and of
    /// the leaves above it.
    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]>;

    /// What each ray meets first in [`World::plain`](crate::world::World::plain) of the scene of `job`, found as its
    /// quality says. Primitives have their numbers there; planes are counted after them.
    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>>;
}

macro_rules! door {
    ($($(#[$trait_doc:meta])* trait $stage:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident($query:ty) -> $answer:ty;)*
    })*) => {
        $($(#[$trait_doc])* pub trait $stage {
            $($(#[$doc])* fn $name(&self, queries: &[$query]) -> Vec<$answer>;)*
        })*

        /// A call as a message.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Request {
            $($($(#[$doc])* $Message(Vec<$query>),)*)*
            /// A whole frame.
            Render(Box<RenderJob>),
            /// The rays behind a pixel, by column and row.
            Trace(Box<RenderJob>, u32, u32),
            /// Edges of the structure at a depth.
            Outlines(Box<RenderJob>, u32),
            /// What rays meet first in a scene.
            FirstHits(Box<RenderJob>, Vec<Ray>),
        }

        /// An answer as a message.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Answer {
            $($($(#[$doc])* $Message(Vec<$answer>),)*)*
            /// A whole frame; `None` when it was cancelled.
            Render(Option<Box<Rendering>>),
            /// The rays behind a pixel.
            Trace(Vec<TracedRay>),
            /// Edges of the structure at a depth.
            Outlines(Vec<[Vec3; 2]>),
            /// What rays meet first in a scene.
            FirstHits(Vec<Option<PrimitiveHit>>),
        }

        impl Request {
            /// Has `kit` answer.
            pub fn answer(&self, kit: &dyn Kit, watch: &dyn Watch) -> Answer {
                match self {
                    $($(Request::$Message(queries) => Answer::$Message(kit.$name(queries)),)*)*
                    Request::Render(job) => Answer::Render(kit.render(job, watch).map(Box::new)),
                    Request::Trace(job, x, y) => Answer::Trace(kit.trace(job, *x, *y)),
                    Request::Outlines(job, depth) => Answer::Outlines(kit.outlines(job, *depth)),
                    Request::FirstHits(job, rays) => Answer::FirstHits(kit.first_hits(job, rays)),
                }
            }
        }

        $(impl<T: Transport> $stage for Door<T> {
            $(fn $name(&self, queries: &[$query]) -> Vec<$answer> {
                match self.0.call(Request::$Message(queries.to_vec()), &crate::frame::Unwatched) {
                    Answer::$Message(answers) if answers.len() == queries.len() => answers,
                    answer => mishap::wrong_answer(&answer),
                }
            })*
        })*
    };
}

impl<T: Transport> Frames for Door<T> {
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
        match self.0.call(Request::Render(Box::new(job.clone())), watch) {
            // The other side says how large its picture is; what is done with it relies on that.
            Answer::Render(Some(rendering)) if !job.fits(&rendering.film) => {
                mishap::wrong_answer(&rendering.film)
            }
            Answer::Render(rendering) => rendering.map(|rendering| *rendering),
            answer => mishap::wrong_answer(&answer),
        }
    }

    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
        match self.0.call(Request::Trace(Box::new(job.clone()), x, y), &crate::frame::Unwatched) {
            Answer::Trace(rays) => rays,
            answer => mishap::wrong_answer(&answer),
        }
    }

    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]> {
        match self.0.call(Request::Outlines(Box::new(job.clone()), depth), &crate::frame::Unwatched) {
            Answer::Outlines(edges) => edges,
            answer => mishap::wrong_answer(&answer),
        }
    }

    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
        let request = Request::FirstHits(Box::new(job.clone()), rays.to_vec());
        match self.0.call(request, &crate::frame::Unwatched) {
            Answer::FirstHits(hits) if hits.len() == rays.len() => hits,
            answer => mishap::wrong_answer(&answer),
        }
    }
}

door! {
    /// Stage 1: spheres and planes.
    trait Shapes {
        /// The first of two roots that counts for a ray.
        NearestRoot fn nearest_root(RootQuery) -> Option<f32>;
        /// Ray against sphere by the quadratic formula.
        SphereAlgebraic fn sphere_algebraic(SphereQuery) -> Option<f32>;
        /// Ray against sphere by right triangles.
        SphereGeometric fn sphere_geometric(SphereQuery) -> Option<f32>;
        /// The outward unit normal of a sphere at a point of it.
        SphereNormal fn sphere_normal((Sphere, Vec3)) -> Vec3;
        /// Ray against plane.
        Plane fn plane(PlaneQuery) -> Option<f32>;
        /// A normal, turned to the side that a ray with this direction comes from.
        FaceViewer fn face_viewer((Vec3, Vec3)) -> Vec3;
    }

    /// Stage 2: triangles and meshes.
    trait Triangles {
        /// Ray against triangle by Cramer's rule.
        TriangleCramer fn triangle_cramer(TriangleQuery) -> Option<TriangleHit>;
        /// The four scalars of the Gram method.
        GramScalars fn gram_scalars(Triangle) -> GramScalars;
        /// Ray against triangle by plane and Gram matrix.
        TriangleGram fn triangle_gram(TriangleQuery) -> Option<TriangleHit>;
        /// Ray against triangle by a method of the student's choice; the reference is watertight.
        TriangleChoice fn triangle_choice(TriangleQuery) -> Option<TriangleHit>;
        /// Inside test I: planes through the ray's origin and each side.
        InsideByPlanes fn inside_by_planes(InsideQuery) -> bool;
        /// Inside test II: the ray's direction against each side.
        InsideByDirection fn inside_by_direction(InsideQuery) -> bool;
        /// Inside test III: areas; `(α, β, γ)` if inside.
        InsideByAreas fn inside_by_areas(InsideQuery) -> Option<Vec3>;
        /// A value between three corners.
        Interpolate fn interpolate(InterpolateQuery) -> Vec3;
        /// The unit normal of a triangle, if it has one.
        FaceNormal fn face_normal(Triangle) -> Option<Vec3>;
        /// One unit normal a vertex: the average of the faces around it.
        VertexNormals fn vertex_normals(Mesh) -> Vec<Vec3>;
        /// The closest hit among all primitives of the table.
        BruteForce fn brute_force(SearchQuery) -> SearchAnswer;
    }

    /// Stage 3: bounding volume hierarchies.
    trait Hierarchies {
        /// The box around a triangle.
        TriangleBounds fn triangle_bounds(Triangle) -> Aabb;
        /// The box around a sphere.
        SphereBounds fn sphere_bounds(Sphere) -> Aabb;
        /// The smallest box around two boxes.
        Union fn union((Aabb, Aabb)) -> Aabb;
        /// The middle of a box.
        Centroid fn centroid(Aabb) -> Vec3;
        /// The surface area of a box.
        SurfaceArea fn surface_area(Aabb) -> f32;
        /// Where a ray enters and leaves a box, within its range.
        Slab fn slab(SlabQuery) -> Option<(f32, f32)>;
        /// Primitives divided by a rule.
        Split fn split(SplitQuery) -> SplitAnswer;
        /// A hierarchy over boxes.
        Build fn build(BuildQuery) -> Bvh;
        /// The closest hit, visiting both children always.
        ClosestHitBoth fn closest_hit_both(SearchQuery) -> SearchAnswer;
        /// The closest hit, nearer child first, skipping what lies beyond the best hit.
        ClosestHit fn closest_hit(SearchQuery) -> SearchAnswer;
        /// Whether there is any hit.
        AnyHit fn any_hit(SearchQuery) -> (bool, SearchAnswer);
    }

    /// Stage 4: light and shade.
    trait Shading {
        /// The cosine term of diffuse light.
        DiffuseTerm fn diffuse_term(TermQuery) -> f32;
        /// The highlight.
        SpecularTerm fn specular_term(TermQuery) -> f32;
        /// The ray that asks whether a light is visible, if the light can matter.
        ShadowRay fn shadow_ray(ShadowQuery) -> Option<Ray>;
        /// The normal to shade with: `(geometric, interpolated, ray direction)`.
        ShadingNormal fn shading_normal((Vec3, Option<Vec3>, Vec3)) -> Vec3;
        /// The colour of a point.
        Shade fn shade(ShadeQuery) -> ShadeAnswer;
        /// Linear light to a byte with gamma 2.
        EncodeGamma fn encode_gamma(f32) -> u8;
        /// A byte to linear light with gamma 2.
        DecodeGamma fn decode_gamma(u8) -> f32;
    }

    /// Stage 5: mirrors and glass.
    trait Recursion {
        /// The mirrored direction: `(direction, normal)`.
        Mirror fn mirror((Vec3, Vec3)) -> Vec3;
        /// The refracted direction, unless all light is mirrored.
        Refract fn refract(RefractQuery) -> Option<Vec3>;
        /// The mirrored share by Schlick's formula.
        FresnelSchlick fn fresnel_schlick(FresnelQuery) -> f32;
        /// The mirrored share by Fresnel's equations.
        FresnelExact fn fresnel_exact(FresnelQuery) -> f32;
        /// The rays that go on from a surface.
        Children fn children(ChildrenQuery) -> Vec<Child>;
        /// The ray that follows a child, off the surface.
        Leave fn leave((Surface, Child)) -> Ray;
    }

    /// Stage 6: distributed ray tracing.
    trait Distribution {
        /// Where in its cell a sample lies.
        Jittered fn jittered(Stratum) -> Vec2;
        /// Where in or around its pixel a sample lies.
        PixelPosition fn pixel_position((Sampler, Stratum)) -> Vec2;
        /// The weight of a sample at this distance from the centre of its pixel.
        GaussianWeight fn gaussian_weight(Vec2) -> f32;
        /// The colour of a pixel from its samples.
        Develop fn develop(Vec<WeightedColor>) -> Vec3;
        /// A place on a disk of radius 1.
        OnDisk fn on_disk(Vec2) -> Vec2;
        /// The ray from a place on the lens.
        LensRay fn lens_ray(LensQuery) -> Ray;
        /// A point of a rectangular lamp.
        OnRectangle fn on_rectangle(RectangleQuery) -> Vec3;
        /// A point of a round flat lamp.
        OnLampDisk fn on_lamp_disk((Disk, Vec2)) -> Vec3;
        /// A direction to a ball.
        TowardBall fn toward_ball(BallQuery) -> Vec3;
        /// A direction off or through a rough surface.
        Gloss fn gloss(GlossQuery) -> Vec3;
        /// The slot in time of the cell in column x and row y.
        TemporalSlot fn temporal_slot((u32, u32)) -> u32;
        /// A moment while the shutter is open.
        TimeInShutter fn time_in_shutter(TimeQuery) -> f32;
        /// Where a point is that moves from the first to the second in time 0 to 1.
        Between fn between((Vec3, Vec3, f32)) -> Vec3;
        /// The box around all that moves from the first box to the second.
        Sweep fn sweep((Aabb, Aabb)) -> Aabb;
    }

    /// Stage 7: only what the scene calls for.
    trait Economy {
        /// What a light takes.
        LightEffects fn light_effects(LightQuery) -> LightEffects;
        /// What a material takes.
        MaterialEffects fn material_effects(MaterialQuery) -> MaterialEffects;
        /// What a scene takes.
        Effects fn effects(Scene) -> Effects;
        /// The most rays that a scene can take.
        MostRays fn most_rays(BoundQuery) -> RayCounts;
        /// The rays that hits send on.
        RaysOfHits fn rays_of_hits(HitsQuery) -> RayCounts;
        /// How many samples it takes for an error: `(standard deviation of one, error of the mean)`.
        SamplesForError fn samples_for_error((f32, f32)) -> u32;
        /// The column or row of an image that stands for this one.
        Texel fn texel(TexelQuery) -> u32;
        /// The colour of an image.
        TextureColor fn texture_color(TextureQuery) -> Vec3;
    }
    /// Stage 8: every shape in a space of its own.
    trait SceneGraph {
        /// The ray in the space of an object.
        RayToObject fn ray_to_object(ObjectRayQuery) -> Ray;
        /// The normal of an object in the world.
        NormalToWorld fn normal_to_world(NormalQuery) -> Vec3;
        /// The way of a node to the world and back, for the transforms from the root down.
        Place fn placement(Vec<Affine3A>) -> Option<Placement>;
        /// The box around a transformed box.
        BoundsToWorld fn bounds_to_world(BoundsQuery) -> Aabb;
        /// A ball around points.
        BoundingBall fn bounding_ball(Vec<Vec3>) -> Sphere;
        /// Where a ray enters a ball.
        EnterBall fn enter_ball(BallEntryQuery) -> Option<f32>;
        /// The closest hit in a scene graph.
        GraphHit fn closest_hit_in_graph(GraphQuery) -> GraphAnswer;
        /// Ray against box.
        Cuboid fn cuboid(SolidQuery<Cuboid>) -> Option<SolidHit>;
        /// Ray against closed cylinder.
        Cylinder fn cylinder(SolidQuery<Cylinder>) -> Option<SolidHit>;
        /// Ray against closed cone.
        Cone fn cone(SolidQuery<Cone>) -> Option<SolidHit>;
        /// Ray against disk.
        Disk fn disk(SolidQuery<Disk>) -> Option<SolidHit>;
        /// Ray against convex polygon.
        Polygon fn polygon(SolidQuery<Polygon>) -> Option<SolidHit>;
        /// A point of a Bézier patch.
        BezierPoint fn bezier_point(PatchQuery) -> Vec3;
        /// A mesh with four triangles for each.
        LoopSubdivide fn loop_subdivide(Mesh) -> Mesh;
    }

    /// Stage 9: cells of space.
    trait Partitions {
        /// Where a ray is in a cell, in double precision.
        CellSpan fn cell_span(SlabQuery) -> Option<(f64, f64)>;
        /// How many cells a grid should have along each axis.
        GridResolution fn grid_resolution(ResolutionQuery) -> UVec3;
        /// A grid over boxes.
        GridBuild fn grid_build(GridQuery) -> Grid;
        /// The closest hit in a grid.
        GridSearch fn grid_search(CellsQuery<Grid>) -> CellsAnswer;
        /// An octree over boxes.
        OctreeBuild fn octree_build(OctreeQuery) -> Octree;
        /// The closest hit in an octree, from cell to cell.
        OctreeByCells fn octree_by_cells(CellsQuery<Octree>) -> CellsAnswer;
        /// The closest hit in an octree, from the root down.
        OctreeSearch fn octree_search(CellsQuery<Octree>) -> CellsAnswer;
        /// A kd-tree over boxes.
        KdBuild fn kd_build(KdQuery) -> KdTree;
        /// The closest hit in a kd-tree.
        KdSearch fn kd_search(CellsQuery<KdTree>) -> CellsAnswer;
        /// A BSP tree over hulls.
        BspBuild fn bsp_build(BspQuery) -> Bsp;
        /// The closest hit in a BSP tree.
        BspSearch fn bsp_search(CellsQuery<Bsp>) -> CellsAnswer;
        /// The closest hit, knowing what the ray before hit.
        CachedSearch fn cached_search(CachedQuery) -> CellsAnswer;
        /// The closest hits of several rays.
        PacketSearch fn packet_search(PacketQuery) -> PacketAnswer;
    }

    /// Stage 10: answers that survive rounding.
    trait Stability {
        /// The roots of `a t² + b t + c`, for `[a, b, c]`.
        StableRoots fn stable_roots([f32; 3]) -> Option<[f32; 2]>;
        /// Ray against triangle, without leaks between neighbours.
        Watertight fn watertight(TriangleQuery) -> Option<TriangleHit>;
        /// Ray against box, without a miss of what is met.
        ConservativeSlab fn conservative_slab(SlabQuery) -> Option<(f32, f32)>;
        /// Where a ray starts that leaves a surface.
        OffsetOrigin fn offset_origin(OffsetQuery) -> Vec3;
        /// The unit vector along another, if it has a direction.
        SafeNormalize fn safe_normalize(Vec3) -> Option<Vec3>;
        /// Ray against triangle, every number in double precision.
        TriangleInDouble fn triangle_in_double(TriangleQuery) -> Option<TriangleHit>;
        /// Ray against sphere, every number in double precision.
        SphereInDouble fn sphere_in_double(SphereQuery) -> Option<f32>;
    }
}
