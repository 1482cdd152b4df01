//! `grader`: grades submissions, makes hand-outs, and tries the checks themselves.

use anyhow::Result;
use clap::{Parser, Subcommand};
use grader::kits::root;
use grader::{cases, corpus, gaps, gauntlet, generate, handout, jail, mutants, sync};
#[cfg(target_os = "linux")]
use grader::{export, grade};
use raykata_cli::args::{Misuse, Read};
use raykata_cli::{cost, report};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// Grade submissions, make hand-outs, and try the checks themselves. Students run `raykata`.
///
/// Exit codes: 0 all went well; 1 something is wrong: a submission could not be graded, files differ; 2 the command
/// line was not understood.
#[derive(Parser)]
#[command(name = "grader", version, verbatim_doc_comment)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Grade a folder of submissions, each in a jail, and write tables and reports (for instructors).
    #[cfg(target_os = "linux")]
    Grade(grade::Options),
    /// Grade one submission for Gradescope or GitHub Classroom (what `export` writes runs this).
    #[cfg(target_os = "linux")]
    GradeOne(grade::OneOptions),
    /// Put together what `grade --shard` has made of the parts of a class (for instructors).
    #[cfg(target_os = "linux")]
    Merge {
        /// The folders of the parts.
        #[arg(required = true)]
        parts: Vec<PathBuf>,
        /// The folder for the grades of the whole class.
        #[arg(long)]
        out: PathBuf,
    },
    /// Make the student's repository: no answers, nothing that only instructors need (for instructors).
    Handout(handout::Options),
    /// Write what Gradescope or GitHub Classroom needs to grade (for instructors).
    #[cfg(target_os = "linux")]
    #[command(subcommand)]
    Export(export::What),
    /// Show what accuracy costs: ways to intersect a triangle against hard inputs, judged exactly.
    Gauntlet(gauntlet::Options),
    /// The same as `raykata cost`, with a chapter about ways to intersect a triangle.
    #[command(disable_help_flag = true)]
    Cost {
        /// As `raykata cost` takes them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
    /// Try the grader on submissions that want what they have not earned (for authors).
    #[cfg(target_os = "linux")]
    Attacks(grade::AttackOptions),
    /// Grade a made-up class whose grades are known, and compare (for authors).
    #[cfg(target_os = "linux")]
    Rehearse(grade::RehearsalOptions),
    /// List the hard cases, and the checks that see to them (for authors).
    Cases,
    /// Make exercises/ from solutions/ (for authors). Keeps what you have begun.
    Sync {
        /// Only say whether anything differs.
        #[arg(long)]
        check: bool,
        /// Overwrite exercises that have been begun.
        #[arg(long, conflicts_with = "check")]
        force: bool,
    },
    /// Try the checks on known mistakes and on other right solutions (for authors).
    Corpus(corpus::Options),
    /// Show what pictures lack while a function is not written, for each function (for authors).
    Gaps(gaps::Options),
    /// Try the checks on changes that cargo-mutants makes to the solutions (for authors).
    Mutants(mutants::Options),
    /// Make the meshes and images of the scenes (for authors).
    Generate {
        /// The folder that has, or will have, meshes/ and images/.
        #[arg(default_value = "scenes")]
        scenes: PathBuf,
    },
}

fn main() -> ExitCode {
    // As a launcher of what is not trusted, or as the syntax check, this program does nothing else.
    jail::launch_if_asked();
    #[cfg(target_os = "linux")]
    grade::lint_if_asked();
    match run(Cli::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(if error.is::<Misuse>() { 2 } else { 1 })
        }
    }
}

/// Whether all went well.
fn run(cli: Cli) -> Result<bool> {
    match cli.command {
        #[cfg(target_os = "linux")]
        Command::Grade(options) => return grade::run(&root()?, &options),
        #[cfg(target_os = "linux")]
        Command::GradeOne(options) => return grade::one(root, &options),
        #[cfg(target_os = "linux")]
        Command::Merge { parts, out } => return grade::merge(&parts, &out),
        Command::Handout(options) => handout::run(&root()?, &options)?,
        #[cfg(target_os = "linux")]
        Command::Export(what) => export::run(&root()?, &what)?,
        Command::Gauntlet(options) => return gauntlet::run(&root()?, &options),
        Command::Cost { arguments } => match cost::SPEC.read(arguments)? {
            Read::Help(help) => report::say(format_args!("{help}")),
            Read::Given(given) => {
                let program = "cargo run --release -p grader --";
                return cost::run(&cost::Options::read(&given)?, program, Some(&gauntlet::summary));
            }
        },
        #[cfg(target_os = "linux")]
        Command::Attacks(options) => return grade::attack(&root()?, &options),
        #[cfg(target_os = "linux")]
        Command::Rehearse(options) => return grade::rehearse(&root()?, &options),
        Command::Cases => cases::list(&root()?)?,
        Command::Sync { check: true, .. } => sync::check(&root()?)?,
        Command::Sync { force, .. } => sync::sync(&root()?, force)?,
        Command::Corpus(options) => return corpus::run(&root()?, &options),
        Command::Gaps(options) => return gaps::run(&options),
        Command::Mutants(options) => return mutants::run(&root()?, &options),
        Command::Generate { scenes } => generate::write(&scenes)?,
    }
    Ok(true)
}
