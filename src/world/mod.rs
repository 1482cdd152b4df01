//! A scene made flat: every node's transform is applied, and all meshes become one set of primitives (lecture
//! "In RTGI all meshes are merged to a big set of primitives").
//!
//! With stage 8 there are exceptions. Boxes, cylinders, cones, disks, polygons and stretched spheres keep
//! their shape, each in a space of its own, and a mesh with several instances is kept once. Without stage 8,
//! and where they move, these shapes are made of triangles.

mod area_lights;
mod facets;
mod flatten;
mod meshes;
mod solids;
mod transforms;

pub use solids::{Solid, SolidShape};

use crate::camera::Camera;
use crate::effects::Effects;
use crate::graph::{Graph, Placement};
use crate::kit::{Function, StudentFunctions};
use crate::material::{Light, Material, Texture};
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::shape::{BezierPatch, NurbsPatch, Plane, PlaneEquation, Sphere, Triangle};
use glam::{Affine3A, Mat3, Vec2, Vec3};

/// The shape of a primitive: what a ray can be tested against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Geometry {
    /// A sphere, in the space of the primitive.
    Sphere(Sphere),
    /// A triangle, in the space of the primitive; its front is the side from which the corners run
    /// anticlockwise.
    Triangle(Triangle),
    /// A triangle that is hit from its front only.
    OneSided(Triangle),
    /// Index into [`World::solids`], whose shape is tested in a space of its own.
    Solid(u32),
    /// Index into [`World::instances`], whose shared mesh is searched in the space of that mesh.
    Instance(u32),
}

impl Geometry {
    /// The triangle, if the primitive is one, whether it is hit from one side or from both.
    #[inline]
    pub fn triangle(&self) -> Option<&Triangle> {
        match self {
            Geometry::Triangle(triangle) | Geometry::OneSided(triangle) => Some(triangle),
            Geometry::Sphere(_) | Geometry::Solid(_) | Geometry::Instance(_) => None,
        }
    }
}

/// An optional index into a table, `0..u32::MAX`. It takes four bytes instead of the eight of an
/// `Option<u32>`, because a world holds millions of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OptionalIndex(u32);

impl OptionalIndex {
    /// The value that stands for no index: `u32::MAX`, which is never an index.
    pub const NONE: OptionalIndex = OptionalIndex(u32::MAX);

    /// The index into the table, or `None` for [`OptionalIndex::NONE`].
    #[inline]
    pub fn get(self) -> Option<usize> {
        (self != OptionalIndex::NONE).then_some(self.0 as usize)
    }

    /// Appends `entry` to `table` and returns its index.
    fn push<T>(table: &mut Vec<T>, entry: T) -> OptionalIndex {
        table.push(entry);
        OptionalIndex(table.len() as u32 - 1)
    }
}

/// A bounded primitive, in world space or in the space of its shared mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// The shape of the primitive, at time 0 if it moves.
    pub geometry: Geometry,
    /// Index into [`World::materials`], or [`Primitive::INHERITED`].
    pub material: u32,
    /// Index into [`World::normals`], for a triangle with normals at its corners. If it moves, the next entry
    /// there holds its normals at time 1.
    pub normals: OptionalIndex,
    /// For a primitive whose colour is read from an image: index into [`World::uvs`] for a triangle, into
    /// [`World::sphere_axes`] for a sphere.
    pub image: OptionalIndex,
    /// Index into [`World::ends`] of the geometry at time 1, if the primitive moves.
    pub end: OptionalIndex,
}

impl Primitive {
    /// The material of a primitive of a shared mesh that takes the material of its instance.
    pub const INHERITED: u32 = u32::MAX;
}

/// A shared mesh: it is kept once, and several instances place it in the world.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SharedMesh {
    /// The triangles of the mesh, in its own space.
    pub primitives: Vec<Primitive>,
}

/// One placement of a shared mesh in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index of the shared mesh in [`World::shared_meshes`].
    pub shared_mesh: u32,
    /// The transforms from the space of the mesh to the world and back.
    pub placement: Placement,
}

/// An infinite plane in world space. It has no bounding box, so acceleration structures do not hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct InfinitePlane {
    /// The plane, at time 0 if it moves; its normal is of unit length.
    pub plane: Plane,
    /// The coefficients of the same plane in world space, if rays are tested against them: the scene gives the
    /// plane by coefficients, and it does not move.
    pub equation: Option<PlaneEquation>,
    /// Index of its material in [`World::materials`].
    pub material: u32,
    /// The axes of its texture: two directions along the plane in world space, at time 0 if it moves. Each is
    /// as long as one unit of the space of its node, over which the image runs once.
    pub axes: [Vec3; 2],
    /// If the plane moves, three of its points at times 0 and 1. They run anticlockwise seen from the side of
    /// the normal.
    pub motion: Option<[Triangle; 2]>,
}

/// A flat scene: primitives, infinite planes and everything that they refer to by index.
#[derive(Clone, Debug, Default)]
pub struct World {
    /// All bounded primitives, in the order of the scene graph.
    pub primitives: Vec<Primitive>,
    /// All infinite planes, which are tested one by one.
    pub planes: Vec<InfinitePlane>,
    /// Shapes that rays are tested against in a space of their own (stage 8).
    pub solids: Vec<Solid>,
    /// Meshes with several instances, each kept once (stage 8).
    pub shared_meshes: Vec<SharedMesh>,
    /// The placements of these meshes; each is also a primitive in [`World::primitives`].
    pub instances: Vec<Instance>,
    /// The scene graph over [`World::primitives`], if the accelerator of the scene is a volume around each of
    /// its nodes.
    pub graph: Option<Graph>,
    /// Normals at the corners of smooth triangles, in the space of the primitive. Each is of unit length, or
    /// zero where the transformed normal has no direction.
    pub normals: Vec<[Vec3; 3]>,
    /// Texture coordinates at the corners of triangles; `(0, 0)` is the lower left of the image.
    pub uvs: Vec<[Vec2; 3]>,
    /// For spheres with an image: the matrix from directions in the world to directions in the space of the
    /// sphere, up to a positive factor.
    pub sphere_axes: Vec<Mat3>,
    /// The geometry of moving primitives at time 1; [`Primitive::geometry`] is that at time 0.
    pub ends: Vec<Geometry>,
    /// All materials, with the indices that they have in the scene.
    pub materials: Vec<Material>,
    /// All lights, with the indices that they have in the scene.
    pub lights: Vec<Light>,
    /// All images in linear light, with the indices that they have in the scene.
    pub textures: Vec<Texture>,
    /// What the picture will lack, one sentence each; empty if nothing.
    pub notes: Vec<String>,
}

