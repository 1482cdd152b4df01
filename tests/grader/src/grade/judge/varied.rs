//! Tests which checks have hidden inputs.

use super::*;
use crate::kits;

#[test]
fn every_function_has_a_check_with_hidden_inputs() {
    let root = kits::root().expect("a kit");
    let stages: Vec<u8> = STAGES.iter().map(|(stage, _)| *stage).collect();
    let judge = Judge::of(&root, &stages, 0x5eed_0f7e_57ab_1e00, Confinement::Full).expect("a judge");
    let varied: HashSet<_> =
        judge.checks.iter().filter(|put| put.varies).flat_map(|put| put.asks.iter().copied()).collect();
    for put in &judge.checks {
        let open: Vec<_> = put.asks.difference(&varied).collect();
        assert!(open.is_empty(), "{}: no check with hidden inputs asks {open:?}", put.check.name);
    }
    let fixed: Vec<&Put> = judge.checks.iter().filter(|put| !put.varies).collect();
    let points = |puts: &[&Put]| -> u32 {
        puts.iter().map(|put| rubric::entry(put.check.stage, put.check.name).points).sum()
    };
    let all: Vec<&Put> = judge.checks.iter().collect();
    println!(
        "{} of {} checks have fixed inputs: {} of {} points",
        fixed.len(),
        all.len(),
        points(&fixed),
        points(&all)
    );
    for stage in &stages {
        let of_stage: Vec<&Put> = fixed.iter().copied().filter(|put| put.check.stage == *stage).collect();
        println!("stage {stage}: {} checks, {} points", of_stage.len(), points(&of_stage));
    }
}
