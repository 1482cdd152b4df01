//! `judge trials`: single checks of many workers. The mutation testing of `author` changes a check, builds this program, and asks
//! whether a verdict differs.

use anyhow::{Context, Result};
use raykata::worker::{receive, send};
use raykata_cli::kits::{Source, Which};
use raykata_cli::verdicts::{CheckTrial, Verdict};
use std::io::{ErrorKind, Read, Write};

/// Answers trials until the pipe closes.
pub fn serve(mut asked: impl Read, mut answers: impl Write) -> Result<()> {
    loop {
        match receive(&mut asked) {
            Ok(trial) => send(&mut answers, &verdict(&trial)?)?,
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(error.into()),
        }
    }
}

fn verdict(trial: &CheckTrial) -> Result<Verdict> {
    let check = all_checks::find(trial.stage, &trial.check)
        .with_context(|| format!("stage {} has no check `{}`", trial.stage, trial.check))?;
    let kit = Source { which: Which::Solutions, program: trial.worker.clone() }.fresh();
    Ok(match trial.needs_message {
        true => checks::run(check, &kit, 0),
        false if checks::passes(check, &kit, 0) => Verdict::Passed,
        false => Verdict::Failed(String::new()),
    })
}
