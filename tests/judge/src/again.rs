//! `raykata try CHECK`: the call of the message of a check again, alone, with everything that the student's code prints.

use crate::pixel::{find, shorten};
use anyhow::Result;
use checks::broken::with_output;
use checks::calls::{Calls, breaking_call};
use checks::{Inputs, Verdict, examine, verdict};
use raykata::kit::{Answer, Function, KitError, Request};
use raykata_cli::args::wrapped;
use raykata_cli::kits::Source;
use raykata_cli::worker::Worker;

/// Repeats the call of the message of the check `name`; `Ok(true)` if the check passes.
pub fn again(source: &Source, name: &str) -> Result<bool> {
    let check = find(name)?;
    let calls = Calls::default();
    let inputs = Inputs { calls: Some(calls.clone()), ..Inputs::default() };
    let examined = examine(check, &source.fresh(), 0, inputs);
    let request = if examined.is_ok() { breaking_call(&examined) } else { unanswered(&calls, source) };
    match (verdict(check, examined), request) {
        (Verdict::Passed, _) => {
            println!("`{name}` passes, so there is no input to try");
            return Ok(true);
        }
        (Verdict::NotWritten { task, place }, _) => println!("not written yet: {place}\n  {task}"),
        (Verdict::Failed(message), Some(request)) => {
            let (answer, printed) = Worker::alone(source.program.clone(), request.clone());
            println!("{}\n{}", with_output(&message, &printed), report(&request, check.stage, &answer));
        }
        (Verdict::Failed(message), None) => println!(
            "{message}\nThis message describes its input in words, so there is no single call to repeat."
        ),
    }
    Ok(false)
}

/// The answer to a call, and how a student repeats it.
fn report(request: &Request, stage: u8, answer: &Result<Answer, KitError>) -> String {
    let (function, _) = request.queries().unwrap_or_default();
    let answer = match answer {
        Ok(answer) => {
            format!("returns {}", answer.values().first().map_or_else(String::new, |one| shorten(one)))
        }
        Err(error) => format!("does not answer: {error}"),
    };
    // Searches and builders of several stages share a name.
    let is_it = |one: &&Function| one.name() == function && one.stage() == stage;
    let file = Function::ALL.iter().find(is_it).map_or("", |one| one.file());
    format!(
        "{function}, with this input alone, {answer}\n\nTo call it yourself, paste this at the end of \
         exercises/src/{file}.rs:\n\n  #[test]\n  fn again() {{\n      use glam::*;\n      use raykata::kit::types::*;\n      \
         println!(\"{{:?}}\", crate::Kit.door().{});\n  }}\n\nand run\n\n  cargo test -p exercises --lib -- --nocapture",
        wrapped(&request.call().unwrap_or_default(), 10)
    )
}

/// The first call of the last batch without an answer that has none when it is made alone.
fn unanswered(calls: &Calls, source: &Source) -> Option<Request> {
    let (batch, _) = calls.batches().iter().rev().find(|(_, answer)| answer.is_none())?.clone();
    let alone = |call: &Request| Worker::alone(source.program.clone(), call.clone()).0;
    (0..).map_while(|index| batch.only(index)).find(|call| alone(call).is_err())
}
