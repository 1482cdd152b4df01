//! The third hints of stages 1 to 3 lead to code that passes: functions that contain the code of the hints, and otherwise what
//! a textbook prints, pass every check. The code in the third hints of the bonus of stage 12 is that of the reference.

#![allow(clippy::manual_range_contains)] // books write both comparisons

mod stage1_shapes;
mod stage2_triangles;
mod stage3_boxes;
#[path = "../textbook/stage3_build.rs"]
mod stage3_build;
#[path = "../textbook/stage3_traversal.rs"]
mod stage3_traversal;
#[expect(
    dead_code,
    reason = "`stage3_boxes` replaces the functions whose third hints differ from the textbook"
)]
#[path = "../textbook/stage3_boxes.rs"]
mod textbook_boxes;
#[expect(
    dead_code,
    reason = "`stage2_triangles` replaces the functions whose third hints differ from the textbook"
)]
#[path = "../textbook/stage2_triangles.rs"]
mod textbook_triangles;

// The kit of these modules.
include!("../textbook/kit.rs");

/// Code in the third hint of a check, which the functions of this test contain: a line `stage check: code` for each.
const HINTS: &str = include_str!("third_hints.txt");

#[test]
fn the_code_of_the_third_hints_passes() {
    for line in HINTS.lines() {
        let (check, code) = line.split_once(": ").expect("a check and its code");
        let (stage, name) = check.split_once(' ').expect("a stage and a name");
        let hint = &checks::rubric::entry(stage.parse().expect("a number"), name).hints[2];
        assert!(hint.contains(code), "the third hint of `{name}` changed: apply it in this test\n{hint}");
    }
    let kit = checks::linked(Kit);
    for stage in 1..=3 {
        let mut failed = Vec::new();
        for check in all_checks::of_stage(stage) {
            if let checks::Verdict::Failed(message) = checks::run(check, &kit, 0) {
                println!("{message}");
                failed.push(check.name);
            }
        }
        assert!(failed.is_empty(), "stage {stage}: the code of the hints fails {failed:?}");
    }
}
