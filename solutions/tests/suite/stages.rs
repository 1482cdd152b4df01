//! The reference passes the same checks as the exercises.

use all_checks::STAGES;
use checks::Verdict;
use raykata::kit::Kit;
use std::sync::Arc;

macro_rules! stages {
    ($($stage:ident $checks:ident)*) => {
        $(mod $stage {
            $checks::tests!(solutions::Kit);
        })*
    };
}

stages! {
    stage1 stage1_checks stage2 stage2_checks stage3 stage3_checks stage4 stage4_checks
    stage5 stage5_checks stage6 stage6_checks stage7 stage7_checks stage8 stage8_checks
    stage9 stage9_checks stage10 stage10_checks stage11 stage11_checks stage12 stage12_checks
}

/// Other inputs, because instructors grade with their own seeds. For more seeds: `SEEDS=300 cargo test --release -p solutions --test
/// suite other_seeds`; for other seeds add `FIRST=301`, for one stage `STAGE=9`.
#[test]
fn the_reference_passes_every_check_with_other_seeds() {
    let number = |name: &str| std::env::var(name).ok().and_then(|number| number.parse::<u64>().ok());
    let (first, seeds) = (number("FIRST").unwrap_or(1), number("SEEDS").unwrap_or(1));
    let kit: Arc<dyn Kit + Send + Sync> = solutions::kit();
    let mut failed = Vec::new();
    // Spread the seeds, so that no bit is the same in all of them.
    for seed in (first..first + seeds).map(|number| number.wrapping_mul(0x9e37_79b9_7f4a_7c15)) {
        let wanted = |stage: u8| number("STAGE").is_none_or(|only| only == u64::from(stage));
        for check in STAGES.iter().filter(|(stage, _)| wanted(*stage)).flat_map(|(_, checks)| *checks) {
            let verdict = checks::run(check, &kit, seed);
            if verdict != Verdict::Passed {
                // Print failures at once as well, because many seeds take long.
                println!("stage {} {} with seed {seed}: {verdict:?}", check.stage, check.name);
                failed.push(format!("stage {} {} with seed {seed}: {verdict:?}", check.stage, check.name));
            }
        }
    }
    assert!(failed.is_empty(), "{} failures:\n{}", failed.len(), failed.join("\n"));
}
