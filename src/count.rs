//! Counting work: rays by kind, and what the search for the closest hit costs.
//!
//! Code that works is generic over [`Tally`]. With [`Counts`] every event is one addition to a local number; with
//! [`Uncounted`] the calls compile to nothing.

use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Something worth counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A ray from the camera.
    Primary,
    /// A ray towards a light.
    Shadow,
    /// A ray off a mirror.
    Reflection,
    /// A ray through a surface.
    Transmission,
    /// A surface that one of those rays met, shadow rays apart.
    Hit,
    /// A node of a hierarchy whose contents were looked at.
    NodeVisit,
    /// A ray tested against a box.
    BoxTest,
    /// A ray tested against a primitive.
    PrimitiveTest,
    /// A random number looked up.
    RandomNumber,
    /// A colour read from an image.
    TextureRead,
}

/// How often each [`Event`] happened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Rays from the camera.
    pub primary: u64,
    /// Rays towards lights.
    pub shadow: u64,
    /// Rays off mirrors.
    pub reflection: u64,
    /// Rays through surfaces.
    pub transmission: u64,
    /// Surfaces that rays met, shadow rays apart.
    pub hits: u64,
    /// Nodes looked at.
    pub node_visits: u64,
    /// Box tests.
    pub box_tests: u64,
    /// Primitive tests.
    pub primitive_tests: u64,
    /// Random numbers.
    pub random_numbers: u64,
    /// Colours read from images.
    pub texture_reads: u64,
}

impl Counts {
    /// Rays of all kinds.
    pub fn rays(&self) -> u64 {
        self.primary + self.shadow + self.reflection + self.transmission
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Counts) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.reflection += other.reflection;
        self.transmission += other.transmission;
        self.hits += other.hits;
        self.node_visits += other.node_visits;
        self.box_tests += other.box_tests;
        self.primitive_tests += other.primitive_tests;
        self.random_numbers += other.random_numbers;
        self.texture_reads += other.texture_reads;
    }
}

/// Takes note of events, or does not.
pub trait Tally: Default + Send {
    /// Notes one event.
    fn note(&mut self, event: Event);

    /// What was noted.
    fn counts(&self) -> Counts;
}

impl Tally for Counts {
    #[inline]
    fn note(&mut self, event: Event) {
        *match event {
            Event::Primary => &mut self.primary,
            Event::Shadow => &mut self.shadow,
            Event::Reflection => &mut self.reflection,
            Event::Transmission => &mut self.transmission,
            Event::Hit => &mut self.hits,
            Event::NodeVisit => &mut self.node_visits,
            Event::BoxTest => &mut self.box_tests,
            Event::PrimitiveTest => &mut self.primitive_tests,
            Event::RandomNumber => &mut self.random_numbers,
            Event::TextureRead => &mut self.texture_reads,
        } += 1;
    }

    fn counts(&self) -> Counts {
        *self
    }
}

/// Counts nothing and costs nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uncounted;

impl Tally for Uncounted {
    #[inline(always)]
    fn note(&mut self, _: Event) {}

    fn counts(&self) -> Counts {
        Counts::default()
    }
}
