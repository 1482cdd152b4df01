//! The laws of a ray tracer: what students are graded on, one module a stage, to be read as a specification.
//!
//! Every check asks a [`raykata::kit::Kit`] through its door and never knows whose code answers. It is a function that
//! gives `Ok(())` or a [`Broken`] law with the smallest input that breaks it.

pub mod broken;
pub mod double;
mod drawn;
pub mod exact;
pub mod gauntlet;
pub mod generate;
pub mod golden;
pub mod judge;
pub mod paste;
pub mod picture;
pub mod rubric;
pub mod splitmix;
pub mod stage1;
pub mod stage10;
pub mod stage2;
pub mod stage3;
pub mod stage4;
pub mod stage5;
pub mod stage6;
pub mod stage7;
pub mod stage8;
pub mod stage9;
pub mod statistics;
pub mod tree;
pub mod trial;

use raykata::kit::{Kit, Linked, Renders, StudentFunctions};
use std::sync::Arc;

pub use broken::{Broken, Outcome};
pub use drawn::Drawn;
pub use trial::{Check, Trial, Verdict, examine, examine_with, grade, run, verdict};

/// All checks of all stages that are built, in order.
pub const STAGES: &[(u8, &[Check])] = &[
    (1, stage1::CHECKS),
    (2, stage2::CHECKS),
    (3, stage3::CHECKS),
    (4, stage4::CHECKS),
    (5, stage5::CHECKS),
    (6, stage6::CHECKS),
    (7, stage7::CHECKS),
    (8, stage8::CHECKS),
    (9, stage9::CHECKS),
    (10, stage10::CHECKS),
];

/// The functions of a crate as a kit that checks can ask.
pub fn linked<F: StudentFunctions + Renders + Send>(functions: F) -> Arc<dyn Kit + Send + Sync> {
    Arc::new(Linked(functions))
}

/// Lists the checks of a stage, and makes the macro that turns them into tests of a kit: `checks::stage1!(kit)`.
///
/// The leading `($)` lends the inner macro its dollar sign.
macro_rules! checks {
    (($d:tt) $number:literal $stage:ident [$($name:ident)*]) => {
        /// The checks of this stage, in the order of the lecture.
        pub const CHECKS: &[$crate::Check] =
            &[$($crate::Check { stage: $number, name: stringify!($name), law: $name }),*];

        /// One test for each check of the stage.
        #[macro_export]
        macro_rules! $stage {
            ($d kit:expr) => {
                $(#[test]
                fn $name() {
                    $d crate::grade($number, stringify!($name), $d crate::linked($d kit));
                })*
            };
        }
    };
}
pub(crate) use checks;
