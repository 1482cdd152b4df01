//! The attack corpus: submissions that try to get points without earning them or to do harm, and honest ones that look
//! suspicious. `tests/corpus/attack/FAMILY.toml` says how each attack of a family is made and what result it must get; see
//! `README.md` there.
//!
//! `step` (the steps of an attack) · `make` (the folder or archive) · `source` (changes of a source file) · `pack` (archives
//! that no archiver makes) · `remember` (memorised answers) · `verdict` (compares the result) · `run` (runs all attacks)
//!
//! This module neither runs nor compiles an attack. Only the sandbox may do that.

mod make;
mod pack;
mod remember;
mod run;
mod source;
mod step;
mod verdict;

pub use make::{AttackFolders, CANARY, make};
pub use run::run_all;
pub use verdict::{Earned, Expectation, complaints};

use anyhow::{Context, Result, bail, ensure};
use grader::files_below::files_below;
use grader::grade::Shard;
use serde::Deserialize;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// The folder of the attacks, below the root of the kit.
const FOLDER: &str = "tests/corpus/attack";

/// The target of an attack. The attacks of a family stand in the file of its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// No target: the submission is honest and must get the points that it has earned.
    #[default]
    Honest,
    /// The verdict: the attack forges one.
    Forging,
    /// Processor time, memory, or the end of the worker's process.
    Exhausting,
    /// Processes, files, memory and networks of others, at run time.
    Escaping,
    /// Files of others, at compile time.
    Including,
    /// Symbols and sections of the linked program.
    Linking,
    /// The configuration of cargo, compiler and tests, in files and environment variables.
    Settings,
    /// The time and memory of the compiler.
    Compiling,
    /// The code that unpacks the archive or traverses the folder.
    Packing,
    /// The judge, by malformed answers.
    Answers,
    /// The code that reads the worker's messages.
    Protocol,
    /// Points for answers that are right on public inputs only.
    Guessing,
    /// The readers of the report.
    Words,
}

/// The files of a submission before the first step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Base {
    /// Untouched exercises.
    #[default]
    Stubs,
    /// The files of the graded stages are right.
    Solutions,
    /// The files of the graded stages give answers that no check accepts, so that every point is built.
    Wrong,
    /// There are no files.
    Nothing,
}

/// What has a quarter of its time for attacks that run into a time limit whose length they do not test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hasty {
    /// The calls of the judge. The right answers of such an attack take less than half of this shorter time.
    Calls,
    /// The compiler.
    Compiler,
}

/// A submission and the result that it must get.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attack {
    /// Its name, which no other attack has.
    pub name: String,
    /// Its target: the name of the file.
    #[serde(skip)]
    pub family: Family,
    /// The texts that several attacks use, by name. They are those of all files.
    #[serde(skip)]
    fragments: Arc<BTreeMap<String, String>>,
    /// The attack in a few words.
    pub title: String,
    /// What the attack tries, and what a grader that trusts it would do.
    pub what: String,
    /// Its files before the first step.
    #[serde(default)]
    pub base: Base,
    /// The name of the submission, if it differs from that of the attack.
    pub student: Option<String>,
    /// The same name as hexadecimal bytes, for names that are not valid UTF-8.
    pub student_hex: Option<String>,
    /// The graded stages.
    #[serde(default = "stage_one")]
    pub stages: Vec<u8>,
    /// The checks of these stages that are judged, if not all. One `*` in a name matches any text.
    pub checks: Option<Vec<String>>,
    /// The time limit for grading it on an idle machine, in seconds.
    #[serde(default = "a_minute")]
    pub most_seconds: u64,
    /// What has a quarter of its time.
    pub hasty: Option<Hasty>,
    /// The steps that make the submission, in order.
    #[serde(default)]
    pub step: Vec<step::Step>,
    /// The result that it must get.
    pub expect: Expectation,
    /// The result that it must get with rules of the syntax check switched off. This tests the sandbox itself.
    pub without_lint: Option<Expectation>,
}

