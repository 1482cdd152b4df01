//! Every command has a help text, and a wrong command line ends the program with code 2.
use super::program_runs::{does_not_understand, explains};
use std::process::Command;

/// The commands with their arguments and options.
const COMMANDS: [(&str, &str); 9] = [
    ("gauntlet", "--kit --inputs --seed --out 20000"),
    ("cost", "[SCENE] --headline --rounds --set"),
    ("attacks", "[NAME]... --shard"),
    ("rehearse", "--students --out --jobs --honest 200"),
    ("sync", "--check --force"),
    ("corpus", "[NAME]... --stage --function --check --saying --run --bless --reword --seed"),
    ("weaken", "--sample --seed --file --resume"),
    ("gaps", "--check --bless"),
    ("generate", "[SCENES]"),
];

const PROGRAM: &str = env!("CARGO_BIN_EXE_author");

#[test]
fn every_command_is_explained() {
    explains(PROGRAM, "author", &COMMANDS);
}

#[test]
fn what_is_not_understood_ends_with_2() {
    let lines = [
        ("corpsu", "there is no command `corpsu`; did you mean `corpus`?"),
        ("corpus --chekc", "unexpected option `--chekc`; did you mean `--check`?"),
        ("corpus --bless --reword", "`--bless` cannot be used with `--reword`"),
        ("corpus --seed 1 --bless", "`--seed` cannot be used with `--bless`"),
        ("corpus --stage 256", "a whole number from 0 to 255"),
        ("gaps --check --bless", "cannot be used with"),
        ("sync --check --force", "cannot be used with"),
        ("gauntlet --inputs 99", "from 100 to"),
        ("gauntlet --kit solution", "did you mean `solutions`?"),
        ("sync all", "unexpected argument `all`"),
        ("rehearse --jobs 0", "a whole number from 1 to 65535"),
    ];
    does_not_understand(PROGRAM, &lines);
}

/// The command line is checked first, so its errors are the same in every working folder.
#[test]
fn outside_of_a_kit_the_same_is_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new(PROGRAM)
        .current_dir(folder.path())
        .args(["sync", "--check", "--force"])
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
}
