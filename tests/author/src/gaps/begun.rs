//! A kit that is written up to some stage always gives a picture, and it says what it lacks.

use super::switch::Switchable;
use super::{Gap, stage_of};
use crate::corpus::verdict::without_lines;
use crate::pictures::{Scenes, Shown};
use anyhow::Result;
use grader::queue;
use grader::report::bar_of_steps;
use grader::worker::{CALL_PATIENCE, Worker};
use raykata::kit::Door;
use std::collections::BTreeSet;

/// Renders all scenes without all functions from each stage on. Returns whether each picture was made and says what it lacks.
pub fn run(switchable: &Switchable, gaps: &[Gap], scenes: &Scenes, whole: &[Shown]) -> Result<bool> {
    let stages: BTreeSet<u8> = gaps.iter().map(stage_of).collect();
    let stages: Vec<u8> = stages.into_iter().collect();
    let bar = bar_of_steps(stages.len());
    let results = queue::run(&queue::one_a_core(), &stages, |(), &stage| {
        bar.set_message(format!("stages before {stage}"));
        let left_out: Vec<usize> =
            (0..gaps.len()).filter(|&number| stage_of(&gaps[number]) >= stage).collect();
        let worker = switchable.without(&format!("before_{stage}"), &left_out)?;
        let shown = scenes.shown_by(&Door(Worker::new(worker, CALL_PATIENCE).with_short_frames()));
        bar.inc(1);
        let faults = shown.iter().zip(whole).filter_map(|(one, whole)| {
            fault(one, whole).map(|fault| format!("stages before {stage}, {}: {fault}", one.scene))
        });
        Ok(faults.collect::<Vec<String>>())
    })?;
    bar.finish_and_clear();
    results.iter().flatten().for_each(|fault| println!("{fault}"));
    Ok(results.iter().all(Vec::is_empty))
}

/// The mean difference of two pictures below which they look the same: one step of the brightness of a screen. Without the
/// functions of stage 10, pictures are computed by those of earlier stages, which round in another way. Such a picture
/// lacks nothing.
const SAME: f32 = 1.0 / 255.0;

/// The mean difference of all numbers of two pictures of the same size.
fn difference(one: &[[u32; 3]], other: &[[u32; 3]]) -> f32 {
    let numbers =
        |pixels: &[[u32; 3]]| pixels.iter().flatten().map(|&bits| f32::from_bits(bits)).collect::<Vec<_>>();
    let (one, other) = (numbers(one), numbers(other));
    one.iter().zip(&other).map(|(p, q)| (p - q).abs()).sum::<f32>() / one.len().max(1) as f32
}

/// What is wrong with a picture: it was not made, or it looks different from the whole one and does not say why.
fn fault(one: &Shown, whole: &Shown) -> Option<String> {
    match &one.pixels {
        Err(error) => Some(without_lines(error)),
        Ok(pixels) => {
            let whole = whole.pixels.as_ref().map_or(&[][..], |pixels| pixels);
            let differs = !(difference(pixels, whole) <= SAME);
            (differs && one.notes.is_empty())
                .then(|| "the picture looks different and does not say what it lacks".into())
        }
    }
}
