//! `raykata figures`: starts the program that makes the figures of the slides. It is built when it is needed.

use crate::args::{Argument, Given, Misuse, Opt, Spec};
use crate::kits::{Choice, Need, Program, build, root};
use anyhow::{Context, Result, bail};
use std::process::{Command, ExitCode};

/// `raykata figures`.
pub static SPEC: Spec = Spec {
    name: "raykata figures",
    about: "Make the figures of the slides, as slides/figures.toml lists them.",
    arguments: &[Argument::optional("NAME", "The figures to make, without the ending [default: all].").many()],
    options: &[
        &[
            Opt::flag("--check", "Make them again and compare: pixels, counts and drawings, but no times."),
            Opt::value("--deck", "NAME", "Only the figures of this deck, such as stage03."),
        ],
        Choice::OPTIONS,
    ],
};

/// Which figures are made.
pub struct Options {
    /// The words for the program that makes them: `check` or `make`, the deck or nothing, the names.
    words: Vec<String>,
    kit: Choice,
}

impl Options {
    /// Reads the arguments and options.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        let what = if given.has("--check") { "check" } else { "make" };
        let deck = given.path("--deck").map_or(String::new(), |deck| deck.to_string_lossy().into_owned());
        let names = given.arguments(0).iter().map(|name| name.to_string_lossy().into_owned());
        Ok(Options {
            words: [what.to_owned(), deck].into_iter().chain(names).collect(),
            kit: Choice::read(given)?,
        })
    }
}

/// Builds the program and runs it; returns its exit code.
pub fn run(options: &Options) -> Result<ExitCode> {
    let root = root()?;
    if !root.join("slides/Cargo.toml").is_file() {
        bail!("there are no slides in {}", root.display());
    }
    let worker = Program::worker(options.kit.or_reference(&root), Need::Frames);
    let programs = build(&root, "the figures", &[Program::FIGURES, worker])?;
    let [figures, worker] = &programs[..] else { bail!("the program for figures was not built") };
    let here = std::env::current_exe().context("the path of this program is unknown")?;
    let status = Command::new(figures).arg(&root).arg(worker).arg(here).args(&options.words).status();
    let status = status.with_context(|| format!("{} cannot be started", figures.display()))?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(ExitCode::from(code.unwrap_or(1)))
}
