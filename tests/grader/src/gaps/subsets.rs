//! Half-written kits always give a picture, and it says what it lacks.

use super::switch::Switchable;
use super::{Gap, stage_of};
use crate::corpus::verdict::without_lines;
use crate::pictures::{Scenes, Shown};
use crate::queue;
use crate::report::bar_of_steps;
use crate::worker::{CALL_PATIENCE, Worker};
use anyhow::Result;
use oracle::splitmix::Random;
use raykata::kit::Door;
use std::collections::BTreeSet;

/// A set of functions that are left out.
struct Subset {
    what: String,
    /// The numbers of the functions.
    numbers: Vec<usize>,
}

/// Renders all scenes without the functions of `n` random sets, and without all functions from each stage on. Returns whether
/// each picture was made and says what it lacks.
pub fn run(
    switchable: &Switchable,
    gaps: &[Gap],
    scenes: &Scenes,
    whole: &[Shown],
    (n, seed): (u64, u64),
) -> Result<bool> {
    let subsets: Vec<Subset> =
        prefixes(gaps).into_iter().chain((0..n).map(|number| random(gaps, seed, number))).collect();
    let bar = bar_of_steps(subsets.len());
    let numbered: Vec<(usize, &Subset)> = subsets.iter().enumerate().collect();
    let results = queue::run(&queue::one_a_core(), &numbered, |(), (number, subset)| {
        bar.set_message(subset.what.clone());
        let worker = switchable.without(&format!("subset_{number}"), &subset.numbers)?;
        let shown = scenes.shown_by(&Door(Worker::hasty(worker, CALL_PATIENCE)));
        bar.inc(1);
        Ok((shown.iter().zip(whole).map(|(one, whole)| fault(one, whole)).collect::<Vec<_>>(), shown))
    })?;
    bar.finish_and_clear();

    let (mut pictures, mut lacking, mut faults) = (0, 0, 0);
    for (subset, (found, shown)) in subsets.iter().zip(&results) {
        pictures += shown.len();
        lacking += shown.iter().zip(whole).filter(|(one, whole)| one != whole).count();
        for (fault, one) in found.iter().zip(shown).filter_map(|(fault, one)| Some((fault.as_ref()?, one))) {
            faults += 1;
            let names: Vec<&str> =
                subset.numbers.iter().map(|&number| gaps[number].function.as_str()).collect();
            println!("{}, {}: {fault}\n  without {}\n", subset.what, one.scene, names.join(", "));
        }
    }
    println!(
        "{} sets of functions, {pictures} pictures: {lacking} lack something, {faults} of them fail or do not say what",
        subsets.len()
    );
    Ok(faults == 0)
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

/// All functions from each stage on.
fn prefixes(gaps: &[Gap]) -> Vec<Subset> {
    let stages: BTreeSet<u8> = gaps.iter().map(stage_of).collect();
    let from = |stage: u8| Subset {
        what: format!("stages before {stage}"),
        numbers: (0..gaps.len()).filter(|&number| stage_of(&gaps[number]) >= stage).collect(),
    };
    stages.into_iter().map(from).collect()
}

/// A random set, in which few, half or most functions are left out.
fn random(gaps: &[Gap], seed: u64, number: u64) -> Subset {
    let mut random = Random::new(seed, number);
    let share = random.unit();
    let numbers = (0..gaps.len()).filter(|_| random.unit() < share).collect();
    Subset { what: format!("set {number} of seed {seed}"), numbers }
}
