//! Whether rays find what they exactly meet first. The judge, a program of its own that is built when it is needed, knows
//! that; here are the questions to the kit.

use super::measure::{Bench, Measured};
use crate::judge::Judge;
use crate::report::bar_of_steps;
use anyhow::{Context, Result};
use raykata::kit::{RenderJob, View, kit_error};
use raykata::ray::Ray;
use raykata::scene::Scene;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What the oracle says of one way to find hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Verdicts {
    /// Rays that were asked.
    pub rays: u64,
    /// Of these, those that found something else than what they exactly meet first, or nothing, or something for nothing.
    pub wrong: u64,
    /// Of these, those that went through a closed surface.
    pub leaks: u64,
}

/// Judges all settings of parameters that decide only how hits are found. A scene of too much, or of nothing, is not judged.
pub fn judge(root: &Path, bench: &Bench<'_>, scene: &Scene, measured: &mut Measured) -> Result<()> {
    let geometric = measured.series.iter().filter(|series| series.parameter.is_geometric());
    let mut places: Vec<usize> =
        geometric.flat_map(|series| &series.levels).map(|(_, index)| *index).collect();
    places.sort_unstable();
    places.dedup();
    if places.is_empty() || bench.stopped() {
        return Ok(());
    }
    let mut judge = Judge::start(root, "hits")?;
    let bar = bar_of_steps(places.len() + 1);
    bar.set_message("first hits, exactly");
    judge.send(scene)?;
    let rays: Option<Vec<Ray>> = judge.receive()?;
    let Some(rays) = rays else { return Ok(()) };
    for index in places {
        bar.inc(1);
        if bench.stopped() {
            break;
        }
        let point = &mut measured.points[index];
        let scene = point.setting.apply(scene);
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: bench.threads, count: false };
        let hits = kit_error::catch(|| bench.kit.first_hits(&job, &rays))?;
        judge.send(&hits)?;
        point.hits = Some(judge.receive().context("the judge has no verdict on first hits")?);
    }
    bar.finish_and_clear();
    Ok(())
}
