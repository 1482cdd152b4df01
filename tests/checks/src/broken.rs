//! A broken law and its message: at most twelve lines, with the next command last.

use crate::rubric::CheckEntry;
use std::fmt::Write;

/// The result of a check.
pub type CheckResult = Result<(), Broken>;

/// A broken law with the smallest input that breaks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Broken {
    /// The call, as Rust that can be pasted into a test.
    pub input: String,
    /// The answer of the student's code.
    pub yours: String,
    /// The expected answer.
    pub expected: String,
    /// The origin of `expected`: a closed form, double precision, brute force …
    pub source: &'static str,
    /// The known mistake that gives this answer, if there is one.
    pub diagnosis: Option<String>,
    /// Reference, yours and difference side by side, as a PNG file, if pictures were compared in a process that
    /// [writes no files](crate::golden::seal).
    pub picture: Option<Box<Png>>,
}

/// The bytes of a PNG file.
#[derive(Clone, Debug, PartialEq)]
pub struct Png(pub Vec<u8>);

impl Broken {
    /// A broken law: for `input` the code returned `yours`, but `source` gives `expected`.
    pub fn new(
        input: impl Into<String>,
        yours: impl std::fmt::Debug,
        expected: impl std::fmt::Debug,
        source: &'static str,
    ) -> Self {
        Broken::with_texts(input, format!("{yours:?}"), format!("{expected:?}"), source)
    }

    /// The same with texts in place of values.
    pub fn with_texts(
        input: impl Into<String>,
        yours: impl Into<String>,
        expected: impl Into<String>,
        source: &'static str,
    ) -> Self {
        Broken {
            input: input.into(),
            yours: yours.into(),
            expected: expected.into(),
            source,
            diagnosis: None,
            picture: None,
        }
    }

    /// Adds the known mistake that the answer looks like, if there is one.
    pub fn looks_like(self, diagnosis: Option<impl Into<String>>) -> Self {
        Broken { diagnosis: diagnosis.map(Into::into), ..self }
    }

    /// The whole message for the student: title, slide, input, both answers, the diagnosis and the next commands.
    pub fn message(&self, check: &str, rubric: &CheckEntry) -> String {
        let mut message = rubric.header();
        let _ = writeln!(message, "  input     {}", shorten(&self.input, 3));
        let _ = writeln!(message, "  yours     {}", shorten(&self.yours, 1));
        let _ = writeln!(message, "  expected  {} ({})", shorten(&self.expected, 1), self.source);
        if let Some(diagnosis) = &self.diagnosis {
            let _ = writeln!(message, "  looks like: {}", shorten(diagnosis, 2));
        }
        message + &next_commands(rubric.stage, check)
    }
}

/// The last two lines of every failure.
pub fn next_commands(stage: u8, check: &str) -> String {
    format!("  again: cargo test --test stage{stage} {check}\n  stuck: cargo run -- hint {check}\n")
}

/// The first `lines` lines of a text, each cut after 400 characters.
fn shorten(text: &str, lines: usize) -> String {
    let mut cut: Vec<String> = text
        .lines()
        .take(lines)
        .map(|line| match line.char_indices().nth(400) {
            Some((end, _)) => format!("{} …", &line[..end]),
            None => line.to_owned(),
        })
        .collect();
    if text.lines().count() > lines
        && let Some(last) = cut.last_mut()
    {
        last.push_str(" …");
    }
    cut.join("\n            ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_message_has_twelve_lines() {
        let long = "a line\n".repeat(30);
        let broken = Broken::with_texts(&long, &long, &long, "brute force").looks_like(Some(&long));
        let entry = CheckEntry { stage: 3, ..CheckEntry::default() };
        let message = broken.message("some_check", &entry);
        assert!(message.lines().count() <= 12, "{message}");
        assert!(message.ends_with("cargo run -- hint some_check\n"));
    }
}
