//! The program that `raykata watch` starts: `watch ROOT [STAGE]`. It compiles the exercises and runs the checks of a stage
//! whenever a file of the student changes.
//!
//! `run` (one run, which a save cancels) · `course` (stages, checks and verdicts) · `app` (what keys and events do) · `screen` (the text of the screen) · `pixels` (pictures
//! in half blocks) · `terminal` (draws, and reads keys) · `plain` (lines, without a terminal) · `editor` · `reset` (one
//! function as it was before it was written)

mod app;
mod course;
mod editor;
mod pixels;
mod plain;
mod reset;
mod run;
mod screen;
mod terminal;

use anyhow::{Context, Result, bail};
use raykata_cli::program::ended;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    ended(watch().map(|()| true))
}

fn watch() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (root, stage): (PathBuf, Option<u8>) = match words[..] {
        [root] => (root.into(), None),
        [root, stage] => (root.into(), Some(stage.parse().context("the stage is no number")?)),
        _ => bail!("`raykata watch` starts this program. It is not started by hand"),
    };
    let screen = std::io::stdout().is_terminal() && std::io::stdin().is_terminal();
    let dumb = std::env::var_os("TERM").is_some_and(|name| name == "dumb");
    if screen && !dumb { terminal::watch(&root, stage) } else { plain::watch(&root, stage) }
}
