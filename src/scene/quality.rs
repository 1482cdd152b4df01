//! The settings of a scene that trade accuracy for time: acceleration structure, sampling and precision.

use crate::graph::Savings;
use crate::partition::KdHeuristics;
use crate::random::Sampler;
use serde::{Deserialize, Serialize};

/// The acceleration structure that finds the closest hit of a ray. All of them must find the same hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Accelerator {
    /// The fastest hierarchy that is written: [`Accelerator::WideBvh`], or else [`Accelerator::Bvh`]. A split or a leaf size other
    /// than the default selects [`Accelerator::Bvh`], because only the builder of stage 3 has them.
    #[default]
    Auto,
    /// No structure: every ray is tested against every primitive (stage 2).
    BruteForce,
    /// The scene graph itself, with a bounding box around each of its nodes (stage 8).
    BoundingBoxes,
    /// The scene graph itself, with a bounding sphere around each of its nodes (stage 8).
    BoundingSpheres,
    /// The scene graph with a bounding box around each node, where each node remembers the child that the previous ray hit
    /// and searches it first (stage 8).
    CachedBoundingBoxes,
    /// A bounding volume hierarchy (stage 3).
    Bvh,
    /// A bounding volume hierarchy with eight children per node, whose boxes are tested at once (stage 12).
    WideBvh,
    /// The same, and its binary tree is improved by moves of subtrees before (stage 12, bonus).
    ReinsertedBvh,
    /// The same as [`Accelerator::WideBvh`], and camera rays go through it in streams of 64 (stage 12, bonus).
    StreamBvh,
    /// A bounding volume hierarchy whose search visits both children of every node that the ray enters, in any order:
    /// the baseline that shows what the order and the shorter ray save (stage 3). Shadow rays stop at the first hit,
    /// as with [`Accelerator::Bvh`].
    BvhBothChildren,
    /// A uniform grid of equal cells (stage 9).
    Grid,
    /// An octree that is searched from the root down (stage 9).
    Octree,
    /// An octree that is searched from cell to cell along the ray, and not from the root down (stage 9).
    OctreeByCells,
    /// The octree of stage 9, searched from leaf to leaf along the ray without a return to the root.
    OctreeByNeighbours,
    /// A kd-tree: space is divided by planes across the axes (stage 9).
    KdTree,
    /// A binary space partition (BSP) tree: space is divided by planes of any direction (stage 9).
    Bsp,
    /// A BSP tree with the polygons in its nodes: each polygon lies on the planes of the tree, and is split by the
    /// others (stage 9).
    PolygonBsp,
    /// A bounding volume hierarchy; the primitive that the previous ray hit is tested first (stage 9).
    CachedBvh,
    /// A bounding volume hierarchy that is searched by camera rays in packets of eight (stage 9).
    PacketBvh,
}

impl Accelerator {
    /// Every structure once, so without [`Accelerator::Auto`]: brute force, the volumes of the scene graph, the hierarchies, then the
    /// structures that divide space.
    pub const ALL: [Accelerator; 18] = [
        Accelerator::BruteForce,
        Accelerator::BoundingBoxes,
        Accelerator::BoundingSpheres,
        Accelerator::CachedBoundingBoxes,
        Accelerator::Bvh,
        Accelerator::BvhBothChildren,
        Accelerator::CachedBvh,
        Accelerator::PacketBvh,
        Accelerator::WideBvh,
        Accelerator::ReinsertedBvh,
        Accelerator::StreamBvh,
        Accelerator::Grid,
        Accelerator::Octree,
        Accelerator::OctreeByCells,
        Accelerator::OctreeByNeighbours,
        Accelerator::KdTree,
        Accelerator::Bsp,
        Accelerator::PolygonBsp,
    ];

    /// The names of all values in scene files.
    pub fn names() -> [(&'static str, Accelerator); 19] {
        let mut names = [(Accelerator::Auto.name(), Accelerator::Auto); 19];
        for (place, one) in names[1..].iter_mut().zip(Accelerator::ALL) {
            *place = (one.name(), one);
        }
        names
    }

    /// Whether the structure is a bounding volume hierarchy of stage 3, however it is searched, or may be one: then the split and
    /// the leaf size change it.
    pub fn is_hierarchy(self) -> bool {
        matches!(
            self,
            Accelerator::Auto
                | Accelerator::Bvh
                | Accelerator::BvhBothChildren
                | Accelerator::CachedBvh
                | Accelerator::PacketBvh
        )
    }

    /// Whether the structure is a tree of stage 12 with eight children per node.
    pub fn is_wide(self) -> bool {
        matches!(self, Accelerator::WideBvh | Accelerator::ReinsertedBvh | Accelerator::StreamBvh)
    }

    /// The name in scene files, in snake case, for example `bounding_boxes`.
    pub fn name(self) -> &'static str {
        match self {
            Accelerator::Auto => "auto",
            Accelerator::BruteForce => "brute_force",
            Accelerator::BoundingBoxes => "bounding_boxes",
            Accelerator::BoundingSpheres => "bounding_spheres",
            Accelerator::CachedBoundingBoxes => "cached_bounding_boxes",
            Accelerator::Bvh => "bvh",
            Accelerator::BvhBothChildren => "bvh_both_children",
            Accelerator::CachedBvh => "cached_bvh",
            Accelerator::PacketBvh => "packet_bvh",
            Accelerator::WideBvh => "wide_bvh",
            Accelerator::ReinsertedBvh => "reinserted_bvh",
            Accelerator::StreamBvh => "stream_bvh",
            Accelerator::Grid => "grid",
            Accelerator::Octree => "octree",
            Accelerator::OctreeByCells => "octree_by_cells",
            Accelerator::OctreeByNeighbours => "octree_by_neighbours",
            Accelerator::KdTree => "kd_tree",
            Accelerator::Bsp => "bsp",
            Accelerator::PolygonBsp => "polygon_bsp",
        }
    }
}

