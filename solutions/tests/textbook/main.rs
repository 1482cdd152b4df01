//! A textbook solution of stages 1 to 6: plain formulas as slides and books print them, in single precision, by an author who
//! read the idea of each doc comment and not the list under `Exactly:`. It passes the core of each stage.

#![allow(clippy::manual_range_contains)] // books write both comparisons

mod stage1_shapes;
mod stage2_triangles;
mod stage3_boxes;
mod stage3_build;
mod stage3_traversal;
mod stage4_shading;
mod stage5_recursion;
mod stage6_distribution;

// The kit of these modules.
include!("kit.rs");

#[test]
fn a_solution_from_the_slides_and_the_ideas_passes_the_core() {
    let kit = checks::linked(Kit);
    let mut missed = Vec::new();
    for (stage, list) in &all_checks::STAGES[..6] {
        let (mut earned, mut all, mut deeper) = (0, 0, Vec::new());
        for check in *list {
            let entry = checks::rubric::entry(*stage, check.name);
            all += entry.points;
            match checks::run(check, &kit, 0) {
                checks::Verdict::Passed => earned += entry.points,
                verdict if entry.level() == checks::rubric::Level::Core => missed.push((check.name, verdict)),
                _ => deeper.push(check.name),
            }
        }
        println!("stage {stage}: {earned} of {all} points; deeper: {deeper:?}");
    }
    assert!(missed.is_empty(), "{missed:#?}");
}
