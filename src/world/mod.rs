//! A scene made flat: every node's transform applied, all meshes merged into one set of primitives (lecture "In RTGI
//! all meshes are merged to a big set of primitives").
//!
//! Spheres, planes and triangles are what stages 1 and 2 intersect. Until stage 8 brings boxes, cylinders, cones,
//! disks, polygons and stretched spheres their own tests, they are made of triangles here.

mod facets;

use crate::camera::Camera;
use crate::kit::LightSample;
use crate::material::{AreaShape, Emitter, Falloff, Light, Material};
use crate::mesh::Mesh;
use crate::scene::{Node, Precision, Sampler, Scene, SceneMesh};
use crate::shape::{Plane, Shape, Sphere, Triangle};
use glam::{Affine3A, Mat3A, Vec3};

/// What a ray can be tested against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Geometry {
    /// A sphere.
    Sphere(Sphere),
    /// A triangle.
    Triangle(Triangle),
}

/// A bounded primitive in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// Its shape.
    pub geometry: Geometry,
    /// Index into [`World::materials`].
    pub material: u32,
    /// Index into [`World::normals`] for a triangle with normals at its corners.
    pub normals: Option<u32>,
}

/// A flat scene.
#[derive(Clone, Debug, Default)]
pub struct World {
    /// Everything with an end.
    pub primitives: Vec<Primitive>,
    /// Planes, which no box can hold, with their materials.
    pub planes: Vec<(Plane, u32)>,
    /// Unit normals at the corners of smooth triangles.
    pub normals: Vec<[Vec3; 3]>,
    /// As in the scene.
    pub materials: Vec<Material>,
    /// As in the scene.
    pub lights: Vec<Light>,
    /// What the picture will lack, one sentence each.
    pub notes: Vec<String>,
}

/// Gives a mesh one unit normal a vertex.
pub type VertexNormals<'a> = dyn Fn(&Mesh) -> Vec<Vec3> + 'a;

impl World {
    /// Flattens `scene`. Meshes that are to be smooth and have no normals get them from `vertex_normals`; without
    /// it they stay flat.
    pub fn new(scene: &Scene, vertex_normals: Option<&VertexNormals<'_>>) -> World {
        let mut flattener = Flattener {
            scene,
            mesh_normals: scene.meshes.iter().map(|mesh| normals_of(mesh, vertex_normals)).collect(),
            world: World {
                materials: scene.materials.clone(),
                lights: scene.lights.clone(),
                notes: what_is_not_simulated(scene),
                ..World::default()
            },
        };
        for &root in &scene.roots {
            flattener.node(&scene.nodes[root], Affine3A::IDENTITY, 0);
        }
        flattener.world
    }
}

fn normals_of(mesh: &SceneMesh, vertex_normals: Option<&VertexNormals<'_>>) -> Vec<Vec3> {
    match vertex_normals {
        _ if !mesh.smooth => Vec::new(),
        _ if !mesh.mesh.normals.is_empty() => mesh.mesh.normals.clone(),
        Some(average) => average(&mesh.mesh),
        None => Vec::new(),
    }
}

struct Flattener<'a> {
    scene: &'a Scene,
    mesh_normals: Vec<Vec<Vec3>>,
    world: World,
}

impl Flattener<'_> {
    /// Adds `node` and all below it. `to_world` belongs to its parent, `material` is inherited.
    fn node(&mut self, node: &Node, to_world: Affine3A, material: usize) {
        let to_world = to_world * node.transform;
        let material = node.material.unwrap_or(material);
        if let Some(shape) = &node.shape {
            self.shape(shape, &to_world, material as u32);
        }
        for &child in &node.children {
            self.node(&self.scene.nodes[child], to_world, material);
        }
    }

    fn shape(&mut self, shape: &Shape, to_world: &Affine3A, material: u32) {
        match shape {
            Shape::Sphere(sphere) => match uniform_scale(to_world) {
                Some(scale) => {
                    let center = to_world.transform_point3(sphere.center);
                    let geometry = Geometry::Sphere(Sphere { center, radius: scale * sphere.radius });
                    self.world.primitives.push(Primitive { geometry, material, normals: None });
                }
                None => self.facets(&facets::sphere(sphere), to_world, material),
            },
            Shape::Plane(plane) => {
                let normal = normal_matrix(to_world) * plane.normal;
                let point = to_world.transform_point3(plane.point);
                self.world.planes.push((Plane { point, normal: normal.normalize() }, material));
            }
            Shape::Triangle(t) => self.facets(&facets::polygon(&[t.a, t.b, t.c]), to_world, material),
            Shape::Polygon(polygon) => self.facets(&facets::polygon(&polygon.corners), to_world, material),
            Shape::Cuboid(cuboid) => self.facets(&facets::cuboid(cuboid), to_world, material),
            Shape::Cylinder(cylinder) => self.facets(&facets::cylinder(cylinder), to_world, material),
            Shape::Cone(cone) => self.facets(&facets::cone(cone), to_world, material),
            Shape::Disk(disk) => self.facets(&facets::disk(disk), to_world, material),
            Shape::Mesh(index) => self.mesh(*index, to_world, material),
        }
    }

    fn facets(&mut self, facets: &[facets::Facet], to_world: &Affine3A, material: u32) {
        for facet in facets {
            self.triangle(facet.corners, facet.normals, to_world, material);
        }
    }

    fn mesh(&mut self, index: usize, to_world: &Affine3A, material: u32) {
        let SceneMesh { mesh, materials, .. } = &self.scene.meshes[index];
        for (face, vertices) in mesh.triangles.iter().enumerate() {
            let own = mesh.face_materials.get(face).and_then(|&name| materials.get(name as usize));
            let normals = &self.mesh_normals[index];
            let normals = (!normals.is_empty()).then(|| vertices.map(|vertex| normals[vertex as usize]));
            self.triangle(mesh.corners(face), normals, to_world, own.map_or(material, |&own| own as u32));
        }
    }

    fn triangle(
        &mut self,
        corners: [Vec3; 3],
        normals: Option<[Vec3; 3]>,
        to_world: &Affine3A,
        material: u32,
    ) {
        let [a, b, c] = corners.map(|corner| to_world.transform_point3(corner));
        let normals = normals.map(|normals| {
            let matrix = normal_matrix(to_world);
            self.world.normals.push(normals.map(|normal| (matrix * normal).normalize_or_zero()));
            self.world.normals.len() as u32 - 1
        });
        let geometry = Geometry::Triangle(Triangle { a, b, c });
        self.world.primitives.push(Primitive { geometry, material, normals });
    }
}

