//! Counts what the searches for the rays of a pixel visit.

use crate::aabb::Aabb;
use crate::count::{Counts, Event, Tally};
use crate::kit::{RayVisits, TestedBox};

/// Keeps the work of each search apart. Each ray of a pixel is searched once and recorded before the next search, so the searches
/// have the order of the recorded rays. Frames are counted by [`Counts`] alone, which does not ask at each box whether it is kept.
#[derive(Default)]
pub struct Counter {
    counts: Counts,
    rays: Vec<RayVisits>,
    /// The counts at the beginning of the last search.
    before: Counts,
    is_within_mesh: bool,
}

impl Counter {
    /// Ends the last search: what was counted since it began is its work.
    fn end_search(&mut self) {
        let (counts, before) = (self.counts, self.before);
        if let Some(ray) = self.rays.last_mut() {
            ray.node_visits = counts.node_visits - before.node_visits;
            ray.box_tests = counts.box_tests - before.box_tests;
            ray.primitive_tests = counts.primitive_tests - before.primitive_tests;
        }
        self.before = counts;
    }

    /// The work of each search.
    pub fn into_visits(mut self) -> Vec<RayVisits> {
        self.end_search();
        self.rays
    }
}

impl Tally for Counter {
    const COUNTS: bool = true;

    #[inline]
    fn note(&mut self, event: Event) {
        self.counts.note(event);
    }

    fn search(&mut self) {
        self.end_search();
        self.rays.push(RayVisits::default());
    }

    #[inline(always)]
    fn keeps_boxes(&self) -> bool {
        !self.is_within_mesh
    }

    fn tested(&mut self, bounds: &Aabb, hit: bool) {
        if let Some(ray) = self.rays.last_mut() {
            ray.boxes.push(TestedBox { bounds: *bounds, hit });
        }
    }

    fn within_mesh(&mut self, within: bool) {
        self.is_within_mesh = within;
    }

    fn counts(&self) -> Counts {
        self.counts
    }
}