/// Where the builder of a bounding volume hierarchy divides the primitives of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// At the object median: half of the primitives on either side.
    ObjectMedian,
    /// At the spatial median: half of the box on either side.
    SpatialMedian,
    /// Where the expected cost is least by the surface area heuristic (SAH).
    #[default]
    SurfaceArea,
}

impl Split {
    /// All three splits, in the order of the lecture.
    pub const ALL: [Split; 3] = [Split::ObjectMedian, Split::SpatialMedian, Split::SurfaceArea];
}

/// Which ray/triangle test is used with [`Precision::Single`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TriangleMethod {
    /// Solve for `t` and the barycentric coordinates by Cramer's rule (stage 2).
    Cramer,
    /// Intersect the plane of the triangle, then find the barycentric coordinates with the Gram matrix of its
    /// edges (stage 2).
    Gram,
    /// Intersect the plane of the triangle (stage 1), then decide by inside test I: planes through the origin of
    /// the ray and the sides (stage 2). Test III gives the barycentric coordinates of a hit.
    InsideByPlanes,
    /// Intersect the plane of the triangle (stage 1), then decide by inside test II: the sides of the triangle as
    /// seen along the ray (stage 2). Test III gives the barycentric coordinates of a hit.
    InsideByDirection,
    /// Intersect the plane of the triangle (stage 1), then decide by inside test III: barycentric coordinates as
    /// ratios of areas (stage 2).
    InsideByAreas,
    /// The method of the student's choice (stage 2). That of the reference is Möller and Trumbore's.
    Choice,
    /// The watertight test (stage 10): no ray passes between two triangles that share an edge. Until it is
    /// written, frames use [`TriangleMethod::Choice`].
    #[default]
    Watertight,
}

impl TriangleMethod {
    /// All methods, with their names in scene files.
    pub const ALL: [(&str, TriangleMethod); 7] = [
        ("cramer", TriangleMethod::Cramer),
        ("gram", TriangleMethod::Gram),
        ("inside_by_planes", TriangleMethod::InsideByPlanes),
        ("inside_by_direction", TriangleMethod::InsideByDirection),
        ("inside_by_areas", TriangleMethod::InsideByAreas),
        ("choice", TriangleMethod::Choice),
        ("watertight", TriangleMethod::Watertight),
    ];
}

/// Which ray/sphere test is used with [`Precision::Single`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SphereMethod {
    /// Solve the quadratic equation of the ray and the sphere (stage 1).
    #[default]
    Algebraic,
    /// By right triangles: the point nearest to the centre and half of the chord (stage 1).
    Geometric,
    /// The quadratic equation `a t² + b t + c = 0` with coefficients in single precision, solved by `stable_roots`
    /// (stage 10). The roots lose no digits, but `b² - 4ac` cancels for spheres that are small or far away: stage 1
    /// avoids that, so its method stays the default.
    StableRoots,
}

impl SphereMethod {
    /// All methods, with their names in scene files.
    pub const ALL: [(&str, SphereMethod); 3] = [
        ("algebraic", SphereMethod::Algebraic),
        ("geometric", SphereMethod::Geometric),
        ("stable_roots", SphereMethod::StableRoots),
    ];
}

/// How images are read (stage 7).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TextureFilter {
    /// One read per hit, between the four nearest pixels of the image.
    #[default]
    Bilinear,
    /// By cone tracing: from smaller copies of the image (mip levels), over the part of the surface that the ray's cone
    /// covers, with 1 to 32 reads per hit. A distant image does not sparkle.
    Mipmap,
}

impl TextureFilter {
    /// All filters, with their names in scene files.
    pub const ALL: [(&str, TextureFilter); 2] =
        [("bilinear", TextureFilter::Bilinear), ("mipmap", TextureFilter::Mipmap)];
}

