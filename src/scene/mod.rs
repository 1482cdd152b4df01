//! A scene as data: film, camera, lights, materials, meshes and the scene graph.

pub mod effects;
mod gamma2;
mod quality;
mod shown;

pub use crate::light::background::{Background, EnvironmentMap, Gradient};
pub use crate::mesh::SceneMesh;
pub use crate::random::Sampler;
pub use gamma2::{ColorPlace, Gamma2, GradientColor, MaterialColor};
pub(crate) use quality::MOST_PRIMITIVES;
pub use quality::{
    Accelerator, Field, Named, NextEvent, Precision, Quality, SphereMethod, Split, Switches, TextureFilter,
    TriangleMethod,
};
pub use shown::Shown;

use crate::camera::Camera;
use crate::film::Tone;
use crate::material::{Light, Material, Texture};
use crate::message;
use crate::rows::Rows;
use crate::shape::Shape;
use glam::{Affine3A, Mat3A, Vec3, Vec3A};
use serde::{Deserialize, Serialize};

/// How linear light becomes the numbers of an 8-bit image file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// The sRGB curve of IEC 61966-2-1, which screens expect.
    #[default]
    Srgb,
    /// The square root (power 1/2), the gamma of the lecture notes.
    Gamma2,
}

message! { enum Encoding { Srgb, Gamma2 } }

/// Size of the picture in pixels, and how its light becomes the numbers of 8-bit files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FilmSettings {
    /// Pixels per row, at least 1; a scene file may ask for up to 65 536.
    pub width: u32,
    /// Rows of pixels, at least 1; a scene file may ask for up to 65 536 rows, and the memory of
    /// [`load::Limits`](crate::scene::load::Limits) bounds the pixels.
    pub height: u32,
    /// Encoding of 8-bit image files; the film itself holds linear radiance.
    pub encoding: Encoding,
    /// Exposure of 8-bit image files and the tone curve for them.
    pub tone: Tone,
    /// The rows that a frame renders, as in [`Rows::check`]; `None`, the default, renders all. A scene file cannot set it.
    pub rows: Option<Rows>,
}

message! { FilmSettings { width, height, encoding, tone, rows } }

impl FilmSettings {
    /// The rows that a frame renders.
    pub fn rendered_rows(&self) -> Rows {
        self.rows.unwrap_or(Rows::all(self.height))
    }
}

impl Default for FilmSettings {
    /// 640 by 360 pixels in sRGB, without exposure, clamped.
    fn default() -> Self {
        FilmSettings { width: 640, height: 360, encoding: Encoding::Srgb, tone: Tone::default(), rows: None }
    }
}

/// A visible area light, with the material of the node that shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VisibleLight {
    /// Index into [`Scene::lights`] of an area light.
    pub light: usize,
    /// Index into [`Scene::materials`]. The material is black, and emits [`Light::visible_radiance`].
    pub material: usize,
}

message! { VisibleLight { light, material } }

/// A node of the scene graph. Nodes may have several parents; they never form a cycle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Name for messages: that of the scene file, or `node 1`, `node 2` and so on by position in the file.
    pub name: String,
    /// The affine transform from the space of this node to that of its parent, at shutter time 0; it must be
    /// invertible.
    pub transform: Affine3A,
    /// The same transform at shutter time 1, if the node moves (stage 6). [`blend`] gives the transforms
    /// between.
    pub transform_end: Option<Affine3A>,
    /// The shape, in the space of this node; `None` for a node that only groups its children.
    pub shape: Option<Shape>,
    /// Index into [`Scene::materials`], for the shape and for all nodes below that name no material of their
    /// own. `None` inherits the material of the parent; a root without one takes material 0.
    pub material: Option<usize>,
    /// Indices into [`Scene::nodes`] of the children, which stand in the space of this node.
    pub children: Vec<usize>,
}

message! { Node as SceneNode { name, transform, transform_end, shape, material, children } }

