//! The simplest query of each kind: it is used to find out whether a function is written.

use super::types::*;
use crate::material::{Emitter, Falloff};
use glam::UVec2;
use std::sync::Arc;

/// A type with a simplest value.
pub(super) trait Example: Sized {
    /// The simplest value of the type.
    fn example() -> Self;
}

/// `Example` for a type, by an expression in which `example()` gives the example of any other type.
macro_rules! examples {
    ($($Type:ty => $value:expr;)*) => {
        $(impl Example for $Type {
            fn example() -> Self {
                $value
            }
        })*
    };
}

/// `Example` for types whose default is the simplest value.
macro_rules! defaults {
    ($($Type:ty),*) => {
        $(impl Example for $Type {
            fn example() -> Self {
                Self::default()
            }
        })*
    };
}

pub(super) fn example<T: Example>() -> T {
    T::example()
}

impl<T: Example, U: Example> Example for (T, U) {
    fn example() -> Self {
        (example(), example())
    }
}

impl<T: Example, U: Example, V: Example> Example for (T, U, V) {
    fn example() -> Self {
        (example(), example(), example())
    }
}

impl<T: Example> Example for Option<T> {
    fn example() -> Self {
        None
    }
}

impl<T: Example, const N: usize> Example for [T; N] {
    fn example() -> Self {
        std::array::from_fn(|_| example())
    }
}

impl<S: Example> Example for SolidQuery<S> {
    fn example() -> Self {
        SolidQuery { ray: example(), solid: example() }
    }
}

impl<S: Example> Example for CellsQuery<S> {
    fn example() -> Self {
        CellsQuery { cells: example(), ray: example(), hits: Vec::new() }
    }
}

defaults! {
    Mesh, Material, Quality, Effects, KdHeuristics, Bsp, PolygonBsp, Vec<WeightedColor>, Vec<Light>,
    Vec<MaterialHits>, Vec<PrimitiveBox>, Bvh, FlatTree, Vec<Aabb>
}

