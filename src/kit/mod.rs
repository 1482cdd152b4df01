//! The door: the complete list of what students write, each with plain data in and plain data out.
//!
//! Tests, renderer and grader talk to a `&dyn Kit` and never know whose code answers, nor whether it is linked into
//! the same process or sits in a worker at the other end of a pipe. Every call takes a batch, so that a check with
//! thousands of cases crosses the pipe once.

mod adapters;
mod distribution;
pub mod door;
mod economy;
mod example;
mod functions;
mod list;
pub mod mishap;
mod partitions;
mod recursion;
mod scene_graph;
mod shading;
mod shapes;
mod stability;
mod table;
mod traced;
mod triangles;
#[doc(hidden)]
pub mod types;

pub use adapters::{Linked, StudentKit};
pub use distribution::{
    BallQuery, FILTER_RADIUS, GlossQuery, LensQuery, RectangleQuery, TimeQuery, WeightedColor,
};
pub use door::{
    Answer, Distribution, Door, Economy, Frames, Hierarchies, Kit, Partitions, Recursion, Request,
    SceneGraph, Shading, Shapes, Stability, Transport, Triangles,
};
pub use economy::{
    BoundQuery, HitsQuery, LightQuery, MaterialHits, MaterialQuery, RayCounts, TexelQuery, TextureQuery,
};
#[doc(hidden)]
pub use functions::Running;
pub(crate) use functions::note_unwound;
pub use functions::{Function, StudentFunctions, is_written, take_unwound};
pub use mishap::Mishap;
pub use partitions::{
    BspQuery, CachedQuery, CellsAnswer, CellsProbe, CellsQuery, GridQuery, KdQuery, OctreeQuery,
    PacketAnswer, PacketProbe, PacketQuery, ResolutionQuery,
};
pub use recursion::{Bounce, Child, ChildrenQuery, FresnelQuery, Limits, RefractQuery};
pub use scene_graph::{
    BallEntryQuery, BoundsQuery, GraphAnswer, GraphQuery, NormalQuery, ObjectRayQuery, PatchQuery, SolidHit,
    SolidQuery,
};
pub use shading::{LightSample, ShadeAnswer, ShadeQuery, ShadowQuery, Surface, TermQuery};
pub use shapes::{PlaneQuery, RootQuery, SphereQuery};
pub use stability::OffsetQuery;
pub use table::{
    BuildQuery, SearchAnswer, SearchQuery, SlabQuery, SplitAnswer, SplitQuery, Table, TableProbe,
};
pub use traced::{RayKind, TracedRay};
pub use triangles::{GramScalars, InsideQuery, InterpolateQuery, TriangleHit, TriangleQuery};

use crate::count::Counts;
use crate::film::Film;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// What a picture shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum View {
    /// Light.
    #[default]
    Shaded,
    /// The normals of the surfaces, as colours.
    Normals,
    /// What a pixel cost: node visits, box tests and primitive tests of all its rays, a sample, in place of red, green and
    /// blue.
    Work,
}

/// A whole frame to render where the student's code lives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderJob {
    /// What to render; its own film size and quality apply.
    pub scene: Scene,
    /// What to show of it.
    pub view: View,
    /// Picks the random numbers.
    pub seed: u64,
    /// 0 takes one thread a core.
    pub threads: usize,
    /// Whether work is counted. Rays and pixels are the same either way.
    pub count: bool,
}

impl RenderJob {
    /// Whether a picture has the size that was asked for.
    fn fits(&self, film: &Film) -> bool {
        let asked = &self.scene.film;
        let pixels = u64::from(asked.width) * u64::from(asked.height);
        (film.width, film.height) == (asked.width, asked.height) && film.pixels.len() as u64 == pixels
    }
}

/// How large a structure is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StructureSize {
    /// Nodes or cells.
    pub nodes: u64,
    /// Nodes on the longest way down, the root counted.
    pub levels: u64,
    /// How often primitives are listed, all together.
    pub references: u64,
    /// Memory of nodes and lists.
    pub bytes: u64,
}

/// A rendered frame and what it took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rendering {
    /// The picture in linear light.
    pub film: Film,
    /// Work by kind; zero when the job did not ask for it.
    pub counts: Counts,
    /// Primitives that the frame was made of.
    pub primitives: u64,
    /// How large the structure over the scene is, if one was built; parts that stand in several places have their own.
    pub structure: Option<StructureSize>,
    /// Bytes of the structures of all parts together.
    pub bytes_of_parts: u64,
    /// Seconds to build the structure.
    pub build_seconds: f64,
    /// Seconds to render the pixels.
    pub render_seconds: f64,
    /// What the picture lacks and why, one sentence each.
    pub notes: Vec<String>,
}
