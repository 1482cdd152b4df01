//! The checks of all stages in one list, for programs that need more than one stage.

mod rubric;

pub use rubric::differences;

use checks::Check;

/// All checks of all stages, in order.
pub const STAGES: &[(u8, &[Check])] = &[
    (1, stage1_checks::CHECKS),
    (2, stage2_checks::CHECKS),
    (3, stage3_checks::CHECKS),
    (4, stage4_checks::CHECKS),
    (5, stage5_checks::CHECKS),
    (6, stage6_checks::CHECKS),
    (7, stage7_checks::CHECKS),
    (8, stage8_checks::CHECKS),
    (9, stage9_checks::CHECKS),
    (10, stage10_checks::CHECKS),
    (11, stage11_checks::CHECKS),
    (12, stage12_checks::CHECKS),
];

/// The checks of a stage; an empty list if there is no such stage.
pub fn of_stage(stage: u8) -> &'static [Check] {
    STAGES.iter().find(|(number, _)| *number == stage).map_or(&[], |(_, checks)| checks)
}

/// The check of a stage with this name.
pub fn find(stage: u8, name: &str) -> Option<&'static Check> {
    of_stage(stage).iter().find(|check| check.name == name)
}
