//! The types in the signatures of the list of student functions, under the names that the list uses.

pub use super::*;
pub use crate::aabb::Aabb;
pub use crate::bvh::{Bvh, PrimitiveHit, PrimitiveRef, Probe};
pub use crate::camera::{Camera, Lens, Shutter};
pub use crate::effects::{Effects, LightEffects, MaterialEffects};
pub use crate::emitter::{AreaEmitter, EmitterSample, EmitterShape};
pub use crate::graph::{ChildCache, Graph, GraphOptimisations, Placement};
pub use crate::light_path::{
    BsdfSample, PathEffects, PathState, PathStep, PathVertex, Scattering, StepNumbers,
};
pub use crate::material::{Light, Material, Texture, Wrap};
pub use crate::mesh::Mesh;
pub use crate::partition::{Bsp, Cell, Cells, Grid, KdHeuristics, KdTree, Octree, PolygonBsp};
pub use crate::random::Stratum;
pub use crate::ray::Ray;
pub use crate::scene::{Quality, Sampler, Scene, Split};
pub use crate::shape::{BezierPatch, Cone, Cuboid, Cylinder, Disk, NurbsPatch, Polygon, Sphere, Triangle};
pub use crate::wide::simd::{Instructions, Level, Vectorized};
pub use crate::wide::{
    BinGrid, BinSplit, Bins, BoxA, Child, Entered, FlatTree, ForkedTree, Forks, PrimitiveBox, TriangleBlock,
    WideNode, WideProbe, WideRay, WideTree,
};
pub use glam::{Affine3A, UVec3, Vec2, Vec3};
