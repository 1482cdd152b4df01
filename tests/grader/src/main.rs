//! `raykata`: renders scenes, checks exercises, gives hints, and grades.

use anyhow::Result;
use clap::{Parser, Subcommand};
use grader::kits::{Choice, Source, Which, root};
#[cfg(feature = "author")]
use grader::{cases, corpus, gaps, gauntlet, generate, handout, jail, mutants, sync};
use grader::{check, compare, cost, explain, render, strip, tree};
#[cfg(feature = "author")]
#[cfg(target_os = "linux")]
use grader::{export, grade};
#[cfg(feature = "author")]
use std::path::PathBuf;
use std::process::ExitCode;

/// Build a ray tracer by making its tests pass. Without a command: where you stand and what comes next.
///
/// You write in exercises/src. `cargo test --test stage1` grades stage 1, `raykata hint CHECK` helps where you are
/// stuck, `raykata render scenes/stage1.toml` makes a picture.
///
/// Exit codes: 0 all went well; 1 something is wrong: checks failed, files differ, a scene cannot be read; 2 the
/// command line was not understood.
#[derive(Parser)]
#[command(name = "raykata", version, verbatim_doc_comment)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Render a scene to a picture.
    Render(render::Options),
    /// Say what a scene calls for, why, what it costs, and what is left out.
    Explain(explain::Options),
    /// Compare the structures that find what rays meet, side by side on one scene.
    Compare(compare::Options),
    /// Show which knob buys how much accuracy for how much time, and propose the best settings for a time or an error.
    Cost(cost::Options),
    /// Render a scene at growing depths of recursion, or with each sampler, side by side.
    Strip(strip::Options),
    /// Show the rays behind one pixel, for the first of its samples.
    Tree(tree::Options),
    /// Show what accuracy costs: ways to intersect a triangle against hard inputs, judged exactly.
    #[cfg(feature = "author")]
    Gauntlet(gauntlet::Options),
    /// Grade your exercises and print the scorecard.
    Check {
        /// One stage only.
        stage: Option<u8>,
        #[command(flatten)]
        kit: Choice,
    },
    /// Grade a folder of submissions, each in a jail, and write tables and reports (for instructors).
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    Grade(grade::Options),
    /// Grade one submission for Gradescope or GitHub Classroom (what `export` writes runs this).
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    GradeOne(grade::OneOptions),
    /// Put together what `grade --shard` has made of the parts of a class (for instructors).
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    Merge {
        /// The folders of the parts.
        #[arg(required = true)]
        parts: Vec<PathBuf>,
        /// The folder for the grades of the whole class.
        #[arg(long)]
        out: PathBuf,
    },
    /// Try the grader on submissions that want what they have not earned (for authors).
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    Attacks(grade::AttackOptions),
    /// Grade a made-up class whose grades are known, and compare (for authors).
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    Rehearse(grade::RehearsalOptions),
    /// List all checks with their points.
    List {
        /// The hard cases instead, and the checks that see to them.
        #[cfg(feature = "author")]
        #[arg(long)]
        cases: bool,
    },
    /// Get a hint for a check.
    Hint {
        /// Its name, as `list` and failing tests print it.
        check: String,
        /// 1 is a nudge, 3 nearly the answer.
        #[arg(default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=3))]
        level: u8,
    },
    /// Make the student's repository: no answers, nothing that only instructors need (for instructors).
    #[cfg(feature = "author")]
    Handout(handout::Options),
    /// Write what Gradescope or GitHub Classroom needs to grade (for instructors).
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    #[command(subcommand)]
    Export(export::What),
    /// Make exercises/ from solutions/ (for authors). Keeps what you have begun.
    #[cfg(feature = "author")]
    Sync {
        /// Only say whether anything differs.
        #[arg(long)]
        check: bool,
        /// Overwrite exercises that have been begun.
        #[arg(long, conflicts_with = "check")]
        force: bool,
    },
    /// Try the checks on known mistakes and on other right solutions (for authors).
    #[cfg(feature = "author")]
    Corpus(corpus::Options),
    /// Show what pictures lack while a function is not written, for each function (for authors).
    #[cfg(feature = "author")]
    Gaps(gaps::Options),
    /// Try the checks on changes that cargo-mutants makes to the solutions (for authors).
    #[cfg(feature = "author")]
    Mutants(mutants::Options),
    /// Make the meshes and images of the scenes (for authors).
    #[cfg(feature = "author")]
    Generate {
        /// The folder that has, or will have, meshes/ and images/.
        #[arg(default_value = "scenes")]
        scenes: PathBuf,
    },
}

