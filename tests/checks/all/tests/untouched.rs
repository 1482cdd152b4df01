//! The exercises as they are handed out: every check reports which function is not written yet and where, and no check
//! fails for another reason. A stage in which a gap is already filled is skipped with a note. In CI all stages are
//! untouched, because `raykata sync --check` runs before.

use all_checks::STAGES;
use checks::Verdict;
use raykata::kit::StudentKit;
use std::sync::Arc;

/// The number of gaps in the files of a stage in `folder`: the lines that start with `opening`. A stage may have
/// several files.
fn gaps(folder: &str, stage: u8, opening: &str) -> usize {
    let files = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let of_stage =
        files.filter(|file| file.file_name().to_string_lossy().starts_with(&format!("stage{stage}_")));
    let gaps = |text: String| text.lines().filter(|line| line.trim_start().starts_with(opening)).count();
    of_stage.map(|file| std::fs::read_to_string(file.path()).map_or(0, gaps)).sum()
}

#[test]
fn every_check_of_an_untouched_exercise_says_what_is_not_written_yet() {
    let kit: Arc<dyn raykata::kit::Kit + Send + Sync> = exercises::Kit.door();
    for (stage, checks) in STAGES {
        let handed_out = gaps("../../../solutions/src", *stage, "// <stub> todo!");
        let left = gaps("../../../exercises/src", *stage, "todo!");
        if left == 0 || left != handed_out {
            println!("stage {stage} is begun ({left} of {handed_out} gaps left), so it is skipped");
            continue;
        }
        for check in *checks {
            match checks::run(check, &kit, 0) {
                Verdict::NotWritten { place, .. } => {
                    let of_stage = format!("exercises/src/stage{stage}_");
                    assert!(place.starts_with(&of_stage), "{}: {place}", check.name)
                }
                other => panic!("{} of stage {stage}: {other:?}", check.name),
            }
        }
    }
}
