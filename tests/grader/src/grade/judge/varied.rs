//! Tests that no check can be passed by a table of known answers.

use super::*;
use crate::kits;

#[test]
fn every_check_has_hidden_inputs() {
    let root = kits::root().expect("a kit");
    let stages: Vec<u8> = STAGES.iter().map(|(stage, _)| *stage).collect();
    // Even the seed 0 draws.
    let judge = Judge::of(&root, &stages, 0, Confinement::Full).expect("a judge");
    let fixed: Vec<&str> = judge.checks.iter().filter(|put| !put.varies).map(|put| put.check.name).collect();
    assert!(fixed.is_empty(), "checks with fixed inputs: {fixed:?}");

    // Checks with turned inputs count for nothing if no check with drawn inputs passes.
    let outcome = |put: &PreparedCheck| if put.draws { Outcome::Wrong } else { Outcome::Passed };
    let results = judge.results(judge.checks.iter().map(|put| Answered::new(outcome(put), "")).collect());
    let passed = results.iter().filter(|result| result.outcome == Outcome::Passed);
    let alone: Vec<&str> = passed.map(|result| result.name.as_str()).collect();
    assert_eq!(alone, [""; 0], "checks with turned inputs beside which no drawn one stands");
}
