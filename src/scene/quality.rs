//! The settings of a scene that trade accuracy for time: acceleration structure, sampling and precision.

use crate::graph::GraphOptimisations;
use crate::message;
use crate::partition::KdHeuristics;
use crate::random::Sampler;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// The acceleration structure that finds the closest hit of a ray. All of them must find the same hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Accelerator {
    /// The fastest hierarchy that is written: [`Accelerator::WideBvh`], or else [`Accelerator::Bvh`]. A split or a leaf size other
    /// than the default selects [`Accelerator::Bvh`], because only the builder of stage 3 has them.
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

message! { enum Accelerator {
    Auto, BruteForce, BoundingBoxes, BoundingSpheres, CachedBoundingBoxes, Bvh, WideBvh, BvhBothChildren,
    Grid, Octree, OctreeByCells, OctreeByNeighbours, KdTree, Bsp, PolygonBsp, CachedBvh, PacketBvh
} }

impl Accelerator {
    /// Every structure once, so without [`Accelerator::Auto`]: brute force, the volumes of the scene graph, the hierarchies, then the
    /// structures that divide space.
    pub const ALL: [Accelerator; Accelerator::NAMES.len() - 1] = {
        let mut all = [Accelerator::Auto; Accelerator::NAMES.len() - 1];
        let mut i = 0;
        while i < all.len() {
            all[i] = Accelerator::NAMES[i + 1].1;
            i += 1;
        }
        all
    };

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
        self == Accelerator::WideBvh
    }
}

/// Where the builder of a bounding volume hierarchy divides the primitives of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// At the object median: half of the primitives on either side.
    ObjectMedian,
    /// At the spatial median: half of the box on either side.
    SpatialMedian,
    /// Where the expected cost is least by the surface area heuristic (SAH).
    SurfaceArea,
}

message! { enum Split { ObjectMedian, SpatialMedian, SurfaceArea } }

impl Split {
    /// All three splits, in the order of the lecture.
    pub const ALL: [Split; 3] = [Split::ObjectMedian, Split::SpatialMedian, Split::SurfaceArea];
}

/// Which ray/triangle test is used with [`Precision::Single`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
    Watertight,
}

message! { enum TriangleMethod {
    Cramer, Gram, InsideByPlanes, InsideByDirection, InsideByAreas, Choice, Watertight
} }

/// Which ray/sphere test is used with [`Precision::Single`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SphereMethod {
    /// Solve the quadratic equation of the ray and the sphere (stage 1).
    Algebraic,
    /// By right triangles: the point nearest to the centre and half of the chord (stage 1).
    Geometric,
    /// The quadratic equation `a t² + b t + c = 0` with coefficients in single precision, solved by `stable_roots`
    /// (stage 10). The roots lose no digits, but `b² - 4ac` cancels for spheres that are small or far away: stage 1
    /// avoids that, so its method stays the default.
    StableRoots,
}

message! { enum SphereMethod { Algebraic, Geometric, StableRoots } }

/// How images are read (stage 7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TextureFilter {
    /// One read per hit, between the four nearest pixels of the image.
    Bilinear,
    /// By cone tracing: from smaller copies of the image (mip levels), over the part of the surface that the ray's cone
    /// covers, with 1 to 32 reads per hit. A distant image does not sparkle.
    Mipmap,
}

message! { enum TextureFilter { Bilinear, Mipmap } }

/// With indirect light: how paths find the light of emitters and of an environment map (stage 11). All three give the same
/// picture with enough samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NextEvent {
    /// Diffuse rays find them by chance.
    Off,
    /// Each diffuse surface of a path samples one of them (next-event estimation). A diffuse ray that finds a sampled light by
    /// chance adds nothing.
    Only,
    /// Both, with the weights of multiple importance sampling.
    On,
}

message! { enum NextEvent { Off, Only, On } }

/// Floating-point precision of the ray tests against triangles and spheres (stage 10).
///
/// Rays and shapes themselves are stored in single precision. Infinite planes, boxes, cylinders, cones, disks
/// and polygons have one test each, for both settings; their `t` is right to a few roundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// Single precision, 24 bits, by the [`TriangleMethod`] and the [`SphereMethod`] of the scene. The watertight test of the
    /// reference computes in double precision all the same.
    Single,
    /// Double precision, 53 bits, with any [`TriangleMethod`] and [`SphereMethod`].
    Double,
}

message! { enum Precision { Single, Double } }

/// The most primitives of a flattened scene, unless a caller sets another limit.
pub(crate) const MOST_PRIMITIVES: u32 = 20_000_000;

