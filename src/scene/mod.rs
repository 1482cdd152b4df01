//! A scene that has been read and found sound: everything that a frame needs, nothing that can fail.

pub mod error;
pub mod load;
pub mod obj;
pub mod ply;
mod quality;
mod shown;

pub use quality::{Accelerator, Precision, Quality, Sampler, Split, TriangleMethod};
pub use shown::Shown;

use crate::camera::Camera;
use crate::material::{Light, Material, Texture};
use crate::mesh::Mesh;
use crate::shape::Shape;
use glam::{Affine3A, Mat3A, Vec3, Vec3A};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// How linear light becomes the numbers of an image file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// The curve that screens expect.
    #[default]
    Srgb,
    /// Power 1/2, the gamma of the lecture notes.
    Gamma2,
}

/// Size and encoding of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FilmSettings {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// For 8-bit files.
    pub encoding: Encoding,
}

/// A mesh of the scene, with what the scene says of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneMesh {
    /// The tables.
    pub mesh: Arc<Mesh>,
    /// Whether normals are interpolated over a triangle.
    pub smooth: bool,
    /// How often each triangle is divided into four before anything is traced (stage 8).
    pub subdivisions: u32,
    /// For each of the mesh's own material names, the index of the scene's material, if the scene wants them.
    pub materials: Vec<usize>,
}

/// A node of the scene graph. Nodes may have several parents; they never form a cycle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// For messages.
    pub name: String,
    /// From the space of this node to that of its parent, at shutter time 0.
    pub transform: Affine3A,
    /// The same at shutter time 1, if the node moves (stage 6).
    pub transform_end: Option<Affine3A>,
    /// What the node shows, if anything.
    pub shape: Option<Shape>,
    /// Index of the node's material; without one, children and shape take the parent's.
    pub material: Option<usize>,
    /// Indices of nodes below.
    pub children: Vec<usize>,
}

impl Scene {
    /// A scene with nothing in it, seen by `camera`: 1 by 1 pixel, black, one default material.
    pub fn empty(camera: Camera) -> Scene {
        Scene {
            film: FilmSettings { width: 1, height: 1, encoding: Encoding::default() },
            camera,
            background: Vec3::ZERO,
            ambient: Vec3::ZERO,
            indirect_light: false,
            lights: Vec::new(),
            materials: vec![Material::default()],
            material_names: vec!["default".into()],
            textures: Vec::new(),
            meshes: Vec::new(),
            nodes: Vec::new(),
            roots: Vec::new(),
            quality: Quality::default(),
        }
    }
}

impl Node {
    /// From the space of this node to that of its parent at `time`, the matrices blended entry by entry.
    pub fn transform_at(&self, time: f32) -> Affine3A {
        self.transform_end.map_or(self.transform, |end| blend(&self.transform, &end, time))
    }
}

/// `start` at time 0, `end` at time 1, entry by entry.
pub fn blend(start: &Affine3A, end: &Affine3A, time: f32) -> Affine3A {
    let column = |start: Vec3A, end: Vec3A| (1.0 - time) * start + time * end;
    let (s, e) = (&start.matrix3, &end.matrix3);
    Affine3A {
        matrix3: Mat3A::from_cols(
            column(s.x_axis, e.x_axis),
            column(s.y_axis, e.y_axis),
            column(s.z_axis, e.z_axis),
        ),
        translation: column(start.translation, end.translation),
    }
}

/// A scene, ready to be rendered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The picture to make.
    pub film: FilmSettings,
    /// Where it is taken from.
    pub camera: Camera,
    /// Colour of rays that hit nothing.
    pub background: Vec3,
    /// `A`, light that comes from everywhere.
    pub ambient: Vec3,
    /// Light bounced between surfaces is wanted (stage 11).
    pub indirect_light: bool,
    /// All lamps.
    pub lights: Vec<Light>,
    /// All materials; index 0 is the default for shapes that name none.
    pub materials: Vec<Material>,
    /// Names of the materials, for messages.
    pub material_names: Vec<String>,
    /// All images.
    pub textures: Vec<Texture>,
    /// All meshes.
    pub meshes: Vec<SceneMesh>,
    /// All nodes.
    pub nodes: Vec<Node>,
    /// Indices of the nodes that have no parent.
    pub roots: Vec<usize>,
    /// Default knobs for this scene.
    pub quality: Quality,
}