/// With indirect light: how paths find the light of emitters and of an environment map (stage 11). All three give the same
/// picture with enough samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NextEvent {
    /// Diffuse rays find them by chance.
    Off,
    /// Each diffuse surface of a path samples one of them (next-event estimation). A diffuse ray that finds a sampled light by
    /// chance adds nothing.
    Only,
    /// Both, with the weights of multiple importance sampling.
    #[default]
    On,
}

impl NextEvent {
    /// All three, with their names in scene files.
    pub const ALL: [(&str, NextEvent); 3] =
        [("off", NextEvent::Off), ("only", NextEvent::Only), ("on", NextEvent::On)];
}

/// Floating-point precision of the ray tests against triangles and spheres (stage 10).
///
/// Rays and shapes themselves are stored in single precision. Infinite planes, boxes, cylinders, cones, disks
/// and polygons have one test each, for both settings; their `t` is right to a few roundings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// Single precision, 24 bits, by the [`TriangleMethod`] and the [`SphereMethod`] of the scene. The watertight test of the
    /// reference computes in double precision all the same.
    #[default]
    Single,
    /// Double precision, 53 bits, with any [`TriangleMethod`] and [`SphereMethod`].
    Double,
}

/// The most primitives of a flattened scene, unless a caller sets another limit.
pub(crate) const MOST_PRIMITIVES: u32 = 20_000_000;

/// Every setting that trades accuracy for time. A key that a scene file leaves out keeps its value of
/// `Quality::default()`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Number of samples per pixel, at least 1; 1 by default.
    pub samples_per_pixel: u32,
    /// Where the samples of a pixel lie (stage 6); low discrepancy by default.
    pub sampler: Sampler,
    /// Samples per area light and hit (stage 6); 1 by default. With 0 an area light shines from its centre.
    pub light_samples: u32,
    /// Rays for each glossy reflection or transmission at a hit on a rough surface, at least 1 (stage 6); 1
    /// by default.
    pub glossy_samples: u32,
    /// How images are read (stage 7); bilinear by default.
    pub texture_filter: TextureFilter,
    /// Largest number of reflections and refractions on a path from the camera (stage 5); 5 by default.
    pub max_depth: u32,
    /// A secondary ray is not traced if its weight in the pixel is below this in every channel, `0..=1`
    /// (stage 5); 0.001 by default.
    pub min_contribution: f32,
    /// With indirect light: how paths find emitters and an environment map (stage 11); by samples and by chance by default.
    pub next_event: NextEvent,
    /// With indirect light: the number of bounces from which on Russian roulette ends paths, at least 2 (stage 11); 3 by
    /// default. From `max_depth` on it never does.
    pub roulette_from: u32,
    /// With indirect light: the largest channel of the light of a sample; a brighter sample is darkened to it, which
    /// removes bright specks and makes the picture too dark. 0, the default, sets no limit.
    pub clamp: f32,
    /// The acceleration structure that finds the closest hit; a bounding volume hierarchy by default.
    pub accelerator: Accelerator,
    /// Where a bounding volume hierarchy divides its primitives; by surface area by default.
    pub split: Split,
    /// The most primitives in a leaf of a bounding volume hierarchy, at least 1; 4 by default. Trees that
    /// divide space aim at the same number, and stop earlier where a division does not help.
    pub leaf_size: u32,
    /// The ray/triangle test with [`Precision::Single`]; watertight by default.
    pub triangle_method: TriangleMethod,
    /// The ray/sphere test with [`Precision::Single`]; algebraic by default.
    pub sphere_method: SphereMethod,
    /// Whether the triangles of a mesh are copied for each of its instances, as without stage 8; `false`
    /// shares one mesh.
    pub copies: bool,
    /// Which shortcuts a search of the scene graph takes (stage 8); all by default.
    pub savings: Savings,
    /// Floating-point precision of the tests against triangles and spheres (stage 10); single by default.
    pub precision: Precision,
    /// Cells of a uniform grid along its longest side (stage 9); 0, the default, takes the number of the
    /// formula.
    pub grid_resolution: u32,
    /// Which heuristics the builder of a kd-tree follows (stage 9); all by default.
    pub kd_heuristics: KdHeuristics,
}

impl Default for Quality {
    fn default() -> Self {
        Quality {
            samples_per_pixel: 1,
            sampler: Sampler::default(),
            light_samples: 1,
            glossy_samples: 1,
            texture_filter: TextureFilter::default(),
            max_depth: 5,
            min_contribution: 0.001,
            next_event: NextEvent::default(),
            roulette_from: 3,
            clamp: 0.0,
            accelerator: Accelerator::default(),
            split: Split::default(),
            leaf_size: 4,
            triangle_method: TriangleMethod::default(),
            sphere_method: SphereMethod::default(),
            copies: false,
            savings: Savings::default(),
            precision: Precision::default(),
            grid_resolution: 0,
            kd_heuristics: KdHeuristics::default(),
        }
    }
}