/// A function that composes the transforms of the nodes from the root down to a shape, and returns the
/// placement of the shape. `None` means that the shape cannot be placed.
pub type PlacementFunction = fn(&[Affine3A]) -> Option<Placement>;

/// The student functions that a world is made with, and which kinds of shapes it contains.
#[derive(Clone, Copy)]
pub struct WorldFunctions {
    /// Computes one unit normal per vertex. Without it, meshes whose files have no normals are flat.
    pub vertex_normals: Option<fn(&Mesh) -> Vec<Vec3>>,
    /// Composes the transforms from the root down. Without it, all shapes but unstretched spheres and
    /// infinite planes are made of triangles, and meshes are copied for each instance.
    pub placement: Option<PlacementFunction>,
    /// The point of a Bézier patch at `(u, v)`, both in `0..=1`. Without it, patches are left out.
    pub bezier_point: Option<fn(&BezierPatch, Vec2) -> Vec3>,
    /// The point of a NURBS surface at `(u, v)`, both within the domain of the knots. Without it, B-spline and NURBS
    /// surfaces are left out.
    pub nurbs_point: Option<fn(&NurbsPatch, Vec2) -> Vec3>,
    /// Divides each triangle of a mesh into four. Without it, meshes are not subdivided.
    pub subdivide: Option<fn(&Mesh) -> Mesh>,
    /// Whether spheres are shown; otherwise they are left out.
    pub spheres: bool,
    /// Whether infinite planes are shown; otherwise they are left out.
    pub planes: bool,
    /// Whether rays are tested against the coefficients of a plane that is given by them; otherwise by a point
    /// and a normal.
    pub equations: bool,
    /// Whether the triangles of one-sided meshes are hit from their front only; otherwise from both sides.
    pub one_sided: bool,
    /// Whether triangles are shown, and shapes that are made of triangles; otherwise both are left out.
    pub triangles: bool,
}

impl Default for WorldFunctions {
    fn default() -> Self {
        WorldFunctions {
            vertex_normals: None,
            placement: None,
            bezier_point: None,
            nurbs_point: None,
            subdivide: None,
            spheres: true,
            planes: true,
            equations: false,
            one_sided: false,
            triangles: true,
        }
    }
}

impl WorldFunctions {
    /// The functions of `F` for which `written` returns true. All kinds of shapes are shown.
    ///
    /// [`WorldFunctions::placement`] is set only if every function for shapes in spaces of their own is
    /// written.
    pub fn of<F: StudentFunctions>(written: &dyn Fn(Function) -> bool) -> Self {
        // A shape stays in a space of its own only if every function for that is there.
        let in_spaces = [
            Function::placement,
            Function::ray_to_object,
            Function::normal_to_world,
            Function::bounds_to_world,
            Function::cuboid,
            Function::cylinder,
            Function::cone,
            Function::disk,
            Function::polygon,
        ];
        WorldFunctions {
            vertex_normals: written(Function::vertex_normals).then_some(F::vertex_normals),
            placement: in_spaces.into_iter().all(written).then_some(F::placement),
            bezier_point: written(Function::bezier_point).then_some(F::bezier_point),
            nurbs_point: [Function::nurbs_point, Function::bspline_basis]
                .into_iter()
                .all(written)
                .then_some(F::nurbs_point),
            subdivide: written(Function::loop_subdivide).then_some(F::loop_subdivide),
            equations: written(Function::plane_by_coefficients),
            one_sided: written(Function::backfacing),
            ..WorldFunctions::default()
        }
    }
}

impl World {
    /// Flattens `scene`: applies all transforms and collects the primitives, with motion and images as far as
    /// `effects` ask for them.
    ///
    /// A scene without motion in `effects` stands where it is when the shutter opens. Copies of meshes beyond
    /// [`Scene::max_primitives`] are left out, with a note.
    ///
    /// # Panics
    ///
    /// If an index of the scene is out of range; a scene that [`crate::files::scene`] has read has no such
    /// index. A graph with a loop overflows the stack. A panic of a student function is passed on.
    pub fn new(scene: &Scene, effects: &Effects, functions: &WorldFunctions) -> World {
        flatten::flatten(scene, effects, functions)
    }

    /// The scene as triangles, spheres and infinite planes alone, standing where it is when the shutter
    /// opens, with no student function used; curved surfaces are left out. Searches and tests of different
    /// kits can be compared on it.
    ///
    /// # Panics
    ///
    /// If an index of the scene is out of range.
    pub fn plain(scene: &Scene) -> World {
        World::new(scene, &Effects::default(), &WorldFunctions::default())
    }
}

/// The camera of `scene` with the aspect ratio of its film, for a film whose size has been changed. The
/// vertical field of view stays the same.
pub fn camera_for(scene: &Scene) -> Camera {
    Camera { aspect: scene.film.width as f32 / scene.film.height as f32, ..scene.camera }
}
