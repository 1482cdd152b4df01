//! Searches the hand-out for lines of answers.

use super::FOLDERS;
use crate::exercises::{self, Block};
use crate::files_below::files_below;
use aho_corasick::AhoCorasick;
use anyhow::{Context, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A marker in an answer in `solutions/src/lib.rs`. It must not occur anywhere else.
pub const CANARY: &str = "canary-answers-9b1f6c52";

/// Shortest line that is searched for, in bytes. Shorter lines, such as `}`, occur in any code.
const SHORTEST: usize = 30;

/// Returns the lines that identify answers, per file of `solutions/src`: long lines that occur neither in the exercises nor
/// in the scaffold, the checks or the hints.
pub fn answers(root: &Path) -> Result<BTreeMap<String, BTreeSet<String>>> {
    // Collect all text that students may read.
    let exercises = exercises::exercises(root)?;
    let mut public: String = exercises.iter().map(|exercise| exercise.stub.as_str()).collect();
    let of_code = FOLDERS.iter().filter(|(_, endings)| endings.contains(&"rs"));
    for (known, _) in of_code.filter(|(folder, _)| root.join(folder).exists()) {
        public.extend(texts(&root.join(known))?.into_iter().map(|(_, text)| text));
    }
    // Collect the long lines of each answer.
    let mut answers = BTreeMap::new();
    for exercise in &exercises {
        let name = exercise.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let path = root.join("solutions/src").join(&name);
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let mut known = BTreeSet::new();
        for block in exercises::blocks(&text, &path)? {
            if let Block::Answer(answer, _) = block {
                let answer = answer.into_iter().filter(|line| !line.trim_start().starts_with("// <"));
                known.extend(answer.flat_map(lines).filter(|line| !line.contains(CANARY)));
            }
        }
        answers.insert(name, known);
    }
    // Leave out those that occur in public text.
    let known: BTreeSet<&str> = answers.values().flatten().map(String::as_str).collect();
    let public: BTreeSet<String> = Search::new(known)?.in_text(&public).map(str::to_owned).collect();
    for known in answers.values_mut() {
        known.retain(|line| !public.contains(line));
    }
    answers.retain(|_, known| !known.is_empty());
    Ok(answers)
}

/// Returns the lines of answers, and the marker, that occur in the files of a folder.
pub fn leaks(root: &Path, folder: &Path) -> Result<Vec<String>> {
    let answers = answers(root)?;
    let search = Search::new(answers.values().flatten().map(String::as_str).collect())?;
    let mut leaks = Vec::new();
    for (file, text) in texts(folder)? {
        if text.contains(CANARY) {
            leaks.push(format!("{file}: the canary"));
        }
        let held: BTreeSet<&str> = search.in_text(&text).collect();
        for (solution, lines) in &answers {
            let held = lines.iter().filter(|line| held.contains(line.as_str()));
            leaks.extend(held.map(|line| format!("{file}: `{line}` of solutions/src/{solution}")));
        }
    }
    Ok(leaks)
}

/// A search for many lines at once.
struct Search<'a> {
    lines: Vec<&'a str>,
    automaton: AhoCorasick,
}

impl<'a> Search<'a> {
    fn new(lines: BTreeSet<&'a str>) -> Result<Self> {
        let lines: Vec<&str> = lines.into_iter().collect();
        Ok(Search { automaton: AhoCorasick::new(&lines)?, lines })
    }

    /// The lines that occur in `text`, also as parts of longer lines; some more than once.
    fn in_text<'b>(&'b self, text: &'b str) -> impl Iterator<Item = &'a str> + 'b {
        self.automaton.find_overlapping_iter(text).map(|found| self.lines[found.pattern()])
    }
}

fn lines(text: &str) -> impl Iterator<Item = String> {
    text.lines().map(str::trim).filter(|line| line.len() > SHORTEST).map(str::to_owned)
}

/// Returns all files below a folder as text, with invalid UTF-8 replaced.
fn texts(folder: &Path) -> Result<Vec<(String, String)>> {
    let mut texts = Vec::new();
    for name in files_below(folder, "", &|_| true)? {
        let path = folder.join(&name);
        let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
        texts.push((name, String::from_utf8_lossy(&bytes).into_owned()));
    }
    texts.sort();
    Ok(texts)
}
