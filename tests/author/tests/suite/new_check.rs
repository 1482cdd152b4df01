//! A check that `author new-check` has written compiles, for each function.

use super::program_runs::{leaves_out_what_takes_long, printed, root};
use raykata::kit::Function;
use std::process::Command;

/// The checks are compiled in a hand-out. This takes a minute, so it runs only with `CI_LONG=1`.
#[test]
fn a_new_check_of_any_function_compiles_without_a_warning() {
    if leaves_out_what_takes_long() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let kit = folder.path().join("kit");
    grader::handout::write(&root(), &kit, None).expect("a hand-out");

    // Write a check of each function. A hand-out has no corpus.
    std::fs::create_dir(kit.join("tests/corpus")).expect("a folder");
    for function in Function::ALL {
        let (name, stage) = (format!("{function:?}_is_new"), function.stage().to_string());
        let mut command = Command::new(env!("CARGO_BIN_EXE_author"));
        command.current_dir(&kit).args(["new-check", &name, "--stage", &stage, "--module", "new_checks"]);
        let output =
            command.args(["--function", &format!("{function:?}")]).output().expect("the program starts");
        assert!(output.status.success(), "{name}: {}", printed(&output).1);
    }

    // Compile them.
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(&kit).env("CARGO_TARGET_DIR", kit.join("target")).env("CARGO_NET_OFFLINE", "true");
    cargo.arg("check");
    for stage in 1..=12 {
        cargo.args(["--package", &format!("stage{stage}")]);
    }
    let output = cargo.output().expect("cargo starts");
    let complained = printed(&output).1;
    assert!(output.status.success() && !complained.contains("warning"), "{complained}");
}