impl Attack {
    /// Returns whether the judge tries this check.
    pub fn is_judged(&self, stage: u8, check: &str) -> bool {
        let named = |names: &Vec<String>| names.iter().any(|name| verdict::is_like(check, name));
        self.stages.contains(&stage) && self.checks.as_ref().is_none_or(named)
    }
}

fn stage_one() -> Vec<u8> {
    vec![1]
}

fn a_minute() -> u64 {
    60
}

/// A file of attacks.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FamilyFile {
    /// Texts that several attacks use.
    #[serde(default)]
    fragments: BTreeMap<String, String>,
    attack: Vec<Attack>,
}

/// Loads all attacks of the kit at `root`, sorted by name.
pub fn load(root: &Path) -> Result<Vec<Attack>> {
    let (mut attacks, mut fragments) = (Vec::new(), BTreeMap::new());
    for file in files_below(root, FOLDER, &|path| path.ends_with(".toml"))? {
        let of_family = read(&root.join(&file)).with_context(|| file.clone())?;
        attacks.extend(of_family.attack);
        for (name, text) in of_family.fragments {
            let twice = format!("{file}: another file has a fragment `{name}`: choose another name");
            ensure!(fragments.insert(name, text).is_none(), twice);
        }
    }
    let fragments = Arc::new(fragments);
    attacks.iter_mut().for_each(|attack| attack.fragments = fragments.clone());
    attacks.sort_by(|one, other| one.name.cmp(&other.name));
    if let Some(pair) = attacks.windows(2).find(|pair| pair[0].name == pair[1].name) {
        let [family, other] = [pair[0].family, pair[1].family];
        bail!("{FOLDER}: two attacks are called `{}` ({family:?}, {other:?}): rename one", pair[0].name);
    }
    Ok(attacks)
}

/// Returns the attacks with these names, or all if `names` is empty.
pub fn choose(attacks: Vec<Attack>, names: &[String]) -> Result<Vec<Attack>> {
    for name in names {
        ensure!(attacks.iter().any(|attack| attack.name == *name), "{FOLDER} has no attack `{name}`");
    }
    Ok(attacks.into_iter().filter(|attack| names.is_empty() || names.contains(&attack.name)).collect())
}

/// Returns a part of the attacks. All attacks of a later stage are in one part, because preparing a judge for it takes some
/// seconds. Those of stage 1 fill up the parts, so that the time limits of each part have about the same sum.
pub fn part(attacks: Vec<Attack>, shard: Shard) -> Vec<Attack> {
    let (mut of_stage_1, others): (Vec<_>, Vec<_>) =
        attacks.into_iter().partition(|attack| attack.stages == stage_one());
    let mut parts: Vec<Vec<Attack>> = vec![Vec::new(); shard.of as usize];
    for attack in others {
        let last = attack.stages.iter().max().copied().unwrap_or_default();
        parts[usize::from(last) % shard.of as usize].push(attack);
    }
    // Begin with the attacks that take longest.
    of_stage_1.sort_by_key(|attack| Reverse(attack.most_seconds));
    let sum = |part: &Vec<Attack>| part.iter().map(|attack| attack.most_seconds).sum::<u64>();
    for attack in of_stage_1 {
        if let Some(least) = parts.iter_mut().min_by_key(|part| sum(part)) {
            least.push(attack);
        }
    }
    parts.swap_remove(shard.index as usize - 1)
}

fn read(file: &Path) -> Result<FamilyFile> {
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let family: Family =
        toml::Value::String(name).try_into().context("the file has the name of no family")?;
    let mut of_family: FamilyFile = toml::from_str(&fs::read_to_string(file)?)?;
    of_family.attack.iter_mut().for_each(|attack| attack.family = family);
    let unsorted = of_family.attack.windows(2).find(|pair| pair[0].name > pair[1].name);
    if let Some(pair) = unsorted {
        bail!("`{}` stands before `{}`: sort the attacks by name", pair[0].name, pair[1].name);
    }
    Ok(of_family)
}

#[cfg(test)]
mod tests;
