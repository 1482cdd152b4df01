//! A scene that has been read and found sound: everything that a frame needs, nothing that can fail.

pub mod error;
pub mod load;
pub mod obj;
pub mod ply;
mod shown;

pub use shown::Shown;

use crate::camera::Camera;
use crate::graph::Savings;
use crate::material::{Light, Material, Texture};
use crate::mesh::Mesh;
use crate::partition::KdHeuristics;
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

/// Which structure finds the closest hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Accelerator {
    /// Every primitive for every ray.
    BruteForce,
    /// The scene graph itself, with a box around each of its nodes (stage 8).
    BoundingBoxes,
    /// The same with balls (stage 8).
    BoundingSpheres,
    /// A bounding volume hierarchy.
    #[default]
    Bvh,
    /// A uniform grid (stage 9).
    Grid,
    /// An octree (stage 9).
    Octree,
    /// An octree, searched from cell to cell and not from the root down (stage 9).
    OctreeByCells,
    /// A kd-tree (stage 9).
    KdTree,
    /// A binary space partition (stage 9).
    Bsp,
    /// A bounding volume hierarchy, after what the ray before met (stage 9).
    CachedBvh,
    /// A bounding volume hierarchy, with rays from the camera in packets of eight (stage 9).
    PacketBvh,
}

impl Accelerator {
    /// All of them.
    pub const ALL: [Accelerator; 11] = [
        Accelerator::BruteForce,
        Accelerator::BoundingBoxes,
        Accelerator::BoundingSpheres,
        Accelerator::Bvh,
        Accelerator::CachedBvh,
        Accelerator::PacketBvh,
        Accelerator::Grid,
        Accelerator::Octree,
        Accelerator::OctreeByCells,
        Accelerator::KdTree,
        Accelerator::Bsp,
    ];

    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Accelerator::BruteForce => "brute_force",
            Accelerator::BoundingBoxes => "bounding_boxes",
            Accelerator::BoundingSpheres => "bounding_spheres",
            Accelerator::Bvh => "bvh",
            Accelerator::CachedBvh => "cached_bvh",
            Accelerator::PacketBvh => "packet_bvh",
            Accelerator::Grid => "grid",
            Accelerator::Octree => "octree",
            Accelerator::OctreeByCells => "octree_by_cells",
            Accelerator::KdTree => "kd_tree",
            Accelerator::Bsp => "bsp",
        }
    }
}

/// How a hierarchy divides its primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// Half of the primitives on either side.
    ObjectMedian,
    /// Half of the box on either side.
    SpatialMedian,
    /// Where the expected cost is least.
    #[default]
    SurfaceArea,
}

impl Split {
    /// All three, in the order of the lecture.
    pub const ALL: [Split; 3] = [Split::ObjectMedian, Split::SpatialMedian, Split::SurfaceArea];
}

/// Which of the ray/triangle tests is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TriangleMethod {
    /// Cramer's rule.
    Cramer,
    /// Plane first, then the Gram matrix.
    Gram,
    /// Watertight edge tests.
    #[default]
    Watertight,
}

/// Where the samples of a pixel lie (stage 6).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sampler {
    /// In its centre, all of them.
    Center,
    /// Anywhere.
    Random,
    /// Anywhere in cells of a grid, one a cell.
    Jittered,
    /// Around the centre, weighted by a Gaussian.
    Gaussian,
    /// Spread as evenly as can be; a single one in the centre.
    #[default]
    LowDiscrepancy,
}

impl Sampler {
    /// Whether `samples` samples of a pixel lie anywhere else than in its centre.
    pub fn spreads(self, samples: u32) -> bool {
        match self {
            Sampler::Center => false,
            Sampler::LowDiscrepancy => samples > 1,
            Sampler::Random | Sampler::Jittered | Sampler::Gaussian => true,
        }
    }
}

/// How many digits ray/shape tests work with (stage 10).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// 24 bits.
    #[default]
    Single,
    /// 53 bits.
    Double,
}

/// Every knob that trades accuracy for time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Samples a pixel, at least 1.
    pub samples_per_pixel: u32,
    /// Where they lie (stage 6).
    pub sampler: Sampler,
    /// Samples of an area light a hit (stage 6); with 0 it shines from its middle.
    pub light_samples: u32,
    /// Rays of a rough mirror a hit, at least 1 (stage 6).
    pub gloss_samples: u32,
    /// How often a ray may be mirrored or refracted (stage 5).
    pub max_depth: u32,
    /// Rays of less weight are not traced (stage 5).
    pub min_contribution: f32,
    /// What finds the closest hit.
    pub accelerator: Accelerator,
    /// How a hierarchy is split.
    pub split: Split,
    /// The most primitives that a leaf holds, at least 1.
    pub leaf_size: u32,
    /// The ray/triangle test.
    pub triangle_method: TriangleMethod,
    /// Whether a mesh that stands in several places is copied for each, as if stage 8 were not there.
    pub copies: bool,
    /// What a search of the scene graph saves (stage 8).
    pub savings: Savings,
    /// Digits of ray/shape tests (stage 10).
    pub precision: Precision,
    /// Cells of a grid along its longest side; 0 takes the formula's (stage 9).
    pub grid_resolution: u32,
    /// What the builder of a kd-tree minds (stage 9).
    pub kd_heuristics: KdHeuristics,
}

impl Default for Quality {
    fn default() -> Self {
        Quality {
            samples_per_pixel: 1,
            sampler: Sampler::default(),
            light_samples: 1,
            gloss_samples: 1,
            max_depth: 5,
            min_contribution: 0.001,
            accelerator: Accelerator::default(),
            split: Split::default(),
            leaf_size: 4,
            triangle_method: TriangleMethod::default(),
            copies: false,
            savings: Savings::default(),
            precision: Precision::default(),
            grid_resolution: 0,
            kd_heuristics: KdHeuristics::default(),
        }
    }
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
