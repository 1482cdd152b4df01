//! A broken law and its message: at most twelve lines, with the next command last.

use crate::rubric::CheckEntry;
use raykata::kit::Request;
use std::collections::BTreeSet;
use std::fmt::Write;

/// The longest call that a message shows, in bytes: a search in a tree over four primitives.
const LONGEST_CALL: usize = 1200;

/// The most lines of what the student's code prints in a call that a message shows.
const MOST_PRINTED: usize = 30;

/// The result of a check.
pub type CheckResult = Result<(), Broken>;

/// A broken law with a small input that breaks it.
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
    /// What the message is made from, and what `raykata try` repeats.
    pub details: Box<Details>,
    /// Reference, yours and difference side by side, as a PNG file, if pictures were compared in a process that
    /// [writes no files](crate::golden::seal).
    pub picture: Option<Box<Png>>,
}

/// What else is known of a broken law.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Details {
    /// All [known mistakes](Broken::explained_by) that give this answer, the most specific one first.
    pub(crate) mistakes: Vec<Mistake>,
    /// The index of the input in its batch, and the number of inputs in the batch.
    pub(crate) index: Option<(usize, usize)>,
    /// The call of the student's function that breaks the law, if it is a single one.
    pub call: Option<Request>,
}

/// A known mistake that gives an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mistake {
    text: &'static str,
    /// The number of mistakes with this text before it in its list. So mistakes that share a text stay apart.
    before: usize,
    /// Whether it is a formula: the right answers of the batch refute those that differ from them.
    is_formula: bool,
}

impl Mistake {
    /// The mistakes of a list that give the answer, or those that do not.
    pub(crate) fn those(gives: bool, listed: &[(bool, &'static str)], is_formula: bool) -> Vec<Self> {
        let before = |n: usize| listed[..n].iter().filter(|(_, text)| *text == listed[n].1).count();
        let mistake = |n: usize| Mistake { text: listed[n].1, before: before(n), is_formula };
        (0..listed.len()).filter(|&n| listed[n].0 == gives).map(mistake).collect()
    }
}

/// The words of a mistake before what says whether it is made: long words take a line of their own.
pub trait Words: Sized {
    /// A pair with the words last, as in a list of mistakes.
    fn when<T>(self, given: T) -> (T, Self) {
        (given, self)
    }
}

impl Words for &'static str {}

/// A table of mistakes with their words: `named![Flaw::Open => "…"]`.
#[macro_export]
macro_rules! named {
    ($($given:expr => $words:expr),* $(,)?) => { [$(($given, $words)),*] };
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
            ..Broken::default()
        }
    }

    /// Adds the known mistake that the answer looks like, if there is one.
    pub fn looks_like(self, diagnosis: Option<impl Into<String>>) -> Self {
        Broken { diagnosis: diagnosis.map(|text| text.into().into_boxed_str()), ..self }
    }

    /// Adds the call that breaks the law.
    pub fn in_call(mut self, call: Request) -> Self {
        self.details.call = Some(call);
        self
    }

