//! Hands all attacks to a grader.

use super::{Attack, Expectation, Place, choose, complaints, load, make};
use crate::grade::result::Graded;
use crate::queue;
use anyhow::{Context, Result};
use sha2::{Digest, Sha256};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Makes the attacks of these names, all if none is named, hands each to `grade` (submission, stages, rules of the syntax
/// check that are switched off), and says what is not as it must be. Those that also name what must come of them without
/// the syntax check are graded twice.
pub fn run_all(
    root: &Path,
    names: &[String],
    grade: impl Fn(&Path, &[u8], &[String]) -> Result<Graded> + Sync,
) -> Result<Vec<(Attack, Vec<String>)>> {
    let root = root.canonicalize().with_context(|| root.display().to_string())?;
    let mut attacks = choose(load(&root)?, names)?;
    // The longest first, or everybody waits for the last one.
    attacks.sort_by_key(|attack| Reverse(attack.most_seconds));
    let complaints = queue::run(&queue::one_a_core(), &attacks, |(), attack| try_one(&root, attack, &grade))?;
    let mut tried: Vec<(Attack, Vec<String>)> = attacks.into_iter().zip(complaints).collect();
    tried.sort_by(|(one, _), (other, _)| one.name.cmp(&other.name));
    Ok(tried)
}

fn try_one(
    root: &Path,
    attack: &Attack,
    grade: &impl Fn(&Path, &[u8], &[String]) -> Result<Graded>,
) -> Result<Vec<String>> {
    let folder = tempfile::tempdir()?;
    let submission = make(attack, &Place { root, folder: folder.path() })?;
    let before = fingerprints(folder.path())?;
    let graded = |expected: &Expectation| {
        let begin = Instant::now();
        let mut found = match grade(&submission, &attack.stages, &expected.allow) {
            Ok(graded) => complaints(&attack.stages, expected, &graded),
            Err(error) => vec![format!("the grader gave up: {error:#}")],
        };
        let seconds = begin.elapsed().as_secs();
        if seconds > attack.most_seconds {
            found.push(format!("it took {seconds} s, and {} should do", attack.most_seconds));
        }
        found
    };
    let mut all = graded(&attack.expect);
    if let Some(expected) = &attack.without_lint {
        all.extend(graded(expected).into_iter().map(|what| format!("without the syntax check: {what}")));
    }
    let changed = changes(&before, &fingerprints(folder.path())?);
    all.extend(changed.into_iter().map(|path| format!("it changed {}", path.display())));
    Ok(all)
}

/// What lies in a folder: kind, size and content of everything, links not followed.
pub(super) fn fingerprints(folder: &Path) -> Result<BTreeMap<PathBuf, String>> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(path) = waiting.pop() {
        let metadata = fs::symlink_metadata(&path).with_context(|| path.display().to_string())?;
        let content = if metadata.is_symlink() {
            fs::read_link(&path)?.display().to_string()
        } else if metadata.is_dir() {
            for entry in fs::read_dir(&path)? {
                waiting.push(entry?.path());
            }
            String::new()
        } else if metadata.is_file() {
            Sha256::digest(fs::read(&path)?).iter().map(|byte| format!("{byte:02x}")).collect()
        } else {
            // A pipe may never end.
            String::new()
        };
        found.insert(path, format!("{:?} {content}", metadata.permissions()));
    }
    Ok(found)
}

/// What is new, gone or different.
pub(super) fn changes(before: &BTreeMap<PathBuf, String>, after: &BTreeMap<PathBuf, String>) -> Vec<PathBuf> {
    let paths = before.keys().chain(after.keys().filter(|path| !before.contains_key(*path)));
    paths.filter(|path| before.get(*path) != after.get(*path)).cloned().collect()
}
