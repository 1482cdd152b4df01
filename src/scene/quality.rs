//! What a scene says of how it is to be rendered: structures, sampling, precision.

use crate::graph::Savings;
use crate::partition::KdHeuristics;
use serde::{Deserialize, Serialize};

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

/// How many digits the tests of rays against triangles and spheres work with (stage 10). Rays and shapes themselves are
/// kept in single precision. Planes, boxes, cylinders, cones, disks and polygons have one test each, whatever this is:
/// their `t` is right to a few roundings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// 24 bits, by the [`TriangleMethod`] of the scene; that of the reference which is watertight takes 53 as it is.
    #[default]
    Single,
    /// 53 bits, whatever the method is.
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
    /// Digits of tests against triangles and spheres (stage 10).
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
