//! `grader`: grades submissions, makes hand-outs, and tests the checks themselves.

use anyhow::Result;
use grader::kits::root;
use grader::{
    bars, cases, corpus, course, gaps, gauntlet, generate, handout, mutants, new_check, release, sandbox,
    sync, weaken,
};
#[cfg(target_os = "linux")]
use grader::{export, grade};
use raykata_cli::args::{Given, Misuse, Read, Spec, did_you_mean, entry};
use raykata_cli::cost;
use raykata_cli::report::say;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

/// A command and its function, which returns whether it succeeded.
type Command = (&'static Spec, fn(&Given) -> Result<bool>);

/// All commands, in the order of the help. A name of two words is a subcommand or a command in a group.
const COMMANDS: &[Command] = &[
    #[cfg(target_os = "linux")]
    (&grade::SPEC, |given| in_kit(grade::Options::read(given), grade::run)),
    #[cfg(target_os = "linux")]
    (&grade::ONE, |given| grade::one(root, &grade::OneOptions::read(given)?)),
    #[cfg(target_os = "linux")]
    (&grade::MERGE, |given| grade::merge(&grade::MergeOptions::read(given)?)),
    (&course::SPEC, |given| done(course::show(&course::file(given)?))),
    (&handout::SPEC, |given| done(in_kit(handout::Options::read(given), handout::run))),
    (&release::SPEC, |given| done(in_kit(release::Options::read(given), release::run))),
    #[cfg(target_os = "linux")]
    (&export::GRADESCOPE, |given| done(in_kit(export::Options::of_gradescope(given), export::gradescope))),
    #[cfg(target_os = "linux")]
    (&export::SLURM, |given| done(in_kit(export::SlurmOptions::read(given), export::slurm))),
    #[cfg(target_os = "linux")]
    (&export::PICTURE, |given| done(in_kit(export::PictureOptions::read(given), export::picture))),
    #[cfg(target_os = "linux")]
    (&export::CLASSROOM, |given| done(export::classroom(&export::Options::of_classroom(given)?))),
    (&gauntlet::SPEC, |given| done(in_kit(gauntlet::Options::read(given), gauntlet::run))),
    (&gauntlet::COST, |given| gauntlet::cost(&cost::Options::read(given)?)),
    #[cfg(target_os = "linux")]
    (&grade::ATTACKS, |given| grade::attack(&root()?, &grade::AttackOptions::read(given)?)),
    #[cfg(target_os = "linux")]
    (&grade::REHEARSE, |given| in_kit(grade::RehearsalOptions::read(given), grade::rehearse)),
    (&cases::SPEC, |_| done(cases::list(&root()?))),
    (&sync::SPEC, |given| done(in_kit(sync::Options::read(given), sync::run))),
    (&new_check::SPEC, |given| in_kit(new_check::Options::read(given), new_check::run)),
    (&bars::SPEC, |given| done(in_kit(bars::Options::read(given), bars::run))),
    (&corpus::SPEC, |given| in_kit(corpus::Options::read(given), corpus::run)),
    (&corpus::import::SPEC, |given| in_kit(corpus::import::Options::read(given), corpus::import::run)),
    (&gaps::SPEC, |given| gaps::run(&gaps::Options::read(given)?)),
    (&weaken::SPEC, |given| in_kit(weaken::Options::read(given), weaken::run)),
    (&mutants::SPEC, |given| in_kit(mutants::Options::read(given), mutants::run)),
    (&generate::SPEC, |given| done(generate::write(&generate::folder(given)))),
];

/// Groups: words that begin the names of commands but are not commands themselves, with descriptions.
const GROUPS: &[(&str, &str)] = &[
    #[cfg(target_os = "linux")]
    ("export", "Write the files with which Gradescope, GitHub Classroom or Slurm grade (for instructors)."),
];

fn main() -> ExitCode {
    // If this process was started as a launcher of untrusted code or as the syntax check, it does only that.
    sandbox::launch_if_asked();
    #[cfg(target_os = "linux")]
    grade::lint_if_asked();
    match run(std::env::args_os().skip(1).collect()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(if error.is::<Misuse>() { 2 } else { 1 })
        }
    }
}

/// Runs a command in the kit around the working folder. Errors of the command line are reported first, even outside of a
/// kit.
fn in_kit<T, R>(options: Result<T, Misuse>, work: impl FnOnce(&Path, &T) -> Result<R>) -> Result<R> {
    let options = options?;
    work(&root()?, &options)
}

