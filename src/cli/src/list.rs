//! `raykata list` and `raykata hint`: the contents of the rubric.

use crate::args::{Argument, Given, Misuse, Spec, whole_number, wrapped};
use crate::report::say;
use anyhow::{Result, bail};
use raykata::rubric::{self, CheckEntry};
use std::fmt::Write;
use std::process::ExitCode;

/// `raykata list`.
pub static LIST: Spec = Spec {
    name: "raykata list",
    about: "List the checks with their points.",
    arguments: &[STAGE],
    options: &[],
};

/// `raykata hint`.
pub static HINT: Spec = Spec {
    name: "raykata hint",
    about: "Get a hint for a check.",
    arguments: &[
        Argument::required("CHECK", "Its name, as `raykata list` and failing tests print it."),
        Argument::optional("LEVEL", "1 is a question, 2 the formula, 3 nearly the code [default: 1]."),
    ],
    options: &[],
};

/// The argument of `raykata list` and `raykata watch`.
pub const STAGE: Argument = Argument::optional("STAGE", "One stage only, such as 3 or stage3.");

/// The requested stage, if any: `3` and `stage3` are the same. A stage that does not exist is an error.
pub fn stage(given: &Given) -> Result<Option<u8>, Misuse> {
    let known: Vec<u8> = rubric::stages().into_iter().map(|(number, _)| number).collect();
    given.parsed_argument(0, |text| {
        let number = text.strip_prefix("stage").unwrap_or(text).parse().ok();
        number.filter(|number| known.contains(number)).ok_or_else(|| {
            let (first, last) = (known.first().unwrap_or(&0), known.last().unwrap_or(&0));
            match rubric::stages().iter().find(|(_, stage)| stage.checks.contains_key(text)) {
                Some((of, _)) => format!("this is a check; run it by `cargo test --test stage{of} {text}`"),
                None => format!("there is no such stage; there are stages {first} to {last}"),
            }
        })
    })
}

/// Prints the checks of a stage, or of all.
pub fn run(given: &Given) -> Result<ExitCode> {
    say(format_args!("{}", list(stage(given)?)));
    Ok(ExitCode::SUCCESS)
}

/// Prints a hint for a check.
pub fn run_hint(given: &Given) -> Result<ExitCode> {
    let level = given.parsed_argument(1, |text| whole_number(text, &(1..=3)))?.unwrap_or(1);
    say(format_args!("{}", hint(&given.required(0)?.to_string_lossy(), level)?));
    Ok(ExitCode::SUCCESS)
}

/// The checks of a stage, or of all stages, with their points, levels and titles.
pub fn list(stage: Option<u8>) -> String {
    let mut text = String::new();
    let chosen = |number: u8| stage.is_none_or(|stage| stage == number);
    for (number, about) in rubric::stages().into_iter().filter(|(number, _)| chosen(*number)) {
        let _ = writeln!(text, "stage {number} · {}", about.title);
        let how = format!("work in {}, run `cargo test --test stage{number}`", about.file);
        let _ = writeln!(text, "  {}", wrapped(&how, 2));
        for (name, entry) in about.in_order() {
            let _ = writeln!(text, "  {:>2}  {:<8}  {name}", entry.points, entry.level().word());
            let _ = writeln!(text, "      {}", wrapped(&entry.title, 6));
        }
        text.push('\n');
    }
    text
}

/// The entry of a check in the rubric; the error names checks with similar names.
pub fn entry(name: &str) -> Result<&'static CheckEntry> {
    let all: Vec<(&str, &'static CheckEntry)> =
        rubric::stages().into_iter().flat_map(|(_, stage)| stage.in_order()).collect();
    let Some((_, entry)) = all.iter().find(|(check, _)| *check == name) else {
        let names = || all.iter().map(|(check, _)| *check);
        let mut near: Vec<&str> = names().filter(|other| other.contains(name)).collect();
        if near.is_empty() {
            near = names().filter(|other| strsim::jaro_winkler(other, name) > 0.85).collect();
        }
        near.truncate(5);
        match near.is_empty() {
            true => bail!("there is no check `{name}`; `raykata list` shows all"),
            false => bail!("there is no check `{name}`; did you mean {}?", near.join(", ")),
        }
    };
    Ok(entry)
}

/// One of the three hints of a check.
pub fn hint(name: &str, level: usize) -> Result<String> {
    let entry = entry(name)?;
    let mut text = format!("{}\n  {}\n\n", entry.header(), entry.hints[level - 1]);
    if level < entry.hints.len() {
        let _ = writeln!(text, "  still stuck: cargo run -- hint {name} {}", level + 1);
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_fits_a_terminal_and_has_every_check() {
        let all = list(None);
        let long: Vec<&str> = all.lines().filter(|line| line.chars().count() > 80).collect();
        assert!(long.is_empty(), "{long:#?}");
        for (number, stage) in rubric::stages() {
            let one = list(Some(number));
            assert!(all.contains(&one) && stage.checks.keys().all(|name| one.contains(name.as_str())));
        }
    }
}
