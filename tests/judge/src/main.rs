//! The program that `raykata` starts: `judge check ROOT WORKER [STAGE]`, `judge status ROOT WORKER`, `judge
//! pixel ROOT WORKER CHECK X,Y`, `judge try ROOT WORKER CHECK`, `judge gauntlet ROOT WORKER INPUTS SEED`, `judge verdicts ROOT WORKER STAGE`, which writes messages, `judge hits` and `judge trials`, which
//! read requests from standard input.

use anyhow::{Result, bail};
use judge::{again, boxes_and_offsets, gauntlet, hits, pixel, scorecard, trials};
use raykata::worker::end_with_parent;
use raykata_cli::kits::{Source, Which};
use raykata_cli::program::ended;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    ended(run())
}

/// Runs a command; returns whether it succeeded.
fn run() -> Result<bool> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    // Another program reads the answers of these three.
    if let ["verdicts" | "hits" | "trials", ..] = words[..] {
        end_with_parent();
    }
    let source = |worker: &str| {
        let program = PathBuf::from(worker);
        let is_reference = program.file_stem().is_some_and(|name| name == "solutions-worker");
        Source { which: if is_reference { Which::Solutions } else { Which::Exercises }, program }
    };
    match words[..] {
        ["check", root, worker] => scorecard::scorecard(Path::new(root), &source(worker), None),
        ["check", root, worker, stage] => {
            scorecard::scorecard(Path::new(root), &source(worker), Some(stage.parse()?))
        }
        ["pixel", _, worker, check, at] => pixel::replay(&source(worker), check, at),
        ["try", _, worker, check] => again::again(&source(worker), check),
        ["status", root, worker] => scorecard::status(Path::new(root), &source(worker)).map(|()| true),
        ["gauntlet", _, worker, inputs, seed] => {
            let kit = source(worker).fresh();
            let (inputs, seed) = (inputs.parse()?, seed.parse()?);
            let triangles = gauntlet::tables(gauntlet::rows_of_kit(&*kit), inputs, seed)?;
            for table in triangles.into_iter().chain(boxes_and_offsets::tables(&*kit, inputs, seed)) {
                raykata_cli::report::say(format_args!("{}\n", table.text()));
            }
            Ok(true)
        }
        ["verdicts", _, worker, stage] => {
            scorecard::tell(&source(worker), stage.parse()?, std::io::stdout()).map(|()| true)
        }
        ["hits"] => hits::serve(std::io::stdin().lock(), std::io::stdout().lock()).map(|()| true),
        ["trials"] => trials::serve(std::io::stdin().lock(), std::io::stdout().lock()).map(|()| true),
        _ => bail!("this is the judge: `raykata check` starts it. It is not started by hand"),
    }
}
