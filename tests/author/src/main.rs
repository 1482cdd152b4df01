//! `author`: generates the exercises, and tests the checks and the grader. It is the program of the kit's authors.

use author::{bars, corpus, gaps, gauntlet, generate, sync, weaken};
#[cfg(target_os = "linux")]
use author::{rehearsal, run_attacks};
use grader::kits::root;
use grader::program::{Command, Program, done, exit_code, in_kit};
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
    (&sync::SPEC, |given| done(in_kit(sync::SyncOptions::read(given), sync::run))),
    (&corpus::SPEC, |given| in_kit(corpus::CorpusOptions::read(given), corpus::run)),
    (&gaps::SPEC, |given| gaps::run(&gaps::GapsOptions::read(given)?)),
    (&weaken::SPEC, |given| in_kit(weaken::WeakenOptions::read(given), weaken::run)),
    #[cfg(target_os = "linux")]
    (&run_attacks::SPEC, |given| run_attacks::run(&root()?, &run_attacks::AttacksOptions::read(given)?)),
    #[cfg(target_os = "linux")]
    (&rehearsal::SPEC, |given| in_kit(rehearsal::RehearsalOptions::read(given), rehearsal::run)),
    (&gauntlet::SPEC, |given| done(in_kit(gauntlet::GauntletOptions::read(given), gauntlet::run))),
    (&gauntlet::COST, gauntlet::cost),
    (&bars::SPEC, |given| done(in_kit(bars::BarsOptions::read(given), bars::run))),
    (&generate::SPEC, |given| done(generate::write(&generate::folder(given)))),
];

fn main() -> ExitCode {
    grader::program::main(&PROGRAM)
}
