//! Golden texts: trees, tables and counts that are the same for every correct solution. insta keeps them in
//! `tests/golden`.

use crate::broken::{Broken, CheckResult};
use crate::trial::Trial;
use raykata::kit::{Kit, kit_error};
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

/// Whether insta may write golden texts. Only the tests of the reference may, with any setting of insta: a student's run
/// compares.
fn may_write() -> bool {
    !is_sealed() && std::env::var("CARGO_PKG_NAME").is_ok_and(|package| package == "solutions")
}

/// A table that is composed from answers. The last digit of a number may differ by one, because correct solutions round
/// differently; everything else is the same for all of them.
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
        let Some(expected) = trial.expected(&compose) else {
            let is_written_again = std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always");
            let golden = golden_text(self.name).filter(|_| !(may_write() && is_written_again));
            return match golden {
                Some(golden) if are_close(&yours, &golden) => Ok(()),
                _ => compare(self.name, self.input, &yours),
            };
        };
        match are_close(&yours, &expected) {
            true => Ok(()),
            false => Err(broken(self.input.to_owned(), &yours, &expected)),
        }
    }
}

/// `value` with this many digits after the point. No zero has a sign, because the sign is that of a rounding error.
pub fn digits(value: f32, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let is_zero = text.bytes().all(|byte| b"-0.".contains(&byte));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// Whether two texts have the same words, except for numbers whose last digit differs by one.
fn are_close(yours: &str, theirs: &str) -> bool {
    let mut pairs = yours.trim_end().lines().zip(theirs.trim_end().lines());
    yours.trim_end().lines().count() == theirs.trim_end().lines().count()
        && pairs.all(|(yours, theirs)| {
            let [mine, golden] = [yours, theirs].map(|line| line.split_whitespace().collect::<Vec<_>>());
            mine.len() == golden.len()
                && mine.iter().zip(golden).all(|(mine, golden)| is_close_word(mine, golden))
        })
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

fn folder() -> &'static str {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../golden")
}

/// The golden text `name` without its header, if there is one.
fn golden_text(name: &str) -> Option<String> {
    let file = std::fs::read_to_string(format!("{}/{name}.snap", folder())).ok()?;
    file.splitn(3, "---\n").nth(2).map(str::to_owned)
}

/// Compares `text` with the golden text `name`. `INSTA_UPDATE=always cargo test -p solutions` writes it again.
pub fn compare(name: &str, input: &str, text: &str) -> CheckResult {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder());
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let golden = golden_text(name).unwrap_or("(there is no golden text)".into());
    let same = match may_write() {
        true => kit_error::catch(|| settings.bind(|| insta::assert_snapshot!(name, text))).is_ok(),
        false => golden.trim_end() == text.trim_end(),
    };
    if same {
        return Ok(());
    }
    let line = different_line(text, &golden);
    Err(broken(format!("{input}\nline {} of tests/golden/{name}.snap", line + 1), text, &golden))
}

/// The index of the first line that differs.
fn different_line(text: &str, golden: &str) -> usize {
    let lines = |text: &str| text.lines().map(|line| line.trim_end().to_owned()).collect::<Vec<String>>();
    let [yours, theirs] = [text, golden].map(lines);
    let differs = |line: usize| match (yours.get(line), theirs.get(line)) {
        (Some(yours), Some(theirs)) => yours != theirs && !are_close(yours, theirs),
        _ => true,
    };
    let n_lines = yours.len().max(theirs.len());
    let exactly = || (0..n_lines).find(|&line| yours.get(line) != theirs.get(line));
    (0..n_lines).find(|&line| differs(line)).or_else(exactly).unwrap_or(0)
}

/// The message about the first line that differs.
fn broken(input: String, text: &str, golden: &str) -> Broken {
    let line = different_line(text, golden);
    let [yours, theirs] = [text, golden].map(|text| text.lines().nth(line).unwrap_or("(the end)").trim());
    Broken::with_texts(input, yours, theirs, "the golden text")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_last_digit_may_differ_by_one() {
        for (yours, theirs) in [("a 1.200", "a 1.201"), ("-0.0001 7", "0.0000 7"), ("9.99e9", "1.00e10")] {
            assert!(are_close(yours, theirs), "{yours} {theirs}");
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
            assert!(!are_close(yours, theirs), "{yours} {theirs}");
        }
        assert_eq!([digits(-1e-9, 3), digits(-0.5, 1), digits(2.0, 0)], ["0.000", "-0.5", "2"]);
    }
}
