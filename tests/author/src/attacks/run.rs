//! Grades all attacks.

use super::{Attack, AttackFolders, Expectation, complaints, make};
use anyhow::{Context, Result};
use grader::grade::result::Graded;
use grader::queue;
use sha2::{Digest, Sha256};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How many attacks are tried at the same time per core: some wait and do not compute. Time limits of calls count processor
/// time.
const ATTACKS_PER_CORE: u64 = 3;

/// An attack and its result.
pub struct TriedAttack {
    /// The attack.
    pub attack: Attack,
    /// Its grade with the whole syntax check, or the error if the grader failed.
    pub graded: Result<Graded>,
    /// The differences from the expected result, one sentence each.
    pub complaints: Vec<String>,
    /// How long it took.
    pub took: Duration,
}

/// Makes these attacks and grades each by `grade(submission, attack, rules of the syntax check to switch off)`. Calls `done`
/// after each. An attack with an expected result without the syntax check is graded twice. The result is sorted by
/// name.
pub fn run_all(
    root: &Path,
    mut attacks: Vec<Attack>,
    grade: impl Fn(&Path, &Attack, &[String]) -> Result<Graded> + Sync,
    done: impl Fn(&TriedAttack) + Sync,
) -> Result<Vec<TriedAttack>> {
    let root = root.canonicalize().with_context(|| root.display().to_string())?;
    // Start with the longest ones, so that no long attack runs alone at the end.
    attacks.sort_by_key(|attack| Reverse(attack.most_seconds));
    let jobs = ATTACKS_PER_CORE as usize * queue::cores();
    let mut tried = queue::run(&vec![(); jobs], &attacks, |(), attack| {
        let tried = try_one(&root, attack, &grade)?;
        done(&tried);
        Ok(tried)
    })?;
    tried.sort_by(|one, other| one.attack.name.cmp(&other.attack.name));
    Ok(tried)
}

fn try_one(
    root: &Path,
    attack: &Attack,
    grade: &impl Fn(&Path, &Attack, &[String]) -> Result<Graded>,
) -> Result<TriedAttack> {
    let begun = Instant::now();
    let folder = tempfile::tempdir()?;
    let submission = make(attack, &AttackFolders { root, folder: folder.path() })?;
    // Grade the submission, with and without the syntax check.
    let before = fingerprints(folder.path())?;
    let try_it = |expected: &Expectation| {
        let begin = Instant::now();
        let graded = grade(&submission, attack, &expected.allow);
        let mut found = match &graded {
            Ok(graded) => complaints(attack, expected, graded),
            Err(error) => vec![format!("the grader failed: {error:#}")],
        };
        let seconds = begin.elapsed().as_secs();
        // The limit is that of an attack alone on a core.
        let most = ATTACKS_PER_CORE * attack.most_seconds;
        if seconds > most {
            found.push(format!("it took {seconds} s, more than {most} s"));
        }
        (graded, found)
    };
    let (graded, mut all) = try_it(&attack.expect);
    if let Some(expected) = &attack.without_lint {
        let (_, found) = try_it(expected);
        all.extend(found.into_iter().map(|what| format!("without the syntax check: {what}")));
    }
    // Report changed files.
    let changed = changes(&before, &fingerprints(folder.path())?);
    all.extend(changed.into_iter().map(|path| format!("the attack changed {}", path.display())));
    Ok(TriedAttack { attack: attack.clone(), graded, complaints: all, took: begun.elapsed() })
}

/// Returns kind, size and content of everything in a folder. Links are not followed.
fn fingerprints(folder: &Path) -> Result<BTreeMap<PathBuf, String>> {
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
            // Do not read pipes: they may never end.
            String::new()
        };
        found.insert(path, format!("{:?} {content}", metadata.permissions()));
    }
    Ok(found)
}

/// Returns the paths that are new, gone or different.
fn changes(before: &BTreeMap<PathBuf, String>, after: &BTreeMap<PathBuf, String>) -> Vec<PathBuf> {
    let paths = before.keys().chain(after.keys().filter(|path| !before.contains_key(*path)));
    paths.filter(|path| before.get(*path) != after.get(*path)).cloned().collect()
}
