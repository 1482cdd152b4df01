//! The program that `raykata update` starts: `update ROOT FOLDER [--dry-run]`. It brings the kit of a student to the version of a
//! new hand-out. Functions that the student has written stay as they are, and the old text of each changed file is kept.
//!
//! `kit` (what a folder holds) · `exercise` (one file of the student) · `plan` (all changes, and how they are made)

mod exercise;
mod kit;
mod plan;

use anyhow::{Result, bail};
use kit::Kit;
use plan::Plan;
use raykata_cli::program::ended;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    ended(update().map(|()| true))
}

fn update() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (root, folder, is_trial) = match words[..] {
        [root, folder] => (root, folder, false),
        [root, folder, "--dry-run"] => (root, folder, true),
        _ => bail!("`raykata update` starts this program. It is not started by hand"),
    };
    let yours = Kit::of_student(Path::new(root))?;
    let new = Kit::handed_out(Path::new(folder))?;
    if new.version < yours.version {
        bail!("{folder} has version {}, which is older than yours, {}", new.version, yours.version);
    }
    let plan = Plan::new(&yours, &new)?;
    print!("{}", plan.summary(&yours, &new));
    if plan.is_empty() {
        println!("Everything is as in the new kit. Nothing was changed.");
    } else if is_trial {
        println!("Nothing was changed, because of --dry-run.");
    } else {
        let kept = plan.make(&yours.root)?;
        if let Some(kept) = kept {
            println!("The old texts are in {}.", kept.display());
        }
        println!("`cargo run` shows your next step.");
    }
    Ok(())
}
