//! The traits that tests, renderer and grader call, and the same calls as messages. Both are generated from
//! the list of student functions (`list.rs`).

use super::queries::{answer_type, query_type};
use super::*;
use crate::aabb::Aabb;
use crate::bvh::{Bvh, PrimitiveHit, PrimitiveRef};
use crate::effects::{Effects, LightEffects, MaterialEffects};
use crate::emitter::EmitterSample;
use crate::graph::Placement;
use crate::light_path::{BsdfSample, PathEffects, PathStep};
use crate::mesh::Mesh;
use crate::message;
use crate::partition::{Bsp, Grid, KdTree, Octree, PolygonBsp};
use crate::progress::Watch;
use crate::random::Stratum;
use crate::ray::Ray;
use crate::scene::{Sampler, Scene, Split};
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Polygon, Sphere, Triangle};
use crate::wide::{BinSplit, Bins, Entered, Filtered, FlatTree, ForkedTree, WideTree};
use glam::{Affine3A, UVec3, Vec2, Vec3};
use std::fmt::Debug;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Carries a request to the process that contains the student's code, and brings back the answer.
///
/// A call without an answer (student code that panics, loops or crashes) unwinds with a [`KitError`], as a
/// panic of linked student code does; [`kit_error::catch`] catches both.
pub trait Transport: Sync {
    /// Sends `request` and waits for its answer. `watch` receives the progress of a frame, and can cancel it.
    ///
    /// # Panics
    ///
    /// Unwinds with a [`KitError`] if there is no answer.
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer;

    /// The same as [`Hosted::waited`], of the process at the other end.
    fn waited(&self) -> Duration {
        Duration::ZERO
    }

    /// Swaps that put the `n` queries of the next request into another order, so that no answer can depend on its place. None by
    /// default.
    fn swaps(&self, _n: usize) -> Vec<(usize, usize)> {
        Vec::new()
    }
}

impl<T: Transport + Send> Transport for Arc<T> {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        (**self).call(request, watch)
    }

    fn waited(&self) -> Duration {
        (**self).waited()
    }
}

/// A [`Kit`] whose functions run at the other end of a transport.
pub struct Door<T>(pub T);

/// Defines [`Kit`] as the sum of these traits.
macro_rules! kit {
    ($First:ident $($Trait:ident)+) => {
        /// All functions that students write, by stage, and the frames that are rendered with them.
        pub trait Kit: $First $(+ $Trait)+ {}
        impl<T: $First $(+ $Trait)+> Kit for T {}
    };
}

kit! {
    Shapes Triangles Hierarchies Shading Recursion Distribution EffectsAnalysis SceneGraph Partitions Stability
    LightTransport Speed Frames Hosted Sync
}

/// What is known of the process that runs the functions.
pub trait Hosted {
    /// The time for which this process has been ready to compute but had no processor, because others used them. It is 0
    /// if the process is the caller's own, and where it is not known. A time limit that leaves it out is the same on a busy
    /// machine.
    fn waited(&self) -> Duration {
        Duration::ZERO
    }

    /// The seconds that the functions take to answer `request`, measured in their process, without messages. `None` if that is
    /// the caller's own process.
    fn seconds_of(&self, _request: Request) -> Option<f64> {
        None
    }
}

/// The seconds that `work` takes, the least of five times: other programs only add to it.
pub fn least_seconds(mut work: impl FnMut()) -> f64 {
    let seconds = |_| {
        let started = Instant::now();
        work();
        started.elapsed().as_secs_f64()
    };
    (0..5).map(seconds).fold(f64::INFINITY, f64::min)
}

/// Whole frames, rendered in the process that contains the student's code, so that no single ray crosses a
/// process boundary.
///
/// # Panics
///
/// Every function unwinds with a [`KitError`] if student code panics, if its process ends, or if the kit was
/// built without frames.
pub trait Frames {
    /// Renders `job`; returns `None` if `watch` cancelled it.
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering>;

    /// The rays of the first sample of the pixel in column `x` (from the left) and row `y` (from the top) of
    /// `job`, exactly those that a frame traces. A parent has a smaller index than its secondary rays.
    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay>;

    /// The rays of [`trace`](Frames::trace), in the same order, each with what the search for its hit visits.
    fn visits(&self, job: &RenderJob, x: u32, y: u32) -> Vec<(TracedRay, RayVisits)>;