examples! {
    f32 => 1.0;
    u8 => 1;
    u32 => 0;
    i64 => 0;
    usize => 1;
    bool => true;
    Vec2 => Vec2::ZERO;
    Vec3 => Vec3::Z;
    Ray => Ray::new(Vec3::ZERO, Vec3::Z);
    Aabb => Aabb::new(Vec3::ZERO, Vec3::ONE);
    Sphere => Sphere { center: 2.0 * Vec3::Z, radius: 1.0 };
    Triangle => Triangle { a: Vec3::Z, b: Vec3::X, c: Vec3::Y };
    Cuboid => Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    Cylinder => Cylinder { base: Vec3::ZERO, top: Vec3::Y, radius: 1.0 };
    Cone => Cone { base: Vec3::ZERO, apex: Vec3::Y, radius: 1.0 };
    Disk => Disk { center: Vec3::ZERO, normal: Vec3::Y, radius: 1.0 };
    Polygon => Polygon { corners: vec![Vec3::ZERO, Vec3::X, Vec3::Y] };
    BezierPatch => BezierPatch { rows: [[Vec3::ZERO; 4]; 4] };
    NurbsPatch => NurbsPatch {
        degrees: [1, 1],
        knots: [0, 1].map(|_| vec![0.0, 0.0, 1.0, 1.0]),
        rows: vec![vec![Vec3::ZERO; 2]; 2],
        weights: vec![vec![1.0; 2]; 2],
    };
    Stratum => Stratum { cell: UVec2::ZERO, grid: UVec2::ONE, u: Vec2::ZERO };
    Sampler => Sampler::Jittered;
    Split => Split::SurfaceArea;
    Wrap => Wrap::Repeat;
    Limits => Limits { max_depth: 0, min_contribution: 0.0 };
    Lens => Lens { aperture: 0.0, focal_distance: 1.0 };
    Shutter => Shutter { open: 0.0, close: 1.0 };
    PathState => PathState {
        origin: Vec3::Z,
        direction: Vec3::NEG_Z,
        weight: Vec3::ONE,
        bounces: 0,
        pdf: f32::INFINITY,
    };
    PathVertex => PathVertex {
        surface: example(),
        scattering: example(),
        emission: Vec3::ZERO,
        emitter: None,
        light: None,
    };
    StepNumbers => StepNumbers { light: Vec2::ZERO, bsdf: Vec3::ZERO, roulette: 0.0 };
    UVec3 => UVec3::ONE;
    Affine3A => Affine3A::IDENTITY;
    Camera => Camera::new(Vec3::ZERO, Vec3::Z, Vec3::Y, 40.0, 1.0).expect("a camera that looks along z");
    Scene => Scene::empty(example());
    Surface => Surface {
        point: Vec3::ZERO,
        error: Vec3::ZERO,
        geometric_normal: Vec3::Z,
        shading_normal: Vec3::Z,
    };
    Light => Light {
        emitter: Emitter::Point { position: Vec3::Z, falloff: Falloff::None },
        color: Vec3::ONE,
        intensity: 1.0,
        shadows: true,
        cone: None,
    };
    LightSample => LightSample { direction: Vec3::Z, distance: 1.0, radiance: Vec3::ONE };
    Texture => Texture { width: 1, height: 1, pixels: Arc::new(vec![Vec3::ONE]), wrap: Wrap::Repeat };
    SecondaryRay => SecondaryRay { bounce: Bounce::Reflection, direction: Vec3::Z, weight: Vec3::ONE };
    Grid => Grid { bounds: Aabb::EMPTY, resolution: UVec3::ONE, starts: vec![0, 0], items: Vec::new() };
    Octree => Octree::empty();
    KdTree => KdTree::new(Aabb::EMPTY);

    Vec<PrimitiveRef> => [0, 1].map(|id| PrimitiveRef { id, bounds: example(), centroid: Vec3::splat(0.5) }).into();
    Vec<Affine3A> => Vec::new();
    Vec<Vec3> => vec![Vec3::ZERO];
    Vec<f32> => vec![0.0, 0.0, 1.0, 1.0]; // the knots of a straight line
    Vec<Vec<Vec3>> => Vec::new();

    SphereQuery => SphereQuery { ray: example(), sphere: example() };
    PlaneQuery => PlaneQuery {
        ray: example(),
        plane: crate::shape::Plane { point: Vec3::Z, normal: Vec3::Z },
    };
    PlaneEquationQuery => PlaneEquationQuery {
        ray: example(),
        plane: crate::shape::PlaneEquation { normal: Vec3::Z, d: -1.0 },
    };
    SearchQuery => SearchQuery { bvh: Bvh::default(), ray: example(), table: Table::default() };
    SlabQuery => SlabQuery { ray: example(), bounds: example() };
    ShadeQuery => ShadeQuery {
        surface: example(),
        to_viewer: Vec3::Z,
        material: example(),
        ambient: Vec3::ONE,
        lights: Vec::new(),
        visible: Vec::new(),
    };
    GraphQuery => GraphQuery {
        graph: Graph::default(),
        ray: example(),
        savings: GraphOptimisations::default(),
        table: Table::default(),
    };
    CachedGraphQuery => CachedGraphQuery { search: example(), cache: ChildCache::default() };
    CachedQuery => CachedQuery { last: None, ray: example(), hits: Vec::new(), entries: Vec::new() };
    PacketQuery => PacketQuery { bvh: Bvh::default(), rays: Vec::new(), tables: Vec::new() };
    AreaEmitter => AreaEmitter { shape: EmitterShape::Sphere(example()), radiance: Vec3::ONE, two_sided: false };
    Scattering => Scattering { diffuse: Vec3::ONE, normal: Vec3::Z, secondary: Vec::new() };
    EmitterSample => EmitterSample { direction: Vec3::Z, distance: 1.0, radiance: Vec3::ONE, pdf: 1.0 };
    BinGrid => BinGrid { low: glam::Vec3A::ZERO, scale: glam::Vec3A::ONE, n_bins: 2 };
    BinSplitQuery => BinSplitQuery { bins: Box::new(Bins::EMPTY), n_bins: 2 };
    PartitionQuery => PartitionQuery {
        primitives: Vec::new(),
        grid: example(),
        split: BinSplit { axis: 0, bin: 1, cost: 1.0 },
    };
    WideBoxesQuery => WideBoxesQuery { node: Box::new(WideNode::EMPTY), ray: example() };
    BlockQuery => BlockQuery { block: Box::new(TriangleBlock::new([0; 8], |_| Some(example()))), ray: example() };
    WideQuery => WideQuery {
        tree: WideTree { nodes: vec![WideNode::EMPTY], blocks: Vec::new() },
        ray: example(),
        entries: vec![[f32::INFINITY; 8]],
        hits: Vec::new(),
    };
}
