//! Whether anything that is handed out holds answers.

use super::FOLDERS;
use crate::sync::{self, Block};
use anyhow::{Context, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Stands in an answer in `solutions/src/lib.rs` and must stand nowhere else.
pub const CANARY: &str = "canary-answers-9b1f6c52";

/// Shorter lines are `}` and what anybody writes.
const SHORTEST: usize = 30;

/// The lines of the answers by which they can be told, by file of `solutions/src`: long ones that are neither in the
/// exercises nor in what everybody may read, the scaffold, the laws and the hints.
pub fn answers(root: &Path) -> Result<BTreeMap<String, BTreeSet<String>>> {
    let exercises = sync::exercises(root)?;
    let mut public: String = exercises.iter().map(|exercise| exercise.stub.as_str()).collect();
    for (known, _) in FOLDERS.iter().filter(|(folder, _)| root.join(folder).exists()) {
        public.extend(texts(&root.join(known))?.into_iter().map(|(_, text)| text));
    }
    public += &super::text(root, "tests/rubric.toml")?;
    let mut answers = BTreeMap::new();
    for exercise in &exercises {
        let name = exercise.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let path = root.join("solutions/src").join(&name);
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let mut told = BTreeSet::new();
        for block in sync::blocks(&text, &path)? {
            if let Block::Answer(answer, _) = block {
                let answer = answer.into_iter().filter(|line| !line.trim_start().starts_with("// <"));
                let tells = |line: &String| !public.contains(line.as_str()) && !line.contains(CANARY);
                told.extend(answer.flat_map(lines).filter(tells));
            }
        }
        if !told.is_empty() {
            answers.insert(name, told);
        }
    }
    Ok(answers)
}

/// Lines of answers, and the canary, in the files of a folder.
pub fn leaks(root: &Path, folder: &Path) -> Result<Vec<String>> {
    let answers = answers(root)?;
    let mut leaks = Vec::new();
    for (file, text) in texts(folder)? {
        if text.contains(CANARY) {
            leaks.push(format!("{file}: the canary"));
        }
        for (solution, lines) in &answers {
            let held = lines.iter().filter(|line| text.contains(line.as_str()));
            leaks.extend(held.map(|line| format!("{file}: `{line}` of solutions/src/{solution}")));
        }
    }
    Ok(leaks)
}

fn lines(text: &str) -> impl Iterator<Item = String> {
    text.lines().map(str::trim).filter(|line| line.len() > SHORTEST).map(str::to_owned)
}

/// All files below a folder, whatever bytes they hold.
fn texts(folder: &Path) -> Result<Vec<(String, String)>> {
    let mut texts = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            for entry in fs::read_dir(&path).with_context(|| path.display().to_string())? {
                waiting.push(entry?.path());
            }
        } else {
            let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
            let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
            texts.push((name, String::from_utf8_lossy(&bytes).into_owned()));
        }
    }
    texts.sort();
    Ok(texts)
}