fn main() -> ExitCode {
    // As a launcher of what is not trusted, or as the syntax check, this program does nothing else.
    #[cfg(feature = "author")]
    jail::launch_if_asked();
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    grade::lint_if_asked();
    let cli = Cli::parse();
    match run(cli) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(1)
        }
    }
}

/// Whether all went well.
fn run(cli: Cli) -> Result<bool> {
    match cli.command {
        None => check::status(&Source::prepare(Which::Exercises, &root()?)?)?,
        Some(Command::Render(options)) => render::run(&options)?,
        Some(Command::Explain(options)) => explain::run(&options)?,
        Some(Command::Compare(options)) => return compare::run(&options),
        Some(Command::Cost(options)) => return cost::run(&options),
        #[cfg(feature = "author")]
        Some(Command::Gauntlet(options)) => return gauntlet::run(&options),
        Some(Command::Strip(options)) => strip::run(&options)?,
        Some(Command::Tree(options)) => tree::run(&options)?,
        Some(Command::Check { stage, kit }) => {
            return check::scorecard(&Source::prepare(kit.or_exercises(), &root()?)?, stage);
        }
        #[cfg(feature = "author")]
        #[cfg(target_os = "linux")]
        Some(Command::Grade(options)) => return grade::run(&root()?, &options),
        #[cfg(feature = "author")]
        #[cfg(target_os = "linux")]
        Some(Command::GradeOne(options)) => return grade::one(root, &options),
        #[cfg(feature = "author")]
        #[cfg(target_os = "linux")]
        Some(Command::Attacks(options)) => return grade::attack(&root()?, &options),
        #[cfg(feature = "author")]
        #[cfg(target_os = "linux")]
        Some(Command::Rehearse(options)) => return grade::rehearse(&root()?, &options),
        #[cfg(feature = "author")]
        #[cfg(target_os = "linux")]
        Some(Command::Merge { parts, out }) => return grade::merge(&parts, &out),
        #[cfg(feature = "author")]
        Some(Command::List { cases: true }) => cases::list(&root()?)?,
        Some(Command::List { .. }) => check::list(),
        Some(Command::Hint { check, level }) => check::hint(&check, usize::from(level))?,
        #[cfg(feature = "author")]
        Some(Command::Handout(options)) => handout::run(&root()?, &options)?,
        #[cfg(feature = "author")]
        #[cfg(target_os = "linux")]
        Some(Command::Export(what)) => export::run(&root()?, &what)?,
        #[cfg(feature = "author")]
        Some(Command::Sync { check: true, .. }) => sync::check(&root()?)?,
        #[cfg(feature = "author")]
        Some(Command::Sync { force, .. }) => sync::sync(&root()?, force)?,
        #[cfg(feature = "author")]
        Some(Command::Corpus(options)) => return corpus::run(&root()?, &options),
        #[cfg(feature = "author")]
        Some(Command::Gaps(options)) => return gaps::run(&options),
        #[cfg(feature = "author")]
        Some(Command::Mutants(options)) => return mutants::run(&root()?, &options),
        #[cfg(feature = "author")]
        Some(Command::Generate { scenes }) => generate::write(&scenes)?,
    }
    Ok(true)
}
