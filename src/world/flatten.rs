//! Traversal of the scene graph: transforms are multiplied, shapes become primitives, and what moves is kept
//! at shutter times 0 and 1.

use super::facets::{self, Facet};
use super::meshes::{Meshes, PreparedMesh};
use super::transforms::{normal_matrix, plane_axes, uniform_scale, unit};
use super::{
    Geometry, InfinitePlane, Instance, OptionalIndex, Primitive, SharedMesh, Solid, SolidShape, World,
    WorldFunctions,
};
use crate::effects::Effects;
use crate::graph::{Graph, GraphNode, Placement};
use crate::scene::{Accelerator, Node, Scene, blend};
use crate::shape::{Plane, PlaneEquation, Shape, Sphere, Triangle};
use glam::{Affine3A, Mat3, Vec2, Vec3};
use std::ops::Range;

/// Traverses `scene` from its roots and returns its primitives in world space; see [`World::new`].
pub(super) fn flatten(scene: &Scene, effects: &Effects, functions: &WorldFunctions) -> World {
    let mut meshes = Meshes::new(scene, effects, functions);
    let searched = matches!(
        scene.quality.accelerator,
        Accelerator::BoundingBoxes | Accelerator::BoundingSpheres | Accelerator::CachedBoundingBoxes
    );
    let mut flattener = Flattener {
        scene,
        effects,
        functions,
        // Without motion blur, nodes stand where they are when the shutter opens.
        still_at: scene.camera.shutter.map_or(0.0, |shutter| shutter.open),
        path: Vec::new(),
        world: World {
            materials: scene.materials.clone(),
            lights: scene.lights.clone(),
            textures: scene.textures.clone(),
            // The graph has one root, above all roots of the scene.
            graph: searched.then(|| Graph { nodes: vec![GraphNode::default()] }),
            ..World::default()
        },
    };
    for &root in &scene.roots {
        flattener.node(root, &Motion::still(Affine3A::IDENTITY), 0, 0, &mut meshes);
    }
    flattener.world
}

/// The transform of a node to the world at time 0, and at time 1 if it moves.
struct Motion {
    start: Affine3A,
    end: Option<Affine3A>,
    /// Whether `start` is a blend between two times, and not the product of the transforms of the nodes.
    blended: bool,
}

impl Motion {
    fn still(start: Affine3A) -> Motion {
        Motion { start, end: None, blended: false }
    }

    fn then(&self, node: &Node) -> Motion {
        let moves = self.end.is_some() || node.transform_end.is_some();
        let end = || self.end.unwrap_or(self.start) * node.transform_end.unwrap_or(node.transform);
        Motion { start: self.start * node.transform, end: moves.then(end), blended: false }
    }

    /// The same transform for positions that are counted from `origin`. It is computed in double precision, because the
    /// translations often cancel.
    fn counted_from(&self, origin: Vec3) -> Motion {
        let moved = |transform: Affine3A| {
            let shift = transform.matrix3.as_dmat3() * origin.as_dvec3();
            let translation = (transform.translation.as_dvec3() + shift).as_vec3a();
            Affine3A { translation, ..transform }
        };
        Motion { start: moved(self.start), end: self.end.map(moved), blended: self.blended }
    }
}

struct Flattener<'a> {
    scene: &'a Scene,
    effects: &'a Effects,
    functions: &'a WorldFunctions,
    still_at: f32,
    /// The transforms from the root down to the current node.
    path: Vec<Affine3A>,
    world: World,
}

