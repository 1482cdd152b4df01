//! Golden texts: trees, tables and counts that are the same for every correct solution, in `tests/golden`.

use crate::broken::{Broken, CheckResult};
use crate::trial::Trial;
use raykata::kit::Kit;
use std::sync::atomic::{AtomicBool, Ordering};

static SEALED: AtomicBool = AtomicBool::new(false);

/// From now on this process writes no files beside the golden texts and pictures, and environment variables do not
/// change a verdict. The grader calls this before it judges submissions.
pub fn seal() {
    SEALED.store(true, Ordering::Relaxed);
}

/// Whether [`seal`] was called.
pub(crate) fn is_sealed() -> bool {
    SEALED.load(Ordering::Relaxed)
}

/// Whether golden texts are written again. Only the tests of the reference do so: a student's run compares.
fn is_written_again() -> bool {
    let is = |name: &str, value: &str| std::env::var(name).is_ok_and(|set| set == value);
    !is_sealed() && is("CARGO_PKG_NAME", "solutions") && is("INSTA_UPDATE", "always")
}

/// A table that is composed from answers. The last digit of a number may differ by one, because correct solutions round
/// differently; everything else is the same for all of them. If the name of a function precedes its answers, the message has the
/// call that gives the wrong word.
pub struct Table<'a> {
    /// The name of the golden text.
    pub name: &'a str,
    /// What the table shows, for the message.
    pub input: &'a str,
}

impl Table<'_> {
    /// Composes the table from the answers of the trial's kit, and compares it with the golden text; or, for a hidden seed and
    /// with a reference to ask, with the table that the answers of the reference make.
    #[track_caller]
    pub fn check(&self, trial: &Trial<'_>, compose: impl Fn(&dyn Kit) -> String) -> CheckResult {
        let yours = compose(trial.kit);
        let composed = trial.expected(&compose);
        let expected = composed.as_deref().cloned().or_else(|| golden_text(self.name)).unwrap_or_default();
        let judged = match composed {
            None if is_written_again() => compare(self.name, self.input, &yours),
            None => judge(&format!("{}\ntests/golden/{}.snap", self.input, self.name), &yours, &expected),
            Some(_) => judge(self.input, &yours, &expected),
        };
        judged.map_err(|mut broken| {
            let words: Vec<&str> = yours.split_whitespace().collect();
            let pairs = words.iter().zip(expected.split_whitespace());
            let n_right = pairs.take_while(|(yours, expected)| is_close_word(yours, expected)).count();
            broken.details.call = trial.calls.of_table(&words, n_right);
            broken
        })
    }
}

/// `value` with this many digits after the point. No zero has a sign, because the sign is that of a rounding error.
pub fn digits(value: f32, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let is_zero = text.bytes().all(|byte| b"-0.".contains(&byte));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// The index of the first line whose words differ, except for numbers whose last digit differs by one.
fn different_line(yours: &str, theirs: &str) -> Option<usize> {
    let words = |text: &str, line: usize| {
        text.lines().nth(line).map(|line| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    };
    let is_close = |line: usize| match (words(yours, line), words(theirs, line)) {
        (Some(yours), Some(theirs)) => {
            yours.len() == theirs.len()
                && yours.iter().zip(&theirs).all(|(yours, theirs)| is_close_word(yours, theirs))
        }
        _ => false,
    };
    let n_lines = yours.trim_end().lines().count().max(theirs.trim_end().lines().count());
    (0..n_lines).find(|&line| !is_close(line))
}

fn is_close_word(yours: &str, theirs: &str) -> bool {
    // A number with a point: its value, and one unit of its last digit.
    let number = |word: &str| {
        let (mantissa, exponent) = word.split_once('e').unwrap_or((word, "0"));
        let (_, decimals) = mantissa.split_once('.')?;
        let value = word.parse::<f64>().ok().filter(|value| value.is_finite())?;
        Some((value, 10f64.powi(exponent.parse::<i32>().ok()? - decimals.len() as i32)))
    };
    match (number(yours), number(theirs)) {
        // 1.001: the difference of two decimal fractions is rounded.
        (Some((yours, _)), Some((theirs, unit))) => (yours - theirs).abs() <= 1.001 * unit,
        _ => yours == theirs,
    }
}

fn path(name: &str) -> String {
    format!("{}/../golden/{name}.snap", env!("CARGO_MANIFEST_DIR"))
}

/// The golden text `name` without its header, if there is one.
fn golden_text(name: &str) -> Option<String> {
    let file = std::fs::read_to_string(path(name)).ok()?;
    file.splitn(3, "---\n").nth(2).map(str::to_owned)
}

/// Compares `text` with the golden text `name`. `INSTA_UPDATE=always cargo test -p solutions` writes it again.
pub fn compare(name: &str, input: &str, text: &str) -> CheckResult {
    let golden = golden_text(name).unwrap_or("(there is no golden text)".into());
    if golden.trim_end() == text.trim_end() {
        return Ok(());
    }
    if is_written_again() {
        let file = format!("---\nsource: tests/checks/src/golden.rs\n---\n{}\n", text.trim_end());
        return std::fs::write(path(name), file)
            .map_err(|error| Broken::new(name, error, "a file", "written"));
    }
    judge(&format!("{input}\ntests/golden/{name}.snap"), text, &golden)?;
    Err(Broken::with_texts(input, "other last digits", "those of the golden text", "the golden text"))
}

/// The broken law with the first line that differs.
fn judge(input: &str, text: &str, golden: &str) -> CheckResult {
    let Some(line) = different_line(text, golden) else { return Ok(()) };
    let [yours, theirs] = [text, golden].map(|text| text.lines().nth(line).unwrap_or("(the end)").trim());
    Err(Broken::with_texts(format!("{input}, line {}", line + 1), yours, theirs, "the golden text"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_last_digit_may_differ_by_one() {
        for (yours, theirs) in [("a 1.200", "a 1.201"), ("-0.0001 7", "0.0000 7"), ("9.99e9", "1.00e10")] {
            assert_eq!(different_line(yours, theirs), None, "{yours} {theirs}");
        }
        let apart = [
            ("1.200", "1.202"),
            ("7", "8"),
            ("-", "1.0"),
            ("1.0 2.0", "1.0"),
            ("1.0", "1.0\n2.0"),
            ("NaN", "1.0"),
        ];
        for (yours, theirs) in apart {
            assert!(different_line(yours, theirs).is_some(), "{yours} {theirs}");
        }
        assert_eq!([digits(-1e-9, 3), digits(-0.5, 1), digits(2.0, 0)], ["0.000", "-0.5", "2"]);
    }
}
