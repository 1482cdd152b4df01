//! The student's functions as code that can be called: the static trait, whether each function is written, and the adapters to
//! the traits of the [door](super::door). All are generated from the list (`list.rs`).

use super::example::Example;
use super::queries::{answer, answer_type, query_type};
use super::types::*;
use crate::bvh::PrimitiveHit;
use crate::partition::limit::limited;
use crate::progress::Watch;
use std::sync::Arc;

/// A guard around a call of a student function; if the call unwinds, [`KitError::NotWritten`] gets the name of the function.
///
/// The guard costs nothing where nothing panics: it is forgotten before it is dropped.
#[doc(hidden)]
pub struct CallGuard(pub Function);

impl CallGuard {
    /// Ends the guard after the function has returned.
    #[inline(always)]
    pub fn finished(self) {
        std::mem::forget(self);
    }
}

impl Drop for CallGuard {
    #[cold]
    fn drop(&mut self) {
        kit_error::note_function(self.0);
    }
}

macro_rules! functions {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($arguments:tt)*)
            -> $Return:ty = $file:ident::$function:ident; $how:tt)*
    })*) => {
        /// All student functions for direct calls: the renderer and the adapters of [`Linked`](super::Linked)
        /// are generic over it.
        ///
        /// [`student_kit!`](crate::student_kit) implements it for the functions of a crate.
        pub trait StudentFunctions: Sync + 'static {
            $($($(#[$doc])* #[allow(clippy::too_many_arguments, missing_docs)]
            fn $name $(<$($generics)*>)? ($($arguments)*) -> $Return;)*)*
        }

        /// Whether `function` is written: calls it with the simplest input of its kind, and returns `false`
        /// if it reaches a `todo!`. Any other panic counts as written. A `todo!` that only other inputs reach
        /// is found when a frame reaches it.
        pub fn is_written<F: StudentFunctions>(function: Function) -> bool {
            let call: fn() = match function {
                $($(Function::$name => || {
                    let query = &<query_type!($how ($($arguments)*)) as Example>::example();
                    let _ = answer!(query $name $how ($($arguments)*));
                },)*)*
            };
            !matches!(kit_error::catch(call), Err(KitError::NotWritten { .. }))
        }
    };
}

crate::student_functions! { functions }

#[doc(hidden)]
#[macro_export]
#[allow(clippy::crate_in_macro_def, reason = "the stage files are in the crate that uses the macro")]
macro_rules! implement_student_functions {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($argument:ident: $Type:ty),* $(,)?)
            -> $Return:ty = $file:ident::$function:ident; $how:tt)*
    })*) => {
        impl $crate::kit::StudentFunctions for crate::Kit {
            $($(
            #[inline(always)]
            fn $name $(<$($generics)*>)? ($($argument: $Type),*) -> $Return {
                let running = $crate::kit::CallGuard($crate::kit::Function::$name);
                let answer = crate::$file::$function($($argument),*);
                running.finished();
                answer
            }
            )*)*
        }
    };
}

/// Defines `pub struct Kit`, a kit of the functions of the crate that calls the macro. Tests, workers and
/// frames use it.
///
/// The crate declares one module per file that the list names. With its feature `frames` the kit renders
/// frames. Without it the kit answers checks only, and compiles in a fraction of the time.
#[macro_export]
macro_rules! student_kit {
    () => {
        #[cfg(feature = "frames")]
        $crate::student_kit!(Some(&$crate::tracer::Renderer::<Kit>::NEW));
        #[cfg(not(feature = "frames"))]
        $crate::student_kit!(None);
    };
    ($renderer:expr) => {
        /// The functions of this crate as a kit.
        #[derive(Clone, Copy, Debug, Default)]
        pub struct Kit;

        #[doc(hidden)]
        mod student_functions {
            #[allow(unused_imports)]
            use $crate::kit::types::*;
            $crate::student_functions! { $crate::implement_student_functions }
        }

        /// Functions of this crate whose calls are counted. Checks judge by the count what a split costs.
        pub mod counted {
            use $crate::kit::types::Aabb;

            /// The `union` of this crate.
            #[inline]
            pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
                $crate::kit::count_union();
                super::stage3_boxes::union(first, second)
            }
        }

        impl $crate::kit::StudentKit for Kit {
            fn renderer() -> Option<&'static dyn $crate::kit::Frames> {
                $renderer
            }
        }
    };
}

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
fn search(
    query: &SearchQuery,
    find: impl FnOnce(&mut TableProbe<'_>) -> Option<PrimitiveHit>,
) -> SearchAnswer {
    let mut probe = TableProbe::new(query);
    let hit = find(&mut probe);
    probe.answer(hit)
}

/// Runs a search of cells on the table of a query; returns its hit and the lists of its calls.
fn look<S>(
    query: &CellsQuery<S>,
    find: impl FnOnce(&mut CellsProbe<'_>) -> Option<PrimitiveHit>,
) -> CellsAnswer {
    let mut probe = CellsProbe::new(&query.hits);
    let hit = find(&mut probe);
    probe.finish(hit)
}

thread_local! {
    /// The number of calls of `counted::union` on this thread.
    static UNIONS: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// Counts a call of `union`.
#[doc(hidden)]
#[inline]
pub fn count_union() {
    UNIONS.set(UNIONS.get() + 1);
}

/// Divides a copy of `primitives` by `split`; returns their new order and the index at which the right side
/// begins.
fn divide(
    primitives: &[PrimitiveRef],
    split: impl FnOnce(&mut [PrimitiveRef]) -> Option<usize>,
) -> SplitAnswer {
    let mut primitives = primitives.to_vec();
    let before = UNIONS.get();
    let middle = split(&mut primitives);
    let order = primitives.iter().map(|primitive| primitive.id).collect();
    SplitAnswer { order, middle, unions: UNIONS.get() - before }
}

macro_rules! linked {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($arguments:tt)*)
            -> $Return:ty = $file:ident::$function:ident; $how:tt)*
    })*) => {
        $(impl<F: StudentFunctions> $Trait for Linked<F> {
            $(fn $name(&self, queries: &[query_type!($how ($($arguments)*))]) -> Vec<answer_type!($how $Return)> {
                each(queries, |query| answer!(query $name $how ($($arguments)*)))
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
