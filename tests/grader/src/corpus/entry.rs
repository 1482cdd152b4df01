//! An entry of the corpus: a patch of one file of the solutions, with a header that states the required result.

use anyhow::{Context, Result, anyhow, bail};
use std::fmt;
use std::path::Path;

/// The required result of an entry.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// A mistake, which a check must find and name.
    Wrong {
        /// The error of the lecture notes that it repeats, if any.
        trap: Option<String>,
        /// The check that must catch it.
        caught_by: String,
        /// Words that must appear in the message of that check.
        says: Vec<String>,
        /// Whether the message must name no mistake, because the checks do not know this one (`diagnosis: none`).
        is_unknown: bool,
    },
    /// Another right solution, which every check must accept.
    Right,
}

/// The solutions with one difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The stage whose checks it must pass or fail.
    pub stage: u8,
    /// The name of its file, without `.patch`.
    pub name: String,
    /// The mistake or the method, in a sentence.
    pub title: String,
    /// The required result.
    pub claim: Claim,
    /// The file it changes, from the root of the kit: `solutions/src/…`.
    pub file: String,
    /// The difference as `diff -u` prints it.
    pub diff: String,
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/stage{}/{}", self.kind(), self.stage, self.name)
    }
}

impl Entry {
    /// Returns the folder of the entry: `wrong` or `right`.
    pub fn kind(&self) -> &'static str {
        if self.claim == Claim::Right { "right" } else { "wrong" }
    }

    /// Returns whether it is a mistake that the checks must name.
    pub fn has_a_known_mistake(&self) -> bool {
        matches!(self.claim, Claim::Wrong { is_unknown: false, .. })
    }

    /// Reads the text of `tests/corpus/KIND/stageN/NAME.patch`.
    pub fn parse(kind: &str, stage: u8, name: &str, text: &str) -> Result<Entry> {
        let start = if text.starts_with("--- ") { Some(0) } else { text.find("\n--- ").map(|at| at + 1) };
        let Some(start) = start else {
            bail!("there is no difference after the header (a line `--- a/…`)")
        };
        let (header, diff) = text.split_at(start);
        let mut header = Header::parse(header)?;
        let (title, claim) = match kind {
            "wrong" => {
                let (trap, caught_by) = (header.take("trap").pop(), header.one("caught_by")?);
                let (says, diagnosis) = (header.take("says"), header.take("diagnosis").pop());
                let is_unknown = diagnosis.is_some();
                if diagnosis.is_some_and(|word| word != "none") {
                    bail!("`diagnosis:` must be `none`; for words of a diagnosis write `says:`");
                }
                if says.is_empty() && !is_unknown {
                    bail!("the header lacks `says: words of the message` or `diagnosis: none`");
                }
                (header.one("mistake")?, Claim::Wrong { trap, caught_by, says, is_unknown })
            }
            _ => (header.one("method")?, Claim::Right),
        };
        header.nothing_left()?;
        let mut files = diff.lines().filter_map(|line| line.strip_prefix("+++ b/"));
        let file = files
            .next()
            .ok_or_else(|| anyhow!("there is no line `+++ b/solutions/src/…`"))?
            .trim()
            .to_owned();
        if files.next().is_some() {
            bail!("it changes several files; an entry may change only one");
        }
        if !file.starts_with("solutions/src/") || file.contains("..") {
            bail!("it changes {file}; an entry must change a file of solutions/src");
        }
        Ok(Entry { stage, name: name.to_owned(), title, claim, file, diff: diff.to_owned() })
    }

    /// Returns the text of the file with the difference applied.
    pub fn apply(&self, original: &str) -> Result<String> {
        apply(&self.file, &self.diff, original)
    }
}

/// Returns the text of a file with a difference applied.
pub fn apply(file: &str, diff: &str, original: &str) -> Result<String> {
    let patch = diffy::Patch::from_str(diff).map_err(|error| anyhow!("{error}"))?;
    let changed = diffy::apply(original, &patch)
        .map_err(|error| anyhow!("it does not fit the current {file}: {error}"))?;
    if changed == original {
        bail!("it changes nothing in {file}");
    }
    Ok(changed)
}

/// Lines `key: value`; comments begin with `#`.
struct Header(Vec<(String, String)>);

impl Header {
    fn parse(text: &str) -> Result<Header> {
        let lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
        let pair = |line: &str| match line.split_once(':') {
            Some((key, value)) if !value.trim().is_empty() => {
                Ok((key.trim().to_owned(), value.trim().to_owned()))
            }
            _ => Err(anyhow!("the header has the line `{line}`, which is not `key: value`")),
        };
        lines.map(pair).collect::<Result<_>>().map(Header)
    }

