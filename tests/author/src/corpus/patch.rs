//! Differences as `diff -u` prints them: the changes of cargo-mutants.

use super::entry::Sign;
use anyhow::{Context, Result, bail};

/// A part of a patch: lines that go, come and stay.
struct Hunk {
    /// The line of the old file at which it begins, from 0.
    start: usize,
    /// Its lines.
    lines: Vec<(Sign, String)>,
}

/// Reads the parts of a patch.
fn hunks(diff: &str) -> Result<Vec<Hunk>> {
    let mut hunks: Vec<Hunk> = Vec::new();
    for line in diff.lines().skip(2) {
        if let Some(rest) = line.strip_prefix("@@ -") {
            let start = rest.split([',', ' ']).next().unwrap_or_default();
            let start: usize = start.parse().with_context(|| format!("`{line}` names no line"))?;
            hunks.push(Hunk { start: start.saturating_sub(1), lines: Vec::new() });
        } else if !line.starts_with('\\') {
            // A line that begins with a backslash says that the file has no line break at its end.
            let (sign, text) = match line.is_empty() {
                true => (Sign::Stays, ""),
                false => Sign::of(line).with_context(|| format!("`{line}` is no line of a patch"))?,
            };
            let hunk = hunks.last_mut().with_context(|| format!("`{line}` stands before the first `@@`"))?;
            hunk.lines.push((sign, text.to_owned()));
        }
    }
    Ok(hunks)
}

impl Hunk {
    /// The line at which the old lines stand: the nearest to the place that the patch names.
    fn find(&self, lines: &[&str]) -> Result<usize> {
        let old: Vec<&str> = self
            .lines
            .iter()
            .filter(|(sign, _)| *sign != Sign::Comes)
            .map(|(_, line)| line.as_str())
            .collect();
        let first = self.lines.iter().position(|(sign, _)| *sign != Sign::Stays).unwrap_or_default();
        let last = self.lines.iter().rev().position(|(sign, _)| *sign != Sign::Stays).unwrap_or_default();
        // Try with all lines around the change, then with fewer.
        for fewer in 0..=first.max(last) {
            let (skip, cut) = (fewer.min(first), fewer.min(last));
            let wanted = &old[skip..old.len() - cut];
            if wanted.is_empty() {
                break;
            }
            let found = (0..lines.len()).filter(|at| lines[*at..].starts_with(wanted));
            if let Some(at) = found.min_by_key(|at| at.abs_diff(self.start + skip)) {
                return Ok(at - skip.min(at));
            }
        }
        bail!("its lines are not in the file:\n    {}", old.join("\n    "))
    }
}

/// Returns a text with a difference applied.
pub fn apply(diff: &str, text: &str) -> Result<String> {
    let mut lines: Vec<&str> = text.split('\n').collect();
    let hunks = hunks(diff)?;
    // From the last part on, so that the lines of those before keep their places.
    for hunk in hunks.iter().rev() {
        let at = hunk.find(&lines)?;
        let kept = |sign: Sign| {
            hunk.lines.iter().filter(move |(other, _)| *other != sign).map(|(_, line)| line.as_str())
        };
        let old = kept(Sign::Comes).count();
        lines.splice(at..at + old, kept(Sign::Goes));
    }
    Ok(lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIFF: &str = "--- a/a.rs\n+++ b/a.rs\n@@ -1,2 +1,3 @@\n one\n-two\n+zwei\n+drei\n";

    #[test]
    fn a_difference_is_applied_also_where_lines_have_moved() {
        assert_eq!(apply(DIFF, "one\ntwo\n").unwrap(), "one\nzwei\ndrei\n");
        assert_eq!(apply(DIFF, "zero\none\ntwo\nend").unwrap(), "zero\none\nzwei\ndrei\nend");
        assert!(apply(DIFF, "one\nthree\n").unwrap_err().to_string().contains("not in the file"));
    }
}
