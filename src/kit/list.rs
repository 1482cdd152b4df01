//! The list of student functions: every exercise once, with its signature, the file that contains it, the
//! query that tests and the worker protocol use, and the expression that answers a query by the function.
//!
//! Everything that has to name all functions is generated from this list: the trait that the renderer calls
//! ([`StudentFunctions`](super::StudentFunctions)), its implementation in a student's crate
//! ([`student_kit!`](crate::student_kit)), the names ([`Function`](super::Function)) and whether each is
//! written ([`is_written`](super::is_written)), the traits of the door and the messages to a worker
//! ([`super::door`]), and the adapters from functions to the door ([`Linked`](super::Linked)). The comment of
//! an entry documents the function in all of them: what it computes. Its contract stands once, above the exercise. Each function gives
//! one answer per query, in the same order, and panics if the student's function does.
//!
//! An entry consists of the name of the message, the name of the function in the list with its generic
//! parameters in brackets, its signature, `=` the function in the student's crate, and the query with the
//! expression that answers it. In that expression `F` is the student's code.

/// Passes the list to another macro.
#[macro_export]
#[doc(hidden)]
macro_rules! student_functions {
    ($($receiver:tt)*) => {
        $($receiver)*! {
            /// Stage 1: spheres and planes.
            1 trait Shapes {
                /// The smaller of two roots that is in the range of `ray`, `t_min < t < t_max`.
                NearestRoot fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32>
                    = stage1_shapes::nearest_root; [RootQuery Copy]
                /// The `t` of the nearest hit with a sphere in the range of the ray, by the quadratic formula.
                SphereAlgebraic fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32>
                    = stage1_shapes::sphere_algebraic;
                { |q: SphereQuery| -> Option<f32> { F::sphere_algebraic(&q.ray, q.sphere.center, q.sphere.radius) } }
                /// The `t` of the nearest hit with a sphere in the range of the ray, by right triangles.
                SphereGeometric fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32>
                    = stage1_shapes::sphere_geometric;
                { |q: SphereQuery| -> Option<f32> { F::sphere_geometric(&q.ray, q.sphere.center, q.sphere.radius) } }
                /// The outward unit normal of a sphere at `point`, which lies on its surface.
                SphereNormal fn sphere_normal(center: Vec3, point: Vec3) -> Vec3
                    = stage1_shapes::sphere_normal;
                { |(sphere, point): (Sphere, Vec3)| -> Vec3 { F::sphere_normal(sphere.center, *point) } }
                /// The `t` of the hit with an infinite plane in the range of the ray.
                Plane fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32>
                    = stage1_shapes::plane;
                { |q: PlaneQuery| -> Option<f32> { F::plane(&q.ray, q.plane.point, q.plane.normal) } }
                /// The `t` of the hit with the plane `n·p + D = 0` in the range of the ray.
                PlaneByCoefficients fn plane_by_coefficients(ray: &Ray, normal: Vec3, d: f32) -> Option<f32>
                    = stage1_shapes::plane_by_coefficients;
                { |q: PlaneEquationQuery| -> Option<f32> { F::plane_by_coefficients(&q.ray, q.plane.normal, q.plane.d) } }
                /// `normal`, negated if necessary, so that it points to the side from which the ray comes.
                FaceForward fn face_forward(normal: Vec3, direction: Vec3) -> Vec3
                    = stage1_shapes::face_forward; ()
            }

            /// Stage 2: triangles and meshes.
            2 trait Triangles {
                /// The hit with a triangle in the range of the ray, by Cramer's rule; `None` if there is none.
                TriangleCramer fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage2_triangles::triangle_cramer; [TriangleQuery Copy]
                /// The four scalars of a triangle that the Gram method computes once.
                GramScalars fn gram_scalars(triangle: &Triangle) -> GramScalars
                    = stage2_triangles::gram_scalars; ()
                /// The hit with a triangle, by the hit with its plane and the Gram matrix.
                TriangleGram fn triangle_gram(ray: &Ray, triangle: &Triangle, scalars: &GramScalars) -> Option<TriangleHit>
                    = stage2_triangles::triangle_gram;
                { |q: TriangleQuery| -> Option<TriangleHit> {
                    let scalars = F::gram_scalars(&q.triangle);
                    F::triangle_gram(&q.ray, &q.triangle, &scalars)
                } }
                /// The hit with a triangle in the range of the ray, by a method of the student's choice.
                TriangleChoice fn triangle_choice(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage2_triangles::triangle_choice; (TriangleQuery)
                /// Inside test I: `point` is on the same side of the planes through the origin and each edge.
                InsideByPlanes fn inside_by_planes(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool
                    = stage2_triangles::inside_by_planes; [InsideQuery Copy]
                /// Inside test II: `point` is on the same side of all edges, as seen along the ray.
                InsideByDirection fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool
                    = stage2_triangles::inside_by_direction; (InsideQuery)
                /// Inside test III: the barycentric coordinates of `point` as ratios of signed areas.
                InsideByAreas fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3>
                    = stage2_triangles::inside_by_areas; (InsideQuery)
                /// Whether a triangle turns its back to the ray.
                Backfacing fn backfacing(ray: &Ray, triangle: &Triangle) -> bool
                    = stage2_triangles::backfacing; (TriangleQuery)
                /// The value at the barycentric coordinates `(α, β, γ)` between the values at three corners.
                Interpolate fn interpolate(barycentric: Vec3, corners: [Vec3; 3]) -> Vec3
                    = stage2_triangles::interpolate; [InterpolateQuery Copy]
                /// The unit normal of a triangle with the direction of `(b - a) × (c - a)`.
                FaceNormal fn face_normal(triangle: &Triangle) -> Option<Vec3>
                    = stage2_triangles::face_normal; ()
                /// One unit normal per vertex of a mesh: the mean of the normals of the triangles around it.
                VertexNormals fn vertex_normals(mesh: &Mesh) -> Vec<Vec3>
                    = stage2_triangles::vertex_normals; ()
                /// The closest hit among primitives `0..n_primitives`, by a test of each.
                BruteForce fn brute_force[P: Probe](n_primitives: u32, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage2_triangles::brute_force;
                { |q: SearchQuery| -> SearchAnswer {
                    let n_primitives = q.table.primitives.len() as u32;
                    search(q, |probe| F::brute_force(n_primitives, probe, &q.ray))
                } }
            }

            /// Stage 3: bounding volume hierarchies.
            3 trait Hierarchies {
                /// The smallest closed box around a triangle, in world units, without padding.
                TriangleBounds fn triangle_bounds(triangle: &Triangle) -> Aabb
                    = stage3_boxes::triangle_bounds; ()
                /// A closed box around a sphere, in world units, tight except for rounding.
                SphereBounds fn sphere_bounds(sphere: &Sphere) -> Aabb
                    = stage3_boxes::sphere_bounds; ()
                /// The smallest box that contains two boxes. The union with an empty box changes nothing.
                Union fn union(first: &Aabb, second: &Aabb) -> Aabb
                    = stage3_boxes::union; ()
                /// The centre of a box, in world units.
                Centroid fn centroid(bounds: &Aabb) -> Vec3
                    = stage3_boxes::centroid; ()
                /// The area of the six faces of a box, in square world units; 0 for the empty box.
                SurfaceArea fn surface_area(bounds: &Aabb) -> f32
                    = stage3_boxes::surface_area; ()
                /// The `t` at which a ray enters and leaves a closed box, both in `[t_min, t_max]`.
                Slab fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)>
                    = stage3_boxes::slab;
                { |q: SlabQuery| -> Option<(f32, f32)> { F::slab(&q.ray, q.ray.direction.recip(), &q.bounds) } }
                /// Object median: half of the primitives come first, ordered along the longest axis.
                SplitObjectMedian fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize
                    = stage3_build::split_object_median;
                { |primitives: Vec<PrimitiveRef>| -> SplitAnswer {
                    divide(primitives, |primitives| Some(F::split_object_median(primitives)))
                } }
                /// Spatial median: the primitives in the first half of the longest axis come first.
                SplitSpatialMedian fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize
                    = stage3_build::split_spatial_median;
                { |primitives: Vec<PrimitiveRef>| -> SplitAnswer {
                    divide(primitives, |primitives| Some(F::split_spatial_median(primitives)))
                } }
                /// Surface area heuristic: the cheapest split; `None` for a leaf.
                SplitSurfaceArea fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize>
                    = stage3_build::split_surface_area;
                { |primitives: Vec<PrimitiveRef>| -> SplitAnswer { divide(primitives, F::split_surface_area) } }
                /// A hierarchy over primitives with these boxes.
                Build fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh
                    = stage3_build::build; [BuildQuery]
                /// The closest hit in a hierarchy, by a visit of both children of each node.
                ClosestHitBoth fn closest_hit_both[P: Probe](bvh: &Bvh, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage3_traversal::closest_hit_both;
                { |q: SearchQuery| -> SearchAnswer { search(q, |probe| F::closest_hit_both(&q.bvh, probe, &q.ray)) } }
                /// The closest hit in a hierarchy, nearer child first.
                ClosestHit fn closest_hit[P: Probe](bvh: &Bvh, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage3_traversal::closest_hit;
                { |q: SearchQuery| -> SearchAnswer { search(q, |probe| F::closest_hit(&q.bvh, probe, &q.ray)) } }
                /// Whether the ray hits any primitive in its range.
                AnyHit fn any_hit[P: Probe](bvh: &Bvh, probe: &mut P, ray: &Ray) -> bool
                    = stage3_traversal::any_hit;
                { |q: SearchQuery| -> (bool, SearchAnswer) {
                    let mut found = false;
                    let answer = search(q, |probe| {
                        found = F::any_hit(&q.bvh, probe, &q.ray);
                        None
                    });
                    (found, answer)
                } }
            }

            /// Stage 4: shading and shadows.
            4 trait Shading {
                /// The diffuse term of the Phong model: the cosine between the normal and the light.
                DiffuseTerm fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32
                    = stage4_shading::diffuse_term; (TermQuery)
                /// The specular term of the Phong model: `cosⁿ φ` between the reflected light and the viewer.
                SpecularTerm fn specular_term(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32
                    = stage4_shading::specular_term; [TermQuery Copy]
                /// The shadow ray from a surface to a light; `None` if none is needed.
                ShadowRay fn shadow_ray(surface: &Surface, light: &LightSample) -> Option<Ray>
                    = stage4_shading::shadow_ray; [ShadowQuery Copy]
                /// The unit normal for shading, on the side from which the ray comes.
                ShadingNormal fn shading_normal(geometric: Vec3, interpolated: Option<Vec3>, direction: Vec3) -> Vec3
                    = stage4_shading::shading_normal; ()
                /// The colour of a point in linear light, by the Phong model.
                Shade fn shade[V: FnMut(usize, &Ray) -> bool](
                    surface: &Surface, to_viewer: Vec3, material: &Material, ambient: Vec3, lights: &[LightSample], visible: V
                ) -> Vec3
                    = stage4_shading::shade;
                { |q: ShadeQuery| -> ShadeAnswer {
                    let mut shadows = ShadowProbe::new(q);
                    let visible = |light: usize, ray: &Ray| shadows.visible(light, ray);
                    let color =
                        F::shade(&q.surface, q.to_viewer, &q.material, q.ambient, &q.lights, visible);
                    shadows.finish(color)
                } }
                /// The byte `0..=255` for a component of linear light with gamma 2, rounded to nearest.
                EncodeGamma fn encode_gamma(linear: f32) -> u8
                    = stage4_shading::encode_gamma; ()
                /// The component of linear light, `0..=1`, for a byte with gamma 2.
                DecodeGamma fn decode_gamma(byte: u8) -> f32
                    = stage4_shading::decode_gamma; ()
            }

            /// Stage 5: reflection and refraction.
            5 trait Recursion {
                /// The unit direction of the reflected ray, for the unit direction of a ray and a unit normal.
                Reflect fn reflect(direction: Vec3, normal: Vec3) -> Vec3
                    = stage5_recursion::reflect; ()
                /// The unit direction of the refracted ray by Snell's law.
                Refract fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3>
                    = stage5_recursion::refract; [RefractQuery Copy]
                /// The Fresnel reflectance, `0..=1`, by Schlick's approximation.
                FresnelSchlick fn fresnel_schlick(cos_theta: f32, n1: f32, n2: f32) -> f32
                    = stage5_recursion::fresnel_schlick; [FresnelQuery Copy]
                /// The Fresnel reflectance of unpolarised light, `0..=1`, by Fresnel's equations.
                FresnelExact fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32
                    = stage5_recursion::fresnel_exact; (FresnelQuery)
                /// The secondary rays that leave a surface, each with its weight.
                Scatter fn scatter(
                    direction: Vec3, normal: Vec3, entering: bool, material: &Material, weight: Vec3, depth: u32, limits: &Limits
                ) -> Vec<SecondaryRay>
                    = stage5_recursion::scatter; [ScatterQuery]
                /// The ray along a secondary ray, without upper limit of `t`.
                SpawnRay fn spawn_ray(surface: &Surface, secondary: &SecondaryRay) -> Ray
                    = stage5_recursion::spawn_ray; ()
            }

            /// Stage 6: distributed ray tracing. Random numbers come as arguments, `0 <= u < 1`.
            6 trait Distribution {
                /// The position of a stratified sample in the unit square.
                Jittered fn jittered(stratum: &Stratum) -> Vec2
                    = stage6_distribution::jittered; ()
                /// The position of a sample in pixels, relative to the upper left corner of its pixel.
                PixelPosition fn pixel_position(sampler: Sampler, stratum: &Stratum) -> Vec2
                    = stage6_distribution::pixel_position; ()
                /// The weight of a sample at `offset` from the centre of its pixel, in pixels.
                GaussianWeight fn gaussian_weight(offset: Vec2) -> f32
                    = stage6_distribution::gaussian_weight; ()
                /// The colour of a pixel: the weighted mean of its samples.
                FilterPixel fn filter_pixel(samples: &[WeightedColor]) -> Vec3
                    = stage6_distribution::filter_pixel; ()
                /// A uniformly distributed point of the disk of radius 1 around the origin.
                SampleDisk fn sample_disk(u: Vec2) -> Vec2
                    = stage6_distribution::sample_disk; ()
                /// The ray from a point of the lens that meets the pinhole ray on the focal plane.
                LensRay fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray
                    = stage6_distribution::lens_ray; [LensQuery Copy]
                /// A uniformly distributed point of a rectangle, in world units.
                SampleRectangle fn sample_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3
                    = stage6_distribution::sample_rectangle; [RectangleQuery Copy]
                /// A uniformly distributed point of a disk, in world units.
                SampleLightDisk fn sample_light_disk(disk: &Disk, u: Vec2) -> Vec3
                    = stage6_distribution::sample_light_disk; ()
                /// A direction to a sphere, uniform over its solid angle.
                SampleSphere fn sample_sphere(sphere: &Sphere, from: Vec3, u: Vec2) -> Vec3
                    = stage6_distribution::sample_sphere; [SphereSampleQuery Copy]
                /// A direction around `ideal` with the density of a Phong lobe.
                SamplePhongLobe fn sample_phong_lobe(ideal: Vec3, normal: Vec3, roughness: f32, u: Vec2) -> Vec3
                    = stage6_distribution::sample_phong_lobe; [PhongLobeQuery Copy]
                /// The time slot, `1..=16`, of the cell in column `x` and row `y`, by the table of the lecture.
                TemporalSlot fn temporal_slot(x: u32, y: u32) -> u32
                    = stage6_distribution::temporal_slot; ()
                /// The time at position `u` of a slot of the shutter's interval.
                TimeInShutter fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32
                    = stage6_distribution::time_in_shutter; [TimeQuery Copy]
                /// Linear interpolation (`lerp`) of a point, exact at both ends.
                Lerp fn lerp(start: Vec3, end: Vec3, time: f32) -> Vec3
                    = stage6_distribution::lerp; ()
                /// The box around everything that moves linearly from box `start` to box `end` (motion bounds).
                MotionBounds fn motion_bounds(start: &Aabb, end: &Aabb) -> Aabb
                    = stage6_distribution::motion_bounds; ()
            }

            /// Stage 7: the effects analysis, which computes only what a scene needs.
            7 trait EffectsAnalysis {
                /// What a light needs: samples, and whether it is an area light and casts shadows.
                LightEffects fn light_effects(light: &Light, quality: &Quality) -> LightEffects
                    = stage7_effects::light_effects; [LightQuery]
                /// What a material needs: lights, secondary rays, glossy reflection and images.
                MaterialEffects fn material_effects(material: &Material, lights: &[Light], quality: &Quality) -> MaterialEffects
                    = stage7_effects::material_effects; [MaterialQuery]
                /// What a scene needs. Materials and meshes that no shape of the scene has need nothing.
                Effects fn effects(scene: &Scene) -> Effects
                    = stage7_effects::effects; ()
                /// An upper bound of the number of rays of each kind that a scene can need.
                MostRays fn most_rays(scene: &Scene, effects: &Effects) -> RayCounts
                    = stage7_effects::most_rays; [BoundQuery]
                /// The exact number of rays of each kind that these hits need.
                RaysOfHits fn rays_of_hits(hits: &[MaterialHits], effects: &Effects, quality: &Quality) -> RayCounts
                    = stage7_effects::rays_of_hits; [HitsQuery]
                /// The smallest number of samples n with `deviation / √n <= error`.
                SamplesForError fn samples_for_error(deviation: f32, error: f32) -> u32
                    = stage7_effects::samples_for_error; ()
                /// The column or row that an image shows at `index`.
                Texel fn texel(index: i64, size: u32, wrap: Wrap) -> u32
                    = stage7_effects::texel; [TexelQuery Copy]
                /// The colour of an image at `uv` in linear light, by bilinear interpolation.
                TextureColor fn texture_color(texture: &Texture, uv: Vec2) -> Vec3
                    = stage7_effects::texture_color; [TextureQuery]
            }

            /// Stage 8: the scene graph, with every shape in a space of its own.
            8 trait SceneGraph {
                /// The ray in the space of an object, with the same `t` for every point as in the world.
                RayToObject fn ray_to_object(ray: &Ray, to_object: &Affine3A) -> Ray
                    = stage8_scene_graph::ray_to_object; [ObjectRayQuery Copy]
                /// The unit normal in the world, by the transpose of `to_object`.
                NormalToWorld fn normal_to_world(normal: Vec3, to_object: &Affine3A) -> Vec3
                    = stage8_scene_graph::normal_to_world; [NormalQuery Copy]
                /// The transforms of a node to the world and back; `None` without an inverse.
                Place fn placement(path: &[Affine3A]) -> Option<Placement>
                    = stage8_scene_graph::placement; ()
                /// A box in the world around the transformed box, rounded outwards.
                BoundsToWorld fn bounds_to_world(to_world: &Affine3A, bounds: &Aabb) -> Aabb
                    = stage8_scene_graph::bounds_to_world; [BoundsQuery Copy]
                /// A bounding sphere of one or more points, with at most twice the smallest possible radius.
                BoundingSphere fn bounding_sphere(points: &[Vec3]) -> Sphere
                    = stage8_scene_graph::bounding_sphere; ()
                /// The `t` at which a ray enters a bounding sphere.
                EnterBoundingSphere fn enter_bounding_sphere(ray: &Ray, sphere: &Sphere) -> Option<f32>
                    = stage8_scene_graph::enter_bounding_sphere; [BoundingSphereQuery Copy]
                /// The closest hit in a scene graph, with the given optimisations; `None` if nothing is hit.
                GraphHit fn closest_hit_in_graph[P: Probe](graph: &Graph, probe: &mut P, ray: &Ray, savings: GraphOptimisations) -> Option<PrimitiveHit>
                    = stage8_scene_graph::closest_hit_in_graph;
                { |q: GraphQuery| -> GraphAnswer {
                    let mut probe = TableProbe::without_hierarchy(&q.table);
                    let hit = F::closest_hit_in_graph(&q.graph, &mut probe, &q.ray, q.savings);
                    GraphAnswer { search: probe.answer(hit), asked: probe.asked }
                } }
                /// The closest hit in a scene graph, each node first in the child of the last hit.
                CachedGraphHit fn closest_hit_with_child_cache[P: Probe](
                    graph: &Graph, probe: &mut P, ray: &Ray, savings: GraphOptimisations, cache: &mut ChildCache
                ) -> Option<PrimitiveHit>
                    = stage8_child_cache::closest_hit_with_child_cache;
                { |q: CachedGraphQuery| -> CachedGraphAnswer {
                    let (query, mut cache) = (&q.search, q.cache.clone());
                    let mut probe = TableProbe::without_hierarchy(&query.table);
                    let hit = F::closest_hit_with_child_cache(
                        &query.graph, &mut probe, &query.ray, query.savings, &mut cache
                    );
                    CachedGraphAnswer { found: GraphAnswer { search: probe.answer(hit), asked: probe.asked }, cache }
                } }
                /// The nearest hit with the surface of a box, with the outward normal.
                Cuboid fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Option<SolidHit>
                    = stage8_solids::cuboid;
                { |q: SolidQuery<Cuboid>| -> Option<SolidHit> { F::cuboid(&q.ray, &q.solid) } }
                /// The nearest hit with the surface of a closed cylinder, with the outward normal.
                Cylinder fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<SolidHit>
                    = stage8_solids::cylinder;
                { |q: SolidQuery<Cylinder>| -> Option<SolidHit> { F::cylinder(&q.ray, &q.solid) } }
                /// The nearest hit with the surface of a closed cone, with the outward normal.
                Cone fn cone(ray: &Ray, cone: &Cone) -> Option<SolidHit>
                    = stage8_solids::cone;
                { |q: SolidQuery<Cone>| -> Option<SolidHit> { F::cone(&q.ray, &q.solid) } }
                /// The hit with a flat disk, from either side, in the range of the ray.
                Disk fn disk(ray: &Ray, disk: &Disk) -> Option<SolidHit>
                    = stage8_solids::disk;
                { |q: SolidQuery<Disk>| -> Option<SolidHit> { F::disk(&q.ray, &q.solid) } }
                /// The hit with a flat convex polygon, from either side, in the range of the ray.
                Polygon fn polygon(ray: &Ray, polygon: &Polygon) -> Option<SolidHit>
                    = stage8_solids::polygon;
                { |q: SolidQuery<Polygon>| -> Option<SolidHit> { F::polygon(&q.ray, &q.solid) } }
                /// The point of a bicubic Bézier patch at `uv`, by de Casteljau's algorithm.
                BezierPoint fn bezier_point(patch: &BezierPatch, uv: Vec2) -> Vec3
                    = stage8_surfaces::bezier_point; [PatchQuery Copy]
                /// The value of a B-spline basis function, by the recursion of Cox and de Boor.
                BsplineBasis fn bspline_basis(knots: &[f32], degree: usize, index: usize, u: f32) -> f32
                    = stage8_splines::bspline_basis; [BasisQuery]
                /// The point of a NURBS surface at the parameters `uv`, each within the domain of its knots.
                NurbsPoint fn nurbs_point(patch: &NurbsPatch, uv: Vec2) -> Vec3
                    = stage8_splines::nurbs_point; [NurbsQuery]
                /// A mesh after one step of Loop subdivision.
                LoopSubdivide fn loop_subdivide(mesh: &Mesh) -> Mesh
                    = stage8_surfaces::loop_subdivide; ()
            }

            /// Stage 9: partitions of space and coherent rays.
            9 trait Partitions {
                /// The interval of `t` in which a ray is in a closed cell.
                CellSpan fn cell_span(ray: &Ray, cell: &Cell) -> Option<(f64, f64)>
                    = stage9_cells::span;
                { |q: SlabQuery| -> Option<(f64, f64)> { F::cell_span(&q.ray, &Cell::new(&q.bounds)) } }
                /// The number of cells of a grid along each axis.
                GridResolution fn grid_resolution(bounds: &Aabb, n_primitives: usize, density: f32) -> UVec3
                    = stage9_grid::resolution; [ResolutionQuery Copy]
                /// A uniform grid over primitives with these boxes.
                GridBuild fn grid_build(bounds: &[Aabb], resolution: UVec3) -> Grid
                    = stage9_grid::build; [GridQuery]
                /// The closest hit in a uniform grid, from cell to cell along the ray.
                GridSearch fn grid_search[P: Cells](grid: &Grid, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_grid::closest_hit;
                { |q: CellsQuery<Grid>| -> CellsAnswer { look(q, |probe| F::grid_search(&q.cells, probe, &q.ray)) } }
                /// An octree over primitives with these boxes.
                OctreeBuild fn octree_build(bounds: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree
                    = stage9_octree::build;
                { [OctreeQuery] |q: OctreeQuery| -> Octree {
                    limited(q.bounds.len(), || F::octree_build(&q.bounds, q.leaf_size, q.max_depth))
                } }
                /// The closest hit in an octree, from leaf to leaf along the ray; `None` if nothing is hit.
                OctreeByCells fn octree_by_cells[P: Cells](octree: &Octree, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_octree::closest_hit_by_cells;
                { |q: CellsQuery<Octree>| -> CellsAnswer { look(q, |probe| F::octree_by_cells(&q.cells, probe, &q.ray)) } }
                /// The closest hit in an octree, from leaf to leaf along the ray without a return to the root.
                OctreeByNeighbours fn octree_by_neighbours[P: Cells](octree: &Octree, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_neighbours::closest_hit_by_neighbours;
                { |q: CellsQuery<Octree>| -> CellsAnswer {
                    look(q, |probe| F::octree_by_neighbours(&q.cells, probe, &q.ray))
                } }
                /// The closest hit in an octree, from the root down and nearest octant first.
                OctreeSearch fn octree_search[P: Cells](octree: &Octree, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_octree::closest_hit;
                { |q: CellsQuery<Octree>| -> CellsAnswer { look(q, |probe| F::octree_search(&q.cells, probe, &q.ray)) } }
                /// A kd-tree over primitives with these boxes, by the given heuristics.
                KdBuild fn kd_build(bounds: &[Aabb], heuristics: &KdHeuristics, leaf_size: usize) -> KdTree
                    = stage9_kd_tree::build;
                { [KdQuery] |q: KdQuery| -> KdTree {
                    limited(q.bounds.len(), || F::kd_build(&q.bounds, &q.heuristics, q.leaf_size))
                } }
                /// The closest hit in a kd-tree, nearer side of each plane first; `None` if nothing is hit.
                KdSearch fn kd_search[P: Cells](tree: &KdTree, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_kd_tree::closest_hit;
                { |q: CellsQuery<KdTree>| -> CellsAnswer { look(q, |probe| F::kd_search(&q.cells, probe, &q.ray)) } }
                /// A BSP tree over the hulls of primitives.
                BspBuild fn bsp_build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> Bsp
                    = stage9_bsp::build;
                { [BspQuery] |q: BspQuery| -> Bsp {
                    limited(q.hulls.len(), || F::bsp_build(&q.hulls, q.leaf_size, q.max_depth))
                } }
                /// The closest hit in a BSP tree, nearer side of each plane first; `None` if nothing is hit.
                BspSearch fn bsp_search[P: Cells](bsp: &Bsp, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_bsp::closest_hit;
                { |q: CellsQuery<Bsp>| -> CellsAnswer { look(q, |probe| F::bsp_search(&q.cells, probe, &q.ray)) } }
                /// A BSP tree whose nodes hold the polygons on their planes.
                PolygonBspBuild fn polygon_bsp_build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> PolygonBsp
                    = stage9_polygon_bsp::build;
                { |q: BspQuery| -> PolygonBsp {
                    limited(q.hulls.len(), || F::polygon_bsp_build(&q.hulls, q.leaf_size, q.max_depth))
                } }
                /// The closest hit in a BSP tree with polygons in its nodes.
                PolygonBspSearch fn polygon_bsp_search[P: Cells](bsp: &PolygonBsp, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_polygon_bsp::closest_hit;
                { |q: CellsQuery<PolygonBsp>| -> CellsAnswer {
                    look(q, |probe| F::polygon_bsp_search(&q.cells, probe, &q.ray))
                } }
                /// The closest hit by `search`, after a test of the primitive `last` that the previous ray hit.
                CachedSearch fn cached_search[P: Cells, S: FnOnce(&mut P, &Ray) -> Option<PrimitiveHit>](
                    last: Option<u32>, probe: &mut P, ray: &Ray, search: S
                ) -> Option<PrimitiveHit>
                    = stage9_coherence::closest_hit_cached;
                { |q: CachedQuery| -> CellsAnswer {
                    let mut probe = CellsProbe::new(&q.hits);
                    let search = |probe: &mut CellsProbe<'_>, ray: &Ray| q.search(probe, ray);
                    let hit = F::cached_search(q.last, &mut probe, &q.ray, search);
                    probe.finish(hit)
                } }
                /// The closest hit of each ray, by a traversal of the hierarchy with several rays at once.
                PacketSearch fn packet_search[P: Probe](bvh: &Bvh, probe: &mut P, rays: &[Ray]) -> Vec<Option<PrimitiveHit>>
                    = stage9_coherence::closest_hit_packet;
                { |q: PacketQuery| -> PacketAnswer {
                    let mut probe = PacketProbe::new(q);
                    let hits = F::packet_search(&q.bvh, &mut probe, &q.rays);
                    PacketAnswer { hits, ..probe.answer }
                } }
            }

            /// Stage 10: numerical stability.
            10 trait Stability {
                /// The real roots of `a t² + b t + c = 0`, the smaller one first; a double root is there twice.
                StableRoots fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]>
                    = stage10_stability::stable_roots;
                { |[a, b, c]: [f32; 3]| -> Option<[f32; 2]> { F::stable_roots(*a, *b, *c) } }
                /// The hit with a triangle, without gaps between triangles that share an edge.
                Watertight fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage10_stability::watertight; (TriangleQuery)
                /// The `t` of entry and exit of a box; never `None` for a box that the ray meets.
                ConservativeSlab fn conservative_slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)>
                    = stage10_stability::conservative_slab;
                { |q: SlabQuery| -> Option<(f32, f32)> { F::conservative_slab(&q.ray, q.ray.direction.recip(), &q.bounds) } }
                /// The origin of a ray that leaves a rounded surface (ray offset).
                OffsetOrigin fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3
                    = stage10_stability::offset_origin; [OffsetQuery Copy]
                /// The unit vector in the direction of `v`, however short or long `v` is.
                SafeNormalize fn safe_normalize(v: Vec3) -> Option<Vec3>
                    = stage10_stability::safe_normalize; ()
                /// The hit with a triangle in the range of the ray, by Cramer's rule in double precision.
                TriangleInDouble fn triangle_in_double(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage10_stability::triangle_in_double; (TriangleQuery)
                /// The `t` of the nearest hit with a sphere, in double precision and rounded once.
                SphereInDouble fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32>
                    = stage10_stability::sphere_in_double;
                { |q: SphereQuery| -> Option<f32> { F::sphere_in_double(&q.ray, q.sphere.center, q.sphere.radius) } }
            }

            /// Stage 11: light transport by path tracing. Random numbers come as arguments, `0 <= u < 1`.
            11 trait LightTransport {
                /// A direction with the density `cos θ / π` (cosine-weighted hemisphere sampling).
                CosineDirection fn cosine_direction(normal: Vec3, u: Vec2) -> Vec3
                    = stage11_light_transport::cosine_direction; ()
                /// The density per steradian with which `cosine_direction` samples a unit direction.
                CosinePdf fn cosine_pdf(normal: Vec3, direction: Vec3) -> f32
                    = stage11_light_transport::cosine_pdf; ()
                /// A random point of an emitter as seen from `from`.
                SampleLight fn sample_light(emitter: &AreaEmitter, from: Vec3, u: Vec2) -> Option<EmitterSample>
                    = stage11_light_transport::sample_light; [EmitterQuery Copy]
                /// The density per steradian with which `sample_light` samples a unit direction.
                LightPdf fn light_pdf(emitter: &AreaEmitter, from: Vec3, direction: Vec3) -> f32
                    = stage11_light_transport::light_pdf; [EmitterPdfQuery Copy]
                /// The weight of a sample in multiple importance sampling.
                MisWeight fn mis_weight(own: f32, other: f32) -> f32
                    = stage11_light_transport::mis_weight; ()
                /// The factor of Russian roulette for the weight of a path: 0 if it ends here.
                Survives fn survives(weight: Vec3, bounce: u32, u: f32) -> f32
                    = stage11_light_transport::survives; [RouletteQuery Copy]
                /// The fraction of the light that paths with at most `bounces` bounces miss.
                CutOff fn cut_off(albedo: f32, bounces: u32) -> f32
                    = stage11_light_transport::cut_off; ()
                /// The smallest number of bounces for which `cut_off` is at most `error`.
                BouncesForError fn bounces_for_error(albedo: f32, error: f32) -> u32
                    = stage11_light_transport::bounces_for_error; ()
                /// A random direction in which a path continues, from one lobe of the surface.
                SampleBsdf fn sample_bsdf(scattering: &Scattering, u: Vec3) -> Option<BsdfSample>
                    = stage11_paths::sample_bsdf; [BsdfQuery]
                /// The density with which `sample_bsdf` samples a direction in the diffuse lobe.
                BsdfPdf fn bsdf_pdf(scattering: &Scattering, direction: Vec3) -> f32
                    = stage11_paths::bsdf_pdf; [BsdfPdfQuery]
                /// The radiance that a diffuse surface sends on from a sample of a light, without occlusion.
                SampleLightContribution fn sample_light_contribution(
                    diffuse: Vec3, normal: Vec3, sample: &EmitterSample, bsdf_pdf: f32
                ) -> Vec3
                    = stage11_paths::sample_light_contribution; [LightContributionQuery Copy]
                /// The part of the radiance `emission` that counts for a ray which has hit its emitter.
                EmittedContribution fn emitted_contribution(emission: Vec3, pdf: f32, light_pdf: f32) -> Vec3
                    = stage11_paths::emitted_contribution; [EmissionQuery Copy]
                /// What a path does at a surface: light, shadow ray, and the next ray.
                Step fn step(path: &PathState, vertex: &PathVertex, max_depth: u32, numbers: &StepNumbers) -> PathStep
                    = stage11_paths::step; [StepQuery]
                /// What the paths of a scene need: diffuse rays and sampled lights.
                PathsCalledFor fn paths_called_for(scene: &Scene) -> PathEffects
                    = stage11_paths::paths_called_for; ()
            }

            /// Stage 12: speed.
            12 trait Speed {
                /// A hierarchy of stage 3 as a flat tree: all nodes in one array.
                Flatten fn flatten(bvh: &Bvh) -> FlatTree
                    = stage12_wide::flatten; ()
                /// The number of primitives in each bin, and the box around them, along all three axes.
                FillBins fn fill_bins(primitives: &[PrimitiveBox], grid: &BinGrid) -> Bins
                    = stage12_build::fill_bins;
                { [BinsQuery] |q: BinsQuery| -> Box<Bins> { Box::new(F::fill_bins(&q.primitives, &q.grid)) } }
                /// The cost of a leaf, which pays for whole blocks of eight.
                BlockCost fn block_cost(n_primitives: u32) -> f32
                    = stage12_build::block_cost; ()
                /// The cheapest split between two bins, by the surface area heuristic.
                CheapestSplit fn cheapest_split(bins: &Bins, n_bins: u32) -> Option<BinSplit>
                    = stage12_build::cheapest_split;
                { |q: BinSplitQuery| -> Option<BinSplit> { F::cheapest_split(&q.bins, q.n_bins) } }
                /// Reorders primitives so that those of the left side come first, and returns their number.
                PartitionBins fn partition_bins(primitives: &mut [PrimitiveBox], grid: &BinGrid, split: &BinSplit) -> usize
                    = stage12_build::partition_bins;
                { |q: PartitionQuery| -> SplitAnswer {
                    let mut primitives = q.primitives.clone();
                    let middle = F::partition_bins(&mut primitives, &q.grid, &q.split);
                    SplitAnswer { order: primitives.iter().map(PrimitiveBox::id).collect(), middle: Some(middle), unions: 0 }
                } }
                /// A binary hierarchy over primitives with these boxes, built with bins.
                BuildBinned fn build_binned(bounds: &[Aabb]) -> FlatTree
                    = stage12_build::build_binned; ()
                /// The same tree, built in parallel.
                BuildParallel fn build_parallel(bounds: &[Aabb], forks: &mut Forks) -> FlatTree
                    = stage12_build::build_parallel;
                { |bounds: Vec<Aabb>| -> ForkedTree {
                    let mut forks = Forks::new(false);
                    let tree = F::build_parallel(bounds, &mut forks);
                    ForkedTree { tree, forks: forks.into_log() }
                } }
                /// The cheapest tree with eight children per node over a binary one.
                Collapse fn collapse(tree: &FlatTree, node_cost: f32) -> WideTree
                    = stage12_wide::collapse; ()
                /// Which of the eight boxes of a node a ray enters, and where.
                EnterBoxes fn enter_boxes[L: Level](level: L, node: &WideNode, ray: &WideRay, t_max: f32) -> Entered
                    = stage12_simd::enter_boxes;
                { |q: WideBoxesQuery| -> Entered {
                    struct Work<'a, F>(&'a WideBoxesQuery, std::marker::PhantomData<F>);
                    impl<F: StudentFunctions> Vectorized for Work<'_, F> {
                        type Output = Entered;

                        #[inline(always)]
                        fn run<L: Level>(self, level: L) -> Entered {
                            F::enter_boxes(level, &self.0.node, &WideRay::new(&self.0.ray), self.0.ray.t_max)
                        }
                    }
                    Instructions::detect().run(Work::<F>(q, std::marker::PhantomData))
                } }
                /// Which of eight triangles a ray may hit, and which it passes through for certain.
                MayHit fn may_hit[L: Level](level: L, block: &TriangleBlock, ray: &WideRay, t_max: f32) -> Filtered
                    = stage12_simd::may_hit;
                { |q: BlockQuery| -> Filtered {
                    struct Work<'a, F>(&'a BlockQuery, std::marker::PhantomData<F>);
                    impl<F: StudentFunctions> Vectorized for Work<'_, F> {
                        type Output = Filtered;

                        #[inline(always)]
                        fn run<L: Level>(self, level: L) -> Filtered {
                            F::may_hit(level, &self.0.block, &WideRay::new(&self.0.ray), self.0.ray.t_max)
                        }
                    }
                    Instructions::detect().run(Work::<F>(q, std::marker::PhantomData))
                } }
                /// The closest hit in a wide tree, nearest child first; `None` if nothing is hit.
                WideClosestHit fn wide_closest_hit[P: WideProbe](probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage12_search::wide_closest_hit;
                { |q: WideQuery| -> WideAnswer {
                    let mut probe = WideTableProbe::new(q);
                    let hit = F::wide_closest_hit(&mut probe, &q.ray);
                    probe.answer(hit, hit.is_some())
                } }
                /// Whether the ray hits any primitive of a wide tree in its range (shadow rays).
                WideAnyHit fn wide_any_hit[P: WideProbe](probe: &mut P, ray: &Ray) -> bool
                    = stage12_search::wide_any_hit;
                { |q: WideQuery| -> WideAnswer {
                    let mut probe = WideTableProbe::new(q);
                    let found = F::wide_any_hit(&mut probe, &q.ray);
                    probe.answer(None, found)
                } }
            }
        }
    };
}
