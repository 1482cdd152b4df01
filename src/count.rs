//! Counts of work: rays by kind, and what the search for the closest hit costs.
//!
//! Code that is counted is generic over [`Tally`]. With [`Counts`] every event is one addition to a local
//! number; with [`Uncounted`] the calls compile to nothing.

use crate::aabb::Aabb;
use crate::message;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// A kind of work that is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A ray from the camera was traced.
    Primary,
    /// A shadow ray was traced to a light.
    Shadow,
    /// A reflected ray was traced.
    Reflection,
    /// A refracted ray was traced through a surface.
    Transmission,
    /// A ray in a random direction was traced from a diffuse surface (indirect light).
    Indirect,
    /// A path ended at a surface that reflects light, before its last bounce: by Russian roulette.
    Absorbed,
    /// A ray other than a shadow ray hit a surface.
    Hit,
    /// A search looked at the contents of a node or cell.
    NodeVisit,
    /// A ray was tested against a bounding volume.
    BoxTest,
    /// A ray was tested against a primitive.
    PrimitiveTest,
    /// One random number was looked up.
    RandomNumber,
    /// One colour was read from an image.
    TextureRead,
    /// With a fixed ray offset: a shadow ray hit something that it misses from the point at the error bound.
    ShadowAcne,
    /// With a fixed ray offset: a shadow ray missed what blocks it from the point at the error bound.
    LightLeak,
}

/// How often each [`Event`] happened. The sum of two counts is the sum of each field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// The number of rays from the camera.
    pub primary: u64,
    /// The number of shadow rays.
    pub shadow: u64,
    /// The number of reflected rays.
    pub reflection: u64,
    /// The number of refracted rays.
    pub transmission: u64,
    /// The number of rays in random directions from diffuse surfaces (indirect light).
    pub indirect: u64,
    /// The number of paths that ended at a surface that reflects light, before their last bounce: by Russian roulette.
    pub absorbed: u64,
    /// The number of hits of rays with surfaces, without those of shadow rays.
    pub hits: u64,
    /// The number of nodes or cells whose contents a search looked at.
    pub node_visits: u64,
    /// The number of tests of a ray against a bounding volume.
    pub box_tests: u64,
    /// The number of tests of a ray against a primitive.
    pub primitive_tests: u64,
    /// The number of random numbers that were looked up.
    pub random_numbers: u64,
    /// The number of colours that were read from images.
    pub texture_reads: u64,
    /// With a fixed `ray_offset`: the number of shadow rays that hit something, mostly their own surface, which they miss
    /// when they start at the error bound (shadow acne).
    pub shadow_acne: u64,
    /// With a fixed `ray_offset`: the number of shadow rays that reach the light although something blocks them when they
    /// start at the error bound, because they start beyond it (light leaks).
    pub light_leaks: u64,
}

message! { Counts {
    primary, shadow, reflection, transmission, indirect, absorbed, hits, node_visits, box_tests,
    primitive_tests, random_numbers, texture_reads, shadow_acne, light_leaks
} }

impl Counts {
    /// The number of rays of all five kinds: primary, shadow, reflected, refracted and indirect.
    pub fn rays(&self) -> u64 {
        self.primary + self.shadow + self.reflection + self.transmission + self.indirect
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Counts) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.reflection += other.reflection;
        self.transmission += other.transmission;
        self.indirect += other.indirect;
        self.absorbed += other.absorbed;
        self.hits += other.hits;
        self.node_visits += other.node_visits;
        self.box_tests += other.box_tests;
        self.primitive_tests += other.primitive_tests;
        self.random_numbers += other.random_numbers;
        self.texture_reads += other.texture_reads;
        self.shadow_acne += other.shadow_acne;
        self.light_leaks += other.light_leaks;
    }
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
        *match event {
            Event::Primary => &mut self.primary,
            Event::Shadow => &mut self.shadow,
            Event::Reflection => &mut self.reflection,
            Event::Transmission => &mut self.transmission,
            Event::Indirect => &mut self.indirect,
            Event::Absorbed => &mut self.absorbed,
            Event::Hit => &mut self.hits,
            Event::NodeVisit => &mut self.node_visits,
            Event::BoxTest => &mut self.box_tests,
            Event::PrimitiveTest => &mut self.primitive_tests,
            Event::RandomNumber => &mut self.random_numbers,
            Event::TextureRead => &mut self.texture_reads,
            Event::ShadowAcne => &mut self.shadow_acne,
            Event::LightLeak => &mut self.light_leaks,
        } += 1;
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
