//! The code that all checks share: it runs a check, writes its message, and compares numbers, trees, texts and
//! pictures.
//!
//! The checks of each stage are a separate crate beside this one, so that a student builds the checks of one stage
//! only. A check calls a [`raykata::kit::Kit`] and does not know whose code answers. It is a function that returns
//! `Ok(())` or a [`Broken`] law with a small input that breaks it.

pub mod broken;
pub mod calls;
pub mod double;
mod drawn;
pub mod generate;
pub mod golden;
pub mod judge;
mod law;
pub mod nasty;
pub mod offset;
pub mod paste;
mod patience;
pub mod picture;
pub mod prelude;
mod process;
pub mod radiosity;
pub mod statistics;
mod structure;
pub mod symmetry;
pub mod tree;
pub mod trial;

use raykata::kit::{Kit, StudentKit};
use std::sync::Arc;

pub use broken::{Broken, CheckResult, all_hold};
pub use drawn::Drawn;
pub use judge::{Judged, all_parts, compare, compare_formulas, proven, unless};
/// The points, titles and hints of the checks.
pub use raykata::rubric;
pub use trial::{
    Check, Inputs, ONE_HIDDEN_IN, Trial, Verdict, examine, grade, passes, run, verdict, without_answer,
};

/// The functions of a crate as a kit that checks can call.
pub fn linked(functions: impl StudentKit) -> Arc<dyn Kit + Send + Sync> {
    functions.door()
}

/// Lists the checks of a stage in the crate of that stage, and makes the macro that turns them into tests of a kit:
/// `stage1_checks::tests!(kit)`. A line is `module::check`, and the order is that of the lecture and of the rubric. The requests
/// of a check with `: turned` or `: mirrored` are [turned](crate::symmetry) for hidden seeds. A check with `: composed` compares
/// a text or a picture, and draws its scene by [`Trial::composed`](crate::Trial::composed) for hidden seeds. A check with
/// `=> law(ARGUMENTS)` is the function `law` of its module with these arguments behind the trial.
///
/// The leading `($ crate)` passes a dollar sign and the crate of the stage to the inner macro.
#[macro_export]
macro_rules! stage {
    (@symmetries) => { $crate::symmetry::Symmetries::None };
    (@symmetries turned) => { $crate::symmetry::Symmetries::Turned };
    (@symmetries composed) => { $crate::symmetry::Symmetries::Composed };
    (@symmetries mirrored) => { $crate::symmetry::Symmetries::Mirrored };
    (@law $module:ident $name:ident) => { $module::$name };
    (@law $module:ident $name:ident $law:ident $($argument:expr),*) => { |trial| $module::$law(trial, $($argument),*) };
    (($d:tt $crate_of_stage:tt) $number:literal [
        $($module:ident::$name:ident $(=> $law:ident($($argument:expr),*))? $(: $symmetries:ident)?)*
    ]) => {
        /// The checks of this stage, in the order of the lecture.
        pub const CHECKS: &[$crate::Check] =
            &[$($crate::Check {
                stage: $number,
                name: stringify!($name),
                law: $crate::stage!(@law $module $name $($law $($argument),*)?),
                symmetries: $crate::stage!(@symmetries $($symmetries)?),
            }),*];

        /// The functions that the tests of this stage call.
        pub use $crate::{grade, linked};

        /// One test per check of the stage.
        #[macro_export]
        macro_rules! tests {
            ($d kit:expr) => {
                $(#[test]
                fn $name() {
                    let path = concat!(module_path!(), "::", stringify!($name));
                    $d $crate_of_stage::grade($d $crate_of_stage::CHECKS, path, $d $crate_of_stage::linked($d kit));
                })*
            };
        }
    };
}
