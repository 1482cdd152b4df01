//! The types in the signatures of the list of student functions, under the names that the list uses.

pub use super::*;
pub use crate::aabb::Aabb;
pub use crate::bvh::{Bvh, Contents, Node, PrimitiveHit, PrimitiveRef, Probe};
pub use crate::camera::{Camera, Lens, Shutter};
pub use crate::effects::{Effects, LightEffects, MaterialEffects};
pub use crate::emitter::{AreaEmitter, EmitterSample, EmitterShape};
pub use crate::film::{Tone, ToneCurve};
pub use crate::graph::{ChildCache, Graph, GraphNode, GraphOptimisations, Placement};
pub use crate::light_path::{
    BsdfSample, ChosenEmitter, LightCandidate, Lobe, NextRay, PathEffects, PathState, PathStep, PathVertex,
    Scattering, ShadowQuestion, StepNumbers,
};
pub use crate::material::{
    AreaShape, Cone as SpotCone, Emitter, Falloff, Fresnel, Light, Material, Texture, Wrap,
};
pub use crate::mesh::Mesh;
pub use crate::partition::{
    Bsp, BspNode, Cell, CellTree, Cells, CutPlane, Grid, KdHeuristics, KdNode, KdTree, Octree, OctreeNode,
    PolygonBsp, PolygonBspNode, Tree,
};
pub use crate::random::Stratum;
pub use crate::ray::Ray;
pub use crate::rows::Rows;
pub use crate::scene::{
    Accelerator, Background, ColorPlace, Encoding, EnvironmentMap, FilmSettings, Gamma2, Gradient,
    GradientColor, MaterialColor, NextEvent, Node as SceneNode, Precision, Quality, Sampler, Scene,
    SceneMesh, SphereMethod, Split, TextureFilter, TriangleMethod, VisibleLight,
};
pub use crate::shape::{
    BezierPatch, Cone, Cuboid, Cylinder, Disk, NurbsPatch, Plane, PlaneEquation, Polygon, Shape, Sphere,
    Triangle,
};
pub use crate::wide::simd::{Instructions, Level, Vectorized};
pub use crate::wide::{
    Bin, BinGrid, BinSplit, Bins, BoxA, Child, Entered, FlatNode, FlatTree, Fork, ForkKind, ForkedTree,
    Forks, PrimitiveBox, TriangleBlock, WideNode, WideProbe, WideRay, WideTree,
};
pub use glam::{Affine3A, UVec3, Vec2, Vec3};
pub use std::sync::Arc;
