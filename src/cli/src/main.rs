//! `raykata`: renders scenes, explains and measures them, checks exercises and gives hints.

use anyhow::Result;
use raykata_cli::args::{Given, Misuse, Read, Spec, did_you_mean, entry, whole_number};
use raykata_cli::kits::{Choice, Which, root};
use raykata_cli::report::say;
use raykata_cli::{
    compare, cost, doctor, explain, figures, judge, list, merge_picture, race, render, slides, strip, tree,
    update, view, watch,
};
use std::ffi::OsString;
use std::process::ExitCode;

/// A command, and the function that runs it.
type Command = (&'static Spec, fn(&Given) -> Result<ExitCode>);

/// All commands, in the order of the help.
const COMMANDS: [Command; 18] = [
    (&render::SPEC, |given| render::run(&render::Options::read(given)?).map(|()| ExitCode::SUCCESS)),
    (&merge_picture::SPEC, |given| {
        merge_picture::run(&merge_picture::Options::read(given)?).map(|()| ExitCode::SUCCESS)
    }),
    (&explain::SPEC, |given| explain::run(&explain::Options::read(given)?).map(|()| ExitCode::SUCCESS)),
    (&compare::SPEC, |given| compare::run(&compare::Options::read(given)?).map(ended)),
    (&cost::SPEC, |given| cost::run(&cost::Options::read(given)?, "cargo run --release --", None).map(ended)),
    (&race::SPEC, |given| race::run(&race::Options::read(given)?).map(ended)),
    (&strip::SPEC, |given| strip::run(&strip::Options::read(given)?).map(|()| ExitCode::SUCCESS)),
    (&tree::SPEC, |given| tree::run(&tree::Options::read(given)?).map(|()| ExitCode::SUCCESS)),
    (&list::CHECK, check),
    (&list::LIST, |given| {
        say(format_args!("{}", list::list(list::stage(given)?)));
        Ok(ExitCode::SUCCESS)
    }),
    (&list::HINT, hint),
    (&watch::SPEC, watch::run),
    (&view::SPEC, view::run),
    (&update::SPEC, update::run),
    (&list::GAUNTLET, gauntlet),
    (&figures::SPEC, |given| figures::run(&figures::Options::read(given)?)),
    (&doctor::SPEC, |_| Ok(ended(doctor::run()))),
    (&slides::SPEC, |given| slides::run(&slides::Options::read(given)?).map(|()| ExitCode::SUCCESS)),
];

fn main() -> ExitCode {
    match run(std::env::args_os().skip(1).collect()) {
        Ok(code) => code,
        Err(error) if error.is::<Misuse>() => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(1)
        }
    }
}

fn run(words: Vec<OsString>) -> Result<ExitCode> {
    let Some((first, rest)) = words.split_first() else { return start_page() };
    let first = first.to_string_lossy();
    match (&*first, rest) {
        ("--help" | "-h", _) | ("help", []) => say(format_args!("{}", help())),
        ("--version" | "-V", _) => say(format_args!("raykata {}\n", env!("CARGO_PKG_VERSION"))),
        ("help", [command, ..]) => {
            say(format_args!("{}", find(&command.to_string_lossy())?.0.help()));
        }
        (name, rest) => {
            let (spec, work) = find(name)?;
            match spec.read(rest.iter().cloned())? {
                Read::Help(help) => say(format_args!("{help}")),
                Read::Given(given) => return work(&given),
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn word(spec: &Spec) -> &'static str {
    spec.name.trim_start_matches("raykata ")
}

fn find(name: &str) -> Result<&'static Command, Misuse> {
    const { &COMMANDS }.iter().find(|(spec, _)| word(spec) == name).ok_or_else(|| {
        let known: Vec<&str> = COMMANDS.iter().map(|(spec, _)| word(spec)).collect();
        let other = match name {
            "handout" | "export" | "merge" | "grade" => "grader",
            "sync" | "corpus" | "gaps" | "mutants" | "generate" => "author",
            _ => "",
        };
        // Mention these programs only where they are: a student's repository has none of them.
        let other =
            match !other.is_empty() && root().is_ok_and(|root| root.join("tests").join(other).is_dir()) {
                true => format!("; that is `cargo run -p {other} -- {name}`"),
                false => String::new(),
            };
        Misuse::new(format!(
            "there is no command `{name}`{}{other}\n\nUsage: raykata [COMMAND]\n\nFor more information, try \
             `raykata --help`.",
            did_you_mean(name, &known)
        ))
    })
}

fn help() -> String {
    let commands: String = COMMANDS.iter().map(|(spec, _)| entry(word(spec), spec.about)).collect();
    format!(
        "Build a ray tracer by making its checks pass. Without a command, it shows your
points and your next step.

You write in exercises/src. `cargo test --test stage1` grades stage 1,
`raykata hint CHECK` gives hints for a check, `raykata render
scenes/stage1.toml` renders a picture.

Exit codes: 0 for success; 1 if checks failed, files differ or a scene cannot
be read; 2 if the command line was not understood.

Usage: raykata [COMMAND]

Commands:
{commands}
Options:
{}{}
`raykata COMMAND --help` lists the options of a command.
",
        entry("-h, --help", "Print this help."),
        entry("-V, --version", "Print the version.")
    )
}

fn ended(well: bool) -> ExitCode {
    if well { ExitCode::SUCCESS } else { ExitCode::from(1) }
}

fn start_page() -> Result<ExitCode> {
    judge::judge::<&str>(&root()?, "status", Which::Exercises, &[])
}

fn check(given: &Given) -> Result<ExitCode> {
    let which = Choice::read(given)?.or_exercises();
    if let Some(pixel) = given.path("--pixel") {
        let check = given.required(0).map_err(|_| {
            Misuse::new("`--pixel` needs the name of a check, as in `raykata check CHECK --pixel 12,7`")
        })?;
        return judge::judge(&root()?, "pixel", which, &[check, pixel.as_os_str()]);
    }
    let stage = list::stage(given)?.map(|stage| stage.to_string());
    judge::judge(&root()?, "check", which, stage.as_slice())
}

fn hint(given: &Given) -> Result<ExitCode> {
    let level = given.parsed_argument(1, |text| whole_number(text, &(1..=3)))?.unwrap_or(1);
    let text = list::hint(&given.required(0)?.to_string_lossy(), level)?;
    say(format_args!("{text}"));
    Ok(ExitCode::SUCCESS)
}

fn gauntlet(given: &Given) -> Result<ExitCode> {
    let inputs = given.number("--inputs", 100..=u64::MAX)?.unwrap_or(20_000).to_string();
    let seed = given.number("--seed", 0..=u64::MAX)?.unwrap_or(1).to_string();
    let root = root()?;
    let which = Choice::read(given)?.or_exercises();
    judge::judge(&root, "gauntlet", which, &[inputs, seed])
}