    /// Adds observations before the mistakes that are known already, the most specific one first. Each is its text, and whether
    /// this wrong answer shows it. A wrong formula, which also computes an answer where the student's is right, belongs into the
    /// list of [`unless`](crate::judge::unless), which right answers refute.
    ///
    /// One answer is weak evidence, so the message names a mistake only if it explains every failing input of the batch:
    /// see [`first_broken`]. Variants of a mistake are entries of their own, with the same text and in the same order for
    /// every input, because one variant must explain all.
    pub fn explained_by(self, mistakes: impl IntoIterator<Item = (bool, &'static str)>) -> Self {
        self.with_mistakes(mistakes.into_iter().collect(), false)
    }

    /// The same with a mistake that this wrong answer proves.
    pub fn because(self, mistake: &'static str) -> Self {
        self.explained_by([(true, mistake)])
    }

    /// The same with wrong formulas.
    pub(crate) fn computed_by(self, formulas: Vec<(bool, &'static str)>) -> Self {
        self.with_mistakes(formulas, true)
    }

    fn with_mistakes(mut self, listed: Vec<(bool, &'static str)>, is_formula: bool) -> Self {
        self.details.mistakes.splice(..0, Mistake::those(true, &listed, is_formula));
        self.named()
    }

    /// Without the formulas that a right answer refutes.
    pub(crate) fn without(mut self, refuted: &[Mistake]) -> Self {
        self.details.mistakes.retain(|mistake| !refuted.contains(mistake));
        if refuted.is_empty() { self } else { self.named() }
    }

    /// With the first mistake as its diagnosis. Of formulas that no answer tells apart, the first two are named.
    fn named(self) -> Self {
        let known = &self.details.mistakes;
        let diagnosis = known.first().map(|first| {
            let is_other = |other: &&Mistake| other.is_formula && !other.text.contains(first.text);
            match known.iter().find(is_other).filter(|_| first.is_formula) {
                Some(second) => format!("{}\nor: {}", first.text, second.text).into(),
                None => first.text.into(),
            }
        });
        Broken { diagnosis, ..self }
    }

    /// Whether a mistake is proven for this answer.
    pub(crate) fn is_explained_by(&self, mistake: &Mistake) -> bool {
        self.details.mistakes.contains(mistake)
    }

    /// Whether the law is broken in the same way: the same words in both answers and in both expected values.
    pub(crate) fn is_like(&self, other: &Broken) -> bool {
        let is_finite = |word: &&str| word.parse().is_ok_and(f32::is_finite);
        let words = |text| words(text).filter(|word| !is_finite(word)).collect::<BTreeSet<_>>();
        words(&self.yours) == words(&other.yours) && words(&self.expected) == words(&other.expected)
    }

    /// The whole message for the student: title, slide, input, both answers, the diagnosis and the next commands.
    pub fn message(&self, check: &str, rubric: &CheckEntry) -> String {
        let mut message = rubric.header();
        // An input in words is followed by the call.
        let is_in_words = |(function, _): (&str, _)| !self.input.contains(&format!("{function}("));
        let call = self.details.call.as_ref().filter(|call| call.queries().is_some_and(is_in_words));
        let call = call.and_then(Request::call);
        let lines = if call.is_some() { 2 } else { 3 };
        let _ = writeln!(message, "  input     {}", shorten(&self.input, lines));
        let _ = match call.map(|call| (call.len(), call)) {
            None => Ok(()),
            Some((..=LONGEST_CALL, call)) => writeln!(message, "  call      {call}"),
            Some((n, _)) => {
                writeln!(message, "  call      {n} characters: `cargo run -- try {check}` prints it")
            }
        };
        let _ = writeln!(message, "  yours     {}", shorten(&self.yours, 1));
        let _ = writeln!(message, "  expected  {} ({})", shorten(&self.expected, 1), self.source);
        if let Some(diagnosis) = &self.diagnosis {
            let _ = writeln!(message, "  looks like: {}", shorten(diagnosis, 2));
        }
        message + &next_commands(rubric.stage, check)
    }
}

/// The first broken law of a batch, and its index. Of the [mistakes](Broken::explained_by) that explain it, the message
/// names the first one that explains all other failing inputs as well. If there is none, it names two that explain all
/// of them together, because copied code often has two mistakes.
pub fn first_broken(outcomes: Vec<CheckResult>) -> Option<(usize, Broken)> {
    let n_inputs = outcomes.len();
    let failing =
        outcomes.into_iter().enumerate().filter_map(|(index, outcome)| Some((index, outcome.err()?)));
    let failing: Vec<(usize, Broken)> = failing.collect();
    let (index, mut first) = failing.first()?.clone();
    first.details.index.get_or_insert((index, n_inputs));
    let known = std::mem::take(&mut first.details.mistakes);
    if known.is_empty() {
        return Some((index, first));
    }
    let explains_all = |mistake: &&Mistake| failing.iter().all(|(_, other)| other.is_explained_by(mistake));
    first.details.mistakes = known.iter().filter(explains_all).copied().collect();
    if !first.details.mistakes.is_empty() {
        return Some((index, first.named()));
    }
    // A wrong formula may give one wrong answer by chance, and an observation is certain.
    let suffices = |mistake: &Mistake, n_alone: usize| n_alone > usize::from(mistake.is_formula);
    let pair = known.iter().find_map(|one| {
        let (with, without): (Vec<_>, Vec<_>) =
            failing.iter().partition(|(_, other)| other.is_explained_by(one));
        let explains_rest = |other: &&Mistake| {
            let n_alone = with.iter().filter(|(_, broken)| !broken.is_explained_by(other)).count();
            (one.is_formula || other.is_formula)
                && other.text != one.text
                && without.iter().all(|(_, broken)| broken.is_explained_by(other))
                && suffices(one, n_alone)
                && suffices(other, without.len())
        };
        let other = without.first()?.1.details.mistakes.iter().find(explains_rest)?;
        Some((vec![*one, *other], format!("{}\nand: {}", one.text, other.text).into()))
    });
    let (mistakes, diagnosis) = pair.unzip();
    first.details.mistakes = mistakes.unwrap_or_default();
    Some((index, Broken { diagnosis, ..first }))
}

/// The result for a batch: the law that [`first_broken`] returns.
pub fn all_hold(outcomes: Vec<CheckResult>) -> CheckResult {
    first_broken(outcomes).map_or(Ok(()), |(_, broken)| Err(broken))
}

/// The message with what the student's code `printed` in the call that it is about, before the next commands.
pub fn with_output(message: &str, printed: &str) -> String {
    let (about, commands) = message.split_at(message.find("  again: ").unwrap_or(message.len()));
    match printed.trim_end() {
        "" => message.to_owned(),
        printed => format!("{about}  printed   {}\n{commands}", shorten(printed, MOST_PRINTED)),
    }
}

/// The last lines of every failure.
pub fn next_commands(stage: u8, check: &str) -> String {
    format!(
        "  again: cargo test --test stage{stage} {check}\n  print: cargo run -- try {check}\n  stuck: cargo run -- hint {check}\n"
    )
}

/// The words and numbers of a text.
pub(crate) fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|sign: char| !(sign.is_ascii_alphanumeric() || "+-._".contains(sign)))
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
    fn two_mistakes_together_may_explain_every_failing_input() {
        let fails = |formulas: [bool; 2], is_nan: bool| {
            let broken = Broken::default().explained_by([(is_nan, "nan")]);
            Err(broken.computed_by(vec![(formulas[0], "a"), (formulas[1], "b")]))
        };
        let named = |outcomes| first_broken(outcomes).and_then(|(_, broken)| broken.diagnosis);
        let (a, b, nan) =
            (|| fails([true, false], false), || fails([false, true], false), || fails([false; 2], true));
        assert_eq!(named(vec![fails([true; 2], false)]).as_deref(), Some("a\nor: b"));
        assert_eq!(named(vec![a(), b(), a(), b()]).as_deref(), Some("a\nand: b"));
        // One answer of a formula may be chance, and an observation is certain.
        assert_eq!(named(vec![a(), a(), b()]), None);
        assert_eq!(named(vec![a(), a(), nan()]).as_deref(), Some("a\nand: nan"));
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
    fn a_message_shows_thirty_of_a_hundred_lines_that_a_function_prints() {
        let printed: String = (0..100).map(|n| format!("n = {n}\n")).collect();
        let message = with_output("  yours     3\n  again: x\n", &printed);
        assert_eq!(message.matches("n = ").count(), MOST_PRINTED);
        assert!(message.contains("n = 29 …\n  again: x\n"), "{message}");
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
