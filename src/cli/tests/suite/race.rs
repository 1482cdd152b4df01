//! Runs the command `race`, as far as nothing has to be built.

use super::program_runs::{complaint, printed, root};
use std::process::Command;

#[test]
fn a_race_against_a_missing_folder_is_refused_before_anything_is_built() {
    let race = |against: &str| complaint(&format!("race scenes/gamma.toml --against {against}"), 1);
    assert_eq!(
        race("../missing/exercises"),
        "error: there is no folder ../missing/exercises: `--against` needs a folder of exercises\n"
    );
    assert!(race("scenes").contains("scenes holds no exercises: `--against` needs a folder with src/lib.rs"));
    // A hand-out has no reference.
    let folder = tempfile::tempdir().expect("a folder");
    for (file, text) in [("exercises/Cargo.toml", ""), ("tests/course.toml", "")] {
        let file = folder.path().join(file);
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("written");
        std::fs::write(file, text).expect("written");
    }
    let scene = root().join("scenes/gamma.toml");
    let mut program = Command::new(env!("CARGO_BIN_EXE_raykata"));
    let refused = program.current_dir(&folder).arg("race").arg(scene).output().expect("the program starts");
    let (_, refused) = printed(&refused);
    assert!(
        refused.starts_with("error: there are no solutions in ") && refused.lines().count() == 1,
        "{refused}"
    );
    assert!(
        refused.ends_with("another folder of exercises, as in `--against ../other/exercises`\n"),
        "{refused}"
    );
    let few = complaint("race scenes/gamma.toml --rounds 5", 2);
    assert!(few.contains("a whole number from 6 to 10000 is wanted"));
}
