//! Judges which cells a search visits, and which primitives it tests.

use super::searches::Search;
use checks::prelude::*;
use checks::tree::closest_of;

impl<S> Search<S> {
    /// Judges the visits of the searches for these rays, each of which is aimed at a primitive.
    pub(super) fn visits(&self, kit: &dyn Kit, what: &str, queries: &[CellsQuery<S>]) -> CheckResult {
        assert!(
            queries.iter().all(|query| closest_of(&query.hits, &query.ray).is_some()),
            "a ray hits nothing"
        );
        self.all_visits(kit, queries, |query, yours| self.judge_visits(what, query, &yours))
    }

    /// Judges each answer of the search.
    pub(super) fn all_visits(
        &self,
        kit: &dyn Kit,
        queries: &[CellsQuery<S>],
        judge: impl Fn(&CellsQuery<S>, CellsAnswer) -> CheckResult,
    ) -> CheckResult {
        all_hold(compare(queries, (self.ask)(kit, queries), judge))
    }

    /// Judges the visits of a search that must find a hit: the ray must enter each visited node before its hit, and each tested
    /// primitive must be listed in a visited node.
    pub(super) fn judge_visits(&self, what: &str, query: &CellsQuery<S>, yours: &CellsAnswer) -> CheckResult {
        let parts = (self.parts)(&query.cells, &query.ray);
        let ray = &query.ray;
        let input = || format!("{what}\n{}", ray.paste());
        // A search that visits nothing is not a search.
        if yours.hit.is_none() || yours.visits.is_empty() {
            let found = yours.hit.map(|hit| (hit.primitive, hit.t));
            let expected = format!("{:?} after at least one visit", closest_of(&query.hits, ray));
            let yours = format!("{found:?} after {} visits", yours.visits.len());
            return Err(Broken::with_texts(input(), yours, expected, "brute force, (primitive, t)"));
        }
        let end = yours.hit.map_or(f64::INFINITY, |hit| f64::from(hit.t)).min(f64::from(ray.t_max));
        // Allow 2⁻¹⁴, which is far more than rounding errors and far less than a cell.
        let room = (-14f64).exp2();
        let enter = |visit: u32| parts.iter().find(|(node, ..)| *node == visit).map(|(_, enter, _)| *enter);
        let is_behind = |enter: f64| enter > end + room * end.abs();
        let again = |visit: u32| yours.visits.iter().filter(|other| **other == visit).count() > 1;
        let missed = yours.visits.iter().copied().find(|&visit| enter(visit).is_none());
        let behind =
            yours.visits.iter().find_map(|&visit| enter(visit).filter(|&t| is_behind(t)).map(|t| (visit, t)));
        let twice = yours.visits.iter().copied().find(|&visit| again(visit));
        let is_listed = |primitive: &u32| {
            yours.visits.iter().any(|node| (self.listed)(&query.cells, *node).contains(primitive))
        };
        // A visit that the ray misses may be to a cell that does not exist.
        let mut tests = yours.tests.iter().copied().filter(|_| missed.is_none());
        let unlisted = tests.find(|primitive| !is_listed(primitive));
        // Each fault as `(yours, expected, source)` with its mistake; the message shows the first.
        let faults = [
            "you visit a cell that the ray does not enter".when(
                missed.map(|visit| (format!("a visit to {visit}"), "none".to_owned(), "the ray misses it")),
            ),
            "the search goes on behind the best hit: visit the nearest cells first, and stop at a cell that begins behind the hit"
                .when(behind.map(|(visit, t)| {
                    let begins = format!("a visit to {visit}, which begins at t = {t:.4}");
                    (begins, format!("none beyond the hit at t = {end}"), "counted")
                })
                ),
            "you visit a cell several times"
                .when(twice.map(|visit| (format!("{visit} is visited again"), "once".to_owned(), "counted"))),
            "you test a primitive that no visited cell lists: call `visit` for each cell that the search comes to"
                .when(unlisted.map(|primitive| {
                    let test = format!("a test of primitive {primitive}");
                    (test, "a visit to a cell that lists it".to_owned(), "counted")
                })
                ),
        ];
        let mistakes = faults.each_ref().map(|(fault, mistake)| (fault.is_some(), *mistake));
        match faults.into_iter().find_map(|(fault, _)| fault) {
            None => Ok(()),
            Some((yours, expected, source)) => {
                Err(Broken::with_texts(input(), yours, expected, source).explained_by(mistakes))
            }
        }
    }
}