    fn take(&mut self, key: &str) -> Vec<String> {
        let (taken, left) = std::mem::take(&mut self.0).into_iter().partition(|(name, _)| name == key);
        self.0 = left;
        let taken: Vec<(String, String)> = taken;
        taken.into_iter().map(|(_, value)| value).collect()
    }

    fn one(&mut self, key: &str) -> Result<String> {
        let mut values = self.take(key);
        match (values.pop(), values.is_empty()) {
            (Some(value), true) => Ok(value),
            (Some(_), false) => bail!("the header has several lines `{key}: …`"),
            (None, _) => bail!("the header lacks a line `{key}: …`"),
        }
    }

    fn nothing_left(&self) -> Result<()> {
        match self.0.first() {
            None => Ok(()),
            Some((key, _)) => bail!(
                "the header has `{key}`, which is not one of mistake, trap, caught_by, says, diagnosis (wrong) or method (right)"
            ),
        }
    }
}

/// Reads all entries of the kit at `root`, sorted by stage, then wrong before right, then by name.
pub fn read_all(root: &Path) -> Result<Vec<Entry>> {
    let mut entries = Vec::new();
    for kind in ["wrong", "right"] {
        let folder = root.join("tests/corpus").join(kind);
        for stage_folder in list(&folder)? {
            let Some(stage) = stage_folder.strip_prefix("stage").and_then(|number| number.parse().ok())
            else {
                bail!("tests/corpus/{kind}/{stage_folder}: entries lie in folders stage1, stage2, …");
            };
            for file in list(&folder.join(&stage_folder))? {
                let place = format!("tests/corpus/{kind}/{stage_folder}/{file}");
                let Some(name) = file.strip_suffix(".patch") else {
                    bail!("{place}: entries are files NAME.patch");
                };
                let text = std::fs::read_to_string(root.join(&place)).with_context(|| place.clone())?;
                entries.push(Entry::parse(kind, stage, name, &text).with_context(|| place)?);
            }
        }
    }
    entries.sort_by(|one, other| {
        let key = |entry: &Entry| (entry.stage, entry.claim == Claim::Right, entry.name.clone());
        key(one).cmp(&key(other))
    });
    Ok(entries)
}

/// Returns the names in a folder, sorted. A missing folder has no names.
fn list(folder: &Path) -> Result<Vec<String>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let read = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut names: Vec<String> =
        read.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned())).collect::<Result<_>>()?;
    names.sort();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIFF: &str =
        "--- a/solutions/src/a.rs\n+++ b/solutions/src/a.rs\n@@ -1,2 +1,2 @@\n-one\n+eins\n two\n";

    fn wrong(header: &str) -> Result<Entry> {
        Entry::parse("wrong", 1, "counts", &format!("{header}\n{DIFF}"))
    }

    #[test]
    fn an_entry_is_read_and_applied() {
        let entry =
            wrong("mistake: it counts\ntrap: S3\ncaught_by: a_check\nsays: too\nsays: many\n").unwrap();
        assert_eq!(entry.to_string(), "wrong/stage1/counts");
        let Claim::Wrong { trap, caught_by, says, .. } = &entry.claim else { panic!("{entry:?}") };
        assert_eq!((trap.as_deref(), caught_by.as_str(), says.len()), (Some("S3"), "a_check", 2));
        assert_eq!(entry.apply("one\ntwo\n").unwrap(), "eins\ntwo\n");
        assert!(entry.apply("three\nfour\n").unwrap_err().to_string().contains("does not fit"));
    }

    #[test]
    fn an_entry_may_forbid_a_diagnosis() {
        let entry = wrong("mistake: it counts\ncaught_by: a_check\ndiagnosis: none\n").unwrap();
        assert!(matches!(&entry.claim, Claim::Wrong { says, is_unknown: true, .. } if says.is_empty()));
        assert!(wrong("mistake: m\ncaught_by: c\ndiagnosis: some").is_err());
    }

    #[test]
    fn a_header_that_lacks_something_or_has_too_much_is_refused() {
        let text = |header: &str| wrong(header).unwrap_err().to_string();
        assert!(text("mistake: it counts\nsays: many").contains("lacks a line `caught_by: …`"));
        assert!(text("mistake: it counts\ncaught_by: a_check").contains("lacks `says"));
        assert!(text("mistake: m\ncaught_by: c\nsays: s\ntarp: S3").contains("has `tarp`"));
        assert!(text("mistake").contains("not `key: value`"));
    }
}