    /// The line segments, in world units, that outline the boxes or cells at `depth` (the root has depth 0)
    /// of the structure over the scene, and the leaves above that depth.
    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]>;

    /// The first hit of each ray in [`World::plain`](crate::world::World::plain) of the scene of `job`, found
    /// as the scene's quality says; `None` for a ray that hits nothing. Primitives have their numbers in that
    /// world; infinite planes are numbered after them.
    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>>;
}

/// Each value, to print it.
fn each<T: Debug>(values: &[T]) -> Vec<&dyn Debug> {
    list(values.len(), &|index| &values[index])
}

/// The values by their indices. [`each`] is compiled for each of a hundred types, and this loop once.
fn list<'a>(n: usize, value: &dyn Fn(usize) -> &'a dyn Debug) -> Vec<&'a dyn Debug> {
    (0..n).map(value).collect()
}

macro_rules! door {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($arguments:tt)*)
            -> $Return:ty = $file:ident::$function:ident; $how:tt)*
    })*) => {
        $($(#[$trait_doc])* pub trait $Trait {
            $($(#[$doc])* fn $name(&self, queries: &[query_type!($how ($($arguments)*))]) -> Vec<answer_type!($how $Return)>;)*
        })*

        /// A call of a student function, or for a frame, as a message to a worker.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Request {
            $($($(#[$doc])* $Message(Vec<query_type!($how ($($arguments)*))>),)*)*
            /// Renders a whole frame.
            Render(Box<RenderJob>),
            /// The same, and the worker also sends each tile when it is finished.
            RenderInTiles(Box<RenderJob>),
            /// Asks for the rays of a pixel, by column and row.
            Trace(Box<RenderJob>, u32, u32),
            /// Asks for the rays of a pixel, by column and row, and what the search for each of them visits.
            Visits(Box<RenderJob>, u32, u32),
            /// Asks for the outlines of the structure at a depth.
            Outlines(Box<RenderJob>, u32),
            /// Asks for the first hit of each ray in a scene.
            FirstHits(Box<RenderJob>, Vec<Ray>),
            /// The request in the box, whose tables stay with the judge: its probes ask
            /// [questions](crate::kit::questions).
            Withheld(Box<Request>),
            /// Asks how long the answer to the request in the box takes.
            Timed(Box<Request>),
        }

        /// The answer to a [`Request`] as a message: one answer per query, in the same order.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Answer {
            $($($(#[$doc])* $Message(Vec<answer_type!($how $Return)>),)*)*
            /// A whole frame; `None` if it was cancelled.
            Render(Option<Box<Rendering>>),
            /// The rays of a pixel.
            Trace(Vec<TracedRay>),
            /// The rays of a pixel, and what the search for each of them visits.
            Visits(Vec<(TracedRay, RayVisits)>),
            /// The two ends of each line segment that outlines the structure at a depth.
            Outlines(Vec<[Vec3; 2]>),
            /// The first hit of each ray in a scene.
            FirstHits(Vec<Option<PrimitiveHit>>),
            /// Seconds for all queries of a request.
            Timed(f64),
        }

        message! { enum Request {
            $($($Message(queries),)*)*
            Render(job), RenderInTiles(job), Trace(job, x, y), Visits(job, x, y), Outlines(job, depth),
            FirstHits(job, rays), Withheld(request), Timed(request)
        } }

        message! { enum Answer {
            $($($Message(answers),)*)*
            Render(rendering), Trace(rays), Visits(rays), Outlines(edges), FirstHits(hits), Timed(seconds)
        } }

        impl Request {
            /// The frame that is to be rendered, if any.
            pub fn frame(&self) -> Option<&RenderJob> {
                match self {
                    Request::Render(job) | Request::RenderInTiles(job) => Some(job),
                    _ => None,
                }
            }

            /// The name of the function that this request calls, and its queries; `None` for frames and their rays.
            pub fn queries(&self) -> Option<(&'static str, Vec<&dyn Debug>)> {
                match self {
                    $($(Request::$Message(queries) => Some((stringify!($function), each(queries))),)*)*
                    Request::Withheld(request) => request.queries(),
                    _ => None,
                }
            }

            /// The call of a [`Kit`] as Rust, to paste into a test; `None` for frames and their rays.
            pub fn call(&self) -> Option<String> {
                let (name, queries): (_, &dyn message::Message) = match self {
                    $($(Request::$Message(queries) => (stringify!($name), queries),)*)*
                    Request::Withheld(request) => return request.call(),
                    _ => return None,
                };
                Some(format!("{name}(&{})", queries.rust()))
            }

            /// The request with one of its queries only; `None` for frames and their rays, and if there is no such query.
            pub fn only(&self, index: usize) -> Option<Request> {
                match self {
                    $($(Request::$Message(queries) => Some(Request::$Message(vec![queries.get(index)?.clone()])),)*)*
                    _ => None,
                }
            }

            /// Calls the function of `kit` that this request names. `watch` receives the progress of a frame.
            ///
            /// # Panics
            ///
            /// If the function panics.
            pub fn answer(&self, kit: &dyn Kit, watch: &dyn Watch) -> Answer {
                match self {
                    $($(Request::$Message(queries) => Answer::$Message(kit.$name(queries)),)*)*
                    Request::Render(job) | Request::RenderInTiles(job) => {
                        Answer::Render(kit.render(job, watch).map(Box::new))
                    }
                    Request::Trace(job, x, y) => Answer::Trace(kit.trace(job, *x, *y)),
                    Request::Visits(job, x, y) => Answer::Visits(kit.visits(job, *x, *y)),
                    Request::Outlines(job, depth) => Answer::Outlines(kit.outlines(job, *depth)),
                    Request::FirstHits(job, rays) => Answer::FirstHits(kit.first_hits(job, rays)),
                    Request::Withheld(request) => request.answer(kit, watch),
                    Request::Timed(request) => Answer::Timed(least_seconds(|| {
                        black_box(request.answer(kit, watch));
                    })),
                }
            }
        }

        impl Answer {
            /// The answer to each query; empty for frames and their rays.
            pub fn values(&self) -> Vec<&dyn Debug> {
                match self {
                    $($(Answer::$Message(answers) => each(answers),)*)*
                    _ => Vec::new(),
                }
            }
        }

        $(impl<T: Transport> $Trait for Door<T> {
            $(fn $name(&self, queries: &[query_type!($how ($($arguments)*))]) -> Vec<answer_type!($how $Return)> {
                let (mut queries, swaps) = (queries.to_vec(), self.0.swaps(queries.len()));
                swaps.iter().for_each(|&(i, j)| queries.swap(i, j));
                let n = queries.len();
                match self.0.call(Request::$Message(queries), &crate::progress::Unwatched) {
                    Answer::$Message(mut answers) if answers.len() == n => {
                        swaps.iter().rev().for_each(|&(i, j)| answers.swap(i, j));
                        answers
                    }
                    answer => kit_error::wrong_answer(&answer),
                }
            })*
        })*
    };
}

crate::student_functions! { door }

impl dyn Kit + '_ {
    /// Divides the primitives of each query by the query's rule, with one of the three splitting functions.
    ///
    /// # Panics
    ///
    /// If that function panics.
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

impl<T: Transport> Hosted for Door<T> {
    fn waited(&self) -> Duration {
        self.0.waited()
    }

    fn seconds_of(&self, request: Request) -> Option<f64> {
        match self.0.call(Request::Timed(Box::new(request)), &crate::progress::Unwatched) {
            Answer::Timed(seconds) => Some(seconds),
            answer => kit_error::wrong_answer(&answer),
        }
    }
}

impl<T: Transport> Frames for Door<T> {
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
        let request = if watch.wants_tiles() { Request::RenderInTiles } else { Request::Render };
        match self.0.call(request(Box::new(job.clone())), watch) {
            // Check the size of the picture, because it comes from another process.
            Answer::Render(Some(rendering)) if !job.fits(&rendering.film) => {
                kit_error::wrong_answer(&rendering.film)
            }
            Answer::Render(rendering) => rendering.map(|rendering| *rendering),
            answer => kit_error::wrong_answer(&answer),
        }
    }

    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
        match self.0.call(Request::Trace(Box::new(job.clone()), x, y), &crate::progress::Unwatched) {
            Answer::Trace(rays) => rays,
            answer => kit_error::wrong_answer(&answer),
        }
    }

    fn visits(&self, job: &RenderJob, x: u32, y: u32) -> Vec<(TracedRay, RayVisits)> {
        match self.0.call(Request::Visits(Box::new(job.clone()), x, y), &crate::progress::Unwatched) {
            Answer::Visits(visits) => visits,
            answer => kit_error::wrong_answer(&answer),
        }
    }

    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]> {
        match self.0.call(Request::Outlines(Box::new(job.clone()), depth), &crate::progress::Unwatched) {
            Answer::Outlines(edges) => edges,
            answer => kit_error::wrong_answer(&answer),
        }
    }

    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
        let request = Request::FirstHits(Box::new(job.clone()), rays.to_vec());
        match self.0.call(request, &crate::progress::Unwatched) {
            Answer::FirstHits(hits) if hits.len() == rays.len() => hits,
            answer => kit_error::wrong_answer(&answer),
        }
    }
}
