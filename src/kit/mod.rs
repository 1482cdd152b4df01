//! The complete list of the functions that students write, each with plain data as input and output.
//!
//! Tests, renderer and grader call a `&dyn Kit`. It makes no difference to them whose code answers, or
//! whether that code is linked into the same process or runs in a worker at the other end of a pipe. Every
//! call takes a batch of queries, so that a check with thousands of cases needs one message to the worker.

mod costs;
pub mod door;
mod effects_analysis;
mod example;
mod function_names;
mod functions;
mod job;
pub mod kit_error;
mod list;
mod partitions;
mod queries;
pub mod questions;
mod scene_graph;
mod shading;
mod shapes;
mod speed;
mod table;
mod traced;
#[doc(hidden)]
pub mod types;
pub mod worker;

pub use crate::film::{FILTER_RADIUS, WeightedColor};
pub use crate::geometry::hit::{GramScalars, SolidHit, TriangleHit};
pub use crate::light::surface::{Bounce, LightSample, Limits, SecondaryRay, Surface};
pub use costs::Costs;
pub use door::{
    Answer, Distribution, Door, EffectsAnalysis, Frames, Hierarchies, Hosted, Kit, LightTransport,
    Partitions, Recursion, Request, SceneGraph, Shading, Shapes, Speed, Stability, Transport, Triangles,
    least_seconds,
};
pub use effects_analysis::{MaterialHits, RayCounts};
pub use function_names::Function;
#[doc(hidden)]
pub use functions::{CallGuard, count_union};
pub use functions::{Linked, StudentFunctions, StudentKit, is_written};
pub use job::{RenderJob, Rendering, StructureSize, View};
pub use kit_error::KitError;
pub use partitions::{
    CachedQuery, CellsAnswer, CellsProbe, CellsQuery, PacketAnswer, PacketProbe, PacketQuery,
};
pub use queries::*;
pub use scene_graph::{CachedGraphAnswer, CachedGraphQuery, GraphAnswer, GraphQuery, SolidQuery};
pub use shading::{ShadeAnswer, ShadeQuery, ShadowProbe};
pub use shapes::{PlaneEquationQuery, PlaneQuery, SphereQuery};
pub use speed::{
    BinSplitQuery, BlockQuery, PartitionQuery, WideAnswer, WideBoxesQuery, WideQuery, WideTableProbe,
};
pub use table::{SearchAnswer, SearchQuery, SlabQuery, SplitAnswer, SplitQuery, Table, TableProbe};
pub use traced::{RayKind, RayVisits, TestedBox, TracedRay};
