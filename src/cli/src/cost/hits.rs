//! Compares the first hits of rays with exact ones. The judge, a separate program that is built when it is
//! needed, computes the exact hits; this module asks the kit for its hits.

use super::measure::Bench;
use super::measured::Measured;
use crate::judge::Judge;
use crate::report::bar_of_steps;
use anyhow::{Context, Result};
use raykata::kit::{KitError, kit_error};
use raykata::ray::Ray;
use raykata::scene::Scene;
use std::collections::BTreeSet;
use std::path::Path;

/// Judges all settings of parameters that decide only how hits are found. A scene that is too large or empty
/// is not judged.
pub fn judge(root: &Path, bench: &Bench<'_>, scene: &Scene, measured: &mut Measured) -> Result<()> {
    let geometric = measured.series.iter().filter(|series| series.parameter.is_geometric());
    let places: BTreeSet<usize> =
        geometric.flat_map(|series| &series.levels).map(|(_, index)| *index).collect();
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
        let job = bench.job(&point.setting.apply(scene), 0, false);
        let hits = match kit_error::catch(|| bench.kit.first_hits(&job, &rays)) {
            Ok(hits) => hits,
            // A frame leaves out the shapes of this function; a single ray cannot.
            Err(KitError::NotWritten { place, .. }) => {
                measured
                    .left_out
                    .push(format!("the verdicts on hits: a function is not written yet ({place})"));
                break;
            }
            Err(error) => return Err(error.into()),
        };
        judge.send(&hits)?;
        point.hits = Some(judge.receive().context("the judge has no verdict on first hits")?);
    }
    bar.finish_and_clear();
    Ok(())
}