impl Flattener<'_> {
    /// Adds the node `index` and all nodes below it. `motion` is the transform of its parent, `above` the index
    /// of the parent in the graph, and `material` is inherited from it.
    fn node(&mut self, index: usize, motion: &Motion, material: usize, above: u32, meshes: &mut Meshes) {
        let node = &self.scene.nodes[index];
        let motion = motion.then(node);
        let material = node.material.unwrap_or(material);
        let first = self.world.primitives.len() as u32;
        self.path.push(node.transform);
        if let Some(shape) = &node.shape {
            let motion = match motion.end {
                Some(end) if self.effects.motion && end != motion.start => {
                    Motion { end: Some(end), ..motion }
                }
                Some(end) => {
                    Motion { start: blend(&motion.start, &end, self.still_at), end: None, blended: true }
                }
                None => Motion::still(motion.start),
            };
            let (origin, ready) = match shape {
                Shape::Mesh(mesh) => (self.scene.meshes[*mesh].origin, meshes.of_scene.get_mut(*mesh)),
                _ => (Vec3::ZERO, meshes.of_nodes.get_mut(&index)),
            };
            if origin == Vec3::ZERO {
                self.shape(shape, ready, &motion, material as u32);
            } else {
                self.path.push(Affine3A::from_translation(origin));
                self.shape(shape, ready, &motion.counted_from(origin), material as u32);
                self.path.pop();
            }
        }
        let here = self.in_graph(first..self.world.primitives.len() as u32, above);
        for &child in &node.children {
            self.node(child, &motion, material, here, meshes);
        }
        self.path.pop();
    }

    /// Adds a node with `primitives` to the graph, below the node `above`. Returns its index, or 0 if there
    /// is no graph.
    fn in_graph(&mut self, primitives: Range<u32>, above: u32) -> u32 {
        let Some(Graph { nodes }) = &mut self.world.graph else { return 0 };
        let here = nodes.len() as u32;
        nodes.push(GraphNode { children: Vec::new(), primitives: primitives.collect() });
        nodes[above as usize].children.push(here);
        here
    }

    fn shape(&mut self, shape: &Shape, ready: Option<&mut PreparedMesh>, motion: &Motion, material: u32) {
        match shape {
            Shape::Sphere(_) if !self.functions.spheres => {}
            Shape::Sphere(sphere) => self.sphere(sphere, motion, material),
            Shape::Plane(_) if !self.functions.planes => {}
            Shape::Plane(plane) => self.plane(plane, None, motion, material),
            // A plane that moves is tested by a point and a normal.
            Shape::PlaneEquation(equation) => match (self.functions.equations, motion.end) {
                (true, None) => self.plane(&equation.to_plane(), Some(*equation), motion, material),
                _ if self.functions.planes => self.plane(&equation.to_plane(), None, motion, material),
                _ => {}
            },
            Shape::Triangle(_) | Shape::Mesh(_) | Shape::Bezier { .. } | Shape::Nurbs { .. }
                if !self.functions.triangles => {}
            Shape::Triangle(t) => {
                let uvs = Some([Vec2::ZERO, Vec2::X, Vec2::Y]);
                self.facets(&[Facet { corners: [t.a, t.b, t.c], normals: None, uvs }], motion, material);
            }
            Shape::Mesh(_) | Shape::Bezier { .. } | Shape::Nurbs { .. } => {
                // `None` for a curved surface whose function is not written.
                if let Some(ready) = ready {
                    self.mesh(ready, motion, material);
                }
            }
            _ if self.solid(shape, motion, material) => {}
            _ if !self.functions.triangles => {}
            Shape::Polygon(polygon) => self.facets(&facets::polygon(&polygon.corners), motion, material),
            Shape::Cuboid(cuboid) => self.facets(&facets::cuboid(cuboid), motion, material),
            Shape::Cylinder(cylinder) => self.facets(&facets::cylinder(cylinder), motion, material),
            Shape::Cone(cone) => self.facets(&facets::cone(cone), motion, material),
            Shape::Disk(disk) => self.facets(&facets::disk(disk), motion, material),
        }
    }

    /// The placement of the shape of the current node, if the kit has the function for it. A shape that moves
    /// has none, because its transform changes with time.
    fn placement(&self, motion: &Motion) -> Option<Placement> {
        let place = self.functions.placement?;
        match (motion.end, motion.blended) {
            (Some(_), _) => None,
            (None, true) => place(&[motion.start]),
            (None, false) => place(&self.path),
        }
    }

    /// Adds the shape as a solid, if it can be placed; returns whether it could.
    fn solid(&mut self, shape: &Shape, motion: &Motion, material: u32) -> bool {
        let (Some(shape), Some(placement)) = (SolidShape::of(shape), self.placement(motion)) else {
            return false;
        };
        self.world.solids.push(Solid { shape, placement });
        let geometry = Geometry::Solid(self.world.solids.len() as u32 - 1);
        self.push(geometry, material);
        true
    }

    /// Adds a primitive without normals, image and motion.
    fn push(&mut self, geometry: Geometry, material: u32) {
        let (normals, image, end) = (OptionalIndex::NONE, OptionalIndex::NONE, OptionalIndex::NONE);
        self.world.primitives.push(Primitive { geometry, material, normals, image, end });
    }

    /// Adds a sphere. It stays a sphere unless its transform stretches it at time 0, 1 or in the middle.
    fn sphere(&mut self, sphere: &Sphere, motion: &Motion, material: u32) {
        let at = |to_world: &Affine3A| {
            let radius = uniform_scale(to_world)? * sphere.radius;
            Some(Sphere { center: to_world.transform_point3(sphere.center), radius })
        };
        let start = at(&motion.start);
        let ends = motion.end.map(|end| (at(&end), at(&blend(&motion.start, &end, 0.5))));
        let (start, end) = match (start, ends) {
            (Some(start), None) => (start, None),
            // Keep a moving sphere only if its radius changes linearly: rotations shrink it, because matrices
            // are blended entry by entry.
            (Some(start), Some((Some(end), Some(half))))
                if (2.0 * half.radius - start.radius - end.radius).abs() <= 1e-5 * half.radius =>
            {
                (start, Some(Geometry::Sphere(end)))
            }
            _ if self.solid(&Shape::Sphere(*sphere), motion, material) => return,
            _ if !self.functions.triangles => return,
            _ => return self.facets(&facets::sphere(sphere), motion, material),
        };
        let image = match self.reads_image(material) {
            true => {
                let own = Mat3::from(motion.start.matrix3).transpose();
                OptionalIndex::push(&mut self.world.sphere_axes, own)
            }
            false => OptionalIndex::NONE,
        };
        let end = end.map_or(OptionalIndex::NONE, |end| OptionalIndex::push(&mut self.world.ends, end));
        let geometry = Geometry::Sphere(start);
        self.world.primitives.push(Primitive {
            geometry,
            material,
            normals: OptionalIndex::NONE,
            image,
            end,
        });
    }

    fn plane(&mut self, plane: &Plane, equation: Option<PlaneEquation>, motion: &Motion, material: u32) {
        let (u, v) = plane_axes(plane.normal);
        let corners = |to_world: &Affine3A| {
            let a = to_world.transform_point3(plane.point);
            let [b, c] = [u, v].map(|axis| a + to_world.transform_vector3(axis));
            // Exchange two corners if the transform is a reflection, which would flip the plane.
            let mirrored = to_world.matrix3.determinant() < 0.0;
            if mirrored { Triangle { a, b: c, c: b } } else { Triangle { a, b, c } }
        };
        let normal = unit(normal_matrix(&motion.start) * unit(plane.normal));
        let point = motion.start.transform_point3(plane.point);
        // A transform changes the coefficients: D follows from the new normal and a point of the plane.
        let equation = equation.map(|equation| match motion.start == Affine3A::IDENTITY {
            true => equation,
            false => PlaneEquation { normal, d: -normal.as_dvec3().dot(point.as_dvec3()) as f32 },
        });
        self.world.planes.push(InfinitePlane {
            plane: Plane { point, normal },
            equation,
            material,
            axes: [u, v].map(|axis| motion.start.transform_vector3(axis)),
            motion: motion.end.map(|end| [corners(&motion.start), corners(&end)]),
        });
    }

    fn facets(&mut self, facets: &[Facet], motion: &Motion, material: u32) {
        for facet in facets {
            let triangle = self.triangle(facet, false, motion, material);
            self.world.primitives.push(triangle);
        }
    }

    /// Adds an instance of a mesh. A mesh with several instances is shared, if it can be placed; otherwise its
    /// triangles are copied.
    fn mesh(&mut self, ready: &mut PreparedMesh, motion: &Motion, material: u32) {
        if let Some(placement) = self.placement(motion).filter(|_| ready.shared) {
            let shared_mesh = ready.shared_mesh.unwrap_or_else(|| self.shared_mesh(ready));
            ready.shared_mesh = Some(shared_mesh);
            self.world.instances.push(Instance { shared_mesh, placement });
            let geometry = Geometry::Instance(self.world.instances.len() as u32 - 1);
            return self.push(geometry, material);
        }
        if self.world.primitives.len() + ready.mesh.triangles.len() > self.scene.max_primitives as usize {
            return self.leave_out_copies();
        }
        for face in 0..ready.mesh.triangles.len() {
            let material = ready.material_of(face).unwrap_or(material);
            let triangle = self.triangle(&ready.facet(face), ready.one_sided, motion, material);
            self.world.primitives.push(triangle);
        }
    }
    /// Notes that a mesh is left out, because its copies would exceed [`Scene::max_primitives`].
    fn leave_out_copies(&mut self) {
        let note = format!(
            "meshes are left out: copied for each instance they have more than {} triangles, \
             and only stage 8 shares one mesh",
            self.scene.max_primitives
        );
        if !self.world.notes.contains(&note) {
            self.world.notes.push(note);
        }
    }

    /// Adds a shared mesh with the triangles of a mesh in its own space, and returns its index.
    fn shared_mesh(&mut self, ready: &PreparedMesh) -> u32 {
        let here = Motion::still(Affine3A::IDENTITY);
        let primitives = (0..ready.mesh.triangles.len()).map(|face| {
            let material = ready.material_of(face).unwrap_or(Primitive::INHERITED);
            self.triangle(&ready.facet(face), ready.one_sided, &here, material)
        });
        let shared_mesh = SharedMesh { primitives: primitives.collect() };
        self.world.shared_meshes.push(shared_mesh);
        self.world.shared_meshes.len() as u32 - 1
    }

    fn triangle(&mut self, facet: &Facet, one_sided: bool, motion: &Motion, material: u32) -> Primitive {
        let reads_image = self.reads_image(material);
        // Exchange two corners if the transform is a reflection, which would turn the inside out.
        let mirrored = motion.start.matrix3.determinant() < 0.0;
        let facet = &if mirrored { facet.turned() } else { *facet };
        let world = &mut self.world;
        let corners = |to_world: &Affine3A| {
            let [a, b, c] = facet.corners.map(|corner| to_world.transform_point3(corner));
            let triangle = Triangle { a, b, c };
            if one_sided { Geometry::OneSided(triangle) } else { Geometry::Triangle(triangle) }
        };
        // Transform the vertex normals, for time 1 as well if the triangle moves.
        let mut normals = OptionalIndex::NONE;
        if let Some(own) = facet.normals {
            let carried = |to_world: &Affine3A| {
                let matrix = normal_matrix(to_world);
                own.map(|normal| (matrix * normal).as_dvec3().normalize_or_zero().as_vec3())
            };
            normals = OptionalIndex::push(&mut world.normals, carried(&motion.start));
            if let Some(end) = &motion.end {
                world.normals.push(carried(end));
            }
        }
        let end =
            motion.end.map_or(OptionalIndex::NONE, |end| OptionalIndex::push(&mut world.ends, corners(&end)));
        let uvs = facet.uvs.filter(|_| reads_image);
        let image = uvs.map_or(OptionalIndex::NONE, |uvs| OptionalIndex::push(&mut world.uvs, uvs));
        Primitive { geometry: corners(&motion.start), material, normals, image, end }
    }

    /// Whether a colour of this material comes from an image; for an inherited material, whether that of any
    /// material does.
    fn reads_image(&self, material: u32) -> bool {
        let all = &self.effects.materials;
        all.get(material as usize).map_or_else(|| all.iter().any(|one| one.texture), |one| one.texture)
    }
}
