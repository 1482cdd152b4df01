//! A scene made flat: every node's transform applied, all meshes merged into one set of primitives (lecture "In RTGI
//! all meshes are merged to a big set of primitives").
//!
//! Spheres, planes and triangles are what stages 1 and 2 intersect. Until stage 8 brings boxes, cylinders, cones,
//! disks, polygons and stretched spheres their own tests, they are made of triangles here.

mod facets;
mod flatten;
mod lamps;

use crate::camera::Camera;
use crate::effects::Effects;
use crate::material::{Light, Material, Texture};
use crate::mesh::Mesh;
use crate::scene::{Precision, Scene};
use crate::shape::{Plane, Sphere, Triangle};
use glam::{Mat3, Vec2, Vec3};

/// What a ray can be tested against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Geometry {
    /// A sphere.
    Sphere(Sphere),
    /// A triangle.
    Triangle(Triangle),
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

/// A bounded primitive in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// Its shape, at time 0 if it moves.
    pub geometry: Geometry,
    /// Index into [`World::materials`].
    pub material: u32,
    /// Into [`World::normals`], for a triangle with normals at its corners; if it moves, those of time 1 follow.
    pub normals: Slot,
    /// Into [`World::uvs`] for a triangle, [`World::ball_axes`] for a sphere, if its colour is read from an image.
    pub image: Slot,
    /// Into [`World::ends`], if it moves.
    pub end: Slot,
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

/// Gives a mesh one unit normal a vertex.
pub type VertexNormals<'a> = dyn Fn(&Mesh) -> Vec<Vec3> + 'a;

impl World {
    /// Flattens `scene` as far as `effects` call for it. Meshes that are to be smooth and have no normals get them from
    /// `vertex_normals`; without it they stay flat.
    pub fn new(scene: &Scene, effects: &Effects, vertex_normals: Option<&VertexNormals<'_>>) -> World {
        flatten::flatten(scene, effects, vertex_normals)
    }
}

/// What the scene asks for and no built stage simulates.
pub fn what_is_not_simulated(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    if scene.quality.precision == Precision::Double {
        notes.push("rays are tested in single precision: stage 10, not built yet".into());
    }
    if scene.indirect_light {
        notes.push("light bounced between surfaces is left out: stage 11, not built yet".into());
    }
    notes
}

/// The camera of a scene for a film of another size: the vertical field of view stays.
pub fn camera_for(scene: &Scene) -> Camera {
    Camera { aspect: scene.film.width as f32 / scene.film.height as f32, ..scene.camera }
}
