//! The complete list of the functions that students write, each with plain data as input and output.
//!
//! Tests, renderer and grader call a `&dyn Kit`. It makes no difference to them whose code answers, or
//! whether that code is linked into the same process or runs in a worker at the other end of a pipe. Every
//! call takes a batch of queries, so that a check with thousands of cases needs one message to the worker.

mod costs;
mod distribution;
pub mod door;
mod effects_analysis;
mod example;
mod function_names;
mod functions;
mod job;
pub mod kit_error;
mod light_transport;
mod list;
mod partitions;
pub mod questions;
mod recursion;
mod scene_graph;
mod shading;
mod shapes;
mod speed;
mod stability;
mod table;
mod traced;
mod triangles;
#[doc(hidden)]
pub mod types;
pub mod worker;

pub use crate::film::WeightedColor;
pub use crate::geometry::hit::{GramScalars, SolidHit, TriangleHit};
pub use crate::light::surface::{Bounce, LightSample, Limits, SecondaryRay, Surface};
pub use costs::Costs;
pub use distribution::{
    FILTER_RADIUS, LensQuery, PhongLobeQuery, RectangleQuery, SphereSampleQuery, TimeQuery,
};
pub use door::{
    Answer, Distribution, Door, EffectsAnalysis, Frames, Hierarchies, Hosted, Kit, LightTransport,
    Partitions, Recursion, Request, SceneGraph, Shading, Shapes, Speed, Stability, Transport, Triangles,
};
pub use effects_analysis::{
    BoundQuery, HitsQuery, LightQuery, MaterialHits, MaterialQuery, RayCounts, TexelQuery, TextureQuery,
};
pub use function_names::Function;
#[doc(hidden)]
pub use functions::CallGuard;
pub use functions::{Linked, StudentFunctions, StudentKit, is_written};
pub use job::{RenderJob, Rendering, StructureSize, View};
pub use kit_error::KitError;
pub use light_transport::{
    BsdfPdfQuery, BsdfQuery, EmissionQuery, EmitterPdfQuery, EmitterQuery, LightContributionQuery,
    RouletteQuery, StepQuery,
};
pub use partitions::{
    BspQuery, CachedQuery, CellsAnswer, CellsProbe, CellsQuery, GridQuery, KdQuery, OctreeQuery,
    PacketAnswer, PacketProbe, PacketQuery, ResolutionQuery,
};
pub use recursion::{FresnelQuery, RefractQuery, ScatterQuery};
pub use scene_graph::{
    BasisQuery, BoundingSphereQuery, BoundsQuery, CachedGraphAnswer, CachedGraphQuery, GraphAnswer,
    GraphQuery, NormalQuery, NurbsQuery, ObjectRayQuery, PatchQuery, SolidQuery,
};
pub use shading::{ShadeAnswer, ShadeQuery, ShadowProbe, ShadowQuery, TermQuery};
pub use shapes::{PlaneEquationQuery, PlaneQuery, RootQuery, SphereQuery};
pub use speed::{
    BinSplitQuery, BinsQuery, BlockQuery, PartitionQuery, WideAnswer, WideBoxesQuery, WideQuery,
    WideTableProbe,
};
pub use stability::OffsetQuery;
pub use table::{
    BuildQuery, SearchAnswer, SearchQuery, SlabQuery, SplitAnswer, SplitQuery, Table, TableProbe,
};
pub use traced::{RayKind, RayVisits, TestedBox, TracedRay};
pub use triangles::{InsideQuery, InterpolateQuery, TriangleQuery};
