//! `author`: generates the exercises, and tests the checks and the grader. It is the program of the kit's authors.

use author::{bars, corpus, gaps, gauntlet, generate, sync, weaken};
#[cfg(target_os = "linux")]
use author::{rehearsal, run_attacks};
use grader::program::{Command, Program, exit_code};
use std::process::ExitCode;

const PROGRAM: Program<bool> = Program {
    name: "author",
    about: "Generate the exercises, and test the checks and the grader. Instructors run
`grader`, students `raykata`.

Exit codes: 0 success; 1 failure, for example a submission could not be graded
or files differ; 2 the command line is wrong.",
    help_explains: "explains a command.",
    commands: COMMANDS,
    groups: &[],
    without_command: None,
    elsewhere: |_| Ok(String::new()),
    ends: exit_code,
};

const COMMANDS: &[Command] = &[
    (&sync::SPEC, sync::run),
    (&corpus::SPEC, corpus::run),
    (&gaps::SPEC, gaps::run),
    (&weaken::SPEC, weaken::run),
    #[cfg(target_os = "linux")]
    (&run_attacks::SPEC, run_attacks::run),
    #[cfg(target_os = "linux")]
    (&rehearsal::SPEC, rehearsal::run),
    (&gauntlet::SPEC, gauntlet::run),
    (&gauntlet::COST, gauntlet::cost),
    (&bars::SPEC, bars::run),
    (&generate::SPEC, generate::run),
];

fn main() -> ExitCode {
    grader::program::main(&PROGRAM)
}
