//! The cost of each set of effects.

use super::Explained;
use crate::columns::Columns;
use crate::report::{Thousands, bar_of_steps, job, render};
use anyhow::{Result, bail};
use raykata::count::Counts;
use raykata::effects::Effect;
use std::fmt::Display;

/// A column: its head and its number.
type Column = (&'static str, fn(&Counts) -> u64);

const NUMBERS: [Column; 8] = [
    ("from camera", |counts| counts.primary),
    ("to lights", |counts| counts.shadow),
    ("reflected", |counts| counts.reflection),
    ("refracted", |counts| counts.transmission),
    ("indirect", |counts| counts.indirect),
    ("random numbers", |counts| counts.random_numbers),
    ("image reads", |counts| counts.texture_reads),
    ("box tests", |counts| counts.box_tests),
];

/// Prints one line for each set of the effects that the scene needs, from none to all.
pub fn print(explained: &Explained<'_>) -> Result<()> {
    let called = explained.called_for();
    if called.len() > 10 {
        bail!("the scene needs {} effects: {} sets are too many", called.len(), 1u64 << called.len());
    }
    for (effect, letter) in called.iter().zip('A'..) {
        println!("  {letter}  {effect}");
    }
    let width = called.len().max(7);
    let row = |set: &str, cells: &[&dyn Display; 8]| {
        println!("{set:<width$}  {}", Columns("  ", &[14; 8]).row(cells));
    };
    println!();
    row("effects", &NUMBERS.each_ref().map(|(head, _)| head as &dyn Display));
    let bar = bar_of_steps(1 << called.len());
    for set in 0..1usize << called.len() {
        let has = |bit: usize| set & (1 << bit) != 0;
        let absent = (0..called.len()).filter(|&bit| !has(bit)).map(|bit| called[bit]);
        let scene = absent.fold(explained.scene.clone(), |scene, effect: Effect| effect.removed_from(&scene));
        let counts = render(explained.kit, &job(scene))?.counts;
        let letters = (0..called.len()).zip('A'..);
        let letters: String = letters.map(|(bit, letter)| if has(bit) { letter } else { '·' }).collect();
        let numbers = NUMBERS.map(|(_, number)| Thousands(number(&counts)));
        bar.suspend(|| row(&letters, &numbers.each_ref().map(|number| number as &dyn Display)));
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(())
}