/// A value that is one of a list of names.
pub trait Named {
    /// The names of all values, as in scene files.
    fn names(&self) -> Vec<&'static str>;
    /// The name of this value.
    fn name(&self) -> &'static str;
    /// Replaces this value by the one of this name; an unknown name changes nothing.
    fn choose(&mut self, name: &str);
}

/// Optimisations that are switched on and off one by one; all are on by default.
pub trait Switches {
    /// The name of each of them, as in scene files, and whether it is on.
    fn switches(&mut self) -> Vec<(&'static str, &mut bool)>;
}

macro_rules! names {
    ($($type:ident { $($name:literal $value:ident)+ })+) => {$(
        impl $type {
            /// Every value with its name in scene files.
            pub const NAMES: [(&'static str, $type); [$($name),+].len()] = [$(($name, $type::$value)),+];

            /// The name in scene files.
            pub fn name(self) -> &'static str {
                match self { $($type::$value => $name),+ }
            }
        }

        impl Named for $type {
            fn names(&self) -> Vec<&'static str> {
                vec![$($name),+]
            }
            fn name(&self) -> &'static str {
                $type::name(*self)
            }
            fn choose(&mut self, name: &str) {
                match name { $($name => *self = $type::$value,)+ _ => {} }
            }
        }
    )+};
}

macro_rules! switches {
    ($($type:ident { $($name:ident)+ })+) => {$(
        impl Switches for $type {
            fn switches(&mut self) -> Vec<(&'static str, &mut bool)> {
                vec![$((stringify!($name), &mut self.$name)),+]
            }
        }
    )+};
}

names! {
    Sampler {
        "center" Center "random" Random "jittered" Jittered "gaussian" Gaussian "low_discrepancy" LowDiscrepancy
    }
    TextureFilter { "bilinear" Bilinear "mipmap" Mipmap }
    NextEvent { "off" Off "only" Only "on" On }
    Accelerator {
        "auto" Auto
        "brute_force" BruteForce
        "bounding_boxes" BoundingBoxes
        "bounding_spheres" BoundingSpheres
        "cached_bounding_boxes" CachedBoundingBoxes
        "bvh" Bvh
        "bvh_both_children" BvhBothChildren
        "cached_bvh" CachedBvh
        "packet_bvh" PacketBvh
        "wide_bvh" WideBvh
        "grid" Grid
        "octree" Octree
        "octree_by_cells" OctreeByCells
        "octree_by_neighbours" OctreeByNeighbours
        "kd_tree" KdTree
        "bsp" Bsp
        "polygon_bsp" PolygonBsp
    }
    Split { "object_median" ObjectMedian "spatial_median" SpatialMedian "surface_area" SurfaceArea }
    TriangleMethod {
        "cramer" Cramer
        "gram" Gram
        "inside_by_planes" InsideByPlanes
        "inside_by_direction" InsideByDirection
        "inside_by_areas" InsideByAreas
        "choice" Choice
        "watertight" Watertight
    }
    SphereMethod { "algebraic" Algebraic "geometric" Geometric "stable_roots" StableRoots }
    Precision { "single" Single "double" Double }
}

switches! {
    GraphOptimisations { volumes skip sort }
    KdHeuristics { longest_axis balanced_counts few_straddlers cut_off_empty_space stop_at_overlap }
}

