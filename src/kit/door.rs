//! The traits of the door, and the same calls as messages, both generated from the list of student functions
//! (`list.rs`).

use super::*;
use crate::aabb::Aabb;
use crate::bvh::{Bvh, PrimitiveHit, PrimitiveRef};
use crate::effects::{Effects, LightEffects, MaterialEffects};
use crate::frame::Watch;
use crate::graph::Placement;
use crate::mesh::Mesh;
use crate::partition::{Bsp, Grid, KdTree, Octree};
use crate::random::Stratum;
use crate::ray::Ray;
use crate::scene::{Sampler, Scene, Split};
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Polygon, Sphere, Triangle};
use glam::{Affine3A, UVec3, Vec2, Vec3};

/// Carries a request to where the student's code lives and brings the answer back.
///
/// A call that cannot be answered (student code that panics, loops or crashes) unwinds with a [`Mishap`], as a panic
/// of linked student code does; [`mishap::catch`] catches both.
pub trait Transport: Sync {
    /// Asks.
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer;
}

/// A kit at the other end of a transport.
pub struct Door<T>(pub T);

/// Everything that students write.
pub trait Kit:
    Shapes
    + Triangles
    + Hierarchies
    + Shading
    + Recursion
    + Distribution
    + Economy
    + SceneGraph
    + Partitions
    + Stability
    + Frames
    + Sync
{
}
impl<T> Kit for T where
    T: Shapes
        + Triangles
        + Hierarchies
        + Shading
        + Recursion
        + Distribution
        + Economy
        + SceneGraph
        + Partitions
        + Stability
        + Frames
        + Sync
{
}

/// Whole frames, rendered where the student's code lives, so that no ray crosses a process boundary.
pub trait Frames {
    /// Renders `job`. `None` if `watch` cancelled it.
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering>;

    /// The rays behind the first sample of the pixel in column `x` and row `y` of `job`, the very ones that a frame
    /// traces, parents before children.
    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay>;

    /// The edges of the boxes or cells of the structure over the scene at this depth, the root being at depth 0, and of
    /// the leaves above it.
    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]>;

    /// What each ray meets first in [`World::plain`](crate::world::World::plain) of the scene of `job`, found as its
    /// quality says. Primitives have their numbers there; planes are counted after them.
    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>>;
}

macro_rules! door {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($argument:ident: $Type:ty),* $(,)?)
            -> $Return:ty = $file:ident::$function:ident; |$query:tt: $Query:ty| -> $Answer:ty $adapter:block)*
    })*) => {
        $($(#[$trait_doc])* pub trait $Trait {
            $($(#[$doc])* fn $name(&self, queries: &[$Query]) -> Vec<$Answer>;)*
        })*

        /// A call as a message.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Request {
            $($($(#[$doc])* $Message(Vec<$Query>),)*)*
            /// A whole frame.
            Render(Box<RenderJob>),
            /// The rays behind a pixel, by column and row.
            Trace(Box<RenderJob>, u32, u32),
            /// Edges of the structure at a depth.
            Outlines(Box<RenderJob>, u32),
            /// What rays meet first in a scene.
            FirstHits(Box<RenderJob>, Vec<Ray>),
        }

        /// An answer as a message.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Answer {
            $($($(#[$doc])* $Message(Vec<$Answer>),)*)*
            /// A whole frame; `None` when it was cancelled.
            Render(Option<Box<Rendering>>),
            /// The rays behind a pixel.
            Trace(Vec<TracedRay>),
            /// Edges of the structure at a depth.
            Outlines(Vec<[Vec3; 2]>),
            /// What rays meet first in a scene.
            FirstHits(Vec<Option<PrimitiveHit>>),
        }

        impl Request {
            /// Has `kit` answer.
            pub fn answer(&self, kit: &dyn Kit, watch: &dyn Watch) -> Answer {
                match self {
                    $($(Request::$Message(queries) => Answer::$Message(kit.$name(queries)),)*)*
                    Request::Render(job) => Answer::Render(kit.render(job, watch).map(Box::new)),
                    Request::Trace(job, x, y) => Answer::Trace(kit.trace(job, *x, *y)),
                    Request::Outlines(job, depth) => Answer::Outlines(kit.outlines(job, *depth)),
                    Request::FirstHits(job, rays) => Answer::FirstHits(kit.first_hits(job, rays)),
                }
            }
        }

        $(impl<T: Transport> $Trait for Door<T> {
            $(fn $name(&self, queries: &[$Query]) -> Vec<$Answer> {
                match self.0.call(Request::$Message(queries.to_vec()), &crate::frame::Unwatched) {
                    Answer::$Message(answers) if answers.len() == queries.len() => answers,
                    answer => mishap::wrong_answer(&answer),
                }
            })*
        })*
    };
}

crate::student_functions! { door }

impl dyn Kit + '_ {
    /// Divides the primitives of each query by its rule: one of the three functions that split.
    pub fn split(&self, queries: &[SplitQuery]) -> Vec<SplitAnswer> {
        let divide = |query: &SplitQuery| {
            let primitives = [query.primitives.clone()];
            match query.split {
                Split::ObjectMedian => self.split_object_median(&primitives),
                Split::SpatialMedian => self.split_spatial_median(&primitives),
                Split::SurfaceArea => self.split_surface_area(&primitives),
            }
        };
        queries.iter().flat_map(divide).collect()
    }
}

impl<T: Transport> Frames for Door<T> {
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
        match self.0.call(Request::Render(Box::new(job.clone())), watch) {
            // The other side says how large its picture is; what is done with it relies on that.
            Answer::Render(Some(rendering)) if !job.fits(&rendering.film) => {
                mishap::wrong_answer(&rendering.film)
            }
            Answer::Render(rendering) => rendering.map(|rendering| *rendering),
            answer => mishap::wrong_answer(&answer),
        }
    }

    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
        match self.0.call(Request::Trace(Box::new(job.clone()), x, y), &crate::frame::Unwatched) {
            Answer::Trace(rays) => rays,
            answer => mishap::wrong_answer(&answer),
        }
    }

    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]> {
        match self.0.call(Request::Outlines(Box::new(job.clone()), depth), &crate::frame::Unwatched) {
            Answer::Outlines(edges) => edges,
            answer => mishap::wrong_answer(&answer),
        }
    }

    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
        let request = Request::FirstHits(Box::new(job.clone()), rays.to_vec());
        match self.0.call(request, &crate::frame::Unwatched) {
            Answer::FirstHits(hits) if hits.len() == rays.len() => hits,
            answer => mishap::wrong_answer(&answer),
        }
    }
}
