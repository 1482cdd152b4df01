//! The program that `raykata watch` starts: `watch ROOT JUDGE [STAGE]`. It compiles the exercises and runs the checks of a stage
//! whenever a file of the student changes.
//!
//! `run` (one run, which a save cancels) · `app` (what keys and events do) · `screen` (the text of the screen) · `terminal`
//! (draws, and reads keys) · `plain` (lines, without a terminal) · `editor` · `reset` (one function as before it was written)

mod app;
mod editor;
mod plain;
mod reset;
mod run;
mod screen;
mod terminal;

use anyhow::{Context, Result, bail};
use raykata_cli::program::ended;
use run::Paths;
use std::io::IsTerminal;
use std::process::ExitCode;

fn main() -> ExitCode {
    ended(watch().map(|()| true))
}

fn watch() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let [root, judge, ref stage @ ..] = words[..] else {
        bail!("`raykata watch` starts this program. It is not started by hand")
    };
    let paths = Paths { root: root.into(), judge: judge.into() };
    let stage = stage.first().map(|stage| stage.parse().context("the stage is no number")).transpose()?;
    let screen = std::io::stdout().is_terminal() && std::io::stdin().is_terminal();
    let dumb = std::env::var_os("TERM").is_some_and(|name| name == "dumb");
    if screen && !dumb { terminal::watch(&paths, stage) } else { plain::watch(&paths, stage) }
}
