//! Runs the command `race`, as far as nothing has to be built.

use super::program_runs::{printed, raykata};

#[test]
fn a_race_against_a_missing_folder_is_refused_before_anything_is_built() {
    let race = |against: &str| {
        let output = raykata(&["race", "scenes/gamma.toml", "--against", against]);
        assert_eq!(output.status.code(), Some(1), "{}", printed(&output).0);
        printed(&output).1
    };
    assert_eq!(
        race("../missing/exercises"),
        "error: there is no folder ../missing/exercises: `--against` needs a folder of exercises\n"
    );
    assert!(race("scenes").contains("scenes holds no exercises: `--against` needs a folder with src/lib.rs"));
    let few = raykata(&["race", "scenes/gamma.toml", "--rounds", "5"]);
    assert_eq!(few.status.code(), Some(2));
    assert!(printed(&few).1.contains("a whole number from 6 to 10000 is wanted"));
}