fn done(result: Result<()>) -> Result<bool> {
    result.map(|()| true)
}

/// Runs the command line. Returns whether the command succeeded.
fn run(words: Vec<OsString>) -> Result<bool> {
    let Some((first, rest)) = words.split_first() else {
        return Err(Misuse::new(format!("a command is missing\n\n{}", help().trim_end())).into());
    };
    let asks_for_help = |word: &OsString| ["help", "--help", "-h"].iter().any(|help| word == help);
    match (&*first.to_string_lossy(), rest) {
        ("--help" | "-h", _) | ("help", []) => say(format_args!("{}", help())),
        ("--version" | "-V", _) => say(format_args!("grader {}\n", env!("CARGO_PKG_VERSION"))),
        ("help", words) => say(format_args!("{}", help_for(words)?)),
        (name, [second, rest @ ..]) if asks_for_help(second) && has_commands(name) => {
            let words: Vec<OsString> = [first].into_iter().chain(rest).cloned().collect();
            say(format_args!("{}", help_for(&words)?));
        }
        _ => {
            let ((spec, work), rest) = find(&words)?;
            match spec.read(rest.iter().cloned())? {
                Read::Help(help) => say(format_args!("{help}")),
                Read::Given(given) => return work(&given),
            }
        }
    }
    Ok(true)
}

/// Returns the words that start a command, without the name of the program.
fn words_of(spec: &Spec) -> &'static str {
    spec.name.trim_start_matches("grader ")
}

/// Returns the subcommands of this command, with their second words.
fn below(name: &str) -> impl Iterator<Item = (&'static str, &'static Command)> {
    let second = move |command: &'static Command| {
        let (first, second) = words_of(command.0).split_once(' ')?;
        (first == name).then_some((second, command))
    };
    COMMANDS.iter().filter_map(second)
}

fn has_commands(name: &str) -> bool {
    below(name).next().is_some()
}

/// Returns the command with which a line begins, and the rest of the line.
fn find(line: &[OsString]) -> Result<(&'static Command, &[OsString]), Misuse> {
    let word = |place: usize| line.get(place).map_or("".into(), |word| word.to_string_lossy());
    let (first, second) = (word(0), word(1));
    if let Some((_, command)) = below(&first).find(|(name, _)| *name == second) {
        return Ok((command, &line[2..]));
    }
    if let Some(command) = COMMANDS.iter().find(|(spec, _)| words_of(spec) == first) {
        return Ok((command, &line[1..]));
    }
    let (usage, unknown, known): (String, _, Vec<&str>) = if has_commands(&first) {
        (format!("grader {first}"), second, below(&first).map(|(name, _)| name).collect())
    } else {
        let groups = GROUPS.iter().map(|(name, _)| *name);
        ("grader".into(), first, COMMANDS.iter().map(|(spec, _)| words_of(spec)).chain(groups).collect())
    };
    let wrong = match unknown.is_empty() {
        true => format!("a command is missing; the commands are {}", known.join(", ")),
        false => format!("there is no command `{unknown}`{}", did_you_mean(&unknown, &known)),
    };
    Err(Misuse::new(format!(
        "{wrong}\n\nUsage: {usage} COMMAND\n\nFor more information, try `{usage} --help`."
    )))
}

/// Returns the help of a command or of a group.
fn help_for(words: &[OsString]) -> Result<String, Misuse> {
    let first = words.first().map_or("".into(), |word| word.to_string_lossy());
    let group = GROUPS.iter().find(|(name, _)| *name == first && words.len() == 1);
    let text = match group {
        Some((name, about)) => format!("{about}\n\nUsage: grader {name} COMMAND\n"),
        None => find(words)?.0.0.help(),
    };
    let commands: String = match words.len() {
        1 => below(&first).map(|(name, (spec, _))| entry(name, spec.about)).collect(),
        _ => String::new(),
    };
    Ok(if commands.is_empty() { text } else { format!("{text}\nCommands:\n{commands}") })
}

fn help() -> String {
    let commands: String = COMMANDS.iter().map(|(spec, _)| entry(words_of(spec), spec.about)).collect();
    format!(
        "Grade submissions, make hand-outs, and test the checks themselves. Students run
`raykata`.

Exit codes: 0 success; 1 failure, for example a submission could not be graded
or files differ; 2 the command line is wrong.

Usage: grader COMMAND

Commands:
{commands}
Options:
{}{}
`grader COMMAND --help` explains a command.
",
        entry("-h, --help", "Print this help."),
        entry("-V, --version", "Print the version.")
    )
}
