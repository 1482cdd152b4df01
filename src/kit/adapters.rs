//! Adapters from the static trait to the traits of the [door](super::door): a kit whose functions are linked
//! into this program.

use super::functions::StudentFunctions;
use super::types::*;
use super::*;
use crate::bvh::PrimitiveHit;
use crate::frame::Watch;
use crate::partition::limit::limited;
use std::sync::Arc;

/// The functions of a crate as a [`Kit`], called directly in this process.
#[derive(Clone, Copy, Debug, Default)]
pub struct Linked<F>(pub F);

/// What the crate of a student provides: its functions as a [`Kit`], and the renderer that uses them.
pub trait StudentKit: StudentFunctions + Copy + Send {
    /// The functions as a [`Kit`] that can be shared by threads.
    ///
    /// It is compiled where it is called, in the worker and in the test of a stage, and not again with every
    /// edit of the functions.
    fn door(self) -> Arc<dyn Kit + Send + Sync> {
        Arc::new(Linked(self))
    }

    /// The renderer that uses the functions; `None` if the crate was built without the feature `frames`.
    fn renderer() -> Option<&'static dyn Frames>;
}

/// The answer to each query, in order. It is a plain loop: mapped and collected iterators would be compiled
/// for each of a hundred functions, and again for every submission that is graded.
fn each<Q, A>(queries: &[Q], mut answer: impl FnMut(&Q) -> A) -> Vec<A> {
    let mut answers = Vec::with_capacity(queries.len());
    for query in queries {
        answers.push(answer(query));
    }
    answers
}

/// Runs a search on the table of a query; returns its hit and the counts of its calls.
pub(super) fn search(
    query: &SearchQuery,
    find: impl FnOnce(&mut TableProbe<'_>) -> Option<PrimitiveHit>,
) -> SearchAnswer {
    let mut probe = TableProbe::new(query);
    let hit = find(&mut probe);
    probe.answer(hit)
}

/// Runs a search of cells on the table of a query; returns its hit and the lists of its calls.
pub(super) fn look<S>(
    query: &CellsQuery<S>,
    find: impl FnOnce(&mut CellsProbe<'_>) -> Option<PrimitiveHit>,
) -> CellsAnswer {
    let mut probe = CellsProbe::new(&query.hits);
    let hit = find(&mut probe);
    probe.finish(hit)
}

/// Divides a copy of `primitives` by `split`; returns their new order and the index at which the right side
/// begins.
pub(super) fn divide(
    primitives: &[PrimitiveRef],
    split: impl FnOnce(&mut [PrimitiveRef]) -> Option<usize>,
) -> SplitAnswer {
    let mut primitives = primitives.to_vec();
    let middle = split(&mut primitives);
    SplitAnswer { order: primitives.iter().map(|primitive| primitive.id).collect(), middle }
}

macro_rules! linked {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($argument:ident: $Type:ty),* $(,)?)
            -> $Return:ty = $file:ident::$function:ident; |$query:tt: $Query:ty| -> $Answer:ty $adapter:block)*
    })*) => {
        $(impl<F: StudentFunctions> $Trait for Linked<F> {
            $(fn $name(&self, queries: &[$Query]) -> Vec<$Answer> {
                each(queries, |query| {
                    let $query = query;
                    $adapter
                })
            })*
        })*
    };
}

crate::student_functions! { linked }

impl<F: StudentKit> Hosted for Linked<F> {}

impl<F: StudentKit> Frames for Linked<F> {
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
        frames::<F>().render(job, watch)
    }

    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
        frames::<F>().trace(job, x, y)
    }

    fn visits(&self, job: &RenderJob, x: u32, y: u32) -> Vec<(TracedRay, RayVisits)> {
        frames::<F>().visits(job, x, y)
    }

    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]> {
        frames::<F>().outlines(job, depth)
    }

    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
        frames::<F>().first_hits(job, rays)
    }
}

fn frames<F: StudentKit>() -> &'static dyn Frames {
    F::renderer().unwrap_or_else(|| {
        kit_error::unwind(KitError::Malformed {
            what: "a frame was asked of a kit that was built without frames".into(),
        })
    })
}
