//! A law that was broken, and how it is describe: at most twelve lines, the next command last.

use crate::rubric::Entry;
use std::fmt::Write;

/// What a check finds.
pub type Outcome = Result<(), Broken>;

/// A broken law with the smallest input that breaks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Broken {
    /// The call, as Rust that can be pasted into a test.
    pub input: String,
    /// What came back.
    pub yours: String,
    /// What should have come back.
    pub expected: String,
    /// Where `expected` comes from: a closed form, double precision, brute force …
    pub source: &'static str,
    /// The mistake that makes just this answer, if it is a known one.
    pub diagnosis: Option<String>,
    /// Reference, yours and difference side by side, as a PNG file, if pictures were compared by somebody who
    /// [writes nothing](crate::golden::seal).
    pub picture: Option<Box<Png>>,
}

/// The bytes of a PNG file.
#[derive(Clone, Debug, PartialEq)]
pub struct Png(pub Vec<u8>);

impl Broken {
    /// `yours` came back for `input` where `expected` should have, according to `source`.
    pub fn new(
        input: impl Into<String>,
        yours: impl std::fmt::Debug,
        expected: impl std::fmt::Debug,
        source: &'static str,
    ) -> Self {
        Broken::with_texts(input, format!("{yours:?}"), format!("{expected:?}"), source)
    }

    /// The same with words in place of values.
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

    /// Adds what the answer looks like, if it looks like anything.
    pub fn looks_like(self, diagnosis: Option<impl Into<String>>) -> Self {
        Broken { diagnosis: diagnosis.map(Into::into), ..self }
    }

    /// The whole message.
    pub fn message(&self, check: &str, rubric: &Entry) -> String {
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

/// At most `lines` lines of text, each at most 160 characters.
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
        let entry = Entry { stage: 3, ..Entry::default() };
        let message = broken.message("some_check", &entry);
        assert!(message.lines().count() <= 12, "{message}");
        assert!(message.ends_with("cargo run -- hint some_check\n"));
    }
}
