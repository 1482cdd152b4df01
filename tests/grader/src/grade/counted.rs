//! Finds the checks that judge a cost. For these the judge keeps the tables of the searches and counts the questions itself,
//! because a worker could invent its counts.

use crate::worker::Worker;
use glam::Vec3;
use raykata::count::Counts;
use raykata::frame::Watch;
use raykata::kit::{Answer, Costs, Request, SearchAnswer, Transport};
use raykata::ray::Ray;
use std::sync::Arc;
use std::time::Duration;

/// How much larger than the costs of the reference those of [`Costly`] are. No limit of a check is that generous.
const TIMES: u64 = 20;

/// The reference with the same answers at [`TIMES`] the cost. A check that it fails judges a cost.
pub(super) struct Costly(pub Arc<Worker>);

impl Transport for Costly {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let lights = match &request {
            Request::Shade(queries) => queries.iter().map(|query| query.lights.len()).collect(),
            _ => Vec::new(),
        };
        let mut answer = self.0.call(request, watch);
        raise_costs(&mut answer, &lights);
        answer
    }

    fn waited(&self) -> Duration {
        self.0.waited()
    }
}

fn raise_costs(answer: &mut Answer, lights: &[usize]) {
    for (index, costs) in answer.costs().into_iter().enumerate() {
        match costs {
            Costs::Search(answer) => raise_search(answer),
            Costs::Graph(answer) => {
                raise_search(&mut answer.search);
                raise_list(&mut answer.asked);
            }
            Costs::Cells(answer) => {
                raise_list(&mut answer.visits);
                raise_list(&mut answer.tests);
            }
            Costs::Packet(answer) => {
                raise_list(&mut answer.opened);
                raise_counts(&mut answer.counts);
            }
            Costs::Wide(answer) => {
                raise_list(&mut answer.nodes);
                raise_list(&mut answer.blocks);
                raise_list(&mut answer.primitives);
                answer.calls_after_hit += 1;
            }
            Costs::Shade(answer) => {
                // Trace a shadow ray to every light, also where it cannot matter.
                answer.traced.extend(0..lights.get(index).copied().unwrap_or(0));
                let ray = answer.rays.first().copied().unwrap_or_else(|| Ray::new(Vec3::ZERO, Vec3::X));
                answer.rays.resize(answer.traced.len(), ray);
            }
        }
    }
}

fn raise_search(answer: &mut SearchAnswer) {
    raise_counts(&mut answer.counts);
    answer.tests_after_hit = answer.tests_after_hit * TIMES + 1;
}

fn raise_counts(counts: &mut Counts) {
    for count in [&mut counts.node_visits, &mut counts.box_tests, &mut counts.primitive_tests] {
        *count *= TIMES;
    }
}

fn raise_list(calls: &mut Vec<u32>) {
    *calls = calls.repeat(TIMES as usize);
}