impl Scene {
    /// A scene without shapes and lights, seen by `camera`. Its film is 1 by 1 pixel, its background is
    /// black, and its only material is the default at index 0.
    pub fn empty(camera: Camera) -> Scene {
        Scene {
            film: FilmSettings { width: 1, height: 1, ..FilmSettings::default() },
            camera,
            background: Background::Color(Vec3::ZERO),
            ambient: Vec3::ZERO,
            indirect_light: false,
            lights: Vec::new(),
            visible_lights: Vec::new(),
            materials: vec![Material::default()],
            material_names: vec!["default".into()],
            textures: Vec::new(),
            meshes: Vec::new(),
            nodes: Vec::new(),
            roots: Vec::new(),
            gamma2: Gamma2::default(),
            quality: Quality::default(),
            max_primitives: MOST_PRIMITIVES,
        }
    }

    /// Whether any light of the scene can be reflected by the diffuse or the ambient colour of `material`, which an image
    /// multiplies. Without an analysis of where the light goes, the answer may be yes where none arrives.
    pub(crate) fn is_lit(&self, material: &Material) -> bool {
        let by_light = |light: &Light| light.radiance() * material.diffuse != Vec3::ZERO;
        self.lights.iter().any(by_light)
            || self.ambient * material.ambient != Vec3::ZERO
            || self.indirect_light && material.diffuse != Vec3::ZERO
    }
}

impl Node {
    /// The transform from the space of this node to that of its parent at shutter time `time`,
    /// `0 <= time <= 1`: [`blend`] of its two ends, or [`Node::transform`] if the node does not move.
    pub fn transform_at(&self, time: f32) -> Affine3A {
        self.transform_end.map_or(self.transform, |end| blend(&self.transform, &end, time))
    }
}

/// The matrix `(1 - time) * start + time * end`, entry by entry: `start` at time 0, `end` at time 1. Times
/// outside `0 <= time <= 1` extrapolate, and a NaN gives NaN.
///
/// Pitfall: the blend of two rotations is not a rotation. A shape that turns shrinks on its way, and in the
/// middle of a half turn it has no volume.
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

/// A scene, ready to be rendered: what is shown, from where, and with which accuracy.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Size of the picture in pixels, and encoding of its 8-bit files.
    pub film: FilmSettings,
    /// The camera in world space, with its lens and its shutter.
    pub camera: Camera,
    /// The radiance of rays that hit nothing.
    pub background: Background,
    /// `A`, the ambient light of the Phong model in linear RGB, at least 0 in each channel.
    pub ambient: Vec3,
    /// Whether the scene asks for light that bounces between surfaces (stage 11).
    pub indirect_light: bool,
    /// All lights in world space, in the order of the scene file.
    pub lights: Vec<Light>,
    /// The area lights that rays can see, in ascending order. Each has a node with its shape, and a material of its own.
    pub visible_lights: Vec<VisibleLight>,
    /// All materials; index 0 is the default for shapes that name none.
    pub materials: Vec<Material>,
    /// The name of each material by index, for messages. A material that comes with the mesh `box` is called
    /// `box/NAME`.
    pub material_names: Vec<String>,
    /// All images in linear light; [`Material::texture`] is an index into this list. The file of an image that no surface
    /// shows is not read: it is one black pixel.
    pub textures: Vec<Texture>,
    /// All meshes, each in its own space; [`Shape::Mesh`] holds an index into this list.
    pub meshes: Vec<SceneMesh>,
    /// All nodes of the scene graph; [`Node::children`] and [`Scene::roots`] are indices into this list.
    pub nodes: Vec<Node>,
    /// Indices of the nodes that have no parent, in ascending order. Their transforms lead to world space.
    pub roots: Vec<usize>,
    /// Which colours and images a frame decodes with gamma 2. Until then they are decoded with the sRGB curve.
    pub gamma2: Gamma2,
    /// Sampling, accuracy and acceleration structure, as the scene file sets them.
    pub quality: Quality,
    /// The most primitives of the flattened scene; meshes beyond it are left out, with a note.
    pub max_primitives: u32,
}

message! { Scene {
    film, camera, background, ambient, indirect_light, lights, visible_lights, materials, material_names,
    textures, meshes, nodes, roots, gamma2, quality, max_primitives
} }
