//! The result of an entry, and whether it is the required one.

use super::entry::{Claim, Entry};
use super::records::MATRIX;
use checks::Verdict;
use std::collections::BTreeMap;
use std::fmt;

/// The checks that an entry failed, with their messages.
pub type Failures = BTreeMap<&'static str, String>;

/// The words before a diagnosis.
const DIAGNOSIS: &str = "looks like:";

/// How an entry ended.
#[derive(Clone, Debug, PartialEq)]
pub enum EntryVerdict {
    /// A mistake: the named check caught it, and its message contains the words.
    Killed,
    /// A mistake: the named check caught it, and its message lacks these words.
    Unnamed(Vec<String>),
    /// A mistake that the checks do not know: the named check caught it, and its message names some other mistake.
    Misnamed,
    /// A mistake: the named check caught it, but these checks, which the matrix says reject it, accept it.
    Missed(Vec<&'static str>),
    /// A mistake: other checks caught it.
    KilledByAnother,
    /// A mistake that no check caught, of those that were tried.
    Survived,
    /// A right solution that every check accepts.
    Accepted,
    /// A right solution that a check rejects: a false alarm.
    Rejected,
}

impl EntryVerdict {
    /// Returns the verdict of an entry that failed these checks, and that passed those of `missed`, which must reject it.
    pub fn of(entry: &Entry, failures: &Failures, missed: Vec<&'static str>) -> EntryVerdict {
        match &entry.claim {
            Claim::Right if failures.is_empty() => EntryVerdict::Accepted,
            Claim::Right => EntryVerdict::Rejected,
            Claim::Wrong { .. } if failures.is_empty() => EntryVerdict::Survived,
            Claim::Wrong { caught_by, says, is_unknown, .. } => match failures.get(caught_by.as_str()) {
                None => EntryVerdict::KilledByAnother,
                Some(message) if *is_unknown && message.contains(DIAGNOSIS) => EntryVerdict::Misnamed,
                Some(message) => {
                    let message = one_line(message);
                    let missing: Vec<String> =
                        says.iter().filter(|words| !message.contains(&one_line(words))).cloned().collect();
                    match missing.is_empty() {
                        false => EntryVerdict::Unnamed(missing),
                        true if !missed.is_empty() => EntryVerdict::Missed(missed),
                        true => EntryVerdict::Killed,
                    }
                }
            },
        }
    }

    /// Returns whether this is the required result.
    pub fn is_as_it_must_be(&self) -> bool {
        matches!(self, EntryVerdict::Killed | EntryVerdict::Accepted)
    }
}

/// A text with single spaces in place of line breaks and of several spaces.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// An entry that was tested.
pub struct TriedEntry {
    /// The entry.
    pub entry: Entry,
    /// How it ended.
    pub verdict: EntryVerdict,
    /// The checks that it failed.
    pub failures: Failures,
}

impl TriedEntry {
    /// Returns the message of the named check, if it failed.
    pub fn message(&self) -> Option<&str> {
        self.failures.get(self.entry.caught_by()?).map(String::as_str)
    }

    /// Returns whether the message of the named check contains a diagnosis.
    pub fn is_diagnosed(&self) -> bool {
        self.message().is_some_and(|message| message.contains(DIAGNOSIS))
    }
}

impl fmt::Display for TriedEntry {
    /// Describes the result and what to do, for the authors of checks.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let TriedEntry { entry, verdict, failures } = self;
        let checks = || failures.keys().copied().collect::<Vec<_>>().join(", ");
        let named = entry.caught_by().unwrap_or_default();
        let message = self.message().unwrap_or_default();
        write!(f, "{entry}: {}\n  ", entry.title)?;
        match verdict {
            EntryVerdict::Killed => write!(f, "killed by {named}"),
            EntryVerdict::Accepted => write!(f, "accepted"),
            EntryVerdict::Unnamed(words) => {
                write!(f, "killed by {named}, whose message does not say {}:\n{message}", quoted(words))
            }
            EntryVerdict::Misnamed => {
                write!(f, "killed by {named}, whose message must name no mistake:\n{message}")
            }
            EntryVerdict::Missed(checks) => {
                write!(
                    f,
                    "killed by {named}, but {} accepts it, and {MATRIX} says that it rejects it",
                    checks.join(", ")
                )
            }
            EntryVerdict::KilledByAnother => write!(f, "killed, but not by {named}: by {}", checks()),
            EntryVerdict::Survived => write!(f, "SURVIVED: {named} accepts it"),
            EntryVerdict::Rejected => {
                write!(f, "FALSE ALARM: it is right, but rejected by {}", checks())?;
                failures.values().next().map_or(Ok(()), |message| write!(f, "\n{message}"))
            }
        }
    }
}

