//! `grader`: grades submissions and makes hand-outs. It is the program of instructors.

use grader::kits::root;
use grader::program::{Command, Program, done, exit_code, in_kit};
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
    (&grade::SPEC, |given| in_kit(grade::GradeOptions::read(given), grade::run)),
    #[cfg(target_os = "linux")]
    (&grade::ONE, |given| grade::one(root, &grade::GradeOneOptions::read(given)?)),
    #[cfg(target_os = "linux")]
    (&grade::MERGE, |given| grade::merge(&grade::MergeOptions::read(given)?)),
    (&course::SPEC, |given| done(course::show(&course::file(given)?))),
    (&handout::SPEC, |given| done(in_kit(handout::HandoutOptions::read(given), handout::run))),
    (&release::SPEC, |given| done(in_kit(release::ReleaseOptions::read(given), release::run))),
    #[cfg(target_os = "linux")]
    (&export::GRADESCOPE, |given| {
        done(in_kit(export::ExportOptions::of_gradescope(given), export::gradescope))
    }),
    #[cfg(target_os = "linux")]
    (&export::SLURM, |given| done(in_kit(export::SlurmOptions::read(given), export::slurm))),
    #[cfg(target_os = "linux")]
    (&export::PICTURE, |given| done(in_kit(export::PictureOptions::read(given), export::picture))),
    #[cfg(target_os = "linux")]
    (&export::MOODLE, |given| done(export::platform(&export::PlatformOptions::read(given)?, false))),
    #[cfg(target_os = "linux")]
    (&export::CANVAS, |given| done(export::platform(&export::PlatformOptions::read(given)?, true))),
    #[cfg(target_os = "linux")]
    (&export::CLASSROOM, |given| done(export::classroom(&export::ExportOptions::of_classroom(given)?))),
];

fn main() -> ExitCode {
    grader::program::main(&PROGRAM)
}
