//! `raykata try CHECK`: the call of the message of a check again, alone, with everything that the student's code prints.

use crate::pixel::{Batch, Recorder, find, shorten};
use anyhow::Result;
use checks::{Inputs, Verdict, examine_with, verdict};
use raykata::frame::Unwatched;
use raykata::kit::{Answer, Door, Function, Kit, Request, Transport, kit_error};
use raykata_cli::kits::Source;
use raykata_cli::worker::{CALL_PATIENCE, Worker};
use std::sync::{Arc, PoisonError};

/// Repeats the call of the message of the check `name`; `Ok(true)` if the check passes.
pub fn again(source: &Source, name: &str) -> Result<bool> {
    let check = find(name)?;
    let batches = Arc::default();
    let recorder: Arc<dyn Kit + Send + Sync> =
        Arc::new(Door(Recorder { kit: source.fresh(), batches: Arc::clone(&batches) }));
    let outcome = examine_with(check, &recorder, 0, Inputs::default());
    let broken = outcome.as_ref().ok().and_then(|result| result.as_ref().err()).cloned();
    match verdict(check, outcome) {
        Verdict::Passed => {
            println!("`{name}` passes, so there is no input to try");
            return Ok(true);
        }
        Verdict::NotWritten { task, place } => {
            println!("not written yet: {place}\n  {task}");
            return Ok(false);
        }
        Verdict::Failed(message) => println!("{message}"),
    }
    let batches = batches.lock().unwrap_or_else(PoisonError::into_inner);
    let request = match &broken {
        Some(broken) => batches.iter().rev().find_map(|batch| call_of(batch, &broken.input, &broken.yours)),
        None => {
            let unanswered = batches.iter().rev().find(|(_, answer)| answer.is_none());
            unanswered.and_then(|(request, _)| failing(request, source))
        }
    };
    let Some(request) = request else {
        println!("This message describes its input in words, so there is no single call to repeat.");
        return Ok(false);
    };
    let (function, queries) = request.queries().unwrap_or_default();
    println!("{function}, with this input alone, prints:");
    // The worker ends here, so that its last line is shown before the answer.
    let answer = kit_error::catch(|| {
        Worker::showing(source.program.clone(), CALL_PATIENCE).call(request.clone(), &Unwatched)
    });
    match &answer {
        Ok(answer) => {
            println!("and returns {}", answer.values().first().map_or_else(String::new, |one| shorten(one)))
        }
        Err(error) => println!("and then: {error}"),
    }
    // Searches and builders of several stages share a name.
    let is_it = |one: &&Function| one.name() == function && one.stage() == check.stage;
    let file = Function::ALL.iter().find(is_it).map_or("", |one| one.file());
    match &broken {
        Some(broken) if broken.input.contains(&format!("{function}(")) => println!(
            "\nTo call it yourself, paste this at the end of exercises/src/{file}.rs:\n\n  #[test]\n  fn again() {{\n      use glam::*;\n      use raykata::kit::types::*;\n      dbg!({});\n  }}\n\nand run\n\n  cargo test -p exercises --lib -- --nocapture",
            broken.input
        ),
        _ => println!("\nthe input\n  {}", queries.first().map_or_else(String::new, |one| shorten(one))),
    }
    Ok(false)
}

/// The query of a batch that a message is about: its answer is `yours`, and the function and all numbers of `input` are those
/// of the query, in the same order.
fn call_of((request, answer): &Batch, input: &str, yours: &str) -> Option<Request> {
    let (function, queries) = request.queries()?;
    let answers = answer.as_ref().map(Answer::values).unwrap_or_default();
    let is_it = |index: &usize| {
        let query = format!("{:?}", queries[*index]);
        let mut numbers_of_query = numbers(&query).into_iter();
        let mut has_all =
            || numbers(input).iter().all(|number| numbers_of_query.any(|other| other == *number));
        // A call that panics has no answer.
        answers.get(*index).is_none_or(|answer| format!("{answer:?}") == yours)
            && (query == input || input.contains(function) && has_all())
    };
    let found = (0..queries.len()).rev().find(is_it)?;
    request.only(found)
}

/// The first query of a batch without an answer that has none when it is asked alone.
fn failing(request: &Request, source: &Source) -> Option<Request> {
    let (_, queries) = request.queries()?;
    let kit = Worker::new(source.program.clone(), CALL_PATIENCE);
    let calls = (0..queries.len()).filter_map(|index| request.only(index));
    calls.into_iter().find(|call| kit_error::catch(|| kit.call(call.clone(), &Unwatched)).is_err())
}

/// The numbers of a text, as they are written.
fn numbers(text: &str) -> Vec<&str> {
    let words =
        text.split(|letter: char| !(letter.is_ascii_alphanumeric() || letter == '.' || letter == '-'));
    words
        .filter(|word| word.trim_start_matches('-').starts_with(|first: char| first.is_ascii_digit()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use raykata::kit::RootQuery;
    use raykata::ray::Ray;

    #[test]
    fn the_call_of_a_message_is_found_among_all_calls() {
        let query =
            |roots| RootQuery { roots, ray: Ray::new(glam::Vec3::ZERO, glam::Vec3::X).with_range(1.0, 4.0) };
        let queries = vec![query([3.0, 0.5]), query([0.5, 3.0]), query([0.5, 2.0])];
        let input = "nearest_root([0.5, 3.0], &Ray::new(vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0)).with_range(1.0, 4.0))";
        let batch = (Request::NearestRoot(queries), Some(Answer::NearestRoot(vec![None, None, Some(2.0)])));
        let expected = Some(Request::NearestRoot(vec![query([0.5, 3.0])]));
        assert_eq!(call_of(&batch, input, "None"), expected);
        assert_eq!(call_of(&batch, input, "Some(2.0)"), None);
        assert_eq!(call_of(&batch, &input.replace("nearest_root", "plane"), "None"), None);
    }
}