fn quoted(words: &[String]) -> String {
    words.iter().map(|words| format!("`{words}`")).collect::<Vec<_>>().join(", ")
}

/// Returns the message of a check that did not pass.
pub fn failure(verdict: Verdict) -> Option<String> {
    match verdict {
        Verdict::Passed => None,
        Verdict::Failed(message) => Some(without_lines(&message)),
        Verdict::NotWritten { task, place } => {
            Some(without_lines(&format!("not written yet: {place}\n  {task}\n")))
        }
    }
}

/// Replaces `file.rs:12` by `file.rs`, because every edit above a panic changes its line and would outdate stored messages.
pub fn without_lines(message: &str) -> String {
    let mut parts = message.split(".rs:");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        text.push_str(".rs");
        let rest = part.trim_start_matches(|c: char| c.is_ascii_digit());
        if rest.len() == part.len() {
            text.push(':'); // There is no line number.
        }
        text.push_str(rest);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_panics_are_left_out() {
        let message = "panicked at solutions/src/a.rs:12\n  words: a.rs: b\n";
        assert_eq!(without_lines(message), "panicked at solutions/src/a.rs\n  words: a.rs: b\n");
    }

    #[test]
    fn fates_follow_from_claims_and_failures() {
        let wrong = |says: Vec<String>, is_unknown: bool| Claim::Wrong {
            breaks: String::new(),
            caught_by: "b".into(),
            says,
            is_unknown,
        };
        let claim = wrong(vec!["far root".into()], false);
        let entry = |claim: &Claim| Entry {
            stage: 1,
            name: "n".into(),
            title: "t".into(),
            claim: claim.clone(),
            file: "f".into(),
            changes: Vec::new(),
        };
        let verdict = |claim: &Claim, failed: &[(&'static str, &str)]| {
            let failures = failed.iter().map(|(name, message)| (*name, (*message).to_owned())).collect();
            EntryVerdict::of(&entry(claim), &failures, Vec::new())
        };
        assert_eq!(verdict(&claim, &[]), EntryVerdict::Survived);
        assert_eq!(verdict(&claim, &[("a", "")]), EntryVerdict::KilledByAnother);
        assert_eq!(
            verdict(&claim, &[("b", "the near root")]),
            EntryVerdict::Unnamed(vec!["far root".into()])
        );
        assert_eq!(verdict(&claim, &[("b", "the far\n   root")]), EntryVerdict::Killed);
        let unknown = wrong(Vec::new(), true);
        assert_eq!(verdict(&unknown, &[("b", "  yours 3\n")]), EntryVerdict::Killed);
        assert_eq!(
            verdict(&unknown, &[("b", "  yours 3\n  looks like: the far root\n")]),
            EntryVerdict::Misnamed
        );
        let killed = Failures::from([("b", "the far root".to_owned())]);
        assert_eq!(EntryVerdict::of(&entry(&claim), &killed, vec!["c"]), EntryVerdict::Missed(vec!["c"]));
        assert_eq!(verdict(&Claim::Right, &[]), EntryVerdict::Accepted);
        assert_eq!(verdict(&Claim::Right, &[("a", "")]), EntryVerdict::Rejected);
    }
}