/// A setting of a [`Quality`] with the values that it may have.
pub enum Field<'a> {
    /// A whole number in a closed range.
    Whole(&'a mut u32, RangeInclusive<u32>),
    /// A finite number in a closed range.
    Number(&'a mut f32, RangeInclusive<f32>),
    /// `true` or `false`.
    Truth(&'a mut bool),
    /// One of a list of names.
    Name(&'a mut dyn Named),
    /// Several switches.
    Switches(&'a mut dyn Switches),
}

impl Field<'_> {
    /// The value as in scene files, without the quotes of a name.
    pub fn text(self) -> String {
        match self {
            Field::Whole(number, _) => number.to_string(),
            Field::Number(number, _) => number.to_string(),
            Field::Truth(truth) => truth.to_string(),
            Field::Name(name) => name.name().to_owned(),
            Field::Switches(switches) => {
                let one = |(name, is_on): (&str, &mut bool)| format!("{name} = {is_on}");
                let all: Vec<_> = switches.switches().into_iter().map(one).collect();
                format!("{{ {} }}", all.join(", "))
            }
        }
    }
}

/// Makes of the rows of settings, each `key: type = default, values, sentence`, the struct [`Quality`], its default, and the access
/// to a setting by its key. `values` is a variant of [`Field`] with its range.
macro_rules! settings {
    ($($key:ident: $type:ty = $default:expr, $values:ident$(($range:expr))?, $words:literal;)+) => {
        /// Every setting that trades accuracy for time. A key that a scene file leaves out keeps its value of
        /// `Quality::default()`.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        pub struct Quality {$(
            #[doc = concat!($words, $(" (`", stringify!($range), "`)",)? "; `", stringify!($default), "` by default.")]
            pub $key: $type,
        )+}

        message! { Quality { $($key),+ } }

        impl Default for Quality {
            fn default() -> Self {
                Quality { $($key: $default),+ }
            }
        }

        impl Quality {
            /// The keys of all settings, as in scene files.
            pub const KEYS: [&'static str; [$($words),+].len()] = [$(stringify!($key)),+];

            /// What each setting is, in the order of [`Quality::KEYS`].
            pub const WORDS: [&'static str; Quality::KEYS.len()] = [$($words),+];

            /// The setting of this key, to be read or changed.
            pub fn field(&mut self, key: &str) -> Option<Field<'_>> {
                Some(match key {
                    $(stringify!($key) => Field::$values(&mut self.$key $(, $range)?),)+
                    _ => return None,
                })
            }

            /// Takes the value of the setting of this key from `other`; an unknown key changes nothing.
            pub fn take(&mut self, key: &str, other: &Quality) {
                match key {
                    $(stringify!($key) => self.$key = other.$key,)+
                    _ => {}
                }
            }

            /// The keys of the settings that differ from those of `other`.
            pub fn differences(&self, other: &Quality) -> Vec<&'static str> {
                let differs = [$(self.$key != other.$key),+];
                Quality::KEYS.into_iter().zip(differs).filter(|(_, differs)| *differs).map(|(key, _)| key).collect()
            }
        }
    };
}

/// The largest number of samples: beyond a million, the rounding error of their sum in `f32` exceeds the
/// contribution of one more.
const MAX_SAMPLES: u32 = 1 << 20;
/// The largest number of reflections and refractions on a path: after that many, a mirror that reflects 99.3 % has left a
/// thousandth of the light, which is the default of `min_contribution`.
const MAX_DEPTH: u32 = 1000;
/// The largest number of cells along a side of a grid: 1024^3 cells of 4 bytes fill 4 GiB.
const MAX_GRID: u32 = 1024;

settings! {
    samples_per_pixel: u32 = 1, Whole(1..=MAX_SAMPLES), "Samples per pixel";
    sampler: Sampler = Sampler::LowDiscrepancy, Name, "Positions of the samples in a pixel";
    light_samples: u32 = 1, Whole(0..=MAX_SAMPLES), "Samples per area light and hit; with 0 an area light shines from its centre";
    glossy_samples: u32 = 1, Whole(1..=MAX_SAMPLES), "Rays per glossy reflection or refraction at a hit";
    texture_filter: TextureFilter = TextureFilter::Bilinear, Name, "How images are read";
    max_depth: u32 = 5, Whole(0..=MAX_DEPTH), "The most reflections and refractions on a path";
    min_contribution: f32 = 0.001, Number(0.0..=1.0), "A ray whose weight is below this in every channel is not traced";
    next_event: NextEvent = NextEvent::On, Name, "With indirect light: how paths find emitters and an environment map";
    clamp: f32 = 0.0, Number(0.0..=f32::MAX), "With indirect light: the largest channel of the light of a sample; 0 sets no limit";
    accelerator: Accelerator = Accelerator::Auto, Name, "The acceleration structure";
    split: Split = Split::SurfaceArea, Name, "Where a bounding volume hierarchy divides its primitives";
    leaf_size: u32 = 4, Whole(1..=u32::MAX), "The most primitives of a leaf";
    triangle_method: TriangleMethod = TriangleMethod::Watertight, Name, "The ray/triangle test in single precision";
    sphere_method: SphereMethod = SphereMethod::Algebraic, Name, "The ray/sphere test in single precision";
    copies: bool = false, Truth, "Whether a mesh with several instances is copied for each of them";
    savings: GraphOptimisations = GraphOptimisations::default(), Switches, "Optimisations of the search of the scene graph";
    precision: Precision = Precision::Single, Name, "Precision of tests against triangles and spheres";
    grid_resolution: u32 = 0, Whole(0..=MAX_GRID), "Cells of a grid along its longest side; 0 takes the number of the formula";
    ray_offset: f32 = 0.0, Number(0.0..=f32::MAX), "How far above a surface its rays start; 0 takes the error bound of the point";
    lift_shadow_rays: bool = false, Truth, "Whether shadow rays of smooth meshes start on the curved surface that the normals describe";
    kd_heuristics: KdHeuristics = KdHeuristics::default(), Switches, "Heuristics that the builder of a kd-tree follows";
}
