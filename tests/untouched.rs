//! The exercises as they are handed out: every check says what is not written yet and where, and none fails for
//! another reason. A stage that somebody has begun is not judged, and said so; CI sees all of them untouched, because
//! `raykata sync --check` runs before.

use checks::{STAGES, Verdict};
use std::sync::Arc;

/// How many gaps a file has, by the words that open one.
fn gaps(file: &str, opening: &str) -> usize {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    text.lines().filter(|line| line.trim_start().starts_with(opening)).count()
}

#[test]
fn every_check_of_an_untouched_exercise_says_what_is_not_written_yet() {
    let kit: Arc<dyn raykata::kit::Kit + Send + Sync> = Arc::new(exercises::Kit);
    for (stage, checks) in STAGES {
        let file = checks::rubric::RUBRIC[&format!("stage{stage}")].file.clone();
        let handed_out = gaps(&file.replace("exercises/", "solutions/"), "// <stub> todo!");
        let left = gaps(&file, "todo!");
        if left == 0 || left != handed_out {
            println!("stage {stage} is begun ({left} of {handed_out} gaps left): not judged");
            continue;
        }
        for check in *checks {
            match checks::run(check, &kit, 0) {
                Verdict::NotWritten { place, .. } => {
                    assert!(place.starts_with(&file), "{}: {place}", check.name)
                }
                other => panic!("{} of stage {stage}: {other:?}", check.name),
            }
        }
    }
}
