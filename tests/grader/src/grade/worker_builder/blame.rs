//! Finds the files that cause compile errors, from the compiler's messages.

use crate::sandbox::Ended;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Most bytes of compiler messages that a student sees per file.
const SHOWN: usize = 4000;

/// What to do if the kit cannot call a file as it calls the exercise.
pub const OLDER: &str = "the kit cannot use this file: a name or a function is missing, or has other arguments or another \
                         result than in the exercise. If your exercises are from an older kit, copy your code into the new one\n";

/// Returns the suspects that an error points to.
type Sign = fn(&Value, &[&String]) -> BTreeSet<String>;

/// Returns the files that cause the errors, each with the messages about it. The map is empty if the messages name no file.
pub fn blame(ended: &Ended, suspects: &[&String]) -> BTreeMap<String, String> {
    let errors = errors(ended);
    // Try the most reliable sign first: the place of the error, then the places it points to, then the modules it names. If
    // an exercise is missing or has other arguments, the error lies in the glue that calls it.
    let signs: [Sign; 3] = [primary, pointed_to, named];
    for (index, sign) in signs.into_iter().enumerate() {
        let mut blamed: BTreeMap<String, String> = BTreeMap::new();
        for error in &errors {
            for name in sign(error, suspects) {
                let text = blamed.entry(name).or_default();
                let rendered = error["rendered"].as_str().unwrap_or_default();
                // E0432: the file imports what this kit does not have.
                if text.is_empty()
                    && (index > 0 || error["code"]["code"] == "E0432" && rendered.contains("`raykata"))
                {
                    text.push_str(OLDER);
                }
                if text.len() < SHOWN {
                    text.extend(rendered.chars().take(SHOWN));
                }
            }
        }
        if !blamed.is_empty() {
            return blamed;
        }
    }
    BTreeMap::new()
}

/// Returns the texts of all errors, for a file that no error names. The list is empty if the compiler died.
pub fn texts(ended: &Ended) -> String {
    let errors = errors(ended);
    let text = errors.iter().filter_map(|error| error["rendered"].as_str()).collect::<String>();
    text.chars().take(SHOWN).collect()
}

fn errors(ended: &Ended) -> Vec<Value> {
    let messages = String::from_utf8_lossy(&ended.stderr);
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    messages.filter(|message| message["level"] == "error" && message["spans"].is_array()).collect()
}

fn primary(error: &Value, suspects: &[&String]) -> BTreeSet<String> {
    spans(error)
        .into_iter()
        .filter(|span| span["is_primary"] == true)
        .filter_map(|span| file(span, suspects))
        .collect()
}

fn pointed_to(error: &Value, suspects: &[&String]) -> BTreeSet<String> {
    let children = error["children"].as_array().into_iter().flatten();
    let all = spans(error).into_iter().chain(children.flat_map(spans));
    all.filter_map(|span| file(span, suspects)).collect()
}

fn named(error: &Value, suspects: &[&String]) -> BTreeSet<String> {
    let text = error["rendered"].as_str().unwrap_or_default();
    let module = |name: &&&String| text.contains(name.trim_end_matches(".rs"));
    suspects.iter().filter(module).map(|name| (*name).clone()).collect()
}

fn spans(message: &Value) -> Vec<&Value> {
    message["spans"].as_array().into_iter().flatten().collect()
}

/// Returns the file of a span, or of the macro call around it.
fn file(span: &Value, suspects: &[&String]) -> Option<String> {
    let path = span["file_name"].as_str().unwrap_or_default();
    let is_here =
        |suspect: &&&String| path.strip_suffix(suspect.as_str()).is_some_and(|rest| rest.ends_with('/'));
    match suspects.iter().find(is_here) {
        Some(suspect) => Some((*suspect).clone()),
        None if span["expansion"].is_object() => file(&span["expansion"]["span"], suspects),
        None => None,
    }
}
