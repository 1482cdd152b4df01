//! A scene made flat: every node's transform applied, all meshes merged into one set of primitives (lecture "In RTGI
//! all meshes are merged to a big set of primitives").
//!
//! With stage 8 there are exceptions: boxes, cylinders, cones, disks, polygons and stretched spheres stay what they are,
//! in spaces of their own, and a mesh that stands in several places is kept once. Without it, and where they move, they
//! are made of triangles.

mod facets;
mod flatten;
mod lamps;
mod meshes;
mod solids;
mod transforms;

pub use solids::{Solid, SolidShape, around_ball};

use crate::camera::Camera;
use crate::effects::Effects;
use crate::graph::{Graph, Placement};
use crate::kit::{Function, StudentFunctions};
use crate::material::{Light, Material, Texture};
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::shape::{BezierPatch, Plane, Sphere, Triangle};
use glam::{Affine3A, Mat3, Vec2, Vec3};

/// What a ray can be tested against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Geometry {
    /// A sphere.
    Sphere(Sphere),
    /// A triangle.
    Triangle(Triangle),
    /// Index into [`World::solids`].
    Solid(u32),
    /// Index into [`World::instances`].
    Instance(u32),
}

/// An index into a table, or none: in four bytes instead of eight, because there are millions of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot(u32);

impl Slot {
    /// No index.
    pub const NONE: Slot = Slot(u32::MAX);

    /// The index, if there is one.
    #[inline]
    pub fn get(self) -> Option<usize> {
        (self != Slot::NONE).then_some(self.0 as usize)
    }

    /// Appends `entry` and says where it is.
    fn push<T>(table: &mut Vec<T>, entry: T) -> Slot {
        table.push(entry);
        Slot(table.len() as u32 - 1)
    }
}

/// A bounded primitive in world space, or in that of its part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// Its shape, at time 0 if it moves.
    pub geometry: Geometry,
    /// Index into [`World::materials`], or [`Primitive::INHERITED`].
    pub material: u32,
    /// Into [`World::normals`], for a triangle with normals at its corners; if it moves, those of time 1 follow.
    pub normals: Slot,
    /// Into [`World::uvs`] for a triangle, [`World::ball_axes`] for a sphere, if its colour is read from an image.
    pub image: Slot,
    /// Into [`World::ends`], if it moves.
    pub end: Slot,
}

impl Primitive {
    /// The material of a primitive in a part that takes that of its instance.
    pub const INHERITED: u32 = u32::MAX;
}

/// A mesh that is kept once and stands in several places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Its triangles, in its own space.
    pub primitives: Vec<Primitive>,
}

/// A part in one of its places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index into [`World::parts`].
    pub part: u32,
    /// Where it stands.
    pub placement: Placement,
}

/// A plane, which no box can hold.
#[derive(Clone, Debug, PartialEq)]
pub struct EndlessPlane {
    /// The plane, at time 0 if it moves; its normal is of unit length.
    pub plane: Plane,
    /// Index into [`World::materials`].
    pub material: u32,
    /// Two directions along it that are a unit of its own space long: the axes of its texture.
    pub axes: [Vec3; 2],
    /// Three points of it at times 0 and 1, if it moves; their anticlockwise side is its front.
    pub motion: Option<[Triangle; 2]>,
}

/// A flat scene.
#[derive(Clone, Debug, Default)]
pub struct World {
    /// Everything with an end.
    pub primitives: Vec<Primitive>,
    /// Everything without.
    pub planes: Vec<EndlessPlane>,
    /// Shapes in spaces of their own.
    pub solids: Vec<Solid>,
    /// Meshes that stand in several places.
    pub parts: Vec<Part>,
    /// Their places.
    pub instances: Vec<Instance>,
    /// The scene graph over `primitives`, if that is what rays will search.
    pub graph: Option<Graph>,
    /// Unit normals at the corners of smooth triangles.
    pub normals: Vec<[Vec3; 3]>,
    /// Texture coordinates at the corners of triangles.
    pub uvs: Vec<[Vec2; 3]>,
    /// For spheres with an image, how directions of the world turn into directions of their own space.
    pub ball_axes: Vec<Mat3>,
    /// Where moving primitives are at time 1.
    pub ends: Vec<Geometry>,
    /// As in the scene.
    pub materials: Vec<Material>,
    /// As in the scene.
    pub lights: Vec<Light>,
    /// As in the scene.
    pub textures: Vec<Texture>,
    /// What the picture will lack, one sentence each.
    pub notes: Vec<String>,
}

/// From the transforms from the root down to where a node stands.
pub type Place = fn(&[Affine3A]) -> Option<Placement>;

/// The student functions that a world is made with, and the kinds of shapes that can be shown at all.
#[derive(Clone, Copy)]
pub struct WorldFunctions {
    /// Gives a mesh one unit normal per vertex; without it, meshes whose files have no normals are flat.
    pub vertex_normals: Option<fn(&Mesh) -> Vec<Vec3>>,
    /// Composes the transforms from the root down; without it, all shapes are made of triangles and meshes copied.
    pub placement: Option<Place>,
    /// A point of a patch; without it, patches are left out.
    pub bezier_point: Option<fn(&BezierPatch, Vec2) -> Vec3>,
    /// Four triangles for each; without it, meshes stay as coarse as they are.
    pub subdivide: Option<fn(&Mesh) -> Mesh>,
    /// Whether spheres are shown.
    pub spheres: bool,
    /// Whether infinite planes are shown.
    pub planes: bool,
    /// Whether triangles are shown, and what is made of them.
    pub triangles: bool,
}

impl Default for WorldFunctions {
    fn default() -> Self {
        WorldFunctions {
            vertex_normals: None,
            placement: None,
            bezier_point: None,
            subdivide: None,
            spheres: true,
            planes: true,
            triangles: true,
        }
    }
}

impl WorldFunctions {
    /// Those of `F` that are `written`.
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
            subdivide: written(Function::loop_subdivide).then_some(F::loop_subdivide),
            ..WorldFunctions::default()
        }
    }
}

impl World {
    /// Flattens `scene` as far as `effects` call for it.
    pub fn new(scene: &Scene, effects: &Effects, functions: &WorldFunctions) -> World {
        flatten::flatten(scene, effects, functions)
    }

    /// The same scene of triangles, spheres and planes alone, all where they stand when the shutter opens, whatever is
    /// written: what searches and tests of different kits can be compared on.
    pub fn plain(scene: &Scene) -> World {
        World::new(scene, &Effects::default(), &WorldFunctions::default())
    }
}

/// What the scene asks for and no built stage simulates.
pub fn what_is_not_simulated(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    if scene.indirect_light {
        notes.push("light bounced between surfaces is left out: stage 11, not built yet".into());
    }
    notes
}

/// The camera of a scene for a film of another size: the vertical field of view stays.
pub fn camera_for(scene: &Scene) -> Camera {
    Camera { aspect: scene.film.width as f32 / scene.film.height as f32, ..scene.camera }
}
