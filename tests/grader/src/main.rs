//! `grader`: grades submissions and makes hand-outs. It is the program of instructors.

use grader::program::{Command, Program, exit_code};
use grader::{course, handout, release};
#[cfg(target_os = "linux")]
use grader::{export, grade};
use std::process::ExitCode;

const PROGRAM: Program<bool> = Program {
    name: "grader",
    about: "Grade submissions and make hand-outs. Students run `raykata`, authors `author`.

Exit codes: 0 success; 1 failure, for example a submission could not be graded
or files differ; 2 the command line is wrong.",
    help_explains: "explains a command.",
    commands: COMMANDS,
    groups: &[
        #[cfg(target_os = "linux")]
        (
            "export",
            "Write what Gradescope, GitHub Classroom or Slurm need, or fill the table of Moodle or Canvas.",
        ),
    ],
    without_command: None,
    elsewhere: |_| Ok(String::new()),
    ends: exit_code,
};

const COMMANDS: &[Command] = &[
    #[cfg(target_os = "linux")]
    (&grade::SPEC, grade::run),
    #[cfg(target_os = "linux")]
    (&grade::ONE, grade::one),
    #[cfg(target_os = "linux")]
    (&grade::MERGE, grade::merge),
    (&course::SPEC, course::show),
    (&handout::SPEC, handout::run),
    (&release::SPEC, release::run),
    #[cfg(target_os = "linux")]
    (&export::GRADESCOPE, export::gradescope),
    #[cfg(target_os = "linux")]
    (&export::SLURM, export::slurm),
    #[cfg(target_os = "linux")]
    (&export::PICTURE, export::picture),
    #[cfg(target_os = "linux")]
    (&export::MOODLE, |given| export::platform(given, false)),
    #[cfg(target_os = "linux")]
    (&export::CANVAS, |given| export::platform(given, true)),
    #[cfg(target_os = "linux")]
    (&export::CLASSROOM, export::classroom),
];

fn main() -> ExitCode {
    grader::program::main(&PROGRAM)
}
