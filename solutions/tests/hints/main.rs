//! The third hints of stages 1 to 6 lead to code that passes: functions that contain the code of the hints, and otherwise what
//! a textbook prints, pass every check. The code in the third hints of the bonus of stage 12 is that of the reference.

#![allow(clippy::manual_range_contains)] // books write both comparisons

mod stage1_shapes;
mod stage2_triangles;
mod stage3_boxes;
mod stage3_build {
    pub use crate::textbook_build::*;
    pub use solutions::stage3_build::build;
}
mod stage4_shading;
mod stage5_recursion;
mod stage6_distribution;

/// The textbook, parts of which the modules above replace by the code of the third hints.
macro_rules! textbook {
    ($($name:ident $path:literal)*) => {
        $(
            #[allow(dead_code, unused_imports)]
            #[path = $path]
            mod $name;
        )*
    };
}

textbook! {
    textbook_shapes "../textbook/stage1_shapes.rs"
    textbook_triangles "../textbook/stage2_triangles.rs"
    textbook_boxes "../textbook/stage3_boxes.rs"
    textbook_build "../textbook/stage3_build.rs"
    textbook_shading "../textbook/stage4_shading.rs"
    textbook_recursion "../textbook/stage5_recursion.rs"
    textbook_distribution "../textbook/stage6_distribution.rs"
}

use solutions::*;

// Functions with the code of the hints; those of later stages are the reference's.
raykata::student_kit!(None);

/// Checks, and the code in the third hint of each, which the functions of this test contain.
const HINTS: &str = include_str!("third_hints.txt");

#[test]
fn the_code_of_the_third_hints_passes() {
    let entries = checks::rubric::RUBRIC.values().flat_map(|stage| stage.in_order());
    let entries: std::collections::BTreeMap<_, _> = entries.collect();
    for (name, code) in HINTS.lines().filter_map(|line| line.split_once(": ")) {
        let hint = &entries[name].hints[2];
        assert!(hint.contains(code), "the third hint of `{name}` changed: apply it in this test\n{hint}");
    }
    let kit = checks::linked(Kit);
    for stage in 1..=6 {
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
