//! Tests that no check can be passed by a table of known answers.

use super::*;
use crate::kits;

#[test]
fn every_check_has_hidden_inputs() {
    let root = kits::root().expect("a kit");
    let stages: Vec<u8> = STAGES.iter().map(|(stage, _)| *stage).collect();
    let judge = Judge::of(&root, &stages, 0x5eed_0f7e_57ab_1e00, Confinement::Full).expect("a judge");
    let fixed: Vec<&str> = judge.checks.iter().filter(|put| !put.varies).map(|put| put.check.name).collect();
    assert!(fixed.is_empty(), "checks with fixed inputs: {fixed:?}");
}
