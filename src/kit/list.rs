//! The list of student functions: every exercise once, with its signature, the file that holds it, the question that
//! tests and the worker protocol ask about it, and how an answer is put together from the function.
//!
//! Everything that has to name all functions is generated from this list: the trait that the renderer calls
//! ([`StudentFunctions`](super::StudentFunctions)), its implementation in a student's crate
//! ([`student_kit!`](crate::student_kit)), the names ([`Function`](super::Function)) and whether each is written
//! ([`is_written`](super::is_written)), the traits of the door and the messages to a worker ([`super::door`]), and the
//! adapters from functions to the door ([`Linked`](super::Linked)).
//!
//! An entry reads: the name of the message, the name of the function in the list with its generic parameters in brackets,
//! its signature, `=` the function in the student's crate, and the question with the expression that answers it. In that
//! expression `F` is the student's code.

/// Hands the list to another macro.
#[macro_export]
#[doc(hidden)]
macro_rules! student_functions {
    ($($receiver:tt)*) => {
        $($receiver)*! {
            /// Stage 1: spheres and planes.
            1 trait Shapes {
                /// The first of two roots that counts for a ray.
                NearestRoot fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32>
                    = stage1_shapes::nearest_root;
                |q: RootQuery| -> Option<f32> { F::nearest_root(q.roots, &q.ray) }
                /// Ray against sphere by the quadratic formula.
                SphereAlgebraic fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32>
                    = stage1_shapes::sphere_algebraic;
                |q: SphereQuery| -> Option<f32> { F::sphere_algebraic(&q.ray, q.sphere.center, q.sphere.radius) }
                /// Ray against sphere by right triangles.
                SphereGeometric fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32>
                    = stage1_shapes::sphere_geometric;
                |q: SphereQuery| -> Option<f32> { F::sphere_geometric(&q.ray, q.sphere.center, q.sphere.radius) }
                /// The outward unit normal of a sphere at a point of it.
                SphereNormal fn sphere_normal(center: Vec3, point: Vec3) -> Vec3
                    = stage1_shapes::sphere_normal;
                |(sphere, point): (Sphere, Vec3)| -> Vec3 { F::sphere_normal(sphere.center, *point) }
                /// Ray against plane.
                Plane fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32>
                    = stage1_shapes::plane;
                |q: PlaneQuery| -> Option<f32> { F::plane(&q.ray, q.plane.point, q.plane.normal) }
                /// A normal, turned to the side that a ray with this direction comes from.
                FaceViewer fn face_viewer(normal: Vec3, dir: Vec3) -> Vec3
                    = stage1_shapes::face_viewer;
                |(normal, dir): (Vec3, Vec3)| -> Vec3 { F::face_viewer(*normal, *dir) }
            }

            /// Stage 2: triangles and meshes.
            2 trait Triangles {
                /// Ray against triangle by Cramer's rule.
                TriangleCramer fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage2_triangles::triangle_cramer;
                |q: TriangleQuery| -> Option<TriangleHit> { F::triangle_cramer(&q.ray, &q.triangle) }
                /// The four scalars of the Gram method.
                GramScalars fn gram_scalars(triangle: &Triangle) -> GramScalars
                    = stage2_triangles::gram_scalars;
                |q: Triangle| -> GramScalars { F::gram_scalars(q) }
                /// Ray against triangle by plane and Gram matrix.
                TriangleGram fn triangle_gram(ray: &Ray, triangle: &Triangle, scalars: &GramScalars) -> Option<TriangleHit>
                    = stage2_triangles::triangle_gram;
                |q: TriangleQuery| -> Option<TriangleHit> {
                    let scalars = F::gram_scalars(&q.triangle);
                    F::triangle_gram(&q.ray, &q.triangle, &scalars)
                }
                /// Ray against triangle by a method of the student's choice; the reference is watertight.
                TriangleChoice fn triangle_choice(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage2_triangles::triangle_choice;
                |q: TriangleQuery| -> Option<TriangleHit> { F::triangle_choice(&q.ray, &q.triangle) }
                /// Inside test I: planes through the ray's origin and each side.
                InsideByPlanes fn inside_by_planes(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool
                    = stage2_triangles::inside_by_planes;
                |q: InsideQuery| -> bool { F::inside_by_planes(&q.ray, q.point, &q.triangle) }
                /// Inside test II: the ray's direction against each side.
                InsideByDirection fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool
                    = stage2_triangles::inside_by_direction;
                |q: InsideQuery| -> bool { F::inside_by_direction(&q.ray, q.point, &q.triangle) }
                /// Inside test III: areas; `(α, β, γ)` if inside.
                InsideByAreas fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3>
                    = stage2_triangles::inside_by_areas;
                |q: InsideQuery| -> Option<Vec3> { F::inside_by_areas(q.point, &q.triangle) }
                /// A value between three corners.
                Interpolate fn interpolate(weights: Vec3, corners: [Vec3; 3]) -> Vec3
                    = stage2_triangles::interpolate;
                |q: InterpolateQuery| -> Vec3 { F::interpolate(q.weights, q.corners) }
                /// The unit normal of a triangle, if it has one.
                FaceNormal fn face_normal(triangle: &Triangle) -> Option<Vec3>
                    = stage2_triangles::face_normal;
                |q: Triangle| -> Option<Vec3> { F::face_normal(q) }
                /// One unit normal a vertex: the average of the faces around it.
                VertexNormals fn vertex_normals(mesh: &Mesh) -> Vec<Vec3>
                    = stage2_triangles::vertex_normals;
                |q: Mesh| -> Vec<Vec3> { F::vertex_normals(q) }
                /// The closest hit among all primitives of the table.
                BruteForce fn brute_force[P: Probe](n_primitives: u32, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage2_triangles::brute_force;
                |q: SearchQuery| -> SearchAnswer {
                    let n_primitives = q.table.primitives.len() as u32;
                    search(q, |probe| F::brute_force(n_primitives, probe, &q.ray))
                }
            }

            /// Stage 3: bounding volume hierarchies.
            3 trait Hierarchies {
                /// The box around a triangle.
                TriangleBounds fn triangle_bounds(triangle: &Triangle) -> Aabb
                    = stage3_bvh::triangle_bounds;
                |q: Triangle| -> Aabb { F::triangle_bounds(q) }
                /// The box around a sphere.
                SphereBounds fn sphere_bounds(sphere: &Sphere) -> Aabb
                    = stage3_bvh::sphere_bounds;
                |q: Sphere| -> Aabb { F::sphere_bounds(q) }
                /// The smallest box around two boxes.
                Union fn union(first: &Aabb, second: &Aabb) -> Aabb
                    = stage3_bvh::union;
                |(first, second): (Aabb, Aabb)| -> Aabb { F::union(first, second) }
                /// The middle of a box.
                Centroid fn centroid(bounds: &Aabb) -> Vec3
                    = stage3_bvh::centroid;
                |q: Aabb| -> Vec3 { F::centroid(q) }
                /// The surface area of a box.
                SurfaceArea fn surface_area(bounds: &Aabb) -> f32
                    = stage3_bvh::surface_area;
                |q: Aabb| -> f32 { F::surface_area(q) }
                /// Where a ray enters and leaves a box, within its range.
                Slab fn slab(ray: &Ray, inverse_dir: Vec3, bounds: &Aabb) -> Option<(f32, f32)>
                    = stage3_bvh::slab;
                |q: SlabQuery| -> Option<(f32, f32)> { F::slab(&q.ray, q.ray.dir.recip(), &q.bounds) }
                /// Half of the primitives on either side.
                SplitObjectMedian fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize
                    = stage3_bvh::split_object_median;
                |primitives: Vec<PrimitiveRef>| -> SplitAnswer {
                    divide(primitives, |primitives| Some(F::split_object_median(primitives)))
                }
                /// Half of the box on either side.
                SplitSpatialMedian fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize
                    = stage3_bvh::split_spatial_median;
                |primitives: Vec<PrimitiveRef>| -> SplitAnswer {
                    divide(primitives, |primitives| Some(F::split_spatial_median(primitives)))
                }
                /// The cut that costs least, if it costs less than a leaf.
                SplitSurfaceArea fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize>
                    = stage3_bvh::split_surface_area;
                |primitives: Vec<PrimitiveRef>| -> SplitAnswer { divide(primitives, F::split_surface_area) }
                /// A hierarchy over boxes.
                Build fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh
                    = stage3_bvh::build;
                |q: BuildQuery| -> Bvh { F::build(&q.bounds, q.split, q.leaf_size) }
                /// The closest hit, visiting both children always.
                ClosestHitBoth fn closest_hit_both[P: Probe](bvh: &Bvh, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage3_bvh::closest_hit_both;
                |q: SearchQuery| -> SearchAnswer { search(q, |probe| F::closest_hit_both(&q.bvh, probe, &q.ray)) }
                /// The closest hit, nearer child first, skipping what lies beyond the best hit.
                ClosestHit fn closest_hit[P: Probe](bvh: &Bvh, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage3_bvh::closest_hit;
                |q: SearchQuery| -> SearchAnswer { search(q, |probe| F::closest_hit(&q.bvh, probe, &q.ray)) }
                /// Whether there is any hit.
                AnyHit fn any_hit[P: Probe](bvh: &Bvh, probe: &mut P, ray: &Ray) -> bool
                    = stage3_bvh::any_hit;
                |q: SearchQuery| -> (bool, SearchAnswer) {
                    let mut found = false;
                    let answer = search(q, |probe| {
                        found = F::any_hit(&q.bvh, probe, &q.ray);
                        None
                    });
                    (found, answer)
                }
            }

            /// Stage 4: light and shade.
            4 trait Shading {
                /// The cosine term of diffuse light.
                DiffuseTerm fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32
                    = stage4_shading::diffuse_term;
                |q: TermQuery| -> f32 { F::diffuse_term(q.normal, q.to_light) }
                /// The highlight.
                SpecularTerm fn specular_term(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32
                    = stage4_shading::specular_term;
                |q: TermQuery| -> f32 { F::specular_term(q.normal, q.to_light, q.to_viewer, q.exponent) }
                /// The ray that asks whether a light is visible, if the light can matter.
                ShadowRay fn shadow_ray(surface: &Surface, light: &LightSample) -> Option<Ray>
                    = stage4_shading::shadow_ray;
                |q: ShadowQuery| -> Option<Ray> { F::shadow_ray(&q.surface, &q.light) }
                /// The normal to shade with: `(geometric, interpolated, ray direction)`.
                ShadingNormal fn shading_normal(geometric: Vec3, interpolated: Option<Vec3>, dir: Vec3) -> Vec3
                    = stage4_shading::shading_normal;
                |(geometric, smooth, dir): (Vec3, Option<Vec3>, Vec3)| -> Vec3 { F::shading_normal(*geometric, *smooth, *dir) }
                /// The colour of a point.
                Shade fn shade[V: FnMut(usize, &Ray) -> bool](
                    surface: &Surface, to_viewer: Vec3, material: &Material, ambient: Vec3, lights: &[LightSample], visible: V
                ) -> Vec3
                    = stage4_shading::shade;
                |q: ShadeQuery| -> ShadeAnswer {
                    let mut traced = Vec::new();
                    let visible = |light: usize, _: &Ray| {
                        traced.push(light);
                        q.visible[light]
                    };
                    let color =
                        F::shade(&q.surface, q.to_viewer, &q.material, q.ambient, &q.lights, visible);
                    ShadeAnswer { color, traced }
                }
                /// Linear light to a byte with gamma 2.
                EncodeGamma fn encode_gamma(linear: f32) -> u8
                    = stage4_shading::encode_gamma;
                |linear: f32| -> u8 { F::encode_gamma(*linear) }
                /// A byte to linear light with gamma 2.
                DecodeGamma fn decode_gamma(byte: u8) -> f32
                    = stage4_shading::decode_gamma;
                |byte: u8| -> f32 { F::decode_gamma(*byte) }
            }

            /// Stage 5: mirrors and glass.
            5 trait Recursion {
                /// The mirrored direction: `(direction, normal)`.
                Mirror fn mirror(dir: Vec3, normal: Vec3) -> Vec3
                    = stage5_recursion::mirror;
                |(dir, normal): (Vec3, Vec3)| -> Vec3 { F::mirror(*dir, *normal) }
                /// The refracted direction, unless all light is mirrored.
                Refract fn refract(dir: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3>
                    = stage5_recursion::refract;
                |q: RefractQuery| -> Option<Vec3> { F::refract(q.dir, q.normal, q.n1, q.n2) }
                /// The mirrored share by Schlick's formula.
                FresnelSchlick fn fresnel_schlick(cos_theta: f32, n1: f32, n2: f32) -> f32
                    = stage5_recursion::fresnel_schlick;
                |q: FresnelQuery| -> f32 { F::fresnel_schlick(q.cos_theta, q.n1, q.n2) }
                /// The mirrored share by Fresnel's equations.
                FresnelExact fn fresnel_exact(cos_theta: f32, n1: f32, n2: f32) -> f32
                    = stage5_recursion::fresnel_exact;
                |q: FresnelQuery| -> f32 { F::fresnel_exact(q.cos_theta, q.n1, q.n2) }
                /// The rays that go on from a surface.
                Children fn children(
                    dir: Vec3, normal: Vec3, entering: bool, material: &Material, weight: Vec3, depth: u32, limits: &Limits
                ) -> Vec<Child>
                    = stage5_recursion::children;
                |q: ChildrenQuery| -> Vec<Child> {
                    F::children(q.dir, q.normal, q.entering, &q.material, q.weight, q.depth, &q.limits)
                }
                /// The ray that follows a child, off the surface.
                Leave fn leave(surface: &Surface, child: &Child) -> Ray
                    = stage5_recursion::leave;
                |(surface, child): (Surface, Child)| -> Ray { F::leave(surface, child) }
            }

            /// Stage 6: distributed ray tracing.
            6 trait Distribution {
                /// Where in its cell a sample lies.
                Jittered fn jittered(stratum: &Stratum) -> Vec2
                    = stage6_distribution::jittered;
                |q: Stratum| -> Vec2 { F::jittered(q) }
                /// Where in or around its pixel a sample lies.
                PixelPosition fn pixel_position(sampler: Sampler, stratum: &Stratum) -> Vec2
                    = stage6_distribution::pixel_position;
                |(sampler, stratum): (Sampler, Stratum)| -> Vec2 { F::pixel_position(*sampler, stratum) }
                /// The weight of a sample at this distance from the centre of its pixel.
                GaussianWeight fn gaussian_weight(offset: Vec2) -> f32
                    = stage6_distribution::gaussian_weight;
                |offset: Vec2| -> f32 { F::gaussian_weight(*offset) }
                /// The colour of a pixel from its samples.
                Develop fn develop(samples: &[WeightedColor]) -> Vec3
                    = stage6_distribution::develop;
                |samples: Vec<WeightedColor>| -> Vec3 { F::develop(samples) }
                /// A place on a disk of radius 1.
                OnDisk fn on_disk(u: Vec2) -> Vec2
                    = stage6_distribution::on_disk;
                |u: Vec2| -> Vec2 { F::on_disk(*u) }
                /// The ray from a place on the lens.
                LensRay fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray
                    = stage6_distribution::lens_ray;
                |q: LensQuery| -> Ray { F::lens_ray(&q.camera, &q.pinhole, &q.lens, q.on_lens) }
                /// A point of a rectangular lamp.
                OnRectangle fn on_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3
                    = stage6_distribution::on_rectangle;
                |q: RectangleQuery| -> Vec3 { F::on_rectangle(q.corner, q.edges, q.u) }
                /// A point of a round flat lamp.
                OnLampDisk fn on_lamp_disk(disk: &Disk, u: Vec2) -> Vec3
                    = stage6_distribution::on_lamp_disk;
                |(disk, u): (Disk, Vec2)| -> Vec3 { F::on_lamp_disk(disk, *u) }
                /// A direction to a ball.
                TowardBall fn toward_ball(ball: &Sphere, from: Vec3, u: Vec2) -> Vec3
                    = stage6_distribution::toward_ball;
                |q: BallQuery| -> Vec3 { F::toward_ball(&q.ball, q.from, q.u) }
                /// A direction off or through a rough surface.
                Gloss fn gloss(ideal: Vec3, normal: Vec3, roughness: f32, u: Vec2) -> Vec3
                    = stage6_distribution::gloss;
                |q: GlossQuery| -> Vec3 { F::gloss(q.ideal, q.normal, q.roughness, q.u) }
                /// The slot in time of the cell in column x and row y.
                TemporalSlot fn temporal_slot(x: u32, y: u32) -> u32
                    = stage6_distribution::temporal_slot;
                |(x, y): (u32, u32)| -> u32 { F::temporal_slot(*x, *y) }
                /// A moment while the shutter is open.
                TimeInShutter fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32
                    = stage6_distribution::time_in_shutter;
                |q: TimeQuery| -> f32 { F::time_in_shutter(&q.shutter, q.slot, q.slots, q.u) }
                /// Where a point is that moves from the first to the second in time 0 to 1.
                Between fn between(start: Vec3, end: Vec3, time: f32) -> Vec3
                    = stage6_distribution::between;
                |(start, end, time): (Vec3, Vec3, f32)| -> Vec3 { F::between(*start, *end, *time) }
                /// The box around all that moves from the first box to the second.
                Sweep fn sweep(start: &Aabb, end: &Aabb) -> Aabb
                    = stage6_distribution::sweep;
                |(start, end): (Aabb, Aabb)| -> Aabb { F::sweep(start, end) }
            }

            /// Stage 7: only what the scene calls for.
            7 trait Economy {
                /// What a light takes.
                LightEffects fn light_effects(light: &Light, quality: &Quality) -> LightEffects
                    = stage7_effects::light_effects;
                |q: LightQuery| -> LightEffects { F::light_effects(&q.light, &q.quality) }
                /// What a material takes.
                MaterialEffects fn material_effects(material: &Material, lights: &[Light], quality: &Quality) -> MaterialEffects
                    = stage7_effects::material_effects;
                |q: MaterialQuery| -> MaterialEffects { F::material_effects(&q.material, &q.lights, &q.quality) }
                /// What a scene takes.
                Effects fn effects(scene: &Scene) -> Effects
                    = stage7_effects::effects;
                |q: Scene| -> Effects { F::effects(q) }
                /// The most rays that a scene can take.
                MostRays fn most_rays(scene: &Scene, effects: &Effects) -> RayCounts
                    = stage7_effects::most_rays;
                |q: BoundQuery| -> RayCounts { F::most_rays(&q.scene, &q.effects) }
                /// The rays that hits send on.
                RaysOfHits fn rays_of_hits(hits: &[MaterialHits], effects: &Effects, quality: &Quality) -> RayCounts
                    = stage7_effects::rays_of_hits;
                |q: HitsQuery| -> RayCounts { F::rays_of_hits(&q.hits, &q.effects, &q.quality) }
                /// How many samples it takes for an error: `(standard deviation of one, error of the mean)`.
                SamplesForError fn samples_for_error(deviation: f32, error: f32) -> u32
                    = stage7_effects::samples_for_error;
                |(deviation, error): (f32, f32)| -> u32 { F::samples_for_error(*deviation, *error) }
                /// The column or row of an image that stands for this one.
                Texel fn texel(index: i64, size: u32, wrap: Wrap) -> u32
                    = stage7_effects::texel;
                |q: TexelQuery| -> u32 { F::texel(q.index, q.size, q.wrap) }
                /// The colour of an image.
                TextureColor fn texture_color(texture: &Texture, uv: Vec2) -> Vec3
                    = stage7_effects::texture_color;
                |q: TextureQuery| -> Vec3 { F::texture_color(&q.texture, q.uv) }
            }

            /// Stage 8: every shape in a space of its own.
            8 trait SceneGraph {
                /// The ray in the space of an object.
                RayToObject fn ray_to_object(ray: &Ray, to_object: &Affine3A) -> Ray
                    = stage8_scene_graph::ray_to_object;
                |q: ObjectRayQuery| -> Ray { F::ray_to_object(&q.ray, &q.to_object) }
                /// The normal of an object in the world.
                NormalToWorld fn normal_to_world(normal: Vec3, to_object: &Affine3A) -> Vec3
                    = stage8_scene_graph::normal_to_world;
                |q: NormalQuery| -> Vec3 { F::normal_to_world(q.normal, &q.to_object) }
                /// The way of a node to the world and back, for the transforms from the root down.
                Place fn placement(path: &[Affine3A]) -> Option<Placement>
                    = stage8_scene_graph::placement;
                |path: Vec<Affine3A>| -> Option<Placement> { F::placement(path) }
                /// The box around a transformed box.
                BoundsToWorld fn bounds_to_world(to_world: &Affine3A, bounds: &Aabb) -> Aabb
                    = stage8_scene_graph::bounds_to_world;
                |q: BoundsQuery| -> Aabb { F::bounds_to_world(&q.to_world, &q.bounds) }
                /// A ball around points.
                BoundingBall fn bounding_ball(points: &[Vec3]) -> Sphere
                    = stage8_scene_graph::bounding_ball;
                |points: Vec<Vec3>| -> Sphere { F::bounding_ball(points) }
                /// Where a ray enters a ball.
                EnterBall fn enter_ball(ray: &Ray, ball: &Sphere) -> Option<f32>
                    = stage8_scene_graph::enter_ball;
                |q: BallEntryQuery| -> Option<f32> { F::enter_ball(&q.ray, &q.ball) }
                /// The closest hit in a scene graph.
                GraphHit fn closest_hit_in_graph[P: Probe](graph: &Graph, probe: &mut P, ray: &Ray, savings: Savings) -> Option<PrimitiveHit>
                    = stage8_scene_graph::closest_hit_in_graph;
                |q: GraphQuery| -> GraphAnswer {
                    let mut probe = TableProbe::without_hierarchy(&q.table);
                    let hit = F::closest_hit_in_graph(&q.graph, &mut probe, &q.ray, q.savings);
                    GraphAnswer { search: probe.answer(hit), asked: probe.asked }
                }
                /// Ray against box.
                Cuboid fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Option<SolidHit>
                    = stage8_solids::cuboid;
                |q: SolidQuery<Cuboid>| -> Option<SolidHit> { F::cuboid(&q.ray, &q.solid) }
                /// Ray against closed cylinder.
                Cylinder fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<SolidHit>
                    = stage8_solids::cylinder;
                |q: SolidQuery<Cylinder>| -> Option<SolidHit> { F::cylinder(&q.ray, &q.solid) }
                /// Ray against closed cone.
                Cone fn cone(ray: &Ray, cone: &Cone) -> Option<SolidHit>
                    = stage8_solids::cone;
                |q: SolidQuery<Cone>| -> Option<SolidHit> { F::cone(&q.ray, &q.solid) }
                /// Ray against disk.
                Disk fn disk(ray: &Ray, disk: &Disk) -> Option<SolidHit>
                    = stage8_solids::disk;
                |q: SolidQuery<Disk>| -> Option<SolidHit> { F::disk(&q.ray, &q.solid) }
                /// Ray against convex polygon.
                Polygon fn polygon(ray: &Ray, polygon: &Polygon) -> Option<SolidHit>
                    = stage8_solids::polygon;
                |q: SolidQuery<Polygon>| -> Option<SolidHit> { F::polygon(&q.ray, &q.solid) }
                /// A point of a Bézier patch.
                BezierPoint fn bezier_point(patch: &BezierPatch, uv: Vec2) -> Vec3
                    = stage8_surfaces::bezier_point;
                |q: PatchQuery| -> Vec3 { F::bezier_point(&q.patch, q.uv) }
                /// A mesh with four triangles for each.
                LoopSubdivide fn loop_subdivide(mesh: &Mesh) -> Mesh
                    = stage8_surfaces::loop_subdivide;
                |q: Mesh| -> Mesh { F::loop_subdivide(q) }
            }

            /// Stage 9: cells of space.
            9 trait Partitions {
                /// Where a ray is in a cell, in double precision.
                CellSpan fn cell_span(ray: &Ray, cell: &Cell) -> Option<(f64, f64)>
                    = stage9_cells::span;
                |q: SlabQuery| -> Option<(f64, f64)> { F::cell_span(&q.ray, &Cell::new(&q.bounds)) }
                /// How many cells a grid should have along each axis.
                GridResolution fn grid_resolution(bounds: &Aabb, n_primitives: usize, density: f32) -> UVec3
                    = stage9_grid::resolution;
                |q: ResolutionQuery| -> UVec3 { F::grid_resolution(&q.bounds, q.n_primitives, q.density) }
                /// A grid over boxes.
                GridBuild fn grid_build(bounds: &[Aabb], resolution: UVec3) -> Grid
                    = stage9_grid::build;
                |q: GridQuery| -> Grid { F::grid_build(&q.bounds, q.resolution) }
                /// The closest hit in a grid.
                GridSearch fn grid_search[P: Cells](grid: &Grid, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_grid::closest_hit;
                |q: CellsQuery<Grid>| -> CellsAnswer { look(q, |probe| F::grid_search(&q.cells, probe, &q.ray)) }
                /// An octree over boxes.
                OctreeBuild fn octree_build(bounds: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree
                    = stage9_octree::build;
                |q: OctreeQuery| -> Octree { F::octree_build(&q.bounds, q.leaf_size, q.max_depth) }
                /// The closest hit in an octree, from cell to cell.
                OctreeByCells fn octree_by_cells[P: Cells](octree: &Octree, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_octree::closest_hit_by_cells;
                |q: CellsQuery<Octree>| -> CellsAnswer { look(q, |probe| F::octree_by_cells(&q.cells, probe, &q.ray)) }
                /// The closest hit in an octree, from the root down.
                OctreeSearch fn octree_search[P: Cells](octree: &Octree, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_octree::closest_hit;
                |q: CellsQuery<Octree>| -> CellsAnswer { look(q, |probe| F::octree_search(&q.cells, probe, &q.ray)) }
                /// A kd-tree over boxes.
                KdBuild fn kd_build(bounds: &[Aabb], heuristics: &KdHeuristics, leaf_size: usize) -> KdTree
                    = stage9_kd_tree::build;
                |q: KdQuery| -> KdTree { F::kd_build(&q.bounds, &q.heuristics, q.leaf_size) }
                /// The closest hit in a kd-tree.
                KdSearch fn kd_search[P: Cells](tree: &KdTree, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_kd_tree::closest_hit;
                |q: CellsQuery<KdTree>| -> CellsAnswer { look(q, |probe| F::kd_search(&q.cells, probe, &q.ray)) }
                /// A BSP tree over hulls.
                BspBuild fn bsp_build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> Bsp
                    = stage9_bsp::build;
                |q: BspQuery| -> Bsp { F::bsp_build(&q.hulls, q.leaf_size, q.max_depth) }
                /// The closest hit in a BSP tree.
                BspSearch fn bsp_search[P: Cells](bsp: &Bsp, probe: &mut P, ray: &Ray) -> Option<PrimitiveHit>
                    = stage9_bsp::closest_hit;
                |q: CellsQuery<Bsp>| -> CellsAnswer { look(q, |probe| F::bsp_search(&q.cells, probe, &q.ray)) }
                /// The closest hit, knowing what the ray before hit.
                CachedSearch fn cached_search[P: Cells, S: FnOnce(&mut P, &Ray) -> Option<PrimitiveHit>](
                    last: Option<u32>, probe: &mut P, ray: &Ray, search: S
                ) -> Option<PrimitiveHit>
                    = stage9_coherence::closest_hit_cached;
                |q: CachedQuery| -> CellsAnswer {
                    let mut probe = CellsProbe::new(&q.hits);
                    let search = |probe: &mut CellsProbe<'_>, ray: &Ray| q.search(probe, ray);
                    let hit = F::cached_search(q.last, &mut probe, &q.ray, search);
                    CellsAnswer { hit, ..probe.answer }
                }
                /// The closest hits of several rays.
                PacketSearch fn packet_search[P: Probe](bvh: &Bvh, probe: &mut P, rays: &[Ray]) -> Vec<Option<PrimitiveHit>>
                    = stage9_coherence::closest_hit_packet;
                |q: PacketQuery| -> PacketAnswer {
                    let mut probe = PacketProbe::new(q);
                    let hits = F::packet_search(&q.bvh, &mut probe, &q.rays);
                    PacketAnswer { hits, ..probe.answer }
                }
            }

            /// Stage 10: answers that survive rounding.
            10 trait Stability {
                /// The roots of `a t² + b t + c`, for `[a, b, c]`.
                StableRoots fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]>
                    = stage10_stability::stable_roots;
                |[a, b, c]: [f32; 3]| -> Option<[f32; 2]> { F::stable_roots(*a, *b, *c) }
                /// Ray against triangle, without leaks between neighbours.
                Watertight fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage10_stability::watertight;
                |q: TriangleQuery| -> Option<TriangleHit> { F::watertight(&q.ray, &q.triangle) }
                /// Ray against box, without a miss of what is met.
                ConservativeSlab fn conservative_slab(ray: &Ray, inverse_dir: Vec3, bounds: &Aabb) -> Option<(f32, f32)>
                    = stage10_stability::conservative_slab;
                |q: SlabQuery| -> Option<(f32, f32)> { F::conservative_slab(&q.ray, q.ray.dir.recip(), &q.bounds) }
                /// Where a ray starts that leaves a surface.
                OffsetOrigin fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3
                    = stage10_stability::offset_origin;
                |q: OffsetQuery| -> Vec3 { F::offset_origin(q.point, q.error, q.normal, q.direction) }
                /// The unit vector along another, if it has a direction.
                SafeNormalize fn safe_normalize(v: Vec3) -> Option<Vec3>
                    = stage10_stability::safe_normalize;
                |v: Vec3| -> Option<Vec3> { F::safe_normalize(*v) }
                /// Ray against triangle, every number in double precision.
                TriangleInDouble fn triangle_in_double(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit>
                    = stage10_stability::triangle_in_double;
                |q: TriangleQuery| -> Option<TriangleHit> { F::triangle_in_double(&q.ray, &q.triangle) }
                /// Ray against sphere, every number in double precision.
                SphereInDouble fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32>
                    = stage10_stability::sphere_in_double;
                |q: SphereQuery| -> Option<f32> { F::sphere_in_double(&q.ray, q.sphere.center, q.sphere.radius) }
            }
        }
    };
}