/// Carries normals to the world: the inverse transpose, up to a positive factor, so that a mirrored transform keeps
/// the outside outside.
fn normal_matrix(to_world: &Affine3A) -> Mat3A {
    to_world.matrix3.inverse().transpose()
}

/// The factor by which a transform scales, if it scales all directions alike to a few roundings.
fn uniform_scale(to_world: &Affine3A) -> Option<f32> {
    let gram = to_world.matrix3.transpose() * to_world.matrix3;
    let squared = gram.x_axis.x;
    // Each entry of the product sums three rounded products: 1e-5 leaves room for rotations and for nothing visible.
    let alike = (gram - Mat3A::from_diagonal(Vec3::splat(squared))).to_cols_array();
    alike.iter().all(|entry| entry.abs() <= 1e-5 * squared).then(|| squared.sqrt())
}

/// What the scene asks for and no built stage simulates.
fn what_is_not_simulated(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    let mut missing = |used: bool, what: &str, stage: u32| {
        if used {
            notes.push(format!("{what}: stage {stage}, not built yet"));
        }
    };
    let any = |wants: fn(&Material) -> bool| scene.materials.iter().any(wants);
    let rough = |m: &Material| m.roughness > 0.0 && (m.mirror != Vec3::ZERO || m.transmission != Vec3::ZERO);
    missing(any(rough), "rough mirrors and glass are sharp", 6);

    missing(
        scene.lights.iter().any(|light| matches!(light.emitter, Emitter::Area { .. })),
        "area lights shine from their middle",
        6,
    );
    missing(
        scene.quality.sampler != Sampler::LowDiscrepancy,
        "the samples of a pixel lie on an even lattice, whatever the sampler",
        6,
    );
    missing(scene.quality.precision == Precision::Double, "rays are tested in single precision", 10);
    missing(scene.camera.lens.is_some_and(|lens| lens.aperture > 0.0), "the lens is a pinhole", 6);
    missing(scene.nodes.iter().any(|node| node.transform_end.is_some()), "moving nodes stand still", 6);
    missing(any(|m| m.texture.is_some()), "textures are left out", 7);
    missing(scene.indirect_light, "light bounced between surfaces is left out", 11);
    notes
}

impl Light {
    /// The light that would arrive at `point` if nothing stood in its way. An area light shines from its middle; the
    /// way to a ball ends at its surface, so that a ball that is seen as well does not stand in its own light.
    pub fn sample(&self, point: Vec3) -> LightSample {
        let from = |position: Vec3, radius: f32, falloff: Falloff| {
            let to_light = position - point;
            let distance = to_light.length();
            let weakened = match falloff {
                Falloff::None => 1.0,
                Falloff::InverseSquare => 1.0 / (distance * distance),
            };
            LightSample {
                direction: to_light.normalize_or(Vec3::Y),
                distance: (distance - radius).max(0.0),
                radiance: weakened * self.radiance(),
            }
        };
        match &self.emitter {
            Emitter::Point { position, falloff } => from(*position, 0.0, *falloff),
            Emitter::Area { shape: AreaShape::Sphere(ball), falloff } => {
                from(ball.center, ball.radius, *falloff)
            }
            Emitter::Area { shape, falloff } => from(shape.center(), 0.0, *falloff),
            Emitter::Directional { direction } => {
                LightSample { direction: -*direction, distance: f32::INFINITY, radiance: self.radiance() }
            }
        }
    }
}

/// The camera of a scene for a film of another size: the vertical field of view stays.
pub fn camera_for(scene: &Scene) -> Camera {
    Camera { aspect: scene.film.width as f32 / scene.film.height as f32, ..scene.camera }
}
