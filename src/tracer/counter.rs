//! Counts the work of frames, and what the searches for the rays of a pixel visit.

use crate::aabb::Aabb;
use crate::count::{Counts, Event, Tally};
use crate::kit::{RayVisits, TestedBox};

/// Counts the work of a frame. Made by [`Counter::of_each_search`], it also keeps the work of each search apart. One type does both,
/// so that the searches are compiled once for both.
#[derive(Default)]
pub struct Counter {
    counts: Counts,
    searches: Option<Box<Searches>>,
}

/// The searches so far. Each ray of a pixel is searched once and recorded before the next search, so the searches have the order
/// of the recorded rays.
#[derive(Default)]
struct Searches {
    rays: Vec<RayVisits>,
    /// The counts at the beginning of the last search.
    before: Counts,
    is_within_mesh: bool,
}

impl Searches {
    /// Ends the last search: what was counted since it began is its work.
    fn end_search(&mut self, counts: &Counts) {
        if let Some(ray) = self.rays.last_mut() {
            ray.node_visits = counts.node_visits - self.before.node_visits;
            ray.box_tests = counts.box_tests - self.before.box_tests;
            ray.primitive_tests = counts.primitive_tests - self.before.primitive_tests;
        }
        self.before = *counts;
    }
}

impl Counter {
    /// A counter that keeps the work of each search apart.
    pub fn of_each_search() -> Counter {
        Counter { searches: Some(Box::default()), ..Counter::default() }
    }

    /// The work of each search.
    pub fn into_visits(self) -> Vec<RayVisits> {
        let Some(mut searches) = self.searches else { return Vec::new() };
        searches.end_search(&self.counts);
        searches.rays
    }
}

impl Tally for Counter {
    const COUNTS: bool = true;

    #[inline]
    fn note(&mut self, event: Event) {
        self.counts.note(event);
    }

    fn search(&mut self) {
        if let Some(searches) = &mut self.searches {
            searches.end_search(&self.counts);
            searches.rays.push(RayVisits::default());
        }
    }

    #[inline(always)]
    fn keeps_boxes(&self) -> bool {
        self.searches.as_ref().is_some_and(|searches| !searches.is_within_mesh)
    }

    fn tested(&mut self, bounds: &Aabb, hit: bool) {
        if let Some(ray) = self.searches.as_mut().and_then(|searches| searches.rays.last_mut()) {
            ray.boxes.push(TestedBox { bounds: *bounds, hit });
        }
    }

    fn within_mesh(&mut self, within: bool) {
        if let Some(searches) = &mut self.searches {
            searches.is_within_mesh = within;
        }
    }

    fn counts(&self) -> Counts {
        self.counts
    }
}
