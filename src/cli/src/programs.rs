//! `raykata watch`, `view`, `update` and `figures`: each builds a program of its own and starts it. They are built when they are
//! needed, so that a picture does not wait for that.

use crate::args::{Argument, Given, Opt, Spec};
use crate::kits::{Choice, Need, Program, build, root, run_program};
use crate::list;
use anyhow::{Context, Result, bail};
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

/// `raykata watch`: follows a student's edits.
pub static WATCH: Spec = Spec {
    name: "raykata watch",
    about: "Compile and check your exercises at each save, and show what comes next.",
    arguments: &[list::STAGE],
    options: &[],
};

/// Starts `watch` with the stage of the command line, and returns its exit code.
pub fn watch(given: &Given) -> Result<ExitCode> {
    let stage = list::stage(given)?;
    let root = root()?;
    let [watch, judge] = build(&root, "the judge of your exercises", [Program::WATCH, Program::JUDGE])?;
    let stage = stage.map(|stage| stage.to_string().into());
    run_program(&watch, [OsString::from(root), judge.into()].into_iter().chain(stage))
}

/// `raykata view`: shows a picture in a browser while your exercises render it.
pub static VIEW: Spec = Spec {
    name: "raykata view",
    about: "Show the picture of a scene in a browser while your exercises render it, again at each save.",
    arguments: &[Argument::optional(
        "SCENE",
        "The scene, a TOML file [default: that of the first stage that is not finished].",
    )],
    options: &[],
};

/// Starts `view`, and returns its exit code.
pub fn view(given: &Given) -> Result<ExitCode> {
    let root = root()?;
    let mut words = vec![root.clone()];
    if let Some(scene) = given.argument(0).map(Path::new) {
        // The program watches this file, so its path must not depend on a folder.
        let path = scene.canonicalize();
        words.push(path.with_context(|| format!("the scene {} cannot be read", scene.display()))?);
    }
    let [view] = build(&root, "the page", [Program::VIEW])?;
    run_program(&view, words)
}

/// `raykata update`: brings a student's kit to the version of a new hand-out.
pub static UPDATE: Spec = Spec {
    name: "raykata update",
    about: "Bring your kit to the version of a new hand-out. What you have written stays as it is.",
    arguments: &[Argument::required("FOLDER", "The new hand-out.")],
    options: &[&[Opt::flag("--dry-run", "Only say what would change.")]],
};

/// Starts `update`, and returns its exit code.
pub fn update(given: &Given) -> Result<ExitCode> {
    let folder = Path::new(given.required(0)?);
    let root = root()?;
    if !folder.is_dir() {
        bail!("there is no folder {}: name the folder of the new hand-out", folder.display());
    }
    let [update] = build(&root, "the program that updates", [Program::UPDATE])?;
    let dry_run = given.has("--dry-run").then(|| "--dry-run".into());
    run_program(&update, [OsString::from(root), folder.into()].into_iter().chain(dry_run))
}

/// `raykata figures`: makes the figures of the slides.
pub static FIGURES: Spec = Spec {
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

/// Starts `figures`, and returns its exit code.
pub fn figures(given: &Given) -> Result<ExitCode> {
    let kit = Choice::read(given)?;
    let root = root()?;
    let worker = Program::worker(kit.or_reference(&root), Need::Frames);
    let [figures, worker] = build(&root, "the figures", [Program::FIGURES, worker])?;
    let here = std::env::current_exe().context("the path of this program is unknown")?;
    let what = if given.has("--check") { "check" } else { "make" };
    let deck = given.path("--deck").unwrap_or_default().into_os_string();
    let words = [root.into(), worker.into(), here.into(), OsString::from(what), deck];
    run_program(&figures, words.into_iter().chain(given.arguments(0).iter().cloned()))
}
