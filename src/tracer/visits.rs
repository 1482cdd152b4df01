//! What the searches for the rays of a pixel visit.

use crate::aabb::Aabb;
use crate::count::{Counts, Event, Tally};
use crate::kit::{RayVisits, TestedBox};

/// A tally that keeps the work of each search apart. Each ray of a pixel is searched once and recorded before the next search,
/// so the searches have the order of the recorded rays.
#[derive(Default)]
pub struct Visits {
    /// The work of each search so far.
    pub rays: Vec<RayVisits>,
    is_within_mesh: bool,
}

impl Tally for Visits {
    const COUNTS: bool = true;

    fn note(&mut self, event: Event) {
        let Some(ray) = self.rays.last_mut() else { return };
        match event {
            Event::NodeVisit => ray.node_visits += 1,
            Event::BoxTest => ray.box_tests += 1,
            Event::PrimitiveTest => ray.primitive_tests += 1,
            _ => {}
        }
    }

    fn search(&mut self) {
        self.rays.push(RayVisits::default());
    }

    fn tested(&mut self, bounds: &Aabb, hit: bool) {
        if let Some(ray) = self.rays.last_mut().filter(|_| !self.is_within_mesh) {
            ray.boxes.push(TestedBox { bounds: *bounds, hit });
        }
    }

    fn within_mesh(&mut self, within: bool) {
        self.is_within_mesh = within;
    }

    fn counts(&self) -> Counts {
        Counts::default()
    }
}
