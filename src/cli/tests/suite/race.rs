//! Runs the command `race`, as far as nothing has to be built.

use super::program_runs::complaint;

#[test]
fn a_race_against_a_missing_folder_is_refused_before_anything_is_built() {
    let race = |against: &str| complaint(&format!("race scenes/gamma.toml --against {against}"), 1);
    assert_eq!(
        race("../missing/exercises"),
        "error: there is no folder ../missing/exercises: `--against` needs a folder of exercises\n"
    );
    assert!(race("scenes").contains("scenes holds no exercises: `--against` needs a folder with src/lib.rs"));
    let few = complaint("race scenes/gamma.toml --rounds 5", 2);
    assert!(few.contains("a whole number from 6 to 10000 is wanted"));
}
