//! A textbook solution of stages 1 to 3: plain formulas as books print them, in single precision, written by somebody who
//! reads the doc comments and does no more than they ask. It must pass the basic checks, and it may lose points in the hard
//! cases only.

#![allow(clippy::manual_range_contains)] // books write both comparisons

mod stage1_shapes;
mod stage2_triangles;
mod stage3_boxes;
mod stage3_build;
mod stage3_traversal;

// The kit of these modules.
include!("kit.rs");

/// The points of a stage, and the names of the checks that fail.
fn score(stage: u8) -> (u32, u32, Vec<&'static str>) {
    let kit = checks::linked(Kit);
    let (_, list) = all_checks::STAGES.iter().find(|(number, _)| *number == stage).expect("a stage");
    let (mut points, mut all, mut failed) = (0, 0, Vec::new());
    for check in *list {
        let worth = checks::rubric::entry(stage, check.name).points;
        all += worth;
        match checks::run(check, &kit, 0) {
            checks::Verdict::Passed => points += worth,
            checks::Verdict::Failed(message) => {
                println!("{message}");
                failed.push(check.name);
            }
            checks::Verdict::NotWritten { task, .. } => panic!("not written: {task}"),
        }
    }
    (points, all, failed)
}

/// A textbook solution fails exactly these checks, and earns at least 75 % of the points.
#[track_caller]
fn expect(stage: u8, points: u32, hard: &[&str]) {
    let (yours, all, failed) = score(stage);
    println!("stage {stage}: {yours} of {all} points");
    assert_eq!(failed, hard);
    assert_eq!(yours, points);
    assert!(4 * yours >= 3 * all, "{yours} of {all} points");
}

#[test]
fn stage_1_by_the_plain_quadratic_formula() {
    let hard = [
        "sphere_algebraic_far_away_and_tiny",
        "sphere_geometric_far_away_and_tiny",
        "plane_by_coefficients_far_from_the_origin",
    ];
    expect(1, 90, &hard);
}

#[test]
fn stage_2_by_moeller_trumbore_and_the_formulas_of_the_slides() {
    let hard = [
        "triangle_gram_far_from_the_origin",
        "gram_scalars_of_thin_triangles_keep_their_sign",
        "backfacing_has_no_smallest_size",
        "face_normal_has_unit_length_at_any_size",
    ];
    expect(2, 115, &hard);
}

#[test]
fn stage_3_by_min_and_max_and_recursion() {
    let hard = [
        "slab_is_hit_by_rays_within_a_face",
        "slab_hits_the_corners_it_is_aimed_at",
        "build_isolates_what_is_not_a_number",
    ];
    expect(3, 103, &hard);
}
