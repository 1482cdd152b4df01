//! Every command has a help text, and a wrong command line ends the program with code 2.
use super::program_runs::{does_not_understand, explains, said};

/// The commands with their arguments and options.
const COMMANDS: [(&str, &str); 10] = [
    ("grade", "SUBMISSIONS --out --jobs --shard --resume --stages --seed --allow --insecure"),
    ("grade-one", "SUBMISSION --gradescope --classroom --stages --seed --allow --insecure"),
    ("merge", "PART... --out"),
    ("handout", "FOLDER --title --stages"),
    ("export gradescope", "--out --stages --seed autograder.zip"),
    ("export slurm", "SUBMISSIONS --out --chunk --stages --seed"),
    ("export slurm-picture", "SCENE --out --pieces --seed --size --tone"),
    ("export moodle", "TABLE GRADES --out --column --stages --scale"),
    ("export canvas", "TABLE GRADES --out --column --stages --scale"),
    ("export classroom", "--out --stages --seed --parts"),
];

const PROGRAM: &str = env!("CARGO_BIN_EXE_grader");

#[test]
fn every_command_is_explained() {
    explains(PROGRAM, "grader", &COMMANDS);
    let (code, export, _) = said(PROGRAM, "export --help");
    assert!(
        code == Some(0) && export.contains("\n  gradescope ") && export.contains("\n  classroom "),
        "{export}"
    );
    assert_eq!(said(PROGRAM, "export help classroom").1, said(PROGRAM, "export classroom --help").1);
}

#[test]
fn what_is_not_understood_ends_with_2() {
    let lines = [
        ("", "a command is missing"),
        ("exprot", "there is no command `exprot`; did you mean `export`?"),
        ("export", "the commands are gradescope, slurm, slurm-picture, moodle, canvas, classroom"),
        ("export classroom --out a --parts 257", "a whole number from 1 to 256"),
        ("export slurm --out a", "SUBMISSIONS is missing"),
        ("export slurm-picture a.toml --out a --sed 1", "did you mean `--seed`?"),
        ("export gradescop", "did you mean `gradescope`?"),
        ("export classroom", "`--out` is missing"),
        ("export gradescope --stages 13", "there is no stage 13"),
        ("grade class", "`--out` is missing"),
        ("grade --out grades", "SUBMISSIONS is missing"),
        ("grade class --out grades --shard 1/2", "`--shard` needs `--seed`"),
        ("grade class --out grades --shard 3/2 --seed 1", "parts are counted from 1"),
        ("grade class --out grades --jobs 0", "a whole number from 1 to 65535"),
        ("grade-one submission", "at least one of `--gradescope FILE` and `--classroom FILE`"),
        ("merge --out grades", "PART is missing"),
        ("merge part", "`--out` is missing"),
        ("handout", "FOLDER is missing"),
    ];
    does_not_understand(PROGRAM, &lines);
}
