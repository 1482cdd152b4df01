//! `raykata`: renders scenes, explains and measures them, checks exercises and gives hints.

use raykata_cli::kits::root;
use raykata_cli::program::{Command, Program, exit_code};
use raykata_cli::{
    compare, cost, doctor, explain, judge, list, merge_picture, programs, race, render, slides, strip, tree,
};
use std::process::ExitCode;

const PROGRAM: Program<ExitCode> = Program {
    name: "raykata",
    about: "Build a ray tracer by making its checks pass. Without a command, it shows your
points and your next step.

You write in exercises/src. `cargo test --test stage1` grades stage 1,
`raykata hint CHECK` gives hints for a check, `raykata render
scenes/stage1.toml` renders a picture.

Exit codes: 0 for success; 1 if checks failed, files differ or a scene cannot
be read; 2 if the command line was not understood.",
    help_explains: "lists the options of a command.",
    commands: &[
        (&render::SPEC, render::run),
        (&merge_picture::SPEC, merge_picture::run),
        (&explain::SPEC, explain::run),
        (&compare::SPEC, compare::run),
        (&cost::SPEC, |given| cost::run(given, None, None).map(exit_code)),
        (&race::SPEC, race::run),
        (&strip::SPEC, strip::run),
        (&tree::SPEC, tree::run),
        (&judge::CHECK, judge::check),
        (&judge::TRY, judge::try_again),
        (&list::LIST, list::run),
        (&list::HINT, list::run_hint),
        (&programs::WATCH, programs::watch),
        (&programs::VIEW, programs::view),
        (&programs::UPDATE, programs::update),
        (&judge::GAUNTLET, judge::gauntlet),
        (&doctor::SPEC, doctor::run),
        (&slides::SPEC, slides::run),
        FIGURES,
    ],
    groups: &[],
    without_command: Some(judge::status),
    elsewhere: |name| Ok(of_other_program(name)),
    ends: |code| code,
};

/// The end of the message about a command that `grader` or `author` has. These programs are mentioned only where they are: a
/// student's repository has none of them.
fn of_other_program(name: &str) -> String {
    let other = match name {
        "handout" | "export" | "merge" | "grade" => "grader",
        "sync" | "corpus" | "gaps" | "generate" => "author",
        _ => return String::new(),
    };
    match root().is_ok_and(|root| root.join("tests").join(other).is_dir()) {
        true => format!("; that is `cargo run -p {other} -- {name}`"),
        false => String::new(),
    }
}

/// The last command. A student's repository has not the reference, by which figures are made.
const FIGURES: Command<ExitCode> = (&programs::FIGURES, programs::figures);

fn main() -> ExitCode {
    let has_figures = root().is_ok_and(|root| root.join("slides/Cargo.toml").is_file());
    let commands = &PROGRAM.commands[..PROGRAM.commands.len() - usize::from(!has_figures)];
    Program { commands, ..PROGRAM }.main()
}
