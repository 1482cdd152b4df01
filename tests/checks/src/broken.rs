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
    pub diagnosis: Option<Box<str>>,
    /// All known mistakes that give this answer, the most specific one first; `None` if the check does not
    /// [list](Broken::explained_by) them.
    pub mistakes: Option<Box<Mistakes>>,
    /// Reference, yours and difference side by side, as a PNG file, if pictures were compared in a process that
    /// [writes no files](crate::golden::seal).
    pub picture: Option<Box<Png>>,
}

/// The known mistakes that give an answer: the text of each, and how many mistakes with this text precede it in its list.
/// So mistakes that share a text stay apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistakes(Vec<(&'static str, usize)>);

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
            mistakes: None,
            picture: None,
        }
    }

    /// Adds the known mistake that the answer looks like, if there is one.
    pub fn looks_like(self, diagnosis: Option<impl Into<String>>) -> Self {
        Broken { diagnosis: diagnosis.map(|text| text.into().into_boxed_str()), ..self }
    }

    /// Adds the known mistakes that are proven for this answer, the most specific one first. Each is its text, and
    /// whether the mistake gives exactly this answer to exactly this input.
    ///
    /// One answer is weak evidence, so the message names a mistake only if it explains every failing input of the batch:
    /// see [`first_broken`]. Variants of a mistake are entries of their own, with the same text and in the same order for
    /// every input, because one variant must explain all.
    pub fn explained_by(self, mistakes: impl IntoIterator<Item = (bool, &'static str)>) -> Self {
        let mistakes: Vec<_> = mistakes.into_iter().collect();
        let before =
            |index: usize| mistakes[..index].iter().filter(|(_, text)| *text == mistakes[index].1).count();
        let proven = (0..mistakes.len())
            .filter(|&index| mistakes[index].0)
            .map(|index| (mistakes[index].1, before(index)))
            .collect();
        Broken { mistakes: Some(Box::new(Mistakes(proven))), ..self }.most_specific()
    }

    /// Adds mistakes before those that are known already, with other texts.
    pub fn explained_first_by(self, mistakes: impl IntoIterator<Item = (bool, &'static str)>) -> Self {
        let later = self.mistakes.as_ref().map_or_else(Vec::new, |mistakes| mistakes.0.clone());
        let mut broken = self.explained_by(mistakes);
        if let Some(mistakes) = &mut broken.mistakes {
            mistakes.0.extend(later);
        }
        broken.most_specific()
    }

    /// Drops a mistake that other answers of the batch refute.
    pub fn not_explained_by(mut self, mistake: &str) -> Self {
        if let Some(mistakes) = &mut self.mistakes {
            mistakes.0.retain(|(text, _)| *text != mistake);
        }
        self.most_specific()
    }

    /// With the first mistake as its diagnosis.
    fn most_specific(self) -> Self {
        let first = self.mistakes.as_ref().and_then(|mistakes| mistakes.0.first());
        Broken { diagnosis: first.map(|(text, _)| (*text).into()), ..self }
    }

    /// The mistake that the message names, if it is one of a list.
    pub(crate) fn named(&self) -> Option<(&'static str, usize)> {
        self.mistakes.as_ref()?.0.first().copied()
    }

    /// Whether a mistake is proven for this answer.
    pub(crate) fn is_explained_by(&self, mistake: (&str, usize)) -> bool {
        self.mistakes.as_ref().is_some_and(|mistakes| mistakes.0.contains(&mistake))
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

/// The first broken law of a batch, and its index. Of the [mistakes](Broken::explained_by) that explain it, the message
/// names the first one that explains all other failing inputs as well, and none if there is no such mistake.
pub fn first_broken(outcomes: Vec<CheckResult>) -> Option<(usize, Broken)> {
    let mut failing =
        outcomes.into_iter().enumerate().filter_map(|(index, outcome)| Some((index, outcome.err()?)));
    let (index, mut first) = failing.next()?;
    let Some(mistakes) = &mut first.mistakes else { return Some((index, first)) };
    for (_, other) in failing {
        mistakes.0.retain(|mistake| other.is_explained_by(*mistake));
    }
    Some((index, first.most_specific()))
}

/// The result for a batch: the law that [`first_broken`] returns.
pub fn all_hold(outcomes: Vec<CheckResult>) -> CheckResult {
    first_broken(outcomes).map_or(Ok(()), |(_, broken)| Err(broken))
}

/// The last lines of every failure.
pub fn next_commands(stage: u8, check: &str) -> String {
    format!(
        "  again: cargo test --test stage{stage} {check}\n  print: cargo run -- try {check}\n  stuck: cargo run -- hint {check}\n"
    )
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
    fn a_mistake_is_named_only_if_it_explains_every_failing_input() {
        let fails = |mistakes: &[&'static str]| {
            Err(Broken::default().explained_by(mistakes.iter().map(|mistake| (true, *mistake))))
        };
        let named = |outcomes| first_broken(outcomes).map(|(index, broken)| (index, broken.diagnosis));
        assert_eq!(named(vec![Ok(()), Ok(())]), None);
        assert_eq!(named(vec![Ok(()), fails(&["a", "b"])]), Some((1, Some("a".into()))));
        assert_eq!(named(vec![fails(&["a", "b"]), Ok(()), fails(&["b", "c"])]), Some((0, Some("b".into()))));
        assert_eq!(named(vec![fails(&["a"]), fails(&["b"])]), Some((0, None)));
        assert_eq!(named(vec![fails(&["a"]), fails(&[])]), Some((0, None)));
    }

    #[test]
    fn variants_that_share_a_text_explain_a_batch_only_alone() {
        let fails =
            |variants: [bool; 2]| Err(Broken::default().explained_by(variants.map(|gives| (gives, "a"))));
        let named = |outcomes| first_broken(outcomes).map(|(_, broken)| broken.diagnosis);
        assert_eq!(named(vec![fails([false, true]), fails([true, true])]), Some(Some("a".into())));
        assert_eq!(named(vec![fails([true, false]), fails([false, true])]), Some(None));
    }

    #[test]
    fn the_longest_message_has_twelve_lines() {
        let long = "a line\n".repeat(30);
        let broken = Broken::with_texts(&long, &long, &long, "brute force").looks_like(Some(&long));
        let entry = crate::rubric::entry(3, "union_holds_both_boxes");
        let message = broken.message("some_check", &entry);
        assert!(message.lines().count() <= 12, "{message}");
        assert!(message.ends_with("cargo run -- hint some_check\n"));
    }
}
