//! Counts of work: rays by kind, and what the search for the closest hit costs.
//!
//! Code that is counted is generic over [`Tally`]. With [`Counts`] every event is one addition to a local
//! number; with [`Uncounted`] the calls compile to nothing.

use crate::aabb::Aabb;
use crate::message;
use serde::{Deserialize, Serialize};
use std::cell::Cell;
use std::ops::AddAssign;

/// Makes the events, and the counts of all of them, from one list.
macro_rules! counts {
    ($($(#[$doc:meta])* $event:ident $count:ident,)*) => {
        /// A kind of work that is counted.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Event {
            $($(#[$doc])* $event,)*
        }

        /// How often each [`Event`] happened. The sum of two counts is the sum of each field.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
        pub struct Counts {
            $($(#[$doc])* pub $count: u64,)*
        }

        message! { Counts { $($count),* } }

        impl AddAssign for Counts {
            fn add_assign(&mut self, other: Counts) {
                $(self.$count += other.$count;)*
            }
        }

        impl Counts {
            #[inline]
            fn of(&mut self, event: Event) -> &mut u64 {
                match event {
                    $(Event::$event => &mut self.$count,)*
                }
            }
        }
    };
}

counts! {
    /// A ray from the camera was traced.
    Primary primary,
    /// A shadow ray was traced to a light.
    Shadow shadow,
    /// A reflected ray was traced.
    Reflection reflection,
    /// A refracted ray was traced through a surface.
    Transmission transmission,
    /// A ray in a random direction was traced from a diffuse surface (indirect light).
    Indirect indirect,
    /// A path ended at a surface that reflects light, before its last bounce: by Russian roulette.
    Absorbed absorbed,
    /// A ray other than a shadow ray hit a surface.
    Hit hits,
    /// A search looked at the contents of a node or cell.
    NodeVisit node_visits,
    /// A ray was tested against a bounding volume.
    BoxTest box_tests,
    /// A ray was tested against a primitive.
    PrimitiveTest primitive_tests,
    /// A test against a primitive went over to exact arithmetic, see [`exact_test`].
    ExactTest exact_tests,
    /// One random number was looked up.
    RandomNumber random_numbers,
    /// One colour was read from an image.
    TextureRead texture_reads,
    /// With a fixed `ray_offset`: a shadow ray hit something that it misses from the point at the error bound (shadow acne).
    ShadowAcne shadow_acne,
    /// With a fixed `ray_offset`: a shadow ray missed what blocks it from the point at the error bound (light leak).
    LightLeak light_leaks,
}

impl Counts {
    /// The number of rays of all five kinds: primary, shadow, reflected, refracted and indirect.
    pub fn rays(&self) -> u64 {
        self.primary + self.shadow + self.reflection + self.transmission + self.indirect
    }
}

thread_local! {
    static EXACT_TESTS: Cell<u64> = const { Cell::new(0) };
}

/// Counts an exact test. A test of a ray against a primitive calls this where it goes over to exact arithmetic; `render`, `cost` and
/// `explain` show how often frames do.
pub fn exact_test() {
    EXACT_TESTS.set(EXACT_TESTS.get() + 1);
}

/// The number of exact tests on this thread so far.
pub(crate) fn exact_tests() -> u64 {
    EXACT_TESTS.get()
}

/// Counts events, or ignores them at no cost. Each tile of a frame is counted by a tally of its own.
pub trait Tally: Default + Send {
    /// Whether events are counted. Work that is only for counting is left out otherwise.
    const COUNTS: bool;

    /// Counts one event.
    fn note(&mut self, event: Event);

    /// The search for the hit of one ray begins.
    #[inline(always)]
    fn search(&mut self) {}

    /// Whether [`Tally::tested`] is to be called for each tested box from here on.
    #[inline(always)]
    fn keeps_boxes(&self) -> bool {
        false
    }

    /// A ray was tested against the box `bounds` of a node. `hit`: it enters the box.
    fn tested(&mut self, _bounds: &Aabb, _hit: bool) {}

    /// From here on, boxes are those of a shared mesh, in its own space, or those of the scene again.
    #[inline(always)]
    fn within_mesh(&mut self, _within: bool) {}

    /// The counts so far; all zero for a tally that ignores events.
    fn counts(&self) -> Counts;
}

impl Tally for Counts {
    const COUNTS: bool = true;

    #[inline]
    fn note(&mut self, event: Event) {
        *self.of(event) += 1;
    }

    fn counts(&self) -> Counts {
        *self
    }
}

/// The [`Tally`] that ignores every event: its calls compile to nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uncounted;

impl Tally for Uncounted {
    const COUNTS: bool = false;

    #[inline(always)]
    fn note(&mut self, _: Event) {}

    fn counts(&self) -> Counts {
        Counts::default()
    }
}
